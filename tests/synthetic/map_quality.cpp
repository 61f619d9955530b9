// SPDX-License-Identifier: MIT
// map_quality (--record DIR | --bag F | --clouds a.pcd ...): how sharp maps are. Of a recording, consecutive
// sweeps are put together with the poses of the suite, de-skewed in several ways; with the truth of a
// synthetic drive the error of each point is given, too.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "atlas/lidar/batching.hpp"
#include "atlas/lidar/deskew_trial.hpp"
#include "atlas/lidar/range_gate.hpp"
#include "atlas/output/pcd.hpp"
#include "positioned_run.hpp"
#include "smooth_run.hpp"
#include "synthetic/deskew_errors.hpp"

namespace {

using namespace atlas;
using atlas_loader::PositionedRun;

struct Arguments {
  atlas_loader::InputOptions input;
  std::vector<std::string> clouds;
  std::string poses = "smoothed", motion = "velocities", truth, json;
  std::size_t sweeps = 10, stride = 1;
  double min_range_m = 3.0, max_range_m = 40.0, min_speed_mps = 1.0, min_height_m = -1e9, cut_margin = 0.0;
  MapQualityParams quality{0.3, 12, 0};
};

/// Mean and its standard error.
struct Spread {
  double mean = 0, error = 0;
};
Spread spreadOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double v : values) sum += v;
  for (const double v : values) squares += (v - sum / n) * (v - sum / n);
  return {sum / n, n > 1 ? std::sqrt(squares / (n - 1) / n) : NAN};
}

/// Qualities of one window of sweeps, by way; `earlier` and `later`: per point, with all stamps moved by the
/// duration of a sweep, which is what mistaking its start for its end, or its end for its start, amounts to.
struct Window : std::map<DeskewWay, MapQuality> {
  double earlier = 0, later = 0;  ///< mean entropy
  std::map<DeskewWay, SkewLeft> skew_left;
};
constexpr DeskewWay kWays[] = {DeskewWay::kPerPoint, DeskewWay::kBatches100, DeskewWay::kNone,
                               DeskewWay::kReversed};

double speedOver(const std::vector<SweepPtr>& sweeps, const Trajectory& trajectory) {
  const auto a = trajectory.at(sweeps.front()->stamp), b = trajectory.at(sweeps.back()->stamp);
  if (!a || !b) return 0.0;
  return (b->translation - a->translation).norm() / toSeconds(sweeps.back()->stamp - sweeps.front()->stamp);
}

std::optional<Window> judge(const std::vector<SweepPtr>& sweeps, const Arguments& arguments,
                            const Trajectory& trajectory, const Pose& T_imu_lidar) {
  if (speedOver(sweeps, trajectory) < arguments.min_speed_mps) return std::nullopt;
  MapQualityParams params = arguments.quality;
  if (params.every == 0) {
    std::size_t points = 0;
    for (const SweepPtr& sweep : sweeps) points += sweep->points.size();
    params.every = std::max<std::size_t>(1, points / 5000);
  }
  Window window;
  for (const DeskewWay way : kWays) {
    const auto quality = qualityOf(sweeps, way, trajectory, T_imu_lidar, params);
    if (!quality || quality->neighbourhoods == 0) return std::nullopt;
    window[way] = *quality;
    MapQualityParams more = params;  // few neighbourhoods are plane and seen in different phases
    more.every = std::max<std::size_t>(1, params.every / 4);
    const auto skew_left = skewLeftOf(sweeps, way, trajectory, T_imu_lidar, more);
    if (skew_left && skew_left->neighbourhoods > 0) window.skew_left[way] = *skew_left;
  }
  const auto shifted = [&](Duration shift) {
    const auto quality = qualityOf(sweeps, DeskewWay::kPerPoint, trajectory, T_imu_lidar, params, shift);
    return quality ? quality->mean_entropy : std::numeric_limits<double>::quiet_NaN();
  };
  const SweepSpan span = *spanOf(*sweeps.front());
  window.earlier = shifted(-(span.last - span.first));
  window.later = shifted(span.last - span.first);
  return window;
}

