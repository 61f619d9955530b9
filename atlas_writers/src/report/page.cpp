// SPDX-License-Identifier: MIT
#include "report/page.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "report/evaluation_table.hpp"
#include "report/grid_picture.hpp"
#include "report/html.hpp"
#include "report/map_picture.hpp"
#include "report/number_text.hpp"
#include "report/pcd_file.hpp"
#include "report/picture_choice.hpp"
#include "report/run_tables.hpp"
#include "report/sensor_timeline.hpp"
#include "report/trajectory_file.hpp"
#include "report/trajectory_plot.hpp"

namespace atlas::report {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

template <class Json>
Json readJson(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  Json value = Json::parse(file, nullptr, false);
  if (value.is_discarded()) throw std::runtime_error(path.string() + ": is not JSON");
  return value;
}

void writeWhole(const fs::path& path, const void* data, std::size_t size) {
  const fs::path temporary = path.string() + ".part";
  {
    std::ofstream file(temporary, std::ios::binary);
    file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    file.flush();
    if (!file) throw std::runtime_error(temporary.string() + ": cannot be written");
  }
  fs::rename(temporary, path);
}

/// Collects the figures of the page and the names of what is missing.
class Gallery {
 public:
  explicit Gallery(fs::path folder) : folder_(std::move(folder)) {}
  void add(const std::string& file, const cv::Mat& pixels, const std::string& caption) {
    std::vector<unsigned char> png;
    cv::imencode(".png", pixels, png);
    writeWhole(folder_ / file, png.data(), png.size());
    html_ += figure(file, caption);
  }
  void add(const std::string& file, const std::optional<Picture>& picture, const std::string& what) {
    if (picture) {
      add(file, picture->pixels, picture->caption);
    } else {
      missing(what);
    }
  }
  void addHtml(const std::string& html) { html_ += html; }
  void missing(const std::string& what) { missing_ += (missing_.empty() ? "" : ", ") + what; }
  [[nodiscard]] std::string html() const {
    const std::string note =
        missing_.empty() ? ""
                         : "<p class=\"subtitle\">Not made by this run: " + escaped(missing_) + ".</p>\n";
    return "<div class=\"grid\">\n" + html_ + "</div>\n" + note;
  }

 private:
  fs::path folder_;
  std::string html_, missing_;
};

void addMap(const fs::path& out, const std::vector<TrajectoryPoint>& trajectory, Gallery& gallery) {
  const fs::path map = out / "map/map.pcd";
  if (!fs::exists(map)) return gallery.missing("map");
  const std::vector<cv::Point3f> points = readPcd(map);
  const cv::Mat picture = drawMap(points, trajectory);
  if (picture.empty()) return gallery.missing("map");
  gallery.add("map.png", picture,
              "Map from above, " + countText(points.size()) +
                  " points coloured by height; trajectory in white, start green, end red");
}

std::string gallerySection(const PageOptions& options, const std::vector<TrajectoryPoint>& trajectory,
                           const fs::path& folder) {
  Gallery gallery(folder);
  const std::string plot = trajectorySvg(trajectory);
  if (plot.empty()) {
    gallery.missing("trajectory");
  } else {
    gallery.addHtml(figureOf(plot, "Trajectory in map, " + countText(trajectory.size()) +
                                       " poses, metres east and north of the anchor"));
  }
  addMap(options.out, trajectory, gallery);
  gallery.add("overlay.png", chooseOverlay(options.out), "camera overlay");
  gallery.add("depth.png", chooseDepth(options.out), "depth image");
  gallery.add("grid.png", chooseGrid(options.out), "occupancy grid");
  gallery.add("thermal.png", chooseThermal(options.out), "thermal image");
  gallery.add("contact_sheet.png", contactSheet(options.out), "contact sheet");
  if (!options.screenshot.empty() && fs::exists(options.screenshot)) {
    gallery.add("rviz.png", cv::imread(options.screenshot.string()), "RViz during the replay");
  }
  return section("Pictures", gallery.html());
}

std::string tableSections(const json& run) {
  std::string html;
  const Table streams = streamTable(run), files = fileTable(run), stages = stageTable(run);
  if (!streams.rows.empty()) html += section("Sensors: messages read", toHtml(streams));
  if (!files.rows.empty()) html += section("Inputs: every row accounted for", toHtml(files));
  if (!stages.rows.empty())
    html += section("Stages", details("read, answered and skipped, by stage", toHtml(stages)));
  const std::string notes = notesHtml(run);
  return notes.empty() ? html : html + section("Notes of the run", notes);
}

std::string datasetSection(const fs::path& out) {
  const fs::path file = out / "thermal/card.json";
  if (!fs::exists(file)) return "";
  const auto card = readJson<json>(file);
  const Table classes = datasetTable(card), dropped = droppedTable(card);
  std::string html = classes.rows.empty() ? "" : toHtml(classes);
  if (!dropped.rows.empty()) html += details("left out, and why", toHtml(dropped));
  return html.empty() ? "" : section("Thermal dataset", html);
}

std::string sensorSection(const fs::path& out) {
  const std::vector<SensorBand> bands = readStatus(out / "sensors/status.csv");
  if (bands.empty()) return "";
  return section("Sensors over time",
                 figureOf(timelineSvg(bands),
                          "Score of the sensor monitor: green 1, amber 0.5, red 0; anomalies "
                          "where they began") +
                     toHtml(sensorTable(bands)));
}

std::string subtitleOf(const json& run, const std::string& label) {
  std::string text = label;
  for (const char* key : {"mode", "version"}) {
    if (run.contains(key) && run[key].is_string()) {
      text += (text.empty() ? "" : " · ") + std::string(key) + " " + run[key].get<std::string>();
    }
  }
  return text;
}

}  // namespace

fs::path writeReport(const PageOptions& options) {
  const auto run = readJson<json>(options.out / "run.json");
  const fs::path folder = options.out / "report";
  fs::create_directories(folder);
  const std::vector<TrajectoryPoint> trajectory = readTum(options.out / "trajectory/trajectory.tum");
  std::string body;
  if (run.contains("complete") && run["complete"].is_boolean() && !run["complete"].get<bool>()) {
    body +=
        section("Incomplete run", "<p class=\"problem\">" +
                                      escaped(run.value("failure", "it did not come to its end")) + "</p>");
  }
  body += toHtml(keyFigures(run, pathLength(trajectory)));
  if (!options.evaluation.empty()) {
    body += section("Errors against the truth of the synthetic drive",
                    evaluationHtml(readJson<nlohmann::ordered_json>(options.evaluation)));
  }
  body += gallerySection(options, trajectory, folder) + sensorSection(options.out) +
          datasetSection(options.out) + tableSections(run);
  const std::string html = document("Atlas Fusion report", subtitleOf(run, options.record_label), body);
  writeWhole(folder / "index.html", html.data(), html.size());
  return folder / "index.html";
}

}  // namespace atlas::report
