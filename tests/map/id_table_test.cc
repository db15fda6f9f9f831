// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/id_table.h"

#include "plumbline/base/ids.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

using Table = IdTable<PointId, std::string>;

Table TwoEntries() {
  Table table;
  table.Insert(PointId{5}, "five");
  table.Insert(PointId{2}, "two");
  return table;
}

TEST(IdTable, FindsWhatIsThereAndNothingElse) {
  const Table table = TwoEntries();
  EXPECT_EQ(*table.Find(PointId{2}), "two");
  EXPECT_EQ(*table.Find(PointId{5}), "five");
  EXPECT_EQ(table.Find(PointId{3}), nullptr);
  EXPECT_EQ(table.Find(PointId{6}), nullptr);
  EXPECT_EQ(table.Find(PointId{}), nullptr);
  EXPECT_EQ(table.entries().begin()->first, PointId{2});
}

TEST(IdTable, KeepsAnEntryThatIsThere) {
  Table table = TwoEntries();
  table.Insert(PointId{2}, "again");
  EXPECT_EQ(*table.Find(PointId{2}), "two");
}

TEST(IdTable, ForgetsWhatIsErased) {
  Table table = TwoEntries();
  table.Erase(PointId{2});
  table.Erase(PointId{9});
  EXPECT_EQ(table.Find(PointId{2}), nullptr);
  EXPECT_EQ(table.entries().size(), 1u);
}

TEST(IdTable, CopiesHaveEntriesOfTheirOwn) {
  Table table = TwoEntries();
  Table copy = table;
  *table.Find(PointId{2}) = "changed";
  EXPECT_EQ(*copy.Find(PointId{2}), "two");
  copy = table;
  EXPECT_EQ(copy.Find(PointId{2}), &copy.entries().begin()->second);
  const Table moved = std::move(copy);
  EXPECT_EQ(moved.Find(PointId{5}), &moved.entries().rbegin()->second);
}

// However many ids there ever were, the index is as large as what is there.
TEST(IdTable, TheIndexStaysSmallWhereOldEntriesGo) {
  IdTable<PointId, int> table;
  for (std::int64_t i = 0; i < 100'000; ++i) {
    table.Insert(PointId{i}, static_cast<int>(i));
    if (i >= 500) table.Erase(PointId{i - 500});
    ASSERT_LE(table.pages(), 500 / decltype(table)::kPage + 3) << i;
  }
  EXPECT_EQ(table.entries().size(), 500U);
  EXPECT_EQ(table.Find(PointId{99'499}), nullptr);
  EXPECT_EQ(*table.Find(PointId{99'500}), 99'500);
}

TEST(IdTable, APageKnowsWhenItChanged) {
  IdTable<PointId, int> table;
  table.Insert(PointId{1}, 1);
  table.Insert(PointId{100}, 1);
  ASSERT_EQ(table.page_count(), 2U);
  std::uint64_t seen = table.changes();
  const auto changed = [&](std::size_t page) {
    return table.PageChanged(page) == 0 || table.PageChanged(page) > seen;
  };
  EXPECT_NE(std::as_const(table).Find(PointId{100}), nullptr);
  EXPECT_EQ(table.Find(PointId{2}), nullptr);
  EXPECT_FALSE(changed(0) || changed(1));
  *table.Find(PointId{100}) = 2;
  EXPECT_TRUE(!changed(0) && changed(1));
  seen = table.changes();
  table.Insert(PointId{2}, 1);
  EXPECT_TRUE(changed(0) && !changed(1));
  seen = table.changes();
  table.Erase(PointId{2});
  EXPECT_TRUE(changed(0) && !changed(1));
  seen = table.changes();
  table.Erase(PointId{100});
  EXPECT_EQ(table.PageChanged(1), 0U);
  table.Insert(PointId{101}, 1);
  EXPECT_TRUE(!changed(0) && changed(1));
  seen = table.changes();
  for (auto& [id, entry] : table.entries()) ++entry;
  EXPECT_TRUE(changed(0) && changed(1));
  seen = table.changes();
  table = IdTable<PointId, int>(table);
  EXPECT_TRUE(changed(0) && changed(1));
}

TEST(IdTable, GoesThroughOnePage) {
  IdTable<PointId, int> table;
  for (const std::int64_t id : {3, 1, 63, 64}) table.Insert(PointId{id}, static_cast<int>(10 * id));
  std::vector<std::pair<std::int64_t, int>> found;
  table.ForEachOfPage(0,
                      [&](PointId id, const int& entry) { found.emplace_back(id.value, entry); });
  const std::vector<std::pair<std::int64_t, int>> expected{{1, 10}, {3, 30}, {63, 630}};
  EXPECT_EQ(found, expected);
  table.ForEachOfPage(2, [&](PointId, const int&) { FAIL(); });
}

}  // namespace
}  // namespace plumbline
