// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// Lengths in bytes to which a message shortens a user's word, and a whole message. A word may be as
// long as its file.
constexpr std::size_t kLongestWord = 80;
constexpr std::size_t kLongestMessage = 2000;

// Returns a text of unknown origin as part of one line on a terminal. Bytes that a terminal may
// take for commands or that are not UTF-8, line ends included, become escapes (\n, \x1b). A text
// longer than `longest` bytes keeps its beginning and its end, with the number of omitted bytes in
// between; the result has about `longest` bytes. O(longest).
std::string Printable(std::string_view text, std::size_t longest = kLongestWord);

// Returns the printable text in single quotes, for "found 'text'".
std::string InQuotes(std::string_view text);

// Returns the text escaped for the body of an HTML page or a quoted attribute.
std::string EscapeHtml(std::string_view text);

// Returns the least number of steps that turn `a` into `b`. A step inserts, deletes or replaces a
// character, or swaps two neighbours (optimal string alignment: no part is edited twice).
std::size_t EditDistance(std::string_view a, std::string_view b);

// Returns the candidate of least edit distance to `name` (ties: the first); nullopt if all are too
// different. For dotted names a candidate whose last part is near also counts, so that `seed` finds
// `slam.seed`; if there is none, one of the nearest group does: `trackng.foo` finds a name that
// begins with `tracking.`.
std::optional<std::string> NearestName(std::string_view name,
                                       std::span<const std::string> candidates);

}  // namespace plumbline
