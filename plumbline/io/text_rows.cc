// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/text_rows.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include <fmt/core.h>

namespace plumbline {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::string_view Trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string> Split(std::string_view text, char separator) {
  std::vector<std::string> fields;
  while (true) {
    const std::size_t end = separator == ' ' ? text.find_first_of(kBlanks) : text.find(separator);
    fields.emplace_back(Trim(text.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    text.remove_prefix(end + 1);
    if (separator == ' ') text = Trim(text);
  }
}

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Returns the number that `count` digits are.
std::optional<int> Digits(std::string_view text, std::size_t first, std::size_t count) {
  if (text.size() < first + count) return std::nullopt;
  int value = 0;
  for (const char c : text.substr(first, count)) {
    if (!IsDigit(c)) return std::nullopt;
    value = 10 * value + (c - '0');
  }
  return value;
}

// Returns the row of a line; nullopt if it is empty or a comment.
std::optional<TextRow> RowOf(const std::filesystem::path& path,
                             int number,
                             std::string_view line,
                             char separator) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (number == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  const std::string_view content = Trim(line);
  if (content.empty() || content.front() == '#') return std::nullopt;
  if (content.size() > kLongestLine) {
    FailAt(path,
           number,
           fmt::format("a line of at most {} bytes", kLongestLine),
           fmt::format("one of {}", content.size()));
  }
  return TextRow{number, Split(content, separator)};
}

}  // namespace

std::vector<TextRow> ReadRows(const std::filesystem::path& path, char separator) {
  const std::string text = ReadInputFile(path);
  std::string_view rest = text;
  std::vector<TextRow> rows;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    if (auto row = RowOf(path, line, rest.substr(0, end), separator)) {
      rows.push_back(*std::move(row));
    }
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return rows;
}

TextRowReader::TextRowReader(const std::filesystem::path& path, char separator)
    : path_(path), separator_(separator) {
  CheckExists(path);
  if (KindOf(path) != "a file") {
    throw InputError(path.string() + ": expected a file, found " + KindOf(path));
  }
  file_.open(path, std::ios::binary);
  if (!file_) throw InputError(path.string() + ": cannot be read");
}

std::optional<TextRow> TextRowReader::Next() {
  std::string line;
  while (ReadLine(line)) {
    if (auto row = RowOf(path_, ++line_, line, separator_)) return row;
  }
  return std::nullopt;
}

// Reads a line without its end, of a longer one than RowOf takes only the beginning.
bool TextRowReader::ReadLine(std::string& line) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  line.clear();
  for (bool any = false;; any = true) {
    if (next_ == block_.size()) {
      block_.resize(kBlock);
      next_ = 0;
      file_.read(block_.data(), kBlock);
      block_.resize(static_cast<std::size_t>(file_.gcount()));
      if (block_.empty()) return any;
    }
    const std::size_t end = std::min(block_.find('\n', next_), block_.size());
    if (line.size() <= kLongestLine) line.append(block_, next_, end - next_);
    next_ = std::min(end + 1, block_.size());
    if (end < block_.size()) return true;
  }
}

void FailAt(const std::filesystem::path& path,
            int line,
            std::string_view expected,
            std::string_view found) {
  std::string message = path.string() + ":" + std::to_string(line) + ": expected ";
  message += expected;
  message += ", found ";
  message += found;
  throw InputError(message);
}

void CheckStampOrder(const std::filesystem::path& path,
                     int line,
                     std::optional<std::int64_t> previous,
                     std::int64_t stamp_ns) {
  if (!previous || *previous < stamp_ns) return;
  FailAt(path,
         line,
         "time stamps that increase",
         *previous == stamp_ns ? "the same time stamp again" : "one that goes back");
}

std::optional<double> ParseNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

double NumberField(const std::filesystem::path& path, const TextRow& row, std::size_t field) {
  const std::optional<double> value = ParseNumber(row.fields.at(field));
  if (!value) {
    FailAt(path,
           row.line,
           "a number in column " + std::to_string(field + 1),
           InQuotes(row.fields[field]));
  }
  return *value;
}

Eigen::Vector3d PlaceFields(const std::filesystem::path& path,
                            const TextRow& row,
                            std::size_t first,
                            std::size_t step) {
  Eigen::Vector3d place;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::size_t field = first + step * static_cast<std::size_t>(i);
    place(i) = NumberField(path, row, field);
    if (std::abs(place(i)) > kFarthest) {
      FailAt(path,
             row.line,
             fmt::format("a coordinate within {:g} of 0 in column {}", kFarthest, field + 1),
             InQuotes(row.fields[field]));
    }
  }
  return place;
}

