// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/id_table.h"

#include "plumbline/base/ids.h"

#include <string>
#include <utility>

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

}  // namespace
}  // namespace plumbline