/// Without what is out of range, lower than asked (the ground is flat, however wrong the times are) or too
/// near to the cut: lasers that look aside of the sensor's own direction are at the other end of the sweep
/// there.
SweepPtr judged(const SweepPtr& sweep, const Arguments& arguments, const Pose& T_imu_lidar) {
  auto result =
      std::make_shared<Sweep>(*gateByRange(sweep, arguments.min_range_m, arguments.max_range_m).sweep);
  const auto [first, last] =
      std::minmax_element(sweep->points.begin(), sweep->points.end(),
                          [](const LidarPoint& a, const LidarPoint& b) { return a.time < b.time; });
  const float first_s = first->time, last_s = last->time;
  const auto margin_s = static_cast<float>(arguments.cut_margin) * (last_s - first_s);
  for (LidarPoint& p : result->points) {
    const bool at_cut = p.time < first_s + margin_s || p.time > last_s - margin_s;
    if (at_cut || (T_imu_lidar * Eigen::Vector3d(p.x, p.y, p.z)).z() < arguments.min_height_m)
      p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
  }
  return result;
}

/// Every lidar's sweeps, in windows and against the truth.
struct Results {
  std::map<std::string, std::vector<Window>> windows;  ///< by topic
  std::map<std::string, std::size_t> passed_over;      ///< windows that stood still
  std::optional<synthetic::DeskewErrors> errors;
};

Results measure(const Arguments& arguments, const PositionedRun& run) {
  Results results;
  if (!arguments.truth.empty() && run.anchor)
    results.errors.emplace(arguments.truth, *run.anchor, run.motion);
  std::map<std::pair<std::string, std::size_t>, std::vector<SweepPtr>> waiting;  // topic, place in stride
  std::map<std::string, int> counts;
  const auto reader = atlas_loader::openInput(arguments.input);
  while (const auto event = reader->next()) {
    const auto* sweep = std::get_if<SweepPtr>(&event->payload);
    if (sweep == nullptr || (*sweep)->points.empty()) continue;
    const std::string& topic = reader->streams()[event->stream].topic;
    const Outcome<Pose> T_imu_lidar = run.rig.T_imu((*sweep)->frame);
    if (!T_imu_lidar) throw std::runtime_error(topic + ": no calibration for frame " + (*sweep)->frame);
    const int index = counts[topic]++;
    if (results.errors) results.errors->add(topic.substr(0, topic.find('/')), index, *sweep, *T_imu_lidar);
    if (arguments.sweeps == 0) continue;
    if (!placed(*sweep, DeskewWay::kPerPoint, run.motion.inMap(), *T_imu_lidar)) continue;  // no poses there
    std::vector<SweepPtr>& sweeps = waiting[{topic, static_cast<std::size_t>(index) % arguments.stride}];
    sweeps.push_back(judged(*sweep, arguments, *T_imu_lidar));
    if (sweeps.size() < arguments.sweeps) continue;
    const auto window = judge(sweeps, arguments, run.motion.inMap(), *T_imu_lidar);
    if (window) results.windows[topic].push_back(*window);
    if (!window) ++results.passed_over[topic];
    sweeps.clear();
  }
  return results;
}

