// SPDX-License-Identifier: MIT
#include "atlas/fusion/assignment.hpp"

#include <limits>
#include <queue>
#include <tuple>

namespace atlas {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Columns [0, columns) are real; column columns + r is the private "none" of row r.
class SparseAssignment {
 public:
  SparseAssignment(const std::vector<std::vector<AssignmentEdge>>& edges, std::size_t columns, double none)
      : edges_(edges),
        columns_(columns),
        none_(none),
        row_of_(columns + edges.size(), kUnassigned),
        column_of_(edges.size(), kUnassigned),
        price_(columns + edges.size(), 0.0),
        distance_(columns + edges.size(), kInfinite),
        via_(columns + edges.size(), kUnassigned),
        done_(columns + edges.size(), 0) {}

  std::vector<int> solve() {
    for (std::size_t row = 0; row < edges_.size(); ++row) augment(static_cast<int>(row));
    for (int& column : column_of_) {
      if (column >= static_cast<int>(columns_)) column = kUnassigned;
    }
    return column_of_;
  }

 private:
  using Entry = std::tuple<double, std::size_t>;  // distance, column: ties go to the smaller column

  void relax(int row, double base) {
    const auto offer = [&](std::size_t column, double cost) {
      const double d = base + cost - price_[column];
      if (done_[column] != 0 || d >= distance_[column]) return;
      if (distance_[column] == kInfinite) touched_.push_back(column);
      distance_[column] = d;
      via_[column] = row;
      queue_.push({d, column});
    };
    for (const AssignmentEdge& edge : edges_[static_cast<std::size_t>(row)]) {
      if (edge.cost < none_) offer(edge.column, edge.cost);
    }
    offer(columns_ + static_cast<std::size_t>(row), none_);
  }

  /// Dijkstra on reduced costs from a free row to the nearest free column; then the prices and the path.
  void augment(int free_row) {
    queue_ = {};
    touched_.clear();
    std::size_t end = 0;
    double least = 0.0;
    relax(free_row, 0.0);
    for (;;) {  // ends: the row's own "none" is free
      const auto [d, column] = queue_.top();
      queue_.pop();
      if (done_[column] != 0 || d > distance_[column]) continue;
      done_[column] = 1;
      if (row_of_[column] == kUnassigned) {
        end = column;
        least = d;
        break;
      }
      const int row = row_of_[column];
      relax(row, d - reducedCost(row, column));
    }
    for (const std::size_t column : touched_) {
      if (done_[column] != 0) price_[column] += distance_[column] - least;
      distance_[column] = kInfinite;
      done_[column] = 0;
    }
    for (std::size_t column = end;;) {
      const int row = via_[column];
      const int before = column_of_[static_cast<std::size_t>(row)];
      row_of_[column] = row;
      column_of_[static_cast<std::size_t>(row)] = static_cast<int>(column);
      if (row == free_row) break;
      column = static_cast<std::size_t>(before);
    }
  }

  [[nodiscard]] double reducedCost(int row, std::size_t column) const {
    if (column >= columns_) return none_ - price_[column];
    double cost = kInfinite;
    for (const AssignmentEdge& edge : edges_[static_cast<std::size_t>(row)]) {
      if (edge.column == column && edge.cost < cost) cost = edge.cost;
    }
    return cost - price_[column];
  }

  const std::vector<std::vector<AssignmentEdge>>& edges_;
  std::size_t columns_;
  double none_;
  std::vector<int> row_of_, column_of_;
  std::vector<double> price_, distance_;
  std::vector<int> via_;
  std::vector<char> done_;
  std::vector<std::size_t> touched_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

std::vector<int> assign(const std::vector<std::vector<AssignmentEdge>>& edges_of_row, std::size_t columns,
                        double cost_of_none) {
  return SparseAssignment(edges_of_row, columns, cost_of_none).solve();
}

}  // namespace atlas
