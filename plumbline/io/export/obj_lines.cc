// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/obj_lines.h"

#include "plumbline/base/printable.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/core.h>

namespace plumbline {
namespace {

using std::filesystem::path;

// Records of OBJ that hold neither vertices nor lines.
constexpr auto kOthers = std::to_array<std::string_view>(
    {"vt",        "vn",     "vp",     "f",      "p",        "o",        "g",    "s",
     "mg",        "usemtl", "mtllib", "usemap", "maplib",   "cstype",   "deg",  "bmat",
     "step",      "curv",   "curv2",  "surf",   "parm",     "trim",     "hole", "scrv",
     "sp",        "end",    "con",    "bevel",  "c_interp", "d_interp", "lod",  "shadow_obj",
     "trace_obj", "ctech",  "stech",  "call",   "csh"});

Eigen::Vector3d VertexOf(const path& file, const TextRow& row) {
  // A vertex has x y z, then a weight, a colour, or both.
  if (row.fields.size() < 4 || row.fields.size() > 8) {
    FailAt(file, row.line, "a vertex (v x y z)", fmt::format("{} numbers", row.fields.size() - 1));
  }
  return PlaceFields(file, row, 1);
}

// Returns the vertex that a word of an `l` record names, such as 7, -1 or 7/2.
const Eigen::Vector3d& VertexNamed(const path& file,
                                   int line,
                                   const std::string& word,
                                   const std::vector<Eigen::Vector3d>& vertices) {
  const std::string_view number = std::string_view(word).substr(0, word.find('/'));
  const char* end = number.data() + number.size();
  std::int64_t index = 0;
  const auto result = std::from_chars(number.data(), end, index);
  const std::int64_t count = std::ssize(vertices);
  if (index < 0 && index >= -count) index += count + 1;
  if (result.ec != std::errc() || result.ptr != end || index < 1 || index > count) {
    FailAt(file,
           line,
           count == 0 ? std::string("vertices above the line")
                      : fmt::format("a vertex from 1 to {}", count),
           InQuotes(word));
  }
  return vertices[static_cast<std::size_t>(index - 1)];
}

}  // namespace

std::vector<Segment3> ReadObjLines(const path& file) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Segment3> segments;
  for (const TextRow& row : ReadRows(file, ' ')) {
    const std::string& record = row.fields.front();
    if (record == "v") {
      vertices.push_back(VertexOf(file, row));
    } else if (record == "l") {
      if (row.fields.size() < 3) {
        FailAt(file, row.line, "two vertices or more", row.fields.size() == 2 ? "one" : "none");
      }
      for (std::size_t i = 2; i < row.fields.size(); ++i) {
        segments.push_back({VertexNamed(file, row.line, row.fields[i - 1], vertices),
                            VertexNamed(file, row.line, row.fields[i], vertices)});
      }
    } else if (std::find(kOthers.begin(), kOthers.end(), record) == kOthers.end()) {
      FailAt(file, row.line, "a record of OBJ such as v or l", InQuotes(record));
    }
  }
  return segments;
}

}  // namespace plumbline