void printWindows(const std::string& topic, const std::vector<Window>& windows,
                  nlohmann::ordered_json& json) {
  std::printf("\n%s: %zu windows\n%-14s %16s %22s %18s %22s\n", topic.c_str(), windows.size(), "de-skew",
              "mean entropy", "minus none", "thickness, mm", "minus none, mm");
  for (const DeskewWay way : kWays) {
    std::vector<double> entropy, entropy_gain, thickness, thickness_gain;
    for (const Window& window : windows) {
      const MapQuality& quality = window.at(way);
      const MapQuality& none = window.at(DeskewWay::kNone);
      entropy.push_back(quality.mean_entropy);
      entropy_gain.push_back(quality.mean_entropy - none.mean_entropy);
      thickness.push_back(1e3 * quality.plane_thickness_m);
      thickness_gain.push_back(1e3 * (quality.plane_thickness_m - none.plane_thickness_m));
    }
    const Spread h = spreadOf(entropy), dh = spreadOf(entropy_gain), t = spreadOf(thickness),
                 dt = spreadOf(thickness_gain);
    std::printf("%-14s %16.3f %12.3f +- %6.3f %18.2f %12.2f +- %6.2f\n", toString(way), h.mean, dh.mean,
                dh.error, t.mean, dt.mean, dt.error);
    json[topic][toString(way)] = {{"windows", windows.size()},
                                  {"mean_entropy", h.mean},
                                  {"mean_entropy_minus_none", {dh.mean, dh.error}},
                                  {"plane_thickness_mm", t.mean},
                                  {"plane_thickness_minus_none_mm", {dt.mean, dt.error}}};
  }
}

/// How much of the skew the surfaces say is left: 0 none, 1 as without de-skew.
void printSkewLeft(const std::vector<Window>& windows, nlohmann::ordered_json& json) {
  for (const DeskewWay way : kWays) {
    std::vector<double> shares, minus_none;
    std::size_t neighbourhoods = 0;
    for (const Window& window : windows) {
      const auto found = window.skew_left.find(way);
      if (found == window.skew_left.end()) continue;
      shares.push_back(found->second.share);
      const auto none = window.skew_left.find(DeskewWay::kNone);
      if (none != window.skew_left.end()) minus_none.push_back(found->second.share - none->second.share);
      neighbourhoods += found->second.neighbourhoods;
    }
    if (shares.empty()) continue;
    const Spread spread = spreadOf(shares), gain = spreadOf(minus_none);
    std::printf("skew left, %-11s: %.3f +- %.3f, minus none %.3f +- %.3f (%zu windows, %zu neighbourhoods)\n",
                toString(way), spread.mean, spread.error, gain.mean, gain.error, shares.size(),
                neighbourhoods);
    json["skew_left"][toString(way)] = {spread.mean, spread.error};
  }
}

/// Which moment of a sweep the stamps mark, as the sharpness of the map has it.
void printStamps(const std::vector<Window>& windows, nlohmann::ordered_json& json) {
  std::vector<double> earlier, later;
  for (const Window& window : windows) {
    const double recorded = window.at(DeskewWay::kPerPoint).mean_entropy;
    if (std::isfinite(window.earlier)) earlier.push_back(window.earlier - recorded);
    if (std::isfinite(window.later)) later.push_back(window.later - recorded);
  }
  const auto verdict = [](const std::vector<double>& values) {
    const Spread spread = spreadOf(values);
    const bool sure = std::abs(spread.mean) > 2.0 * spread.error;
    return !sure               ? "no difference seen"
           : spread.mean > 0.0 ? "fits worse"
                               : "fits BETTER: check --scan-stamp";
  };
  for (const auto& [name, values] : {std::pair{"earlier", earlier}, std::pair{"later", later}}) {
    const Spread spread = spreadOf(values);
    std::printf("stamps one sweep %s: entropy %+.3f +- %.3f, %s\n", name, spread.mean, spread.error,
                verdict(values));
    json[std::string("stamps_one_sweep_") + name] = {spread.mean, spread.error};
  }
}

MapQuality ofCloud(const std::string& path, const MapQualityParams& params) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be opened");
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto points = decodePcd(bytes);
  if (!points) throw std::runtime_error(path + ": not a point cloud that can be read");
  MapQualityParams asked = params;
  if (asked.every == 0) asked.every = std::max<std::size_t>(1, points->size() / 20000);
  return mapQuality(*points, asked);
}

