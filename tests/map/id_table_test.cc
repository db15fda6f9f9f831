// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/id_table.h"

#include "plumbline/base/ids.h"
#include "plumbline/base/random.h"

#include <cstdint>
#include <map>
#include <stdexcept>
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
  EXPECT_EQ(table.begin()->first, PointId{2});
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
  EXPECT_EQ(table.size(), 1u);
}

TEST(IdTable, CopiesHaveEntriesOfTheirOwn) {
  Table table = TwoEntries();
  Table copy = table;
  *table.Find(PointId{2}) = "changed";
  EXPECT_EQ(*copy.Find(PointId{2}), "two");
  copy = table;
  EXPECT_EQ(std::as_const(copy).Find(PointId{2}), &copy.begin()->second);
  const Table moved = std::move(copy);
  EXPECT_EQ(moved.Find(PointId{5}), &moved.rbegin()->second);
}

// What neither has changed since is there once.
TEST(IdTable, CopiesShareWhatIsNotChanged) {
  Table table;
  for (const std::int64_t id : {1, 2, 70, 140}) table.Insert(PointId{id}, std::to_string(id));
  const Table copy = table;
  *table.Find(PointId{1}) = "changed";
  table.Erase(PointId{140});
  EXPECT_NE(std::as_const(table).Find(PointId{1}), copy.Find(PointId{1}));
  EXPECT_EQ(std::as_const(table).Find(PointId{2}), copy.Find(PointId{2}));
  EXPECT_EQ(std::as_const(table).Find(PointId{70}), copy.Find(PointId{70}));
  EXPECT_EQ(*copy.Find(PointId{140}), "140");
  EXPECT_EQ(copy.size(), 4U);
  EXPECT_EQ(table.size(), 3U);
}

// Against a std::map that goes through the same.
TEST(IdTable, IsReadLikeAMap) {
  Rng rng(3);
  IdTable<PointId, int> table;
  std::map<PointId, int> expected;
  EXPECT_TRUE(table.begin() == table.end());
  for (int i = 0; i < 2000; ++i) {
    const PointId id{static_cast<std::int64_t>(rng.Index(600))};
    if (rng.Index(3) == 0) {
      table.Erase(id);
      expected.erase(id);
    } else {
      table.Insert(id, i);
      expected.emplace(id, i);
    }
    ASSERT_EQ(table.size(), expected.size());
    ASSERT_EQ(table.contains(id), expected.contains(id));
  }
  using Pairs = std::vector<std::pair<PointId, int>>;
  EXPECT_EQ(Pairs(table.begin(), table.end()), Pairs(expected.begin(), expected.end()));
  EXPECT_EQ(Pairs(table.rbegin(), table.rend()), Pairs(expected.rbegin(), expected.rend()));
  for (std::int64_t i = -1; i < 700; ++i) {
    const PointId id{i};
    const auto same = [&](auto a, auto b) {
      return (a == table.end()) == (b == expected.end()) &&
             (a == table.end() || a->first == b->first);
    };
    EXPECT_TRUE(same(table.find(id), expected.find(id))) << i;
    EXPECT_TRUE(same(table.lower_bound(id), expected.lower_bound(id))) << i;
    EXPECT_TRUE(same(table.upper_bound(id), expected.upper_bound(id))) << i;
  }
  EXPECT_EQ(table.at(table.begin()->first), table.begin()->second);
  EXPECT_THROW(table.at(PointId{1000}), std::out_of_range);
}

// However many ids there ever were, the index is as large as what is there.
TEST(IdTable, TheIndexStaysSmallWhereOldEntriesGo) {
  IdTable<PointId, int> table;
  const auto pages_there = [&table] {
    std::size_t there = 0;
    for (std::size_t page = 0; page < table.page_count(); ++page) {
      there += table.PageChanged(page) > 0 ? 1 : 0;
    }
    return there;
  };
  for (std::int64_t i = 0; i < 100'000; ++i) {
    table.Insert(PointId{i}, static_cast<int>(i));
    if (i >= 500) table.Erase(PointId{i - 500});
    ASSERT_LE(pages_there(), 500 / decltype(table)::kPage + 3) << i;
  }
  EXPECT_EQ(table.size(), 500U);
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
  table.ForEach([](PointId, int& entry) { ++entry; });
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
  EXPECT_EQ(table.TakenOfPage(0), std::uint64_t{1} << 63U | 0b1010U);
  EXPECT_EQ(table.TakenOfPage(1), 1U);
  EXPECT_EQ(table.TakenOfPage(2), 0U);
  table.Erase(PointId{3});
  table.Erase(PointId{64});
  EXPECT_EQ(table.TakenOfPage(0), std::uint64_t{1} << 63U | 0b10U);
  EXPECT_EQ(table.TakenOfPage(1), 0U);
}

TEST(IdTable, IsAsItWasUnlessChangesAreKept) {
  Rng rng(1);
  for (int round = 0; round < 200; ++round) {
    Table table;
    for (int i = 0; i < 20; ++i) {
      table.Insert(PointId{static_cast<std::int64_t>(rng.Index(300))}, std::to_string(i));
    }
    const Table copy = table;
    const std::vector before(copy.begin(), copy.end());
    const std::uint64_t changes = table.changes();
    const bool keep = round % 2 == 0;
    std::vector<std::pair<PointId, std::string>> changed;
    {
      Table::Undo undo(table);
      for (int i = 0; i < 30; ++i) {
        const PointId id{static_cast<std::int64_t>(rng.Index(500))};
        if (rng.Index(3) == 0) table.Insert(id, "new");
        if (rng.Index(3) == 0) table.Erase(id);
        if (std::string* entry = table.Find(id)) *entry += " changed";
      }
      table.ForEach([](PointId, std::string& entry) { entry += "!"; });
      changed.assign(table.begin(), table.end());
      if (keep) undo.Keep();
    }
    using Entries = std::vector<std::pair<PointId, std::string>>;
    EXPECT_EQ(Entries(copy.begin(), copy.end()), Entries(before.begin(), before.end()));
    EXPECT_EQ(Entries(table.begin(), table.end()),
              keep ? changed : Entries(before.begin(), before.end()));
    EXPECT_EQ(table.size(), keep ? changed.size() : before.size());
    // It is the same table, whose pages tell what changed.
    EXPECT_GE(table.changes(), changes);
    for (std::size_t page = 0; !keep && page < table.page_count(); ++page) {
      EXPECT_LE(table.PageChanged(page), changes);
    }
    table.Insert(PointId{600}, "later");
    EXPECT_EQ(table.rbegin()->second, "later");
  }
}

}  // namespace
}  // namespace plumbline
