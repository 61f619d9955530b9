// SPDX-License-Identifier: MIT
// When is a graph complete? Every expected stage is there and every link is confirmed by the publishing side.
#include <gtest/gtest.h>

#include "run_source.hpp"

namespace {

atlas_msgs::StageHello hello(const std::string& stage, const std::string& process,
                             std::vector<std::string> inputs, std::vector<std::string> outputs,
                             std::vector<std::string> links = {}) {
  atlas_msgs::StageHello msg;
  msg.stage = stage;
  msg.process = process;
  msg.inputs = std::move(inputs);
  msg.outputs = std::move(outputs);
  msg.links = std::move(links);
  return msg;
}

TEST(Graph, NamesTheStageThatIsMissing) {
  EXPECT_EQ(atlas_loader::missingInGraph({"deskew"}, {}), "stage deskew has not said hello");
}

TEST(Graph, StagesOfOneProcessAreLinkedBySharingIt) {
  EXPECT_EQ(atlas_loader::missingInGraph({"a", "b"}, {{"a", hello("a", "/manager", {}, {"/x"})},
                                                      {"b", hello("b", "/manager", {"/x"}, {})}}),
            "");
}

TEST(Graph, LinksBetweenProcessesNeedConfirmation) {
  std::map<std::string, atlas_msgs::StageHello> hellos = {{"a", hello("a", "/a", {}, {"/x"})},
                                                          {"b", hello("b", "/b", {"/x"}, {})}};
  EXPECT_EQ(atlas_loader::missingInGraph({"a", "b"}, hellos), "b is not linked to /x of a");
  hellos["a"].links = {"/x /b"};
  EXPECT_EQ(atlas_loader::missingInGraph({"a", "b"}, hellos), "");
}

TEST(Graph, EveryMissingLinkIsNamedWithTheProcessThatHasToSubscribeAgain) {
  const auto links = atlas_loader::missingLinks({{"a", hello("a", "/a", {}, {"/x", "/y"}, {"/x /b"})},
                                                 {"b", hello("b", "/b", {"/x", "/y"}, {"/z"})},
                                                 {"c", hello("c", "/c", {"/x", "/z"}, {})}});
  ASSERT_EQ(links.size(), 3U);
  EXPECT_EQ(links[0].topic + " " + links[0].process, "/y /b");
  EXPECT_EQ(links[1].topic + " " + links[1].process, "/x /c");
  EXPECT_EQ(links[2].topic + " " + links[2].process, "/z /c");
  EXPECT_EQ(links[2].producer, "b");
}

TEST(Graph, ATopicHasOneProducer) {
  std::map<std::string, atlas_msgs::StageHello> hellos = {
      {"detector", hello("detector", "/a", {}, {"/atlas/progress", "/atlas/x/detections"})},
      {"source", hello("source", "/b", {}, {"/atlas/progress", "/atlas/graph_start"})}};
  EXPECT_NO_THROW(atlas_loader::requireOneProducer(hellos));
  hellos["source"].outputs.push_back("/atlas/x/detections");
  try {
    atlas_loader::requireOneProducer(hellos);
    FAIL() << "two producers";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()),
              "/atlas/x/detections comes from detector and from source; a topic has one producer");
  }
}

TEST(Graph, ATopicWithoutProducerIsNoObstacle) {
  EXPECT_EQ(atlas_loader::missingInGraph({"b"}, {{"b", hello("b", "/b", {"/nobody"}, {})}}), "");
}

TEST(RunSourceParams, NamesFieldAndValue) {
  atlas_loader::RunSourceParams params;
  params.stages = {"a"};
  params.lead_s = 0.1;
  try {
    validate(params);
    FAIL() << "a lead of 0.1 s is too short";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("lead_s"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("0.1"), std::string::npos);
  }
}

}  // namespace
