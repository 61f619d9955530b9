// SPDX-License-Identifier: MIT
#include "files/grid_writer.hpp"

#include <stdexcept>

#include "atlas/output/fixed_text.hpp"
#include "atlas/output/grid_pgm.hpp"
#include "atlas/output/objects_text.hpp"

namespace atlas {

void validate(const GridWriterParams& params) {
  if (!(params.period_s >= 0.0 && params.period_s < 1e6)) {
    throw std::invalid_argument("grid_writer/period_s must be 0 or more seconds, got " +
                                std::to_string(params.period_s));
  }
}

GridWriter::GridWriter(const GridWriterParams& params, const std::filesystem::path& out)
    : folder_(out / "grid"),
      period_(fromSeconds(params.period_s)),
      objects_(std::make_unique<OutputFile>(folder_ / "objects.csv")),
      risk_(std::make_unique<OutputFile>(folder_ / "risk.csv")) {
  objects_->write(objectsCsvHeader());
  risk_->write("stamp_ns,known,total,expected_time_s,object,unknown_share\n");
}

bool GridWriter::write(const OccupancyMap& map) {
  if (map.percent.empty()) return false;
  const Stamp turn = period_ > 0 ? map.stamp / period_ : map.stamp;
  if (turn_ && *turn_ == turn) return false;
  turn_ = turn;
  const std::string name = std::to_string(map.stamp);
  const std::vector<std::uint8_t> pgm = gridPgm(map);
  writeFile(folder_ / (name + ".pgm"), {reinterpret_cast<const char*>(pgm.data()), pgm.size()});
  writeFile(folder_ / (name + ".yaml"), gridYaml(map, name + ".pgm"));
  return true;
}

void GridWriter::write(const Objects& objects) { objects_->write(objectsCsvRows(objects)); }

void GridWriter::write(const RiskAnswer& answer) {
  std::string row = std::to_string(answer.stamp) + (answer.risk ? ",1," : ",0,,,,");
  if (const auto& risk = answer.risk) {
    row += fixedText(risk->total, 6) + ',';
    if (risk->expected_time_s) row += fixedText(*risk->expected_time_s, 3);
    row += ',' + (risk->object ? std::to_string(*risk->object) : std::string()) + ',';
    row += fixedText(risk->unknown_share, 6);
  }
  risk_->write(row + '\n');
}

void GridWriter::close() {
  if (objects_) objects_->commit();
  if (risk_) risk_->commit();
  objects_.reset();
  risk_.reset();
}

}  // namespace atlas
