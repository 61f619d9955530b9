// SPDX-License-Identifier: MIT
// Plain CSV of an IMU and of a GNSS receiver, read strictly: the header names the columns, a row that is not
// as announced is counted under its reason and never used.
//
//   imu    stamp_ns,ax,ay,az,gx,gy,gz[,qx,qy,qz,qw]   m/s^2 (up at rest), rad/s, forward-left-up;
//                                                     q = R_enu_imu of the IMU's own filter
//   gnss   stamp_ns,lat,lon,alt,sd_e,sd_n,sd_u[,heading_deg,sd_heading]   degrees, m above the ellipsoid, m;
//                                                     heading clockwise from north, empty where unknown
#pragma once

#include <filesystem>
#include <optional>

#include "atlas/sensor/record_reader.hpp"
#include "record/text_rows.hpp"

namespace atlas_localization {

/// A number that cannot be what its column says.
struct CsvFault {
  std::size_t index;
  const char* name;
  const char* reason;
};

/// What both readers share: header, rows, report.
class CsvRows {
 public:
  /// Throws std::runtime_error naming file, line and field when it cannot be read or its header differs.
  CsvRows(const std::filesystem::path& file, const std::vector<std::string>& columns,
          const std::vector<std::string>& optional_columns);
  /// The next row that has as many fields as the header; nullptr at the end.
  atlas::record::RowFields* next();
  [[nodiscard]] bool hasOptional() const { return has_optional_; }
  void used() { ++report_.used; }
  /// Counts the row's fault, or this one when its fields could be read.
  void skip(const std::optional<CsvFault>& fault = std::nullopt);
  [[nodiscard]] const atlas::FileReport& report() const { return report_; }
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
  atlas::record::LineReader lines_;
  atlas::record::RowFields fields_;
  std::size_t columns_ = 0, required_ = 0;
  bool has_optional_ = false;
  atlas::FileReport report_;
};

class ImuCsv {
 public:
  explicit ImuCsv(const std::filesystem::path& file);
  std::optional<atlas::ImuSample> next();
  [[nodiscard]] const CsvRows& rows() const { return rows_; }
  /// Throws std::runtime_error when the samples cannot be what the header says: g instead of m/s^2, gravity
  /// pointing down, degrees instead of radians.
  void checkUnits() const;

 private:
  [[nodiscard]] std::optional<CsvFault> faultOf(const atlas::ImuSample& sample) const;

  CsvRows rows_;
  atlas::Stamp last_ = atlas::kBeginOfTime;
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
  double rate_sum_ = 0.0;
  std::uint64_t samples_ = 0;
};

/// Frame of the antenna in every fix.
constexpr const char* kAntennaFrame = "gnss";

/// A row of the GNSS file.
struct GnssRow {
  atlas::GnssFix fix;
  std::optional<atlas::GnssHeading> heading;
};
class GnssCsv {
 public:
  explicit GnssCsv(const std::filesystem::path& file);
  std::optional<GnssRow> next();
  [[nodiscard]] const CsvRows& rows() const { return rows_; }

 private:
  [[nodiscard]] std::optional<CsvFault> faultOf(const GnssRow& row, const Eigen::Vector3d& sd_m) const;

  CsvRows rows_;
  atlas::Stamp last_ = atlas::kBeginOfTime;
};

}  // namespace atlas_localization
