// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/consistency/consistency_report.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// A hundred short and ten long segments; of each tenth of them one is far off.
std::vector<ConsistencySample> Segments() {
  std::vector<ConsistencySample> samples;
  for (int k = 0; k < 110; ++k) {
    ConsistencySample sample;
    sample.kind = ConsistencyKind::kLine;
    sample.dimensions = 2;
    sample.nees = k % 10 == 0 ? 100 : 4 * 1.3863;  // deviations of half the median
    sample.length = k < 100 ? 30 : 300;
    samples.push_back(sample);
  }
  return samples;
}

const ConsistencyShare* Find(const std::vector<ConsistencyShare>& shares, const std::string& of) {
  const auto found =
      std::find_if(shares.begin(), shares.end(), [&](const auto& share) { return share.of == of; });
  return found == shares.end() ? nullptr : &*found;
}

TEST(ConsistencyShares, CountWhatIsInsideByClass) {
  auto samples = Segments();
  for (std::size_t k = 0; k < 100; ++k) {
    if (k % 10 != 0) samples[k].nees = 1.3863;
  }
  const auto shares = ConsistencyShares(samples);
  const ConsistencyShare* all = Find(shares, "all");
  ASSERT_NE(all, nullptr);
  EXPECT_EQ(all->kind, "line");
  EXPECT_EQ(all->samples, 110U);
  EXPECT_NEAR(all->inside, 90 / 110.0, 1e-9);  // 4 * 1.3863 is beyond 4.605
  const ConsistencyShare* small = Find(shares, "length below 60 px");
  ASSERT_NE(small, nullptr);
  EXPECT_NEAR(small->inside, 0.9, 1e-9);
  EXPECT_NEAR(small->factor, 1, 1e-3);
  const ConsistencyShare* large = Find(shares, "length from 120 px");
  ASSERT_NE(large, nullptr);
  EXPECT_EQ(large->samples, 10U);
  EXPECT_NEAR(large->factor, 2, 1e-3);
  EXPECT_EQ(Find(shares, "length 60 to 120 px"), nullptr);
  EXPECT_EQ(Find(shares, "octave below 1"), nullptr);  // lines have none
}

TEST(ConsistencyTable, LeavesSmallClassesOut) {
  const auto shares = ConsistencyShares(Segments());
  EXPECT_NE(ConsistencyTable(shares, 1).find("length from 120 px"), std::string::npos);
  const std::string table = ConsistencyTable(shares, 50);
  EXPECT_EQ(table.find("length from 120 px"), std::string::npos);
  EXPECT_NE(table.find("length below 60 px"), std::string::npos);
}

TEST(ConsistencyJson, HasAllClasses) {
  const std::string json = ConsistencyJson(ConsistencyShares(Segments()));
  EXPECT_NE(json.find("\"of\": \"length from 120 px\""), std::string::npos);
  EXPECT_NE(json.find("\"samples\": 110"), std::string::npos);
}

}  // namespace
}  // namespace plumbline
