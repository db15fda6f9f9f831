// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/true_world.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>

namespace plumbline {
namespace {

using std::filesystem::path;

constexpr std::size_t kEndColumns = 6, kWithKind = 7, kWithFrames = 8, kSurfaceColumns = 9;

std::string Columns(const TextRow& row) { return fmt::format("{} columns", row.fields.size()); }

TrueLineKind KindAt(const path& file, const TextRow& row) {
  const std::string& text = row.fields[kEndColumns];
  for (const auto& [kind, name] : EnumNames(std::type_identity<TrueLineKind>{})) {
    if (text == name) return kind;
  }
  FailAt(file, row.line, "geometry, texture or shadow", InQuotes(text));
}

std::optional<int> ParseFrame(std::string_view text) {
  int frame = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), frame);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || frame < 0) {
    return std::nullopt;
  }
  return frame;
}

// Reads a range such as "7" or "0-17".
std::optional<FrameRange> ParseRange(std::string_view text) {
  const std::size_t dash = text.find('-');
  const std::optional<int> first = ParseFrame(text.substr(0, dash));
  const std::optional<int> last =
      dash == std::string_view::npos ? first : ParseFrame(text.substr(dash + 1));
  if (!first || !last || *first > *last) return std::nullopt;
  return FrameRange{*first, *last};
}

std::vector<FrameRange> RangesAt(const path& file, const TextRow& row) {
  constexpr std::string_view kBetween = " \t";
  std::string_view rest = row.fields[kWithKind];
  std::vector<FrameRange> ranges;
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find_first_of(kBetween));
    rest.remove_prefix(std::min(rest.size(), rest.find_first_not_of(kBetween, word.size())));
    const std::optional<FrameRange> range = ParseRange(word);
    if (!range) {
      FailAt(file, row.line, "frames such as 0-17 25 30-44", InQuotes(word));
    }
    if (!ranges.empty() && range->first <= ranges.back().last) {
      FailAt(file,
             row.line,
             "frames that increase",
             fmt::format("{} after frame {}", InQuotes(word), ranges.back().last));
    }
    ranges.push_back(*range);
  }
  return ranges;
}

// Returns the shortest text that reads back as the same number, without a minus sign before zero.
std::string ShortestNumber(double value) { return fmt::format("{}", value + 0.0); }

void AppendVector(const Eigen::Vector3d& v, std::string& text) {
  text +=
      fmt::format("{},{},{}", ShortestNumber(v.x()), ShortestNumber(v.y()), ShortestNumber(v.z()));
}

std::string FormatRanges(const std::vector<FrameRange>& ranges) {
  std::string text;
  for (const FrameRange& range : ranges) {
    if (!text.empty()) text += ' ';
    text += fmt::format("{}", range.first);
    if (range.last > range.first) text += fmt::format("-{}", range.last);
  }
  return text;
}

}  // namespace

std::vector<TrueLine> ReadTrueLines(const path& file) {
  const std::vector<TextRow> rows = ReadRows(file, ',');
  std::vector<TrueLine> lines;
  lines.reserve(rows.size());
  for (const TextRow& row : rows) {
    const std::size_t columns = row.fields.size();
    if (columns < kEndColumns || columns > kWithFrames) {
      FailAt(file, row.line, "6 to 8 columns (x1,y1,z1,x2,y2,z2,kind,visible)", Columns(row));
    }
    if (columns != rows.front().fields.size()) {
      FailAt(file, row.line, Columns(rows.front()) + " as in the rows above", Columns(row));
    }
    TrueLine line;
    line.segment = {PlaceFields(file, row, 0), PlaceFields(file, row, 3)};
    if (line.segment.start == line.segment.end) {
      FailAt(file, row.line, "two ends in different places", "the same point twice");
    }
    if (columns >= kWithKind) line.kind = KindAt(file, row);
    if (columns >= kWithFrames) line.visible = RangesAt(file, row);
    lines.push_back(std::move(line));
  }
  return lines;
}

void WriteTrueLines(const path& file, std::span<const TrueLine> lines) {
  const bool frames = !lines.empty() && lines.front().visible.has_value();
  std::string text = "#x1 [m],y1 [m],z1 [m],x2 [m],y2 [m],z2 [m],kind";
  text += frames ? ",visible\n" : "\n";
  for (const TrueLine& line : lines) {
    PLUMBLINE_CHECK(line.visible.has_value() == frames, "frames of some lines only");
    AppendVector(line.segment.start, text);
    text += ',';
    AppendVector(line.segment.end, text);
    text += ',' + NameOf(line.kind);
    if (frames) text += ',' + FormatRanges(*line.visible);
    text += '\n';
  }
  WriteFileAtomically(file, text);
}

std::vector<Parallelogram> ReadSurfaces(const path& file) {
  std::vector<Parallelogram> surfaces;
  for (const TextRow& row : ReadRows(file, ',')) {
    if (row.fields.size() != kSurfaceColumns) {
      FailAt(file, row.line, "9 columns (ox,oy,oz,ux,uy,uz,vx,vy,vz)", Columns(row));
    }
    surfaces.push_back(
        {PlaceFields(file, row, 0), PlaceFields(file, row, 3), PlaceFields(file, row, 6)});
    if (!(surfaces.back().side_u.cross(surfaces.back().side_v).norm() > 0)) {
      FailAt(file, row.line, "two sides that span an area", "sides of no length, or parallel");
    }
  }
  return surfaces;
}

void WriteSurfaces(const path& file, std::span<const Parallelogram> surfaces) {
  std::string text = "#ox [m],oy [m],oz [m],ux [m],uy [m],uz [m],vx [m],vy [m],vz [m]\n";
  for (const Parallelogram& surface : surfaces) {
    AppendVector(surface.origin, text);
    text += ',';
    AppendVector(surface.side_u, text);
    text += ',';
    AppendVector(surface.side_v, text);
    text += '\n';
  }
  WriteFileAtomically(file, text);
}

}  // namespace plumbline
