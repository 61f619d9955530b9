// SPDX-License-Identifier: MIT
// The program atlas_localize as a function: files in, files out.
#include "localize.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "simulated_drive.hpp"

namespace atlas_localization {
namespace {

using namespace atlas;
using namespace atlas::test;

struct Files {
  LocalizeOptions options;
  std::vector<Truth> truth;
};

Files writeDrive(const std::string& name) {
  std::mt19937 random(1);
  const DriveParams d = cityDrive(30.0);
  Files files;
  files.truth = drive(d);
  const Recording recording = record(files.truth, d, realisticErrors(random), random);
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / name;
  std::filesystem::remove_all(folder);  // of an earlier run
  std::filesystem::create_directories(folder);
  std::ofstream imu(folder / "imu.csv"), gnss(folder / "gnss.csv");
  imu.precision(12);
  gnss.precision(14);
  imu << "stamp_ns,ax,ay,az,gx,gy,gz\n";
  for (const ImuSample& s : recording.imu) {
    const Eigen::Vector3d& a = s.linear_acceleration_mps2;
    const Eigen::Vector3d& w = s.angular_velocity_radps;
    imu << s.stamp << ',' << a.x() << ',' << a.y() << ',' << a.z() << ',' << w.x() << ',' << w.y() << ','
        << w.z() << '\n';
  }
  gnss << "stamp_ns,lat,lon,alt,sd_e,sd_n,sd_u\n";
  for (const GnssFix& fix : recording.fixes) {
    gnss << fix.stamp << ',' << fix.position.latitude_deg << ',' << fix.position.longitude_deg << ','
         << fix.position.altitude_m << ",0.02,0.02,0.04\n";
  }
  files.options.imu = folder / "imu.csv";
  files.options.gnss = folder / "gnss.csv";
  files.options.out = folder / "out";
  files.options.lever_arm_m = d.lever_arm_imu;
  return files;
}

std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Localize, WritesTheFourFiles) {
  const Files files = writeDrive("localize_good");
  const LocalizeSummary summary = localize(files.options);
  const auto filtered = linesOf(files.options.out / "trajectory.tum");
  const auto smoothed = linesOf(files.options.out / "smoothed.tum");
  EXPECT_GT(filtered.size(), 2000u);  // from the first metres on: there is no receiver heading
  EXPECT_EQ(filtered.size(), smoothed.size());
  EXPECT_EQ(filtered.size(), summary.poses);
  std::ifstream anchor_file(files.options.out / "anchor.json");
  const auto anchor = nlohmann::json::parse(anchor_file);
  EXPECT_NEAR(anchor.at("latitude").get<double>(), kBrno.latitude_deg, 1e-4);
  EXPECT_GT(linesOf(files.options.out / "innovations.csv").size(), 300u);
}

TEST(Localize, CovariancesAreWrittenWhenAskedFor) {
  Files files = writeDrive("localize_covariances");
  localize(files.options);
  EXPECT_FALSE(std::filesystem::exists(files.options.out / "trajectory_covariance.csv"));
  files.options.covariances = true;
  const LocalizeSummary summary = localize(files.options);
  const auto filtered = linesOf(files.options.out / "trajectory_covariance.csv");
  const auto smoothed = linesOf(files.options.out / "smoothed_covariance.csv");
  ASSERT_EQ(filtered.size(), summary.poses + 1);  // the title
  ASSERT_EQ(smoothed.size(), summary.poses + 1);
  const auto field = [](const std::string& line, int index) {
    std::istringstream stream(line);
    std::string value;
    for (int i = 0; i <= index; ++i) std::getline(stream, value, ',');
    return std::stod(value);
  };
  const std::string& before = filtered[summary.poses / 2];
  const std::string& after = smoothed[summary.poses / 2];
  EXPECT_EQ(field(before, 0), field(after, 0));
  for (const int variance : {4, 7, 9, 10, 13, 15, 16, 19, 21}) {  // the nine diagonals
    EXPECT_GT(field(before, variance), 0.0) << variance;
    EXPECT_LT(field(after, variance), field(before, variance)) << variance << ": the smoother knows more";
  }
}

TEST(Localize, EmptyGnssIsRefusedAndNothingIsWritten) {
  Files files = writeDrive("localize_empty");
  std::ofstream(files.options.gnss) << "stamp_ns,lat,lon,alt,sd_e,sd_n,sd_u\n";
  EXPECT_THROW(localize(files.options), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(files.options.out / "trajectory.tum"));
}

TEST(Localize, UnknownFilterIsRefused) {
  Files files = writeDrive("localize_filter");
  files.options.filter = "magic";
  EXPECT_THROW(localize(files.options), std::invalid_argument);
}

}  // namespace
}  // namespace atlas_localization
