// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/byte_format.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

ByteReader ReaderOf(const std::string& bytes) {
  return {{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "x"};
}

template <class T>
T ThereAndBack(const T& value) {
  ByteWriter writer;
  Transfer(writer, value);
  ByteReader reader = ReaderOf(writer.bytes());
  T back{};
  Transfer(reader, back);
  EXPECT_EQ(reader.remaining(), 0U);
  return back;
}

template <class Number>
std::vector<Number> ColumnThereAndBack(const std::vector<Number>& numbers, std::size_t bytes) {
  const auto get = [](auto& number) -> auto& { return number; };
  ByteWriter writer;
  TransferColumn(writer, numbers, get);
  EXPECT_EQ(writer.bytes().size(), 1 + bytes * numbers.size());
  ByteReader reader = ReaderOf(writer.bytes());
  std::vector<Number> back(numbers.size());
  TransferColumn(reader, back, get);
  EXPECT_EQ(reader.remaining(), 0U);
  return back;
}

TEST(ByteFormat, GivesBackWhatWasWritten) {
  EXPECT_EQ(ThereAndBack(-5), -5);
  EXPECT_EQ(ThereAndBack(true), true);
  EXPECT_EQ(ThereAndBack(1.0 / 3), 1.0 / 3);
  EXPECT_EQ(ThereAndBack(PointId{7}), PointId{7});
  const std::string text("a\0b", 3);
  EXPECT_EQ(ThereAndBack(text), text);
  const std::vector<std::int64_t> list{1, -3};
  EXPECT_EQ(ThereAndBack(list), list);
  const std::map<LineId, std::array<std::uint64_t, 2>> by_id{{LineId{1}, {2, 3}},
                                                             {LineId{4}, {5, 6}}};
  EXPECT_EQ(ThereAndBack(by_id), by_id);
}

TEST(ByteFormat, TakesAsFewBytesForAColumnAsItsNumbersNeed) {
  const std::vector<double> floats{0.5, -0x1p100, 0.0, -0.0, 0x1p-126};
  const std::vector<double> back = ColumnThereAndBack(floats, 4);
  EXPECT_EQ(back, floats);
  EXPECT_TRUE(std::signbit(back[3]));
  const std::vector<double> doubles{0.5, 0.1};
  EXPECT_EQ(ColumnThereAndBack(doubles, 8), doubles);
  const std::vector<int> small{-1, 0, 127, -128};
  EXPECT_EQ(ColumnThereAndBack(small, 1), small);
  const std::vector<int> wide{-1, std::numeric_limits<int>::min()};
  EXPECT_EQ(ColumnThereAndBack(wide, 4), wide);
  const std::vector<std::int64_t> widest{std::numeric_limits<std::int64_t>::min(),
                                         std::numeric_limits<std::int64_t>::max()};
  EXPECT_EQ(ColumnThereAndBack(widest, 8), widest);
  EXPECT_EQ(ColumnThereAndBack(std::vector<int>(), 0), std::vector<int>());
}

TEST(ByteFormat, RefusesNumbersThatDoNotFit) {
  ByteWriter writer;
  const std::vector<std::int64_t> large{1000};
  const auto get = [](auto& number) -> auto& { return number; };
  TransferColumn(writer, large, get);
  ByteReader reader = ReaderOf(writer.bytes());
  std::vector<std::uint8_t> bytes(1);
  EXPECT_THROW(TransferColumn(reader, bytes, get), InputError);
  std::vector<double> doubles(1);
  ByteReader other = ReaderOf(writer.bytes());
  EXPECT_THROW(TransferColumn(other, doubles, get), InputError);
}

TEST(ByteFormat, CountsDoNotExceedWhatIsThere) {
  ByteWriter writer;
  Transfer(writer, std::int64_t{1} << 40);
  ByteReader reader = ReaderOf(writer.bytes());
  std::vector<double> list;
  EXPECT_THROW(Transfer(reader, list), InputError);
}

TEST(ByteFormat, RefusesKeysOutOfOrder) {
  ByteWriter writer;
  const std::vector<std::pair<int, int>> pairs{{2, 0}, {1, 0}};
  Transfer(writer, pairs);
  ByteReader reader = ReaderOf(writer.bytes());
  std::map<int, int> map;
  EXPECT_THROW(Transfer(reader, map), InputError);
}

}  // namespace
}  // namespace plumbline
