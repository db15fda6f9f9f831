// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

}  // namespace plumbline
