// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace plumbline {

// How much of a user's word a message repeats, and how long a whole message may be, in bytes. A
// word may be as long as the file in which it stands.
constexpr std::size_t kLongestWord = 80;
constexpr std::size_t kLongestMessage = 2000;

// Returns a text of unknown origin as part of one line on a terminal. Bytes that a terminal may
// take for commands or that are no UTF-8, line ends included, become escapes (\n,
// \x1b). Of a text longer than `longest` bytes the first and the last are kept, with the number
// of the others between them. The result is about that long, whatever the text. O(longest).
std::string Printable(std::string_view text, std::size_t longest = kLongestWord);

// Returns the printable text in single quotes, for "found 'text'".
std::string InQuotes(std::string_view text);

}  // namespace plumbline
