// SPDX-License-Identifier: MIT
#include "localize.hpp"

#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "atlas/localization/eskf_history.hpp"
#include "atlas/localization/localization_stage.hpp"
#include "atlas/output/trajectory_text.hpp"
#include "atlas_ros/stage_params.hpp"
#include "atlas_ros/yaml_reader.hpp"
#include "csv_sensors.hpp"
#include "files/output_file.hpp"

namespace atlas_localization {
namespace {

atlas::LocalizationParams paramsOf(const LocalizeOptions& options) {
  atlas::LocalizationParams params;
  params.filter = "eskf";
  if (!options.config.empty()) {
    params = atlas_ros::readSection(atlas_ros::loadConfiguration(options.config), options.config,
                                    "localization", params);
  }
  if (!options.filter.empty()) params.filter = options.filter;
  params.gnss_antenna_frame = kAntennaFrame;
  validate(params);
  return params;
}

/// stamp_ns,source,y0,y1,y2,sigma0,sigma1,sigma2,mahalanobis_sq,rows,used
std::string lineOf(const atlas::InnovationRecord& record) {
  std::string text = std::to_string(record.stamp) + "," + record.source;
  for (const Eigen::Vector3d& values : {record.innovation, record.sigma}) {
    for (int i = 0; i < 3; ++i) {
      text += ',';
      if (i < record.rows) atlas::appendFixed(text, values(i), 6);
    }
  }
  text += ',';
  atlas::appendFixed(text, record.mahalanobis_sq, 4);
  return text + "," + std::to_string(record.rows) + (record.used ? ",1\n" : ",0\n");
}

void describe(const CsvRows& rows, std::vector<std::string>& lines) {
  const atlas::FileReport& report = rows.report();
  lines.push_back(rows.file() + ": " + std::to_string(report.rows) + " rows, " + std::to_string(report.used) +
                  " used");
  for (const auto& [reason, count] : report.skipped)
    lines.push_back("  skipped " + std::to_string(count) + ": " + reason);
  for (const std::string& example : report.examples) lines.push_back("  " + example);
}

/// Both files in order of stamps, through the stage.
void feed(atlas::LocalizationStage& stage, ImuCsv& imu_csv, GnssCsv& gnss_csv) {
  using Stage = atlas::LocalizationStage;
  stage.finish(Stage::kTfStatic);
  std::optional<atlas::ImuSample> imu = imu_csv.next();
  std::optional<GnssRow> gnss = gnss_csv.next();
  while (imu || gnss) {
    const bool gnss_first = gnss && (!imu || gnss->fix.stamp <= imu->stamp);
    const atlas::Stamp stamp = gnss_first ? gnss->fix.stamp : imu->stamp;
    if (gnss_first) {
      stage.push(gnss->fix);
      if (gnss->heading) stage.push(*gnss->heading);
      gnss = gnss_csv.next();
    } else {
      stage.push(*imu);
      imu = imu_csv.next();
    }
    for (const auto input : {Stage::kGnssFix, Stage::kGnssHeading, Stage::kImu})
      stage.advance(input, stamp - 1);
  }
  for (const auto input : {Stage::kGnssFix, Stage::kGnssHeading, Stage::kImu}) stage.finish(input);
}

/// The files of a run; what is not committed leaves no trace.
class Outputs {
 public:
  Outputs(const LocalizeOptions& options, bool smooths)
      : folder_(options.out),
        trajectory_(folder_ / "trajectory.tum"),
        innovations_(folder_ / "innovations.csv") {
    innovations_.write("stamp_ns,source,y0,y1,y2,sigma0,sigma1,sigma2,mahalanobis_sq,rows,used\n");
    if (smooths) smoothed_.emplace(folder_ / "smoothed.tum");
    if (!options.covariances) return;
    covariance_.emplace(folder_ / "trajectory_covariance.csv").write(atlas::covarianceTitle());
    if (smooths)
      smoothed_covariance_.emplace(folder_ / "smoothed_covariance.csv").write(atlas::covarianceTitle());
  }
  void filtered(const atlas::Odometry& odometry) {
    trajectory_.write(tumLine(odometry));
    if (covariance_) covariance_->write(covarianceLine(odometry));
  }
  void innovation(const atlas::InnovationRecord& record) { innovations_.write(lineOf(record)); }
  void smoothed(const atlas::Odometry& odometry) {
    smoothed_->write(tumLine(odometry));
    if (smoothed_covariance_) smoothed_covariance_->write(covarianceLine(odometry));
  }
  void commit(const atlas::Geodetic& anchor) {
    const nlohmann::ordered_json json = {{"latitude", anchor.latitude_deg},
                                         {"longitude", anchor.longitude_deg},
                                         {"altitude", anchor.altitude_m}};
    atlas::writeFile(folder_ / "anchor.json", json.dump(1) + "\n");
    trajectory_.commit();
    innovations_.commit();
    for (auto* file : {&smoothed_, &covariance_, &smoothed_covariance_})
      if (*file) (*file)->commit();
  }

 private:
  std::filesystem::path folder_;
  atlas::OutputFile trajectory_, innovations_;
  std::optional<atlas::OutputFile> smoothed_, covariance_, smoothed_covariance_;
};

}  // namespace

LocalizeSummary localize(const LocalizeOptions& options) {
  const atlas::LocalizationParams params = paramsOf(options);
  ImuCsv imu(options.imu);
  GnssCsv gnss(options.gnss);
  const bool smooths = params.filter == "eskf";
  Outputs outputs(options, smooths);

  atlas::LocalizationStage stage(params);
  atlas::eskf::History history({options.out});  // what exceeds the memory goes beside the outputs
  LocalizeSummary summary;
  if (smooths) stage.record(&history);
  atlas::StaticTransforms antenna;
  antenna.transforms.push_back(
      {"base_link", kAntennaFrame, {Eigen::Quaterniond::Identity(), options.lever_arm_m}});
  stage.push(0, antenna);
  std::optional<atlas::Anchor> anchor;
  stage.on_anchor = [&](const atlas::Anchor& first) { anchor = first; };
  stage.on_odometry = [&](const atlas::Odometry& odometry) {
    outputs.filtered(odometry);
    ++summary.poses;
  };
  stage.on_innovation = [&](const atlas::InnovationRecord& record) { outputs.innovation(record); };
  feed(stage, imu, gnss);

  imu.checkUnits();
  if (!anchor) throw std::runtime_error(options.gnss.string() + ": no usable row");
  history.smooth();
  for (std::size_t i = 0; i < history.size(); ++i) outputs.smoothed(history.odometry(i));
  outputs.commit(anchor->position);

  describe(imu.rows(), summary.lines);
  describe(gnss.rows(), summary.lines);
  for (const auto& [what, count] : stage.counters().all())
    summary.lines.push_back(what + ": " + std::to_string(count));
  return summary;
}

}  // namespace atlas_localization
