// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/stamp_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST(PairByStamp, JoinsWhatIsNearestToEachOther) {
  EXPECT_THAT(PairByStamp({100, 200, 300}, {95, 205, 301}, 10),
              ElementsAre(Pair(0, 0), Pair(1, 1), Pair(2, 2)));
  // 206 is the nearest to 200 and to 210, which is the nearer one.
  EXPECT_THAT(PairByStamp({200, 210}, {206}, 10), ElementsAre(Pair(1, 0)));
  // Of two that are equally near the earlier one.
  EXPECT_THAT(PairByStamp({200}, {195, 205}, 10), ElementsAre(Pair(0, 0)));
}

TEST(PairByStamp, LeavesOutWhatIsTooFarOrAlone) {
  EXPECT_THAT(PairByStamp({100, 200}, {110, 211}, 10), ElementsAre(Pair(0, 0)));
  EXPECT_THAT(PairByStamp({100, 200}, {}, 10), IsEmpty());
  EXPECT_THAT(PairByStamp({}, {100}, 10), IsEmpty());
}

}  // namespace
}  // namespace plumbline
