// SPDX-License-Identifier: MIT
// Scans wherever they lie: in the folder, in scans/, in scans.zip.
#include "record/scan_store.hpp"

#include <gtest/gtest.h>

#include "small_zip.hpp"
#include "temporary_folder.hpp"

namespace atlas::record {
namespace {

using test::TemporaryFolder;
using Indices = std::vector<std::uint32_t>;

TEST(ScanStore, NumberIsInTheName) {
  EXPECT_EQ(scanIndex("scan000012.pcd"), 12U);
  EXPECT_EQ(scanIndex("some/folder/scan7.pcd"), 7U);
  for (const char* name :
       {"scan.pcd", "scan-1.pcd", "scan1.ply", "frame1.pcd", "scan1a.pcd", "scan99999999999.pcd", ""})
    EXPECT_FALSE(scanIndex(name)) << name;
}

TEST(ScanStore, LooseFilesComeFirstThenScansThenZip) {
  const TemporaryFolder folder;
  EXPECT_EQ(openScanStore(folder.path()), nullptr);
  test::writeZip(folder / "scans.zip", {{"scan000003.pcd", "in zip"}});
  EXPECT_EQ(openScanStore(folder.path())->place(), "scans.zip");
  folder.write("scans/scan000002.pcd", "in folder");
  EXPECT_EQ(openScanStore(folder.path())->place(), "scans");
  folder.write("scan000001.pcd", "loose");
  const auto store = openScanStore(folder.path());
  EXPECT_EQ(store->place(), "");
  EXPECT_EQ(store->indices(), Indices{1});
  EXPECT_EQ(store->read(1).bytes, "loose");
  EXPECT_EQ(store->read(2).error, "scan missing");
}

TEST(ScanStore, SameNumberTwiceIsCountedAndTheSameEveryTime) {
  const TemporaryFolder folder;
  folder.write("scan1.pcd", "short name");
  folder.write("scan000001.pcd", "long name");
  const auto store = openScanStore(folder.path());
  EXPECT_EQ(store->repeated(), 1U);
  EXPECT_EQ(store->read(1).bytes, "long name") << "the first one by name";
}

TEST(ZipStore, ReadsInAnyOrderAndKeepsBigMembersWhole) {
  const TemporaryFolder folder;
  std::string big;
  for (std::uint32_t i = 0; i < 300'000; ++i) big += static_cast<char>(i * 7919U >> 3);
  test::writeZip(folder / "scans.zip", {{"scan000000.pcd", "zero"},
                                        {"readme.txt", "?"},
                                        {"sub/scan000001.pcd", big},
                                        {"scan000002.pcd", "two"}});
  const auto store = openScanStore(folder.path());
  EXPECT_EQ(store->indices(), (Indices{0, 1, 2}));
  EXPECT_EQ(store->listingError(), "");
  EXPECT_EQ(store->read(2).bytes, "two");
  EXPECT_EQ(store->read(0).bytes, "zero") << "backwards";
  EXPECT_EQ(store->read(1).bytes, big);
  EXPECT_EQ(store->read(1).bytes, big) << "again";
}

TEST(ZipStore, DamagedMemberIsAnErrorAndTheOthersAreRead) {
  const TemporaryFolder folder;
  std::string big;
  for (std::uint32_t i = 0; i < 50'000; ++i) big += static_cast<char>((i * i) >> 5);
  test::writeZip(folder / "scans.zip",
                 {{"scan000000.pcd", "zero"}, {"scan000001.pcd", big}, {"scan000002.pcd", "two"}});
  std::string bytes = folder.read("scans.zip");
  const std::size_t middle = bytes.find("scan000001.pcd") + 2000;
  for (std::size_t i = 0; i < 64; ++i) bytes[middle + i] = static_cast<char>(~bytes[middle + i]);
  folder.write("scans.zip", bytes);
  const auto store = openScanStore(folder.path());
  EXPECT_EQ(store->read(0).bytes, "zero");
  EXPECT_EQ(store->read(1).error, "zip member damaged");
  EXPECT_EQ(store->read(2).bytes, "two");
}

TEST(ZipStore, CutArchiveGivesWhatIsThere) {
  const TemporaryFolder folder;
  test::writeZip(folder / "scans.zip",
                 {{"scan000000.pcd", std::string(5000, 'a')}, {"scan000001.pcd", std::string(5000, 'b')}});
  const std::string bytes = folder.read("scans.zip");
  folder.write("scans.zip", bytes.substr(0, bytes.find("scan000001.pcd") + 20));  // no directory at the end
  const auto store = openScanStore(folder.path());
  ASSERT_NE(store, nullptr);
  EXPECT_EQ(store->read(0).bytes, std::string(5000, 'a'));
  EXPECT_FALSE(store->read(1).error.empty());
  EXPECT_FALSE(store->listingError().empty()) << "the user is told";
}

TEST(ZipStore, GarbageHasNoScansAndSaysSo) {
  const TemporaryFolder folder;
  folder.write("scans.zip", std::string(10'000, '\x5a'));
  const auto store = openScanStore(folder.path());
  ASSERT_NE(store, nullptr);
  EXPECT_TRUE(store->indices().empty());
  EXPECT_FALSE(store->listingError().empty());
  EXPECT_EQ(store->read(0).error, "scan missing");
}

}  // namespace
}  // namespace atlas::record
