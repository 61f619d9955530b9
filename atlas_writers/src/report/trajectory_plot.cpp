// SPDX-License-Identifier: MIT
#include "report/trajectory_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "report/number_text.hpp"

namespace atlas::report {
namespace {

constexpr double kWidth = 640, kHeight = 480, kMargin = 46;  // px of the drawing

/// From metres in map to px of the drawing, the same scale in both directions, north up.
struct View {
  double x_min_m = 0, y_min_m = 0, scale_px_per_m = 1, x_offset_px = 0, y_offset_px = 0;
  [[nodiscard]] double x(double x_m) const { return x_offset_px + (x_m - x_min_m) * scale_px_per_m; }
  [[nodiscard]] double y(double y_m) const {
    return kHeight - y_offset_px - (y_m - y_min_m) * scale_px_per_m;
  }
};

struct Range {
  double low = 0, high = 0;
  [[nodiscard]] double span() const { return high - low; }
};

template <class Get>
Range rangeOf(const std::vector<TrajectoryPoint>& trajectory, Get get) {
  Range range{get(trajectory.front()), get(trajectory.front())};
  for (const auto& p : trajectory) range = {std::min(range.low, get(p)), std::max(range.high, get(p))};
  return range;
}

View viewOf(const Range& x, const Range& y) {
  const double span_x = std::max(x.span(), 1.0), span_y = std::max(y.span(), 1.0);
  View view{x.low, y.low, std::min((kWidth - 2 * kMargin) / span_x, (kHeight - 2 * kMargin) / span_y), 0, 0};
  view.x_offset_px = (kWidth - x.span() * view.scale_px_per_m) / 2;
  view.y_offset_px = (kHeight - y.span() * view.scale_px_per_m) / 2;
  return view;
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::string grid(const View& view, double step_m) {
  std::string svg =
      "<g stroke=\"#8894a3\" stroke-opacity=\"0.25\" fill=\"#8894a3\" font-size=\"11\" "
      "font-family=\"sans-serif\">\n";
  const double x_left_m = view.x_min_m - view.x_offset_px / view.scale_px_per_m;
  const double y_low_m = view.y_min_m - view.y_offset_px / view.scale_px_per_m;
  for (double k = std::ceil(x_left_m / step_m); view.x(k * step_m) < kWidth; ++k) {
    const double at = view.x(k * step_m);
    svg += text("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"0\" y2=\"%g\"/>", at, at, kHeight);
    svg += text("<text stroke=\"none\" x=\"%.1f\" y=\"%g\">%s</text>\n", at + 3, kHeight - 6,
                valueText(k * step_m).c_str());
  }
  for (double k = std::ceil(y_low_m / step_m); view.y(k * step_m) > 0; ++k) {
    const double at = view.y(k * step_m);
    svg += text("<line y1=\"%.1f\" y2=\"%.1f\" x1=\"0\" x2=\"%g\"/>", at, at, kWidth);
    svg +=
        text("<text stroke=\"none\" x=\"4\" y=\"%.1f\">%s</text>\n", at - 3, valueText(k * step_m).c_str());
  }
  return svg + "</g>\n";
}

/// Blue (slow) to orange (fast).
std::string speedColor(double ratio) {
  const double r = std::clamp(ratio, 0.0, 1.0);
  return text("#%02x%02x%02x", static_cast<unsigned>(40 + 200 * r), static_cast<unsigned>(110 + 20 * r),
              static_cast<unsigned>(210 - 180 * r));
}

/// Points at least 2 px apart, always with the first and the last: what the eye can see.
std::vector<TrajectoryPoint> thinned(const std::vector<TrajectoryPoint>& trajectory, double scale_px_per_m) {
  std::vector<TrajectoryPoint> kept{trajectory.front()};
  for (const auto& p : trajectory) {
    if (std::hypot(p.x_m - kept.back().x_m, p.y_m - kept.back().y_m) * scale_px_per_m >= 2) kept.push_back(p);
  }
  kept.push_back(trajectory.back());
  return kept;
}

double speed(const TrajectoryPoint& a, const TrajectoryPoint& b) {
  const double dt_s = b.stamp_s - a.stamp_s;
  return dt_s > 0 ? std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) / dt_s : 0;
}

std::string marker(const View& view, const TrajectoryPoint& p, const char* color, const char* label) {
  return text(
      "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"%s\"/><text x=\"%.1f\" y=\"%.1f\" fill=\"%s\" "
      "font-size=\"13\" "
      "font-family=\"sans-serif\">%s</text>\n",
      view.x(p.x_m), view.y(p.y_m), color, view.x(p.x_m) + 8, view.y(p.y_m) - 6, color, label);
}

std::string legend(double step_m, double top_speed_mps) {
  return text(
      "<text x=\"%g\" y=\"16\" text-anchor=\"end\" fill=\"#8894a3\" font-size=\"12\" "
      "font-family=\"sans-serif\">"
      "grid %s m, north up; blue 0 to orange %s m/s</text>\n",
      kWidth - 6, valueText(step_m).c_str(), valueText(top_speed_mps).c_str());
}

}  // namespace

double gridStep(double span_m) {
  const double rough = span_m / 8;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

std::string trajectorySvg(const std::vector<TrajectoryPoint>& trajectory) {
  if (trajectory.size() < 2) return "";
  const Range x = rangeOf(trajectory, [](const auto& p) { return p.x_m; });
  const Range y = rangeOf(trajectory, [](const auto& p) { return p.y_m; });
  const View view = viewOf(x, y);
  const double step_m = gridStep(std::max({x.span(), y.span(), 1.0}));
  const auto points = thinned(trajectory, view.scale_px_per_m);
  double top_mps = 1e-9;
  for (std::size_t i = 2; i < points.size(); ++i)
    top_mps = std::max(top_mps, speed(points[i - 2], points[i]));
  std::string svg =
      text("<svg viewBox=\"0 0 %g %g\" role=\"img\" aria-label=\"trajectory\">\n", kWidth, kHeight);
  svg += grid(view, step_m) + "<g stroke-width=\"3\" stroke-linecap=\"round\">\n";
  for (std::size_t i = 1; i < points.size(); ++i) {
    svg += text("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n",
                view.x(points[i - 1].x_m), view.y(points[i - 1].y_m), view.x(points[i].x_m),
                view.y(points[i].y_m), speedColor(speed(points[i - 1], points[i]) / top_mps).c_str());
  }
  svg += "</g>\n" + marker(view, trajectory.front(), "#2e8b57", "start") +
         marker(view, trajectory.back(), "#c0392b", "end");
  return svg + legend(step_m, top_mps) + "</svg>\n";
}

}  // namespace atlas::report
