// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/line_detection.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/image/filters.h"

#include "apps/command_line.h"
#include "arrays.h"
#include "bindings.h"
#include "options.h"
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace plumbline::python {
namespace {

// A line feature as a row of a structured array.
struct LineRow {
  double start[2] = {};
  double end[2] = {};
  double sigma_px = 0, response = 0;
  std::int32_t octave = 0;
  std::uint8_t descriptor[32] = {};
};

LineRow ToRow(const LineFeature& line) {
  const Segment2& s = line.segment;
  LineRow row{{s.start.x(), s.start.y()},
              {s.end.x(), s.end.y()},
              line.sigma_px,
              line.response,
              line.octave,
              {}};
  std::memcpy(row.descriptor, line.descriptor.data(), sizeof row.descriptor);
  return row;
}

LineFeature FromRow(const LineRow& row) {
  LineFeature line;
  line.segment = {{row.start[0], row.start[1]}, {row.end[0], row.end[1]}};
  line.sigma_px = row.sigma_px;
  line.response = row.response;
  line.octave = row.octave;
  std::memcpy(line.descriptor.data(), row.descriptor, sizeof row.descriptor);
  return line;
}

py::array ToRows(const std::vector<LineFeature>& lines) {
  std::vector<LineRow> rows;
  rows.reserve(lines.size());
  for (const LineFeature& line : lines) rows.push_back(ToRow(line));
  return py::array_t<LineRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

std::vector<LineFeature> ReadLines(py::handle value, const char* name) {
  if (!py::isinstance<py::array_t<LineRow>>(value) ||
      py::reinterpret_borrow<py::array>(value).ndim() != 1) {
    throw InputError(std::string(name) +
                     ": expected lines of shape (N,), as detect_lines gives them, found " +
                     Describe(value));
  }
  const auto rows = py::array_t<LineRow, py::array::c_style>::ensure(value);
  std::vector<LineFeature> lines;
  for (py::ssize_t i = 0; i < rows.size(); ++i) {
    lines.push_back(FromRow(rows.data()[i]));
    const LineFeature& line = lines.back();
    const double length = line.segment.Length();
    if (std::isfinite(length) && length > 0 && line.sigma_px > 0 && std::isfinite(line.sigma_px)) {
      continue;
    }
    throw InputError(fmt::format(
        "{}: expected lines of finite length and sigma_px, greater than 0, found {} and {} at [{}]",
        name,
        length,
        line.sigma_px,
        i));
  }
  return lines;
}

struct DetectionRequest {
  GrayImage image;
  ValidRegion valid{1, 1};
  LineDetector detector = LineDetector::kDrawing;
  int count = 0;
  LineDetectionOptions options;
};

DetectionRequest ReadRequest(py::handle image,
                             int count,
                             const std::string& detector,
                             const py::object& mask,
                             const py::kwargs& given) {
  DetectionRequest request;
  request.image = ReadGray(image, "image");
  request.valid = ValidRegion(request.image.width(), request.image.height());
  if (!mask.is_none()) {
    const GrayImage valid = ReadGray(mask, "mask");
    if (valid.width() != request.image.width() || valid.height() != request.image.height()) {
      throw InputError(fmt::format("mask: expected the size of the image, ({}, {}), found ({}, {})",
                                   request.image.height(),
                                   request.image.width(),
                                   valid.height(),
                                   valid.width()));
    }
    request.valid = ValidRegion(valid);
  }
  request.detector = ParseChoice<LineDetector>("detector", detector);
  if (count < 0) throw InputError(fmt::format("count: expected at least 0, found {}", count));
  request.count = count;
  constexpr int kSmallest = 16;  // pixels; bands of descriptors and blurs need some room
  if (std::min(request.image.width(), request.image.height()) < kSmallest) {
    throw InputError(fmt::format("image: expected at least {} rows and columns, found {} and {}",
                                 kSmallest,
                                 request.image.height(),
                                 request.image.width()));
  }
  SetOptions(given, request.options);
  return request;
}

py::array Detect(py::handle image,
                 int count,
                 const std::string& detector,
                 const py::object& mask,
                 const py::kwargs& given) {
  const DetectionRequest request = ReadRequest(image, count, detector, mask, given);
  std::vector<LineFeature> lines;
  {
    const py::gil_scoped_release release;
    const GradientImage gradient = ComputeGradient(request.image, kLineBlurPx);
    lines = DetectLines(
        request.image, gradient, request.valid, request.detector, request.count, request.options);
    DescribeLines(gradient, &lines);
  }
  return ToRows(lines);
}

// The options of matching have no table of their own in the library.
void VisitMatching(LineMatchOptions& o, const auto& visit) {
  visit("max_distance", o.max_distance, Range{0, 256});
  visit("ratio", o.ratio, Range{0.1, 1});
  visit("max_angle_deg", o.max_angle_deg, Range{0, 180});
  visit("max_offset_px", o.max_offset_px, Range{0, 1e6});
  visit("max_shift_px", o.max_shift_px, Range{0, 1e6});
  visit("min_length_ratio", o.min_length_ratio, Range{0, 1});
}

LineMatchOptions ReadMatching(const py::kwargs& given) {
  LineMatchOptions options;
  std::string known = "mutual";
  std::size_t used = 0;
  VisitMatching(options, [&](const char* name, auto& value, const Range& range) {
    known += std::string(", ") + name;
    if (!given.contains(name)) return;
    ++used;
    const Doubles number = ReadDoubles(given[name], name, {});
    if (*number.data() < range.min || *number.data() > range.max) {
      throw InputError(fmt::format(
          "{}: expected {} to {}, found {}", name, range.min, range.max, *number.data()));
    }
    value = static_cast<std::remove_reference_t<decltype(value)>>(*number.data());
  });
  if (given.contains("mutual")) {
    ++used;
    if (!py::isinstance<py::bool_>(given["mutual"])) {
      throw InputError("mutual: expected True or False, found " + Describe(given["mutual"]));
    }
    options.mutual = given["mutual"].cast<bool>();
  }
  if (used < given.size()) {
    throw InputError("match_lines: expected the options " + known + ", found " +
                     py::str(static_cast<py::object>(py::list(given))).cast<std::string>());
  }
  return options;
}

py::array Match(py::handle a, py::handle b, const py::kwargs& given) {
  const std::vector<LineFeature> first = ReadLines(a, "a"), second = ReadLines(b, "b");
  const LineMatchOptions options = ReadMatching(given);
  std::vector<FeatureMatch> matches;
  {
    const py::gil_scoped_release release;
    matches = MatchLines(first, second, options);
  }
  Integers array({static_cast<py::ssize_t>(matches.size()), py::ssize_t{3}});
  std::int64_t* out = array.mutable_data();
  for (const FeatureMatch& match : matches) {
    for (const int value : {match.a, match.b, match.distance}) *out++ = value;
  }
  return array;
}

py::tuple MatchPair(const RectifiedCamera& camera,
                    py::handle left,
                    py::handle right,
                    const py::kwargs& given) {
  StereoLineOptions options;
  SetOptions(given, options);
  if (!(camera.baseline > 0)) {
    throw InputError("camera: expected a baseline greater than 0, found 0");
  }
  const auto lines = ReadLines(left, "left"), candidates = ReadLines(right, "right");
  const auto matches = MatchStereoLines(camera, lines, candidates, options);
  Doubles segments({static_cast<py::ssize_t>(matches.size()), py::ssize_t{2}, py::ssize_t{2}});
  std::vector<double> sigmas;
  double* out = segments.mutable_data();
  for (const auto& match : matches) {
    sigmas.push_back(match ? match->sigma_px : kMissing);
    const Eigen::Vector2d none(kMissing, kMissing);
    for (const Eigen::Vector2d& end :
         {match ? match->segment.start : none, match ? match->segment.end : none}) {
      *out++ = end.x();
      *out++ = end.y();
    }
  }
  return py::make_tuple(segments, ToArray(sigmas));
}

}  // namespace

void BindLines(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(LineRow, start, end, sigma_px, response, octave, descriptor);
  module.def("detect_lines",
             &Detect,
             py::arg("image"),
             py::arg("count") = 200,
             py::arg("detector") = "drawing",
             py::arg("mask") = py::none(),
             R"(detect_lines(image, count=200, detector="drawing", mask=None, **options)

The best `count` straight edges of an image, uint8 (rows, columns), spread over it, with their
descriptors: a new structured array (N,) of start (2,) and end (2,) in pixels (x, y; pixel centres
at integers), directed with the brighter side on the left, sigma_px (deviation of each end across
the line), response (mean gradient [grey levels/px]), octave, descriptor (32 bytes: binary LBD,
Zhang and Koch, JVCIR 2013).

detector: "drawing", "lsd" or "edlines". mask: uint8, 0 where pixels are not real. options: those of
features.line, such as min_length=0.05.)");
  module.def("match_lines", &Match, py::arg("a"), py::arg("b"), R"(match_lines(a, b, **options)

Pairs of lines with like descriptors and compatible places in two images of near viewpoints:
(M, 3) int64 of index in a, index in b, Hamming distance; ordered by a, each line at most once.
A new array. options: max_distance=80, ratio=0.9, mutual=True, max_angle_deg=20,
max_offset_px=80, max_shift_px=120 (0: no test), min_length_ratio=0.3.)");
  module.def("match_stereo_lines",
             &MatchPair,
             py::arg("camera"),
             py::arg("left"),
             py::arg("right"),
             R"(match_stereo_lines(camera, left, right, **options) -> (segments, sigmas)

The same line in the right image of a rectified pair for each left line: segments (N, 2, 2) in
pixels and sigmas (N,) across, NaN where there is none. New arrays. options: those of
features.stereo_lines.)");
}

}  // namespace plumbline::python
