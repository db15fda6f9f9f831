// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/stamp_order.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include <fmt/core.h>

namespace plumbline {
namespace {

constexpr std::string_view kOneRepeated = "repeats a time stamp and is left out";
constexpr std::string_view kMoreRepeated = "repeat a time stamp and are left out";

void AddNote(const FaultyRows& rows,
             const std::filesystem::path& file,
             std::string_view one,
             std::string_view more,
             std::vector<std::string>& notes) {
  if (rows.count > 0) notes.push_back(rows.Note(file, one, more));
}

// Returns the index of the nearest time, the earlier of two equally near ones. `stamps` must not be
// empty.
std::size_t Nearest(const std::vector<std::int64_t>& stamps, std::int64_t stamp_ns) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), stamp_ns);
  const auto index = static_cast<std::size_t>(after - stamps.begin());
  if (after == stamps.begin()) return 0;
  if (after == stamps.end()) return index - 1;
  return stamp_ns - stamps[index - 1] <= *after - stamp_ns ? index - 1 : index;
}

}  // namespace

std::string FaultyRows::Note(const std::filesystem::path& file,
                             std::string_view one,
                             std::string_view more) const {
  if (count == 1) return fmt::format("{}:{}: 1 row {}", file.string(), first_line, one);
  return fmt::format("{}:{}: {} rows {}, this one first", file.string(), first_line, count, more);
}

void NoteLeftOut(const std::filesystem::path& file,
                 const FaultyRows& repeated,
                 const FaultyRows& unsorted,
                 std::vector<std::string>& notes) {
  AddNote(repeated, file, kOneRepeated, kMoreRepeated, notes);
  AddNote(unsorted,
          file,
          "goes back in time and is left out",
          "go back in time and are left out",
          notes);
}

std::vector<std::size_t> OrderOfTime(const std::filesystem::path& list,
                                     const std::vector<StampedRow>& rows,
                                     std::vector<std::string>& notes) {
  std::vector<std::size_t> sorted(rows.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
    return rows[a].stamp_ns < rows[b].stamp_ns;
  });
  std::vector<std::size_t> order;
  std::vector<bool> stays(rows.size(), false);
  for (const std::size_t i : sorted) {
    if (!order.empty() && rows[order.back()].stamp_ns == rows[i].stamp_ns) continue;
    order.push_back(i);
    stays[i] = true;
  }
  FaultyRows repeated, unsorted;
  std::size_t latest = 0;  // of the rows before
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!stays[i]) {
      repeated.Add(rows[i].line);
    } else if (rows[i].stamp_ns < rows[latest].stamp_ns) {
      unsorted.Add(rows[i].line);
    } else {
      latest = i;
    }
  }
  AddNote(repeated, list, kOneRepeated, kMoreRepeated, notes);
  AddNote(unsorted,
          list,
          "goes back in time and is sorted in",
          "go back in time and are sorted in",
          notes);
  return order;
}

std::vector<std::pair<std::size_t, std::size_t>> PairByStamp(
    const std::vector<std::int64_t>& first,
    const std::vector<std::int64_t>& second,
    std::int64_t most_ns) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (second.empty()) return pairs;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::size_t nearest = Nearest(second, first[i]);
    if (std::abs(second[nearest] - first[i]) > most_ns) continue;
    if (Nearest(first, second[nearest]) == i) pairs.emplace_back(i, nearest);
  }
  return pairs;
}

}  // namespace plumbline
