// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/colmap_camera_models.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

// A row with an entry, and its number.
struct ColmapRow {
  int line = 0;
  std::vector<std::string> fields;
};

std::vector<ColmapRow> ColmapRows(const std::string& text) {
  std::istringstream lines(text);
  std::vector<ColmapRow> rows;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    ColmapRow row{number, {}};
    for (std::string word; words >> word;) row.fields.push_back(word);
    if (!row.fields.empty() && !row.fields.front().starts_with('#')) rows.push_back(row);
  }
  return rows;
}

bool IsWhole(const std::string& text) {
  return std::all_of(
      text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

[[noreturn]] void FailInRow(const std::string& source, int line, const std::string& why) {
  throw InputError(fmt::format("{}:{}: {}", source, line, why));
}

const ColmapCameraModel& ModelNamed(const std::string& source, const ColmapRow& row) {
  const std::string& name = row.fields[1];
  std::vector<std::string_view> names;
  for (const ColmapCameraModel& model : kColmapCameraModels) {
    if (name == model.name) return model;
    names.push_back(model.name);
  }
  FailInRow(source,
            row.line,
            fmt::format("expected one of {}, found {}", fmt::join(names, ", "), InQuotes(name)));
}

// The rate has no place in the file: a comment may give it, "# rate_hz: 20".
std::optional<double> RateInComment(const std::string& text, const std::string& source) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string mark, key, value;
    words >> mark >> key >> value;
    if (mark != "#" || key != "rate_hz:") continue;
    const double rate = ParseNumber(value).value_or(0);
    if (const auto fault = RateFault(rate)) FailInRow(source, number, "rate_hz: " + *fault);
    return rate;
  }
  return std::nullopt;
}

}  // namespace

bool IsColmapCameras(const std::string& text) {
  constexpr std::size_t kFewest = 5;
  const std::vector<ColmapRow> rows = ColmapRows(text);
  if (rows.empty() || rows.front().fields.size() < kFewest) return false;
  const std::vector<std::string>& fields = rows.front().fields;
  const std::string& model = fields[1];
  const bool known = std::ranges::any_of(
      kColmapCameraModels, [&](const ColmapCameraModel& one) { return one.name == model; });
  return IsWhole(fields[0]) && (known || (IsWhole(fields[2]) && IsWhole(fields[3]))) &&
         std::all_of(model.begin(), model.end(), [](unsigned char c) {
           return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_';
         });
}

Calibration ReadColmapCameras(const std::string& text, const std::string& source) {
  const std::vector<ColmapRow> rows = ColmapRows(text);
  if (rows.size() > 1) {
    FailInRow(source, rows[1].line, "expected one camera, found another one; leave one row");
  }
  const ColmapRow& row = rows.front();
  const ColmapCameraModel& model = ModelNamed(source, row);
  std::vector<double> numbers;
  for (std::size_t i = 2; i < row.fields.size(); ++i) {
    const std::optional<double> number = ParseNumber(row.fields[i]);
    if (!number) FailInRow(source, row.line, "expected a number, found " + InQuotes(row.fields[i]));
    numbers.push_back(*number);
  }
  const std::size_t expected = 2 + model.focal_lengths + 2 + model.coefficients;
  if (numbers.size() != expected) {
    FailInRow(source,
              row.line,
              fmt::format(
                  "expected {} numbers behind {}, found {}", expected, model.name, numbers.size()));
  }
  const auto check = [&](const std::optional<std::string>& fault) {
    if (fault) FailInRow(source, row.line, *fault);
  };
  check(SizeFault(numbers[0], numbers[1]));
  CameraIntrinsics in;
  in.width = static_cast<int>(numbers[0]);
  in.height = static_cast<int>(numbers[1]);
  const double* next = numbers.data() + 2;
  in.fx = *next++;
  in.fy = model.focal_lengths == 2 ? *next++ : in.fx;
  // The first pixel has its centre at (0.5, 0.5) there.
  in.cx = *next++ - 0.5;
  in.cy = *next++ - 0.5;
  in.model = model.model;
  std::copy_n(next, model.coefficients, in.distortion.begin());
  check(IntrinsicsFault(in));
  check(DistortionFault(in));
  Calibration calibration;
  calibration.left = Camera(in);
  calibration.rate_hz = RateInComment(text, source);
  return calibration;
}

}  // namespace plumbline
