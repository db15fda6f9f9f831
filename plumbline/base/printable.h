// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace plumbline {

// How much of a word of the user's a message repeats, and how long a whole message may be: a word
// may be as long as the file it stands in. Bytes.
constexpr std::size_t kLongestWord = 80;
constexpr std::size_t kLongestMessage = 2000;

// A text of unknown origin as part of one line on a terminal: bytes that a terminal may take for
// commands or that are no UTF-8, line ends included, become escapes (\n, \x1b), and of a text
// longer than `longest` bytes the first and the last are left, with their number between them. The
// result is about that long, whatever the text. O(longest).
std::string Printable(std::string_view text, std::size_t longest = kLongestWord);

// The printable text in single quotes, for "found 'text'".
std::string InQuotes(std::string_view text);

}  // namespace plumbline
