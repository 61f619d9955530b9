// SPDX-License-Identifier: MIT
#include "csv_sensors.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "atlas/base/geometry.hpp"

namespace atlas_localization {
namespace {

using atlas::record::RowFields;

constexpr std::size_t kMostExamples = 5;
constexpr double kMostForce_mps2 = 200.0;  // no vehicle's IMU measures more
constexpr double kMostRate_radps = 40.0;   // 2300 deg/s
constexpr double kMostAltitude_m = 20000.0;
constexpr double kMaxNormError = 1e-2;  // of a quaternion with few digits

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.emplace_back(atlas::record::trim(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

std::string joined(const std::vector<std::string>& columns) {
  std::string text;
  for (const std::string& column : columns) text += (text.empty() ? "" : ",") + column;
  return text;
}

atlas::Stamp stampOf(RowFields& row) {
  return row.integer(0, "stamp_ns", 0, std::numeric_limits<std::int64_t>::max());
}

Eigen::Vector3d vectorOf(RowFields& row, std::size_t first, const char* x, const char* y, const char* z) {
  const double a = row.number(first, x), b = row.number(first + 1, y), c = row.number(first + 2, z);
  return {a, b, c};
}

}  // namespace

CsvRows::CsvRows(const std::filesystem::path& file, const std::vector<std::string>& columns,
                 const std::vector<std::string>& optional_columns)
    : file_(file.string()), lines_(file), fields_(file_, ',') {
  if (!lines_.opened()) throw std::runtime_error(file_ + ": cannot be opened");
  const auto header = lines_.next();
  if (!header) throw std::runtime_error(file_ + ": empty; the first line must be " + joined(columns));
  std::vector<std::string> all = columns;
  all.insert(all.end(), optional_columns.begin(), optional_columns.end());
  const std::vector<std::string> names = split(header->text);
  has_optional_ = names == all;
  if (!has_optional_ && names != columns) {
    const std::vector<std::string>& wanted = names.size() > columns.size() ? all : columns;
    std::size_t i = 0;
    while (i < names.size() && i < wanted.size() && names[i] == wanted[i]) ++i;
    throw std::runtime_error(file_ + ":1: field " + std::to_string(i + 1) + " must be '" +
                             (i < wanted.size() ? wanted[i] : "nothing more") + "', got '" +
                             (i < names.size() ? names[i] : "nothing") + "'; the header is " +
                             joined(columns) + "[," + joined(optional_columns) + "]");
  }
  columns_ = names.size();
  required_ = columns.size();
}

RowFields* CsvRows::next() {
  while (const auto line = lines_.next()) {
    if (atlas::record::isBlank(line->text)) continue;
    ++report_.rows;
    fields_.assign(*line);
    // Empty fields at the end of a row may be left out.
    const bool complete =
        fields_.size() > columns_ ? fields_.expect(columns_) : fields_.expectAtLeast(required_);
    if (complete) return &fields_;
    skip();
  }
  return nullptr;
}

void CsvRows::skip(const std::optional<CsvFault>& fault) {
  if (fault) {
    fields_.fail(fault->reason, "field " + std::to_string(fault->index + 1) + " (" + fault->name + "): " +
                                    fault->reason + ": '" + std::string(fields_.text(fault->index)) + "'");
  }
  ++report_.skipped[fields_.reason()];
  if (report_.examples.size() < kMostExamples) report_.examples.push_back(fields_.example());
}

ImuCsv::ImuCsv(const std::filesystem::path& file)
    : rows_(file, {"stamp_ns", "ax", "ay", "az", "gx", "gy", "gz"}, {"qx", "qy", "qz", "qw"}) {}

std::optional<CsvFault> ImuCsv::faultOf(const atlas::ImuSample& sample) const {
  constexpr const char* kNames[] = {"ax", "ay", "az", "gx", "gy", "gz"};
  if (sample.stamp <= last_) return CsvFault{0, "stamp_ns", "not after the one before"};
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (std::abs(sample.linear_acceleration_mps2(i)) > kMostForce_mps2)
      return CsvFault{at + 1, kNames[at], "beyond 200 m/s^2"};
    if (std::abs(sample.angular_velocity_radps(i)) > kMostRate_radps)
      return CsvFault{at + 4, kNames[at + 3], "beyond 40 rad/s"};
  }
  if (sample.orientation && std::abs(sample.orientation->norm() - 1.0) > kMaxNormError)
    return CsvFault{7, "qx", "quaternion not of norm 1"};
  return std::nullopt;
}

std::optional<atlas::ImuSample> ImuCsv::next() {
  while (RowFields* row = rows_.next()) {
    atlas::ImuSample sample;
    sample.stamp = stampOf(*row);
    sample.linear_acceleration_mps2 = vectorOf(*row, 1, "ax", "ay", "az");
    sample.angular_velocity_radps = vectorOf(*row, 4, "gx", "gy", "gz");
    if (rows_.hasOptional()) {
      const Eigen::Vector3d v = vectorOf(*row, 7, "qx", "qy", "qz");
      sample.orientation.emplace(row->number(10, "qw"), v.x(), v.y(), v.z());
    }
    std::optional<CsvFault> fault;
    if (row->ok()) fault = faultOf(sample);
    if (!row->ok() || fault) {
      rows_.skip(fault);
      continue;
    }
    last_ = sample.stamp;
    rows_.used();
    force_sum_ += sample.linear_acceleration_mps2;
    rate_sum_ += sample.angular_velocity_radps.norm();
    ++samples_;
    return sample;
  }
  return std::nullopt;
}

void ImuCsv::checkUnits() const {
  if (samples_ == 0) throw std::runtime_error(rows_.file() + ": no usable row");
  const double count = static_cast<double>(samples_);
  const Eigen::Vector3d force = force_sum_ / count;
  const double rate = rate_sum_ / count;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << rows_.file() << ": ";
  if (force.norm() > 0.5 && force.norm() < 1.5) {
    text << "mean acceleration " << force.norm() << ": in g; m/s^2 is needed";
  } else if (force.norm() < 7.0 || force.norm() > 13.0) {
    text << "mean acceleration " << force.norm() << " m/s^2 is not gravity";
  } else if (force.z() < -7.0) {
    text << "mean az " << force.z() << " m/s^2: gravity must point up at rest (forward-left-up axes)";
  } else if (force.z() < 7.0) {
    text << "mean az " << force.z() << " m/s^2: z is not up (forward-left-up axes are needed)";
  } else if (rate > 5.0) {
    text << "mean rate " << rate << ": in degrees? rad/s is needed";
  } else {
    return;
  }
  throw std::runtime_error(text.str());
}

GnssCsv::GnssCsv(const std::filesystem::path& file)
    : rows_(file, {"stamp_ns", "lat", "lon", "alt", "sd_e", "sd_n", "sd_u"}, {"heading_deg", "sd_heading"}) {}

std::optional<CsvFault> GnssCsv::faultOf(const GnssRow& row, const Eigen::Vector3d& sd_m) const {
  const atlas::Geodetic& g = row.fix.position;
  if (row.fix.stamp <= last_) return CsvFault{0, "stamp_ns", "not after the one before"};
  if (std::abs(g.latitude_deg) > 90.0) return CsvFault{1, "lat", "beyond 90 degrees"};
  if (std::abs(g.longitude_deg) > 180.0) return CsvFault{2, "lon", "beyond 180 degrees"};
  if (std::abs(g.altitude_m) > kMostAltitude_m) return CsvFault{3, "alt", "beyond 20 km"};
  constexpr const char* kNames[] = {"sd_e", "sd_n", "sd_u"};
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (sd_m(i) <= 0.0) return CsvFault{at + 4, kNames[at], "not positive"};
  }
  return std::nullopt;
}

std::optional<GnssRow> GnssCsv::next() {
  while (RowFields* row = rows_.next()) {
    GnssRow result;
    atlas::GnssFix& fix = result.fix;
    fix.stamp = stampOf(*row);
    fix.position = {row->number(1, "lat"), row->number(2, "lon"), row->number(3, "alt")};
    const Eigen::Vector3d sd = vectorOf(*row, 4, "sd_e", "sd_n", "sd_u");
    std::optional<CsvFault> fault;
    if (row->ok()) fault = faultOf(result, sd);
    const std::string_view heading = row->text(7);
    if (row->ok() && !fault && rows_.hasOptional() && !atlas::record::isBlank(heading) && heading != "nan") {
      constexpr double kDeg = M_PI / 180.0;
      const double heading_deg = row->number(7, "heading_deg"), sd_deg = row->number(8, "sd_heading");
      if (row->ok() && std::abs(heading_deg) > 360.0)
        fault = CsvFault{7, "heading_deg", "beyond 360 degrees"};
      if (row->ok() && sd_deg <= 0.0) fault = CsvFault{8, "sd_heading", "not positive"};
      result.heading = atlas::GnssHeading{fix.stamp, atlas::wrapAngle((90.0 - heading_deg) * kDeg),
                                          sd_deg * kDeg * sd_deg * kDeg};
    }
    if (!row->ok() || fault) {
      rows_.skip(fault);
      continue;
    }
    last_ = fix.stamp;
    fix.frame = kAntennaFrame;
    fix.covariance_enu_m2 = {sd.x() * sd.x(), 0, 0, 0, sd.y() * sd.y(), 0, 0, 0, sd.z() * sd.z()};
    rows_.used();
    return result;
  }
  return std::nullopt;
}

}  // namespace atlas_localization
