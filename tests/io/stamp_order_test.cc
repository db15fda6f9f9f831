// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/stamp_order.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct Ordered {
  std::vector<std::size_t> places;
  std::vector<std::string> notes;
};

// The first row stands in line 2.
Ordered OrderOf(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<StampedRow> rows;
  for (const std::int64_t stamp : stamps_ns) {
    rows.push_back({stamp, static_cast<int>(rows.size()) + 2});
  }
  Ordered ordered;
  ordered.places = OrderOfTime("a/list.csv", rows, ordered.notes);
  return ordered;
}

TEST(OrderOfTime, LeavesAGoodListAsItIs) {
  EXPECT_THAT(OrderOf({}).places, IsEmpty());
  const Ordered good = OrderOf({-5, 10, 20});
  EXPECT_THAT(good.places, ElementsAre(0, 1, 2));
  EXPECT_THAT(good.notes, IsEmpty());
}

TEST(OrderOfTime, KeepsTheFirstRowOfATime) {
  const Ordered one = OrderOf({10, 20, 20, 30});
  EXPECT_THAT(one.places, ElementsAre(0, 1, 3));
  EXPECT_THAT(one.notes, ElementsAre("a/list.csv:4: 1 row repeats a time stamp and is left out"));
  const Ordered more = OrderOf({10, 20, 10, 20, 10});
  EXPECT_THAT(more.places, ElementsAre(0, 1));
  EXPECT_THAT(
      more.notes,
      ElementsAre("a/list.csv:4: 3 rows repeat a time stamp and are left out, this one first"));
}

TEST(OrderOfTime, SortsRowsInThatGoBack) {
  const Ordered one = OrderOf({10, 30, 20, 40});
  EXPECT_THAT(one.places, ElementsAre(0, 2, 1, 3));
  EXPECT_THAT(one.notes, ElementsAre("a/list.csv:4: 1 row goes back in time and is sorted in"));
  const Ordered reversed = OrderOf({40, 30, 30, 10});
  EXPECT_THAT(reversed.places, ElementsAre(3, 1, 0));
  EXPECT_THAT(
      reversed.notes,
      ElementsAre("a/list.csv:4: 1 row repeats a time stamp and is left out",
                  "a/list.csv:3: 2 rows go back in time and are sorted in, this one first"));
}

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST(PairByStamp, JoinsWhatIsNearestToEachOther) {
  EXPECT_THAT(PairByStamp({100, 200, 300}, {95, 205, 301}, 10),
              ElementsAre(Pair(0, 0), Pair(1, 1), Pair(2, 2)));
  // 206 is the nearest to 200 and to 210, which is the nearer one.
  EXPECT_THAT(PairByStamp({200, 210}, {206}, 10), ElementsAre(Pair(1, 0)));
  // The earlier one wins if two are equally near.
  EXPECT_THAT(PairByStamp({200}, {195, 205}, 10), ElementsAre(Pair(0, 0)));
}

TEST(PairByStamp, LeavesOutWhatIsTooFarOrAlone) {
  EXPECT_THAT(PairByStamp({100, 200}, {110, 211}, 10), ElementsAre(Pair(0, 0)));
  EXPECT_THAT(PairByStamp({100, 200}, {}, 10), IsEmpty());
  EXPECT_THAT(PairByStamp({}, {100}, 10), IsEmpty());
}

}  // namespace

}  // namespace plumbline
