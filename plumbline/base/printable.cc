// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/printable.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {

namespace {

std::uint8_t Byte(std::string_view text, std::size_t at) {
  return static_cast<std::uint8_t>(text[at]);
}

bool Continues(std::string_view text, std::size_t at) {
  return at < text.size() && (Byte(text, at) & 0xC0U) == 0x80U;
}

// A character of UTF-8; `bytes` is 0 if it is invalid.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

Character CharacterAt(std::string_view text, std::size_t at) {
  // Least code that needs so many bytes.
  constexpr std::uint32_t kFewest[] = {0, 0, 0x80, 0x800, 0x10000};
  const std::uint8_t first = Byte(text, at);
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xF8   ? 0
                            : first >= 0xF0 ? 4
                            : first >= 0xE0 ? 3
                            : first >= 0xC0 ? 2
                                            : 0;
  if (bytes == 0) return {};
  std::uint32_t code = first & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!Continues(text, at + i)) return {};
    code = (code << 6) | (Byte(text, at + i) & 0x3FU);
  }
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kFewest[bytes] || code > 0x10FFFF || surrogate) return {};
  return {code, bytes};
}

// Returns true if a terminal only shows the character: it is no control character, and does not
// change the direction of the surrounding text.
bool IsShown(std::uint32_t code) {
  const auto within = [code](std::uint32_t first, std::uint32_t last) {
    return code >= first && code <= last;
  };
  return !(code < 0x20 || within(0x7F, 0x9F) || within(0x200B, 0x200F) || within(0x2028, 0x202E) ||
           within(0x2060, 0x206F) || code == 0xFEFF);
}

void AppendEscape(std::uint8_t byte, std::string& out) {
  switch (byte) {
    case '\n':
      out += "\\n";
      return;
    case '\r':
      out += "\\r";
      return;
    case '\t':
      out += "\\t";
      return;
    default:
      out += fmt::format("\\x{:02x}", byte);
  }
}

std::string Escaped(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const Character character = CharacterAt(text, at);
    const std::size_t bytes = std::max<std::size_t>(1, character.bytes);
    if (character.bytes > 0 && IsShown(character.code)) {
      out += text.substr(at, bytes);
    } else {
      for (std::size_t i = 0; i < bytes; ++i) AppendEscape(Byte(text, at + i), out);
    }
    at += bytes;
  }
  return out;
}

}  // namespace

std::string Printable(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return Escaped(text);
  // No character of UTF-8 may be cut in two.
  std::size_t head = longest * 2 / 3;
  std::size_t tail = text.size() - (longest - head);
  while (head > 0 && Continues(text, head)) --head;
  while (Continues(text, tail)) ++tail;
  return fmt::format("{} ... ({} bytes) ... {}",
                     Escaped(text.substr(0, head)),
                     text.size(),
                     Escaped(text.substr(tail)));
}

std::string InQuotes(std::string_view text) { return fmt::format("'{}'", Printable(text)); }

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

namespace {

std::string_view LastPart(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

// Returns the part of a dotted name before its last part; empty without a dot.
std::string_view GroupOf(std::string_view name) {
  return name.substr(0, name.size() - LastPart(name).size());
}

// Returns the candidate of least distance to `name` in the group that is nearest to that of `name`
// and not too different.
std::optional<std::string> NearestInGroup(std::string_view name,
                                          std::span<const std::string> candidates) {
  const std::string_view group = GroupOf(name);
  if (group.empty()) return std::nullopt;
  std::optional<std::string> best;
  std::pair best_distance(std::max<std::size_t>(2, group.size() / 3) + 1, std::size_t{0});
  for (const std::string& candidate : candidates) {
    const std::pair distance(EditDistance(group, GroupOf(candidate)),
                             EditDistance(LastPart(name), LastPart(candidate)));
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace

std::size_t EditDistance(std::string_view a, std::string_view b) {
  // Rows of the table of distances between the first i characters of a and the first j of b.
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

std::optional<std::string> NearestName(std::string_view name,
                                       std::span<const std::string> candidates) {
  // No name is longer; distances of megabytes would take minutes.
  constexpr std::size_t kLongest = 200;
  if (name.size() > kLongest) return std::nullopt;
  const std::string_view last = LastPart(name);
  const std::size_t limit = std::max<std::size_t>(2, last.size() / 2);
  std::optional<std::string> best;
  std::size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance =
        std::min(EditDistance(name, candidate), EditDistance(last, LastPart(candidate)) + 1);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best ? best : NearestInGroup(name, candidates);
}

}  // namespace plumbline
