// SPDX-License-Identifier: MIT
#include "report/sensor_timeline.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>

#include "report/number_text.hpp"
#include "report/trajectory_plot.hpp"

namespace atlas::report {
namespace {

constexpr double kWidth = 1000, kNames = 150, kRow = 34, kBand = 14, kTop = 8,
                 kAxis = 26;     // px of the drawing
constexpr double kLetter = 6.2;  // px of a letter of the labels

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : line) {
    if (c == separator) {
      parts.emplace_back();
    } else if (c != '\r') {
      parts.back() += c;
    }
  }
  return parts;
}

/// Green at 1 over amber to red at 0.
std::string scoreColor(double score) {
  const double s = std::clamp(score, 0.0, 1.0);
  const double red = s > 0.5 ? 46 + 2 * (1 - s) * (230 - 46) : 230 - (0.5 - s) * 60;
  const double green = s > 0.5 ? 139 + 2 * (1 - s) * 20 : 2 * s * 159 + (0.5 - s) * 80;
  return text("#%02x%02x%02x", static_cast<unsigned>(red), static_cast<unsigned>(green), 60U);
}

struct View {
  Stamp begin = 0;
  double span_s = 1;
  [[nodiscard]] double x(Stamp stamp) const {
    return kNames + (kWidth - kNames - 10) * toSeconds(stamp - begin) / span_s;
  }
};

View viewOf(const std::vector<SensorBand>& bands) {
  View view{kEndOfTime, 1};
  Stamp end = kBeginOfTime;
  for (const SensorBand& band : bands) {
    view.begin = std::min(view.begin, band.spans.front().begin);
    end = std::max(end, band.spans.back().end);
  }
  view.span_s = std::max(1e-3, toSeconds(end - view.begin));
  return view;
}

/// The anomalies of a band where they begin; what would cover the label before it is left out.
std::string labels(const SensorBand& band, const View& view, double y) {
  std::string svg;
  std::vector<std::string> before;
  double free_from = 0;
  for (const SensorSpan& span : band.spans) {
    std::string label;
    for (const std::string& name : span.anomalies) {
      if (std::find(before.begin(), before.end(), name) == before.end())
        label += (label.empty() ? "" : ", ") + name;
    }
    before = span.anomalies;
    const double width = kLetter * static_cast<double>(label.size());
    const double x = std::min(view.x(span.begin), kWidth - width - 4);
    if (label.empty() || x < free_from) continue;
    svg += text("<text x=\"%.1f\" y=\"%.1f\" fill=\"#8894a3\" font-size=\"11\">%s</text>\n", x, y,
                escaped(label).c_str());
    free_from = x + width + kLetter;
  }
  return svg;
}

std::string axis(const View& view, double height) {
  std::string svg;
  const double step_s = gridStep(view.span_s);
  for (double t = 0; t <= view.span_s; t += step_s) {
    const double x = view.x(view.begin + fromSeconds(t));
    svg += text(
        "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"0\" y2=\"%.1f\" stroke=\"#8894a3\" stroke-opacity=\"0.25\"/>", x,
        x, height - kAxis);
    svg += text("<text x=\"%.1f\" y=\"%.1f\" fill=\"#8894a3\" font-size=\"11\">%s s</text>\n", x + 3,
                height - 10, valueText(t).c_str());
  }
  return svg;
}

Stamp stampOf(const std::string& field, const std::string& where) {
  Stamp stamp = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), stamp);
  if (error != std::errc() || end != field.data() + field.size())
    throw std::runtime_error(where + ": field 1 (stamp_ns): not a whole number: '" + field + "'");
  return stamp;
}

double scoreOf(const std::string& field, const std::string& where) {
  double score = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), score);
  if (error != std::errc() || end != field.data() + field.size() || !(score >= 0.0 && score <= 1.0))
    throw std::runtime_error(where + ": field 3 (score): not in 0..1: '" + field + "'");
  return score;
}

}  // namespace

std::vector<SensorBand> readStatus(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::map<std::string, std::vector<SensorSpan>> by_sensor;
  std::string line;
  Stamp last = 0;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1 || line.empty()) continue;
    const std::string where = file.string() + ":" + std::to_string(number);
    const std::vector<std::string> fields = split(line, ',');
    if (fields.size() != 4)
      throw std::runtime_error(where + ": need 4 fields, got " + std::to_string(fields.size()));
    SensorSpan span{stampOf(fields[0], where), 0, scoreOf(fields[2], where), {}};
    for (const std::string& anomaly : split(fields[3], ';')) {
      if (!anomaly.empty()) span.anomalies.push_back(anomaly.substr(0, anomaly.find('=')));
    }
    last = span.begin;
    auto& spans = by_sensor[fields[1]];
    if (!spans.empty()) spans.back().end = span.begin;
    const bool same =
        !spans.empty() && spans.back().score == span.score && spans.back().anomalies == span.anomalies;
    if (!same) spans.push_back(span);
  }
  std::vector<SensorBand> bands;
  for (auto& [sensor, spans] : by_sensor) {
    spans.back().end = last;
    bands.push_back({sensor, std::move(spans)});
  }
  return bands;
}

std::string timelineSvg(const std::vector<SensorBand>& bands) {
  if (bands.empty()) return "";
  const View view = viewOf(bands);
  const double height = kTop + kRow * static_cast<double>(bands.size()) + kAxis;
  std::string svg = text(
                        "<svg viewBox=\"0 0 %g %g\" role=\"img\" aria-label=\"sensors over time\" "
                        "font-family=\"sans-serif\">\n",
                        kWidth, height) +
                    axis(view, height);
  double y = kTop;
  for (const SensorBand& band : bands) {
    svg += text("<text x=\"%g\" y=\"%.1f\" text-anchor=\"end\" fill=\"#8894a3\" font-size=\"13\">%s</text>\n",
                kNames - 8, y + kBand - 2, escaped(band.sensor).c_str());
    for (const SensorSpan& span : band.spans) {
      svg += text("<rect x=\"%.2f\" y=\"%.1f\" width=\"%.2f\" height=\"%g\" fill=\"%s\"/>\n",
                  view.x(span.begin), y, std::max(0.6, view.x(span.end) - view.x(span.begin)), kBand,
                  scoreColor(span.score).c_str());
    }
    svg += labels(band, view, y + kBand + 12);
    y += kRow;
  }
  return svg + "</svg>\n";
}

Table sensorTable(const std::vector<SensorBand>& bands) {
  Table table{{"sensor", "anomalies", "mean score", "least score"}, {}, 2};
  for (const SensorBand& band : bands) {
    double score_time = 0, time_s = 0, least = 1;
    std::map<std::string, double> lasted_s;
    for (const SensorSpan& span : band.spans) {
      const double span_s = toSeconds(span.end - span.begin);
      score_time += span.score * span_s;
      time_s += span_s;
      least = std::min(least, span.score);
      for (const std::string& name : span.anomalies) lasted_s[name] += span_s;
    }
    std::string anomalies;
    for (const auto& [name, seconds] : lasted_s)
      anomalies += (anomalies.empty() ? "" : ", ") + name + " " + valueText(seconds) + " s";
    const double mean = time_s > 0 ? score_time / time_s : band.spans.back().score;
    table.rows.push_back(
        {band.sensor, anomalies.empty() ? "none" : anomalies, valueText(mean), valueText(least)});
  }
  return table;
}

}  // namespace atlas::report
