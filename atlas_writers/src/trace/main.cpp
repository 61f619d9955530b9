// SPDX-License-Identifier: MIT
// atlas_trace OUT KIND ...: prints what a product of a run was made from, down to the raw data.
//   depth CAMERA N              N-th depth image of a camera
//   thermal N                   labels of the N-th thermal frame
//   frustum CAMERA FRAME [DETECTION]
//   object ID [--at STAMP_NS]   its last update, or the last one at or before a stamp
// Exit status 0: printed, 1: the run has no such product, 2: wrong arguments or unreadable.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <optional>

#include "atlas/output/origins_csv.hpp"
#include "atlas/output/trace_tree.hpp"

namespace {

using atlas::Origin;
using atlas::ProductOrigins;

/// The file is read once for each level of the tree, row by row: memory does not grow with the drive.
class TraceFile {
 public:
  explicit TraceFile(std::string path) : path_(std::move(path)) {}
  template <class Visit>
  void forEach(Visit&& visit) const {
    std::ifstream file(path_);
    if (!file) throw std::runtime_error(path_ + ": cannot be read (a run of this version writes it)");
    std::string line;
    std::getline(file, line);
    for (int number = 2; std::getline(file, line); ++number) {
      const auto row = atlas::parseOriginsRow(line);
      if (!row)
        throw std::runtime_error(path_ + ":" + std::to_string(number) +
                                 ": not product,index,stamp_ns,origins: '" + line.substr(0, 80) + "'");
      visit(*row);
    }
  }
  [[nodiscard]] std::vector<ProductOrigins> find(const std::vector<Origin>& wanted) const {
    std::vector<ProductOrigins> found;
    forEach([&](const ProductOrigins& row) {
      for (const Origin& origin : wanted) {
        if (row.product != origin.topic || row.stamp != origin.stamp) continue;
        found.push_back(row);
        break;
      }
    });
    return found;
  }
  /// The last one that fits. `product` may be the end of the name, for the one camera that has it; without
  /// an index any one at or before `latest`.
  [[nodiscard]] std::optional<Origin> root(const std::string& product, std::optional<std::uint32_t> index,
                                           atlas::Stamp latest) const {
    std::optional<Origin> result;
    forEach([&](const ProductOrigins& row) {
      const bool ends =
          row.product.size() >= product.size() &&
          row.product.compare(row.product.size() - product.size(), product.size(), product) == 0;
      if (ends && row.index == index.value_or(row.index) && row.stamp <= latest)
        result = Origin{row.product, row.stamp, row.index, {}};
    });
    return result;
  }

 private:
  std::string path_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Prints what a product of a run was made from, down to the raw data.");
  std::string out, camera;
  std::uint32_t index = 0;
  std::optional<std::uint32_t> detection;
  atlas::Stamp latest = atlas::kEndOfTime;
  app.add_option("OUT", out, "output folder of a run")->required()->check(CLI::ExistingDirectory);
  app.require_subcommand(1);
  auto* depth = app.add_subcommand("depth", "a depth image");
  depth->add_option("CAMERA", camera)->required();
  depth->add_option("N", index, "number of the image in its stream")->required();
  auto* thermal = app.add_subcommand("thermal", "the labels of a thermal frame");
  thermal->add_option("N", index, "number of the frame in its stream")->required();
  auto* frustum = app.add_subcommand("frustum", "the frustums of an image, or one of them");
  frustum->add_option("CAMERA", camera)->required();
  frustum->add_option("FRAME", index, "number of the image in its stream")->required();
  frustum->add_option("DETECTION", detection, "index of the detection in the image");
  auto* object = app.add_subcommand("object", "an object of the local map");
  object->add_option("ID", index)->required();
  object->add_option("--at", latest, "stamp in ns: its last update at or before");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const TraceFile file(out + "/trace/origins.csv");
    std::string product = "/projected_detections";
    if (depth->parsed()) product = camera + "/depth/image";
    if (frustum->parsed()) product = camera + "/frustums";
    std::optional<std::uint32_t> number = index;
    if (object->parsed()) {
      product = "objects/" + std::to_string(index);
      number.reset();
    }
    const auto root = file.root(product, number, latest);
    if (!root) {
      std::fprintf(stderr, "atlas_trace: %s has no %s #%u\n", out.c_str(), product.c_str(), index);
      return 1;
    }
    if (detection) std::printf("detection %u of\n", *detection);
    std::printf("%s", atlas::traceTree(*root, [&](const std::vector<Origin>& wanted) {
                        return file.find(wanted);
                      }).c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "atlas_trace: %s\n", error.what());
    return 2;
  }
}
