// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/text_rows.h"

#include "plumbline/base/crc32.h"

#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ParseSeconds, IsExact) {
  const std::vector<std::pair<std::string, std::int64_t>> cases = {
      {"0", 0},
      {"0.000000", 0},
      {"1.", 1'000'000'000},
      {".5", 500'000'000},
      {"1305031102.175304", 1'305'031'102'175'304'000},
      {"1403636584.763555584", 1'403'636'584'763'555'584},
      {"0.0000000014", 1},
      {"0.0000000015", 2},
      {"0.0000000005", 1},
      {"0.00000000005", 0},
      {"1.037000e-01", 103'700'000},
      {"1.234567e+02", 123'456'700'000},
      {"5E-10", 1},
      {"4e-10", 0},
      {"4000000000.0", kLatestStampNs},
  };
  for (const auto& [text, stamp] : cases) EXPECT_EQ(ParseSeconds(text), stamp) << text;
}

TEST(ParseSeconds, RefusesWhatIsNotATime) {
  for (const char* text : {"",
                           "-1",
                           "abc",
                           "1.2.3",
                           "1s",
                           "1e",
                           "1e+",
                           "1e99",
                           "nan",
                           "inf",
                           ".",
                           "1 2",
                           "4000000000.000000001",
                           "1403636584763555584.0",
                           "4000000000.0000000005",
                           "9223372036.854775807",
                           "99999999999999999999999999",
                           "1e-2147483648"}) {
    EXPECT_EQ(ParseSeconds(text), std::nullopt) << text;
  }
}

TEST(ParseNumber, TakesWholeFiniteNumbersOnly) {
  EXPECT_EQ(ParseNumber("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(ParseNumber("+2"), 2.0);
  for (const char* text : {"", "1.5x", "nan", "inf", "1e999", " 1", "0x10"}) {
    EXPECT_EQ(ParseNumber(text), std::nullopt) << text;
  }
}

TEST(ParseNanoseconds, EndsWhereSumsWouldOverflow) {
  EXPECT_EQ(ParseNanoseconds("0"), 0);
  EXPECT_EQ(ParseNanoseconds("4000000000000000000"), kLatestStampNs);
  for (const char* text : {"4000000000000000001", "9223372036854775807", "-1", "", "1.0", "nan"}) {
    EXPECT_EQ(ParseNanoseconds(text), std::nullopt) << text;
  }
}

TEST(ParseDateAndTime, CountsFrom1970) {
  EXPECT_EQ(ParseDateAndTime("1970-01-01", "00:00:00"), 0);
  EXPECT_EQ(ParseDateAndTime("2011-09-26", "13:02:25.964389445"), 1'317'042'145'964'389'445);
  EXPECT_EQ(ParseDateAndTime("2012-02-29", "23:59:59.9999999999"), 1'330'560'000'000'000'000);
  for (const auto& [date, time] :
       std::vector<std::pair<const char*, const char*>>{{"2011-02-29", "00:00:00"},
                                                        {"1969-12-31", "00:00:00"},
                                                        {"9999-01-01", "00:00:00"},
                                                        {"2011/09/26", "00:00:00"},
                                                        {"2011-09-26", "24:00:00"},
                                                        {"2011-09-26", "00:60:00"},
                                                        {"2011-09-26", "00:00:60"},
                                                        {"2011-09-26", "00:00"},
                                                        {"2011-09-26", "00:00:00,5"},
                                                        {"2011-09-26", "00:00:00.5x"},
                                                        {"2011-09-2", "00:00:00"},
                                                        {"", ""}}) {
    EXPECT_EQ(ParseDateAndTime(date, time), std::nullopt) << date << " " << time;
  }
}

TEST(PlaceFields, AreFiniteAndNotTooFar) {
  const TextRow row{3, {"1", "-1e9", "1e9", "1e308", "nan"}};
  EXPECT_EQ(PlaceFields("a.txt", row, 0), Eigen::Vector3d(1, -1e9, 1e9));
  EXPECT_EQ(PlaceFields("a.txt", {1, {"1", "x", "2", "x", "3"}}, 0, 2), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(MessageOf([&] { PlaceFields("a.txt", row, 1); }),
            "a.txt:3: expected a coordinate within 1e+09 of 0 in column 4, found '1e308'");
  EXPECT_EQ(MessageOf([&] { PlaceFields("a.txt", row, 2); }),
            "a.txt:3: expected a coordinate within 1e+09 of 0 in column 4, found '1e308'");
}

TEST(ReadRows, RefusesALineWithoutEnd) {
  const ScratchFolder folder;
  const std::string longest(kLongestLine, '1');
  EXPECT_EQ(ReadRows(folder.Write("a.txt", "1\n" + longest + "\n#" + longest + "\n"), ' ').size(),
            2U);
  const auto file = folder.Write("b.txt", "1\n" + longest + " 2\n");
  EXPECT_EQ(MessageOf([&] { ReadRows(file, ' '); }),
            file.string() + ":2: expected a line of at most 1048576 bytes, found one of 1048578");
}

TEST(ReadRows, DropsCommentsBlanksAndCarriageReturns) {
  const ScratchFolder folder;
  const auto file = folder.Write("a.csv", "\xEF\xBB\xBF# head\r\n\r\n 1 , two words\r\n#x\n3,\n4");
  const std::vector<TextRow> rows = ReadRows(file, ',');
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].line, 3);
  EXPECT_THAT(rows[0].fields, ElementsAre("1", "two words"));
  EXPECT_EQ(rows[1].line, 5);
  EXPECT_THAT(rows[1].fields, ElementsAre("3", ""));
  EXPECT_THAT(rows[2].fields, ElementsAre("4"));
}

TEST(ReadRows, CutsAtRunsOfBlanks) {
  const ScratchFolder folder;
  const auto file = folder.Write("a.txt", "  a \t b  c \n");
  EXPECT_THAT(ReadRows(file, ' ').at(0).fields, ElementsAre("a", "b", "c"));
  EXPECT_TRUE(ReadRows(folder.Write("empty.txt", ""), ' ').empty());
}

TEST(TextRowReader, ReadsTheRowsOfReadRowsOneByOne) {
  const ScratchFolder folder;
  std::string long_table;  // of more than a block
  for (int i = 0; i < 20'000; ++i) long_table += std::to_string(i) + ", x\n";
  for (const std::string& text : std::vector<std::string>{
           "", "\n", "1,2", "1,2\n", "\xEF\xBB\xBF#a\r\n1 , 2\r\n\r\n3,,\n4", long_table}) {
    const auto file = folder.Write("t.csv", text);
    TextRowReader reader(file, ',');
    for (const TextRow& row : ReadRows(file, ',')) {
      const auto next = reader.Next();
      ASSERT_TRUE(next);
      EXPECT_EQ(next->line, row.line);
      EXPECT_EQ(next->fields, row.fields);
    }
    EXPECT_FALSE(reader.Next());
  }
  const auto endless = folder.Write("t.csv", "1,2\n" + std::string(kLongestLine + 100, 'x'));
  TextRowReader reader(endless, ',');
  EXPECT_TRUE(reader.Next());
  EXPECT_THAT(MessageOf([&] { reader.Next(); }), HasSubstr("t.csv:2: expected a line of at most"));
  EXPECT_THAT(MessageOf([&] { TextRowReader(folder.path(), ','); }),
              HasSubstr(": expected a file, found a folder"));
  EXPECT_THAT(MessageOf([&] { TextRowReader(folder / "none", ','); }), HasSubstr("no such file"));
}

TEST(Crc32, AgreesWithTheCheckValueAtEveryLength) {
  const std::string digits = "123456789";
  const std::vector<std::uint8_t> bytes(digits.begin(), digits.end());
  EXPECT_EQ(Crc32(bytes), 0xCBF43926U);
  EXPECT_EQ(Crc32({}), 0U);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    const std::span<const std::uint8_t> all(bytes);
    EXPECT_EQ(Crc32(all.subspan(cut), Crc32(all.first(cut))), 0xCBF43926U) << cut;
  }
}

}  // namespace
}  // namespace plumbline
