// SPDX-License-Identifier: MIT
// Depth images, frustums and thermal labels, from the boxes and detections of a drive of one second.
#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "evaluate_fixture.hpp"
#include "synthetic/drive.hpp"
#include "synthetic/record_files.hpp"
#include "synthetic/thermal_ceiling.hpp"

namespace atlas::synthetic {
namespace {

using nlohmann::ordered_json;

class DepthTest : public EvaluateTest {
 protected:
  static void writePng(const std::filesystem::path& path, const cv::Mat& image) {
    std::filesystem::create_directories(path.parent_path());
    ASSERT_TRUE(cv::imwrite(path.string(), image));
  }
  ordered_json compare(const cv::Mat& truth, const cv::Mat& run) {
    writePng(folders_.truth / "depth" / "camera_ir" / "000010.png", truth);
    writePng(folders_.out / "depth" / "camera_ir" / "000010.png", run);
    Evaluation evaluation;
    evaluateDepth(folders_, evaluation);
    return evaluation.toJson();
  }
  static cv::Mat plain(double depth_m) { return {4, 10, CV_16UC1, cv::Scalar(256.0 * depth_m)}; }
};

TEST_F(DepthTest, CopyOfTheTruthHasNoError) {
  const auto result = compare(plain(20), plain(20))["depth_camera_ir"];
  EXPECT_EQ(result["error_m"]["max"], 0.0);
  EXPECT_EQ(result["error_m"]["count"], 40);
  EXPECT_EQ(result["outliers_percent"], 0.0);
  EXPECT_EQ(result["filled_percent"], 100.0);
}

TEST_F(DepthTest, ErrorsOutliersAndHolesAreToldApart) {
  cv::Mat truth = plain(20), run = plain(20.5);
  run.row(0).setTo(0);                // 10 of 40 unknown
  run.row(1).setTo(256 * 23);         // 10 wrong by more than a tenth
  truth.at<std::uint16_t>(2, 0) = 0;  // 1 filled where the sky is
  const auto result = compare(truth, run)["depth_camera_ir"];
  EXPECT_EQ(result["filled_percent"], 75.0);
  EXPECT_NEAR(result["outliers_percent"], 100.0 * 11 / 30, 1e-9);
  EXPECT_NEAR(result["filled_on_sky_percent"], 100.0 / 30, 1e-9);
  EXPECT_EQ(result["error_m"]["count"], 29);
  EXPECT_EQ(result["error_m"]["median"], 0.5);
  EXPECT_EQ(result["error_m"]["max"], 3.0);
}

TEST_F(DepthTest, EmptyImageHasAFillRateAndNoError) {
  const auto result = compare(plain(20), plain(0))["depth_camera_ir"];
  EXPECT_EQ(result["filled_percent"], 0.0);
  EXPECT_FALSE(result.contains("error_m"));
  EXPECT_FALSE(result.contains("outliers_percent"));
}

TEST_F(DepthTest, OtherSizeOrNoFileIsNamed) {
  const auto result = compare(plain(20), cv::Mat(3, 10, CV_16UC1, cv::Scalar(1)));
  EXPECT_FALSE(result.contains("depth_camera_ir"));
  EXPECT_NE(result["skipped"].dump().find("000010.png"), std::string::npos);
  std::filesystem::remove(folders_.out / "depth" / "camera_ir" / "000010.png");
  Evaluation evaluation;
  evaluateDepth(folders_, evaluation);
  EXPECT_TRUE(evaluation.empty());
  EXPECT_TRUE(isSkipped(evaluation, "frame with truth but no file"));
}

/// A drive of one second, made once: boxes, detections and stamps of two cameras.
class DetectionTest : public EvaluateTest {
 protected:
  static void SetUpTestSuite() {
    std::string name = (std::filesystem::temp_directory_path() / "evaluate_drive_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    record_ = name;
    DriveOptions options;
    options.duration_s = 1.0;
    options.skip_s = 8.0;  // on the road
    options.video = options.lidar = false;
    options.cameras = {"camera_left_front", "camera_ir"};
    writeDrive(options, record_);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(record_); }
  void SetUp() override {
    EvaluateTest::SetUp();
    folders_.record = record_;
    folders_.truth = record_ / "truth";
    cameras_ = *camerasOfDrive(folders_.truth);
  }
  std::map<int, std::vector<TruthBox2d>> boxes(const std::string& camera) const {
    return readBoxesByFrame(folders_.truth / "boxes2d" / (camera + ".csv"));
  }

  /// Each detection that shows a true object gets `distance(true depth)` m, or no row for a NaN.
  void writeFrustums(const std::function<double(double)>& distance) const {
    const auto detections = readDetections(record_ / "yolo" / "camera_left_front.txt", cameras_[0]);
    auto truth = boxes("camera_left_front");
    std::ostringstream text;
    text << "stamp,frame,detection,class,confidence,distance,x,y,z\n";
    for (const auto& [frame, list] : detections) {
      for (std::size_t i = 0; i < list.size(); ++i) {
        const TruthBox2d* object = objectOf(list[i], truth[frame]);
        if (object == nullptr || std::isnan(distance(object->depth_m))) continue;
        text << object->stamp << "," << frame << "," << i << "," << list[i].class_id << ",0.9,"
             << distance(object->depth_m) << ",0,0,0\n";
      }
    }
    writeText(folders_.out / "frustums" / "camera_left_front.csv", text.str());
  }
  ordered_json compareFrustums() const {
    Evaluation evaluation;
    evaluateFrustums(folders_, evaluation);
    return evaluation.toJson();
  }

  /// Labels every thermal frame that is some RGB image's nearest with its true boxes, moved by `shift` of
  /// their width.
  void writeLabels(double shift, const std::string& also = "") const {
    const Camera& thermal = cameras_.back();
    const auto thermal_stamps = readFrameStamps(record_ / "camera_ir" / "timestamps.txt");
    auto truth = boxes("camera_ir");
    for (const auto& [rgb_frame, stamp] : readFrameStamps(record_ / "camera_left_front" / "timestamps.txt")) {
      int nearest = 0;
      for (const auto& [frame, at] : thermal_stamps) {
        if (std::llabs(at - stamp) < std::llabs(thermal_stamps.at(nearest) - stamp)) nearest = frame;
      }
      std::ostringstream text;
      text.precision(9);
      for (const TruthBox2d& box : truth[nearest]) {
        const double width = box.x2 - box.x1;
        text << box.class_id << " " << (0.5 * (box.x1 + box.x2) + 0.5 + shift * width) / thermal.width << " "
             << (0.5 * (box.y1 + box.y2) + 0.5) / thermal.height << " " << width / thermal.width << " "
             << (box.y2 - box.y1) / thermal.height << "\n";
      }
      char name[32];
      std::snprintf(name, sizeof name, "%06d.txt", nearest);
      writeText(folders_.out / "thermal" / "labels" / name, text.str() + also);
    }
  }
  ordered_json compareLabels() const {
    Evaluation evaluation;
    evaluateThermal(folders_, evaluation);
    return evaluation.toJson();
  }

  static std::filesystem::path record_;
  std::vector<Camera> cameras_;
};
std::filesystem::path DetectionTest::record_;

TEST_F(DetectionTest, TrueDistancesHaveNoError) {
  writeFrustums([](double depth) { return depth; });
  const auto result = compareFrustums()["frustums"];
  EXPECT_LT(result["distance_error_m"]["max"], 1e-3);  // six digits in the test's file
  EXPECT_GT(result["distance_error_m"]["count"], 10);
  EXPECT_EQ(result["detections_answered_percent"], 100.0);
  EXPECT_EQ(result["camera_left_front"], (ordered_json{{"distance_error_m", result["distance_error_m"]},
                                                       {"detections_answered_percent", 100.0}}));
}

TEST_F(DetectionTest, WrongDistancesComeBackAsTheyAre) {
  writeFrustums([](double depth) { return depth > 15.0 ? depth - 0.7 : std::nan(""); });
  const auto result = compareFrustums()["frustums"];
  EXPECT_NEAR(result["distance_error_m"]["median"], 0.7, 1e-3);
  EXPECT_LT(result["detections_answered_percent"], 100.0);
}

TEST_F(DetectionTest, FarObjectsAreNotJudged) {
  writeFrustums([](double depth) { return depth > 40.0 ? depth + 5.0 : depth; });
  EXPECT_LT(compareFrustums()["frustums"]["distance_error_m"]["max"], 1e-3);
}

TEST_F(DetectionTest, BrokenRowsAndMissingFilesAreSaid) {
  EXPECT_FALSE(compareFrustums().contains("frustums"));
  writeText(folders_.out / "frustums" / "camera_left_front.csv", "stamp,frame\n1,2,x\n");
  const auto result = compareFrustums();
  EXPECT_EQ(result["skipped"]["frustums/camera_left_front.csv: broken row"], 1);
  EXPECT_FALSE(result["frustums"].contains("distance_error_m"));
  EXPECT_EQ(result["frustums"]["detections_answered_percent"], 0.0);
}

TEST_F(DetectionTest, TrueLabelsOverlapFully) {
  writeLabels(0.0);
  const auto result = compareLabels()["thermal_labels"];
  EXPECT_GT(result["mean_overlap"], 0.9999);
  EXPECT_EQ(result["recall_percent"], 100.0);
  EXPECT_EQ(result["recall_of_detected_percent"], 100.0);
  EXPECT_EQ(result["of_nothing_percent"], 0.0);
  // The boxes of the detections carry noise and the front of an object is not its outline, so true boxes beat
  // them.
  EXPECT_LT(result["mean_overlap_ceiling"], 0.99);
  EXPECT_GT(result["mean_overlap_ceiling"], 0.7);
  EXPECT_GT(result["share_of_ceiling_percent"], 100.0);
}

TEST_F(DetectionTest, ShiftedLabelsOverlapByWhatIsLeft) {
  writeLabels(0.1);
  EXPECT_NEAR(compareLabels()["thermal_labels"]["mean_overlap"], 0.9 / 1.1, 1e-4);
}

TEST_F(DetectionTest, LabelsOfNothingAreCounted) {
  writeLabels(0.0, "77 0.5 0.02 0.01 0.01\n");
  const auto result = compareLabels()["thermal_labels"];
  const double frames = 10.0, labels = result["labels"];  // one second at 10 Hz
  EXPECT_NEAR(result["of_nothing_percent"], 100.0 * frames / labels, 1e-9);
  EXPECT_GT(result["mean_overlap"], 0.9999);
}

TEST_F(DetectionTest, EmptyLabelFilesFindNothing) {
  writeText(folders_.out / "thermal" / "labels" / "000003.txt", "");
  const auto result = compareLabels()["thermal_labels"];
  EXPECT_EQ(result["recall_percent"], 0.0);
  EXPECT_EQ(result["labels"], 0);
  EXPECT_FALSE(result.contains("mean_overlap"));
  EXPECT_FALSE(result.contains("of_nothing_percent"));
}

// A square that faces the RGB camera 15 m ahead, and its corners in the thermal image by the rig alone.
TEST_F(DetectionTest, CeilingIsTheExactProjection) {
  const Camera &rgb = cameras_.front(), &thermal = cameras_.back();
  const std::vector<StampedPose> truth = readTrajectory(folders_.truth / "trajectory.tum");
  const StampedPose &now = truth[100], &later = truth[260];  // 0.4 s, some metres
  constexpr double kDepth_m = 15.0;
  FakeDetection seen{1e9, 1e9, -1e9, -1e9, 0.9, 2};
  PixelBox expected{1e9, 1e9, -1e9, -1e9};
  const auto grow = [](auto& box, const Eigen::Vector2d& px) {
    box.x1 = std::min(box.x1, px.x()), box.x2 = std::max(box.x2, px.x());
    box.y1 = std::min(box.y1, px.y()), box.y2 = std::max(box.y2, px.y());
  };
  for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
    const Eigen::Vector3d p_rgb(x, y, kDepth_m);
    grow(seen, rgb.distort(p_rgb.hnormalized()));
    const Eigen::Vector3d p_map = now.pose * T_imu_sensor(rgb.name) * p_rgb;
    const Eigen::Vector3d p_thermal = (later.pose * T_imu_sensor(thermal.name)).inverse() * p_map;
    grow(expected, thermal.distort(p_thermal.hnormalized()));
  }
  const auto box = ThermalCeiling(rgb, thermal, truth).boxOf(seen, kDepth_m, now.stamp, later.stamp);
  ASSERT_TRUE(box);
  // Distortion bends the sides of a box this near to the centre by well below a pixel.
  EXPECT_NEAR(box->x1, expected.x1, 0.3);
  EXPECT_NEAR(box->x2, expected.x2, 0.3);
  EXPECT_NEAR(box->y1, expected.y1, 0.3);
  EXPECT_NEAR(box->y2, expected.y2, 0.3);
  EXPECT_FALSE(
      ThermalCeiling(rgb, thermal, truth).boxOf(seen, kDepth_m, now.stamp, truth.back().stamp + kSecond));
}

}  // namespace
}  // namespace atlas::synthetic