std::optional<std::int64_t> ParseSeconds(std::string_view text) {
  std::string digits;
  std::ptrdiff_t point = -1;  // number of digits before the decimal point
  std::size_t i = 0;
  if (text.starts_with('+')) ++i;
  for (; i < text.size() && (IsDigit(text[i]) || (text[i] == '.' && point < 0)); ++i) {
    if (text[i] == '.') {
      point = std::ssize(digits);
    } else {
      digits += text[i];
    }
  }
  if (digits.empty()) return std::nullopt;
  if (point < 0) point = std::ssize(digits);
  if (i < text.size()) {
    if (text[i] != 'e' && text[i] != 'E') return std::nullopt;
    std::string_view exponent_text = text.substr(i + 1);
    if (exponent_text.starts_with('+')) exponent_text.remove_prefix(1);
    int exponent = 0;
    const char* end = exponent_text.data() + exponent_text.size();
    const auto result = std::from_chars(exponent_text.data(), end, exponent);
    if (result.ec != std::errc() || result.ptr != end || exponent < -40 || exponent > 40) {
      return std::nullopt;
    }
    point += exponent;
  }
  point += 9;  // seconds to nanoseconds
  if (point < 0) return 0;
  const auto count = static_cast<std::size_t>(point);
  const bool round_up = count < digits.size() && digits[count] >= '5';
  digits.resize(count, '0');
  if (digits.empty()) return round_up ? 1 : 0;
  const std::optional<std::int64_t> whole = ParseNanoseconds(digits);
  if (!whole || !round_up) return whole;
  return *whole < kLatestStampNs ? std::optional(*whole + 1) : std::nullopt;
}

std::optional<std::int64_t> ParseDateAndTime(std::string_view date, std::string_view time) {
  constexpr std::int64_t kMinuteNs = 60'000'000'000;
  const auto year = Digits(date, 0, 4), month = Digits(date, 5, 2), day = Digits(date, 8, 2);
  const auto hour = Digits(time, 0, 2), minute = Digits(time, 3, 2), second = Digits(time, 6, 2);
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const bool form = date.size() == 10 && date[4] == '-' && date[7] == '-' && time[2] == ':' &&
                    time[5] == ':' && (time.size() == 8 || time[8] == '.');
  const std::chrono::year_month_day calendar{std::chrono::year(*year),
                                             std::chrono::month(static_cast<unsigned>(*month)),
                                             std::chrono::day(static_cast<unsigned>(*day))};
  if (!form || !calendar.ok() || *hour > 23 || *minute > 59 || *second > 59) return std::nullopt;
  const std::optional<std::int64_t> seconds_ns = ParseSeconds(time.substr(6));
  const std::int64_t days = std::chrono::sys_days(calendar).time_since_epoch().count();
  if (!seconds_ns || days < 0 || days > kLatestStampNs / (24 * 60 * kMinuteNs)) return std::nullopt;
  const std::int64_t stamp_ns = ((days * 24 + *hour) * 60 + *minute) * kMinuteNs + *seconds_ns;
  return stamp_ns <= kLatestStampNs ? std::optional(stamp_ns) : std::nullopt;
}

std::optional<std::int64_t> ParseNanoseconds(std::string_view text) {
  std::int64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || value < 0 ||
      value > kLatestStampNs) {
    return std::nullopt;
  }
  return value;
}

}  // namespace plumbline
