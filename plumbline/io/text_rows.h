// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// One row of a text table, split into fields without surrounding blanks.
struct TextRow {
  int line = 0;  // from 1
  std::vector<std::string> fields;
};

// Returns the rows of a text file without empty lines and comments (from '#' at the start of a
// line). Fields end at `separator`, or at any run of blanks if that is ' '. Line ends may be CR LF.
// Fails (FailAt) at a row of more than kLongestLine bytes.
constexpr std::size_t kLongestLine = std::size_t{1} << 20;
std::vector<TextRow> ReadRows(const std::filesystem::path& path, char separator);

// Reads the rows of ReadRows one after the other: holds one of them, whatever the file's size.
class TextRowReader {
 public:
  // Throws InputError where ReadInputFile would, but for the size.
  TextRowReader(const std::filesystem::path& path, char separator);
  // Returns the next row; nullopt at the end of the file.
  std::optional<TextRow> Next();

 private:
  bool ReadLine(std::string& line);

  std::filesystem::path path_;
  char separator_;
  std::ifstream file_;
  std::string block_;
  std::size_t next_ = 0;  // in block_
  int line_ = 0;          // number of the last line
};

// Throws InputError "path:line: expected ..., found ...".
[[noreturn]] void FailAt(const std::filesystem::path& path,
                         int line,
                         std::string_view expected,
                         std::string_view found);

// Fails (FailAt) unless stamp_ns is above `previous`, if given.
void CheckStampOrder(const std::filesystem::path& path,
                     int line,
                     std::optional<std::int64_t> previous,
                     std::int64_t stamp_ns);

// Returns the finite number that is the whole text; otherwise nullopt.
std::optional<double> ParseNumber(std::string_view text);
// Returns a field of the row as a finite number; otherwise fails (FailAt). `what` names it: "the x
// position".
double NumberField(const std::filesystem::path& path, const TextRow& row, std::size_t field);
// Returns the fields from `first` on as the coordinates of a position, which must be finite and
// within kFarthest of the origin (FailAt otherwise). Squares of larger ones would overflow.
constexpr double kFarthest = 1e9;  // metres
Eigen::Vector3d PlaceFields(const std::filesystem::path& path,
                            const TextRow& row,
                            std::size_t first,
                            std::size_t step = 1);

// The latest valid time stamp, in the year 2096. The sum of two fits into 64 bits.
constexpr std::int64_t kLatestStampNs = 4'000'000'000'000'000'000;
// Returns true for a stamp accepted by ReadTrajectory: its times may be before 0.
constexpr bool IsReadableStamp(std::int64_t stamp_ns) {
  return stamp_ns >= -kLatestStampNs && stamp_ns <= kLatestStampNs;
}

// Returns a time as nanoseconds, read from the decimal text without loss (rounded to the nearest
// nanosecond if there are more than nine decimals): "1305031102.175304", "1.037e-01". It must not
// be before 0 or after kLatestStampNs.
std::optional<std::int64_t> ParseSeconds(std::string_view text);
// Returns a date and a time of day, "2011-09-26" and "13:02:25.964389445", as nanoseconds since
// 1970 as if they were of UTC. Not before 1970, nor after kLatestStampNs.
std::optional<std::int64_t> ParseDateAndTime(std::string_view date, std::string_view time);
// Returns a whole number of nanoseconds, which must not be negative and at most kLatestStampNs.
std::optional<std::int64_t> ParseNanoseconds(std::string_view text);

}  // namespace plumbline
