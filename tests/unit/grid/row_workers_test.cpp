// SPDX-License-Identifier: MIT
#include "atlas/grid/row_workers.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace atlas {
namespace {

TEST(RowWorkers, EveryRowOnceWithAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 7}) {
    RowWorkers workers(threads);
    EXPECT_EQ(workers.threads(), threads);
    for (const int rows : {0, 1, 2, 5, 200}) {
      std::vector<int> visits(static_cast<std::size_t>(rows), 0);
      workers.run(rows, [&](int first, int end) {
        for (int row = first; row < end; ++row) ++visits[static_cast<std::size_t>(row)];
      });
      for (const int count : visits) EXPECT_EQ(count, 1) << threads << " threads, " << rows << " rows";
    }
  }
}

TEST(RowWorkers, AnErrorReachesTheCallerAndTheNextRunWorks) {
  RowWorkers workers(2);
  EXPECT_THROW(workers.run(10,
                           [](int, int end) {
                             if (end == 10) throw std::runtime_error("row 9");
                           }),
               std::runtime_error);
  int last = 0;
  workers.run(4, [&](int, int end) {
    if (end == 4) last = end;
  });
  EXPECT_EQ(last, 4);
}

TEST(RowWorkers, RefusesNoThreads) {
  EXPECT_THROW(RowWorkers(0), std::invalid_argument);
  EXPECT_THROW(RowWorkers(1000), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