void write(const std::string& path, const nlohmann::ordered_json& json) {
  if (path.empty()) return;
  std::ofstream file(path);
  file << json.dump(1) << "\n";
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

void judgeRecording(Arguments arguments, nlohmann::ordered_json& json) {
  const auto source = atlas_loader::poseSourceNamed(arguments.poses);
  const auto params = atlas_loader::localizationParams("", arguments.input);
  atlas_loader::InputOptions positions = arguments.input;
  positions.topics = {"tf_static", "imu/data", "imu/gnss/fix", "gnss/fix", "gnss/heading"};
  const auto run = atlas_loader::positionRun(positions, params, source, arguments.motion == "velocities");
  if (run.motion.inMap().empty()) throw std::runtime_error("no pose: position or heading never known");
  const Results results = measure(arguments, run);
  for (const auto& [topic, windows] : results.windows) {
    printWindows(topic, windows, json["windows"]);
    printSkewLeft(windows, json["windows"][topic]);
    printStamps(windows, json["windows"][topic]);
  }
  for (const auto& [topic, count] : results.passed_over)
    std::printf("%s: %zu windows passed over (standing)\n", topic.c_str(), count);
  if (results.errors) results.errors->print(json["errors"]);
}

int run(int argc, char** argv) {
  Arguments a;
  CLI::App app("Mean map entropy and plane thickness of maps, and with the truth the error of their points");
  app.add_option("--record", a.input.record, "record to judge");
  app.add_option("--bag", a.input.bag, "bag to judge");
  app.add_option("--clouds", a.clouds, "finished maps to judge (PCD)");
  app.add_option("--calibration", a.input.calibration, "calibration folder of a record that carries none");
  app.add_option("--scan-stamp", a.input.scan_stamp, "of records: end or start")->capture_default_str();
  app.add_option("--poses", a.poses, "filtered, smoothed or recorded")->capture_default_str();
  app.add_option("--motion", a.motion, "within a sweep")->check(CLI::IsMember({"velocities", "poses"}));
  app.add_option("--truth", a.truth, "RECORD/truth of a synthetic drive");
  app.add_option("--sweeps", a.sweeps, "of a window; 0: none")
      ->check(CLI::Range(2, 1000) | CLI::IsMember({0}));
  app.add_option("--stride", a.stride, "every n-th sweep belongs to a window; n windows run side by side")
      ->check(CLI::Range(1, 1000));
  app.add_option("--min-height", a.min_height_m, "m, in the vehicle's frame: lower returns are left out");
  app.add_option("--cut-margin", a.cut_margin, "share of a sweep left out at its start and at its end")
      ->check(CLI::Range(0.0, 0.45));
  app.add_option("--radius", a.quality.radius_m, "m, of a neighbourhood")->capture_default_str();
  app.add_option("--max-range", a.max_range_m, "m, farther returns are left out")->capture_default_str();
  app.add_option("--json", a.json, "write the same numbers to this file");
  CLI11_PARSE(app, argc, argv);
  validate(MapQualityParams{a.quality.radius_m, a.quality.min_neighbours, 1});  // `every` follows later
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const std::string& cloud : a.clouds) {
    const MapQuality quality = ofCloud(cloud, a.quality);
    std::printf("%s: mean entropy %.3f (%zu neighbourhoods), plane thickness %.2f mm (%zu planes)\n",
                cloud.c_str(), quality.mean_entropy, quality.neighbourhoods, 1e3 * quality.plane_thickness_m,
                quality.planes);
    json["clouds"][cloud] = {{"mean_entropy", quality.mean_entropy},
                             {"plane_thickness_mm", 1e3 * quality.plane_thickness_m}};
  }
  if (a.clouds.empty()) judgeRecording(a, json);
  write(a.json, json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "map_quality: %s\n", error.what());
    return 1;
  }
}
