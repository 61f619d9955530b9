// SPDX-License-Identifier: MIT
#include "atlas/fusion/assignment.hpp"

#include <gtest/gtest.h>

#include <random>

namespace atlas {
namespace {

using Edges = std::vector<std::vector<AssignmentEdge>>;

TEST(Assignment, TheSumCountsNotTheFirstRow) {
  // row 0 prefers column 0 as well, but row 1 has nothing else
  const Edges edges = {{{0, 1.0}, {1, 2.0}}, {{0, 1.5}}};
  EXPECT_EQ(assign(edges, 2, 10.0), (std::vector<int>{1, 0}));
}

TEST(Assignment, ARowStaysWithoutWhenThatIsCheaper) {
  EXPECT_EQ(assign({{{0, 5.0}}}, 1, 4.0), (std::vector<int>{kUnassigned}));
  EXPECT_EQ(assign({{{0, 1.0}}, {{0, 2.0}}}, 1, 4.0), (std::vector<int>{0, kUnassigned}));
  EXPECT_TRUE(assign({}, 3, 1.0).empty());
}

TEST(Assignment, NegativeCostsAndTies) {
  EXPECT_EQ(assign({{{0, -3.0}, {1, -5.0}}, {{1, -6.0}}}, 2, 0.0), (std::vector<int>{0, 1}));
  const Edges tie = {{{0, 1.0}, {1, 1.0}}, {{0, 1.0}, {1, 1.0}}};
  EXPECT_EQ(assign(tie, 2, 5.0), assign(tie, 2, 5.0));
}

/// The least sum of a row without a column at `none`, by trying everything.
double leastSum(const Edges& edges, std::size_t row, std::vector<char>& used, double none) {
  if (row == edges.size()) return 0.0;
  double least = none + leastSum(edges, row + 1, used, none);
  for (const AssignmentEdge& edge : edges[row]) {
    if (used[edge.column] != 0) continue;
    used[edge.column] = 1;
    least = std::min(least, edge.cost + leastSum(edges, row + 1, used, none));
    used[edge.column] = 0;
  }
  return least;
}

TEST(Assignment, AsGoodAsTryingEverything) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> cost(-2.0, 6.0), chance(0.0, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t rows = 1 + random() % 6, columns = 1 + random() % 6;
    Edges edges(rows);
    for (auto& row : edges) {
      for (std::uint32_t c = 0; c < columns; ++c) {
        if (chance(random) < 0.6) row.push_back({c, cost(random)});
      }
    }
    const std::vector<int> found = assign(edges, columns, 3.0);
    double sum = 0.0;
    std::vector<char> used(columns, 0);
    for (std::size_t r = 0; r < rows; ++r) {
      if (found[r] == kUnassigned) {
        sum += 3.0;
        continue;
      }
      EXPECT_EQ(used[static_cast<std::size_t>(found[r])]++, 0);
      for (const AssignmentEdge& edge : edges[r])
        sum += edge.column == static_cast<std::uint32_t>(found[r]) ? edge.cost : 0.0;
    }
    std::vector<char> none_used(columns, 0);
    EXPECT_NEAR(sum, leastSum(edges, 0, none_used, 3.0), 1e-9);
  }
}

}  // namespace
}  // namespace atlas
