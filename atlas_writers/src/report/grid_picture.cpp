// SPDX-License-Identifier: MIT
#include "report/grid_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "atlas/base/time.hpp"
#include "report/number_text.hpp"
#include "report/trajectory_file.hpp"

namespace atlas::report {
namespace {

namespace fs = std::filesystem;

constexpr int kSide = 1000;  // px of the longer side, about
const cv::Scalar kStatic(200, 120, 0), kMoving(0, 0, 230), kVehicle(0, 160, 0);

struct GridObject {
  unsigned id = 0;
  double x = 0, y = 0, yaw = 0, length = 0, width = 0, vx = 0, vy = 0;
  bool is_static = false;
};
using ObjectsByStamp = std::map<Stamp, std::vector<GridObject>>;

ObjectsByStamp readObjects(const fs::path& file) {
  ObjectsByStamp objects;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  for (std::size_t row = 2; std::getline(in, line); ++row) {
    long long stamp = 0;
    int is_static = 0;
    GridObject o;
    // stamp_ns,id,class,probability,x,y,z,yaw,length,width,height,vx,vy,vz,static,age
    const int fields =
        std::sscanf(line.c_str(), "%lld,%u,%*d,%*f,%lf,%lf,%*f,%lf,%lf,%lf,%*f,%lf,%lf,%*f,%d", &stamp, &o.id,
                    &o.x, &o.y, &o.yaw, &o.length, &o.width, &o.vx, &o.vy, &is_static);
    if (fields != 10)
      throw std::runtime_error(file.string() + ": row " + std::to_string(row) + " is no object: " + line);
    o.is_static = is_static != 0;
    objects[stamp].push_back(o);
  }
  return objects;
}

/// From map to pixels of the enlarged picture.
struct View {
  double resolution_m = 0, origin_x_m = 0, origin_y_m = 0;
  int scale = 1, rows = 0;
  [[nodiscard]] cv::Point at(double x, double y) const {
    return {static_cast<int>(std::lround((x - origin_x_m) / resolution_m * scale)),
            static_cast<int>(std::lround((rows - (y - origin_y_m) / resolution_m) * scale))};
  }
};

View readView(const fs::path& yaml, const cv::Mat& grid) {
  std::ifstream in(yaml);
  View view;
  int found = 0;
  for (std::string line; std::getline(in, line);) {
    found += std::sscanf(line.c_str(), "resolution: %lf", &view.resolution_m) == 1 ? 1 : 0;
    found += std::sscanf(line.c_str(), "origin: [%lf, %lf", &view.origin_x_m, &view.origin_y_m) == 2 ? 1 : 0;
  }
  if (found != 2 || !(view.resolution_m > 0))
    throw std::runtime_error(yaml.string() + ": has no resolution or no origin");
  view.scale = std::max(1, kSide / std::max(grid.cols, grid.rows));
  view.rows = grid.rows;
  return view;
}

void drawObject(cv::Mat& picture, const View& view, const GridObject& o) {
  const double c = std::cos(o.yaw), s = std::sin(o.yaw);
  std::vector<cv::Point> outline;
  for (const auto& [along, across] : {std::pair{0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}, {-0.5, 0.5}}) {
    const double u = along * o.length, v = across * o.width;
    outline.push_back(view.at(o.x + c * u - s * v, o.y + s * u + c * v));
  }
  const cv::Scalar& color = o.is_static ? kStatic : kMoving;
  cv::polylines(picture, outline, true, color, 2, cv::LINE_AA);
  if (!o.is_static)
    cv::arrowedLine(picture, view.at(o.x, o.y), view.at(o.x + o.vx, o.y + o.vy), color, 2, cv::LINE_AA);
  cv::putText(picture, std::to_string(o.id), outline[0], cv::FONT_HERSHEY_SIMPLEX, 0.5, color, 1,
              cv::LINE_AA);
}

std::size_t movingIn(const std::vector<GridObject>& objects) {
  return static_cast<std::size_t>(
      std::count_if(objects.begin(), objects.end(), [](const GridObject& o) { return !o.is_static; }));
}

}  // namespace

std::optional<Picture> chooseGrid(const fs::path& out) {
  const std::vector<fs::path> grids = filesOf(out / "grid", ".pgm");
  if (grids.empty()) return std::nullopt;
  const ObjectsByStamp objects = readObjects(out / "grid/objects.csv");
  const auto at = [&objects](const fs::path& grid) {
    const auto found = objects.find(std::stoll(grid.stem().string()));
    return found == objects.end() ? std::vector<GridObject>() : found->second;
  };
  fs::path chosen = grids[grids.size() / 2];
  for (const fs::path& grid : grids) {
    if (movingIn(at(grid)) > movingIn(at(chosen))) chosen = grid;
  }
  const cv::Mat grey = cv::imread(chosen.string(), cv::IMREAD_GRAYSCALE);
  if (grey.empty()) throw std::runtime_error(chosen.string() + ": is no picture");
  const View view = readView(fs::path(chosen).replace_extension(".yaml"), grey);
  cv::Mat picture;
  cv::resize(grey, picture, {}, view.scale, view.scale, cv::INTER_NEAREST);
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  const std::vector<GridObject> shown = at(chosen);
  for (const GridObject& object : shown) drawObject(picture, view, object);
  const double stamp_s = toSeconds(std::stoll(chosen.stem().string()));
  for (const TrajectoryPoint& pose : readTum(out / "trajectory/trajectory.tum")) {
    if (pose.stamp_s <= stamp_s) cv::circle(picture, view.at(pose.x_m, pose.y_m), 2, kVehicle, cv::FILLED);
  }
  return Picture{picture,
                 "Occupancy grid: white free, black occupied, grey unknown; way of the vehicle in green, " +
                     countText(shown.size()) + " objects, moving ones red with their way of one second"};
}

}  // namespace atlas::report
