// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumbline {

// Time of a row of a list, and its line.
struct StampedRow {
  std::int64_t stamp_ns = 0;
  int line = 0;  // from 1
};

// Rows of a file with a common fault: their number, and the line of the first.
struct FaultyRows {
  int first_line = 0;
  std::size_t count = 0;

  void Add(int line) {
    if (count++ == 0) first_line = line;
  }
  // "FILE:57: 1 row repeats a time stamp and is left out", or with a larger number "FILE:57: 3 rows
  // repeat a time stamp and are left out, this one first". `one` and `more` are the predicates:
  // "repeats a time stamp and is left out".
  std::string Note(const std::filesystem::path& file,
                   std::string_view one,
                   std::string_view more) const;
};

// Adds notes about the rows of `file` left out for their times: rows of the same time as a row
// before, and rows that go back in time.
void NoteLeftOut(const std::filesystem::path& file,
                 const FaultyRows& repeated,
                 const FaultyRows& unsorted,
                 std::vector<std::string>& notes);

// Returns the indices of the rows of a list in order of time: late rows are sorted in, and of rows
// of the same time the first one stays. Both become notes, with the file, the number of rows and
// the line of the first. O(n log n).
std::vector<std::size_t> OrderOfTime(const std::filesystem::path& list,
                                     const std::vector<StampedRow>& rows,
                                     std::vector<std::string>& notes);

// Returns pairs of times from two ascending lists, by index, in order. Each time is the nearest to
// the other (the earlier of two equally near ones) and at most `most_ns` from it. O(n log n).
std::vector<std::pair<std::size_t, std::size_t>> PairByStamp(
    const std::vector<std::int64_t>& first,
    const std::vector<std::int64_t>& second,
    std::int64_t most_ns);

}  // namespace plumbline
