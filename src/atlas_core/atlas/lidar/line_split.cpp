// SPDX-License-Identifier: MIT
#include "atlas/lidar/line_split.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace atlas {
namespace {

/// Best line of any piece of the chain, from sums over its beginnings.
class Pieces {
 public:
  explicit Pieces(const std::vector<Eigen::Vector3d>& chain) : chain_(chain), sums_(chain.size() + 1) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const Eigen::Vector3d p = chain[i] - chain[0];  // small numbers: map coordinates are kilometres
      sums_[i + 1].linear = sums_[i].linear + p;
      sums_[i + 1].products = sums_[i].products + p * p.transpose();
    }
  }
  [[nodiscard]] Eigen::Matrix3d scatter(std::size_t first, std::size_t end) const {
    const Eigen::Vector3d linear = sums_[end].linear - sums_[first].linear;
    return sums_[end].products - sums_[first].products -
           linear * linear.transpose() / static_cast<double>(end - first);
  }
  /// Sum of the squared distances of the points from their best line.
  [[nodiscard]] double squares(std::size_t first, std::size_t end) const {
    if (end - first < 3) return 0.0;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(scatter(first, end), Eigen::EigenvaluesOnly);
    return std::max(0.0, solver.eigenvalues()[0]) + std::max(0.0, solver.eigenvalues()[1]);
  }
  [[nodiscard]] double rms(std::size_t first, std::size_t end) const {
    return std::sqrt(squares(first, end) / static_cast<double>(end - first));
  }
  [[nodiscard]] ChainLine line(std::size_t first, std::size_t end) const {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(scatter(first, end));
    const Eigen::Vector3d direction = solver.eigenvectors().col(2);
    const Eigen::Vector3d middle =
        chain_[0] + (sums_[end].linear - sums_[first].linear) / static_cast<double>(end - first);
    const auto on_line = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
      return middle + direction * direction.dot(p - middle);
    };
    return {first, end, on_line(chain_[first]), on_line(chain_[end - 1]), rms(first, end)};
  }

 private:
  struct Sums {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  };
  const std::vector<Eigen::Vector3d>& chain_;
  std::vector<Sums> sums_;  ///< of the first i points
};

/// The farthest end that a piece can be grown to in doubling and then in halving steps.
std::size_t grown(const Pieces& pieces, std::size_t first, std::size_t end, std::size_t size,
                  double max_rms_m) {
  std::size_t step = 1;
  while (end + step <= size && pieces.rms(first, end + step) <= max_rms_m) {
    end += step;
    step *= 2;
  }
  for (; step > 0; step /= 2) {
    if (end + step <= size && pieces.rms(first, end + step) <= max_rms_m) end += step;
  }
  return end;
}

/// A grown piece holds some points beyond the corner that it ends at: the border is moved to where both fit
/// best, by at most half of the shorter piece. Neither may become worse than max_rms_m.
void moveBorder(const Pieces& pieces, std::size_t first, std::size_t& border, std::size_t end,
                double max_rms_m) {
  const std::size_t reach = std::min(border - first, end - border) / 2;
  std::size_t best = border;
  double best_squares = pieces.squares(first, border) + pieces.squares(border, end);
  for (std::size_t b = border - reach; b <= border + reach; ++b) {
    const double squares = pieces.squares(first, b) + pieces.squares(b, end);
    if (squares < best_squares && pieces.rms(first, b) <= max_rms_m && pieces.rms(b, end) <= max_rms_m)
      best = b, best_squares = squares;
  }
  border = best;
}

}  // namespace

std::vector<ChainLine> splitIntoLines(const std::vector<Eigen::Vector3d>& chain, std::size_t min_points,
                                      double max_rms_m) {
  struct Piece {
    std::size_t first, end;
  };
  std::vector<ChainLine> lines;
  if (chain.size() < min_points) return lines;
  const Pieces pieces(chain);
  std::vector<Piece> found;
  for (std::size_t first = 0; first + min_points <= chain.size();) {
    if (pieces.rms(first, first + min_points) > max_rms_m) {
      ++first;
      continue;
    }
    const std::size_t end = grown(pieces, first, first + min_points, chain.size(), max_rms_m);
    found.push_back({first, end});
    first = end;
  }
  for (std::size_t i = 1; i < found.size(); ++i) {
    if (found[i - 1].end != found[i].first) continue;
    moveBorder(pieces, found[i - 1].first, found[i].first, found[i].end, max_rms_m);
    found[i - 1].end = found[i].first;
  }
  for (const Piece& piece : found) {
    if (piece.end - piece.first >= min_points) lines.push_back(pieces.line(piece.first, piece.end));
  }
  return lines;
}

}  // namespace atlas
