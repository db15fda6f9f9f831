// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_record.h"

#include "plumbline/base/options.h"
#include "plumbline/io/text_rows.h"

#include <charconv>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

const std::vector<std::string> kColumns = {"frame",
                                           "outcome",
                                           "reason",
                                           "offered",
                                           "greatest_parallax_deg",
                                           "frames",
                                           "seconds",
                                           "reference",
                                           "newest",
                                           "parallax_deg",
                                           "estimated_parallax_deg",
                                           "rotation_error_deg",
                                           "direction_error_deg",
                                           "depth_error",
                                           "depth_outliers",
                                           "compared",
                                           "points",
                                           "lines"};
constexpr std::size_t kOfStart = 5;  // the columns behind these are of the map

std::string Text(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : std::string();
}

std::vector<std::string> FieldsOf(const StartMap& map) {
  const StartErrors& errors = map.errors;
  return {std::to_string(map.frames),
          fmt::format("{:.6g}", map.seconds),
          std::to_string(map.reference),
          std::to_string(map.newest),
          Text(map.parallax_deg),
          Text(map.estimated_parallax_deg),
          Text(errors.rotation_deg),
          Text(errors.direction_deg),
          Text(errors.depth),
          Text(errors.depth_outliers),
          std::to_string(errors.compared),
          std::to_string(map.points),
          std::to_string(map.lines)};
}

// The fields of one row, one after the other.
class RowReader {
 public:
  RowReader(const std::filesystem::path& path, const TextRow& row) : path_(path), row_(row) {}

  const std::string& Word() { return row_.fields[next_++]; }

  StartOutcome Outcome() {
    const std::string& word = Word();
    for (const auto& [value, name] : EnumNames(std::type_identity<StartOutcome>{})) {
      if (word == name) return value;
    }
    FailAt(path_, row_.line, "right, wrong, waiting or unjudged", word);
  }

  std::optional<double> Maybe() {
    const std::string& word = Word();
    if (word.empty()) return std::nullopt;
    if (word == "inf") return std::numeric_limits<double>::infinity();
    const auto number = ParseNumber(word);
    if (!number) FailAt(path_, row_.line, "a number or nothing", word);
    return number;
  }

  int Count() {
    const std::string& word = Word();
    int count = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, count);
    if (error != std::errc() || stop != end) FailAt(path_, row_.line, "a whole number", word);
    return count;
  }

  StartMap Map() {
    StartMap map;
    map.frames = Count();
    map.seconds = Maybe().value_or(0);
    map.reference = Count();
    map.newest = Count();
    map.parallax_deg = Maybe();
    map.estimated_parallax_deg = Maybe().value_or(0);
    map.errors.rotation_deg = Maybe();
    map.errors.direction_deg = Maybe();
    map.errors.depth = Maybe();
    map.errors.depth_outliers = Maybe();
    map.errors.compared = Count();
    map.points = Count();
    map.lines = Count();
    return map;
  }

 private:
  const std::filesystem::path& path_;
  const TextRow& row_;
  std::size_t next_ = 0;
};

}  // namespace

std::string FormatStarts(const std::vector<StartRecord>& records) {
  std::string text = fmt::format("{}\n", fmt::join(kColumns, ","));
  for (const StartRecord& record : records) {
    std::vector<std::string> fields = {std::to_string(record.frame),
                                       NameOf(record.outcome),
                                       record.reason,
                                       std::to_string(record.offered),
                                       Text(record.greatest_parallax_deg)};
    const std::vector<std::string> of_map =
        record.map ? FieldsOf(*record.map) : std::vector<std::string>(kColumns.size() - kOfStart);
    fields.insert(fields.end(), of_map.begin(), of_map.end());
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

std::vector<StartRecord> ReadStarts(const std::filesystem::path& path) {
  std::vector<StartRecord> records;
  const std::vector<TextRow> rows = ReadRows(path, ',');
  if (rows.empty() || rows.front().fields != kColumns) {
    FailAt(path, 1, fmt::format("{}", fmt::join(kColumns, ",")), "something else");
  }
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].fields.size() != kColumns.size()) {
      FailAt(path,
             rows[i].line,
             fmt::format("{} fields", kColumns.size()),
             std::to_string(rows[i].fields.size()));
    }
    RowReader reader(path, rows[i]);
    StartRecord record;
    record.frame = reader.Count();
    record.outcome = reader.Outcome();
    record.reason = reader.Word();
    record.offered = reader.Count();
    record.greatest_parallax_deg = reader.Maybe();
    if (record.outcome != StartOutcome::kWaiting) record.map = reader.Map();
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace plumbline
