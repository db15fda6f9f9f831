// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/geometry/camera_difference.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/map/merge_maps.h"

#include "apps/command_line.h"
#include "apps/map_commands.h"
#include <cmath>
#include <iostream>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

CommandSyntax Syntax() {
  return {"map merge",
          "Makes one map of two of the same camera, in the world of the first. Landmarks that both "
          "have stay\napart; keyframes and landmarks of the second get numbers behind those of the "
          "first.",
          {"FILE", "FILE"},
          {{"--transform",
            "\"tx ty tz qx qy qz qw [scale]\"",
            "first_from_second: takes the world of the second map to that of the first; a scale "
            "for a single camera only"},
           {"--out", "FILE", "the merged map"}}};
}

[[noreturn]] void FailTransform(const std::string& found) {
  throw InputError("--transform: expected \"tx ty tz qx qy qz qw [scale]\", found " + found);
}

Similarity3 ParseTransform(const std::string& text) {
  constexpr std::size_t kRigid = 7;
  constexpr double kMaxNormError = 0.01;  // of the quaternion, as in trajectories
  std::vector<double> numbers;
  std::istringstream words(text);
  std::string word;
  while (words >> word) {
    const std::optional<double> number = ParseNumber(word);
    if (!number) FailTransform("'" + word + "'");
    numbers.push_back(*number);
  }
  if (numbers.size() != kRigid && numbers.size() != kRigid + 1) {
    FailTransform(fmt::format("{} numbers", numbers.size()));
  }
  Similarity3 transform;
  transform.translation = {numbers[0], numbers[1], numbers[2]};
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(std::abs(rotation.norm() - 1) <= kMaxNormError)) {
    FailTransform(fmt::format("a quaternion of norm {:.6g}", rotation.norm()));
  }
  transform.rotation = rotation.normalized();
  if (numbers.size() > kRigid) transform.scale = numbers[kRigid];
  if (!(transform.scale > 0)) FailTransform(fmt::format("the scale {:g}", transform.scale));
  return transform;
}

// What is asked for, before a file is read.
struct MergeRequest {
  Similarity3 first_from_second;
  std::string out;
};

MergeRequest ReadRequest(const CommandLine& line) {
  const auto transform = line.Value("--transform");
  const auto out = line.Value("--out");
  if (!transform) {
    throw InputError(
        "map merge: expected --transform, the pose of the second map's world in the first's; it "
        "is not found by itself yet");
  }
  if (!out) throw InputError("map merge: expected --out FILE");
  for (const std::size_t i : {0U, 1U}) RefuseToReplaceInput(*out, line.Positional(i));
  return {ParseTransform(*transform), *out};
}

}  // namespace

int MapMergeCommand(std::span<const std::string> arguments) {
  const CommandLine line(Syntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(Syntax());
    return 0;
  }
  const MergeRequest request = ReadRequest(line);
  const SavedMap first = LoadMap(line.Positional(0));
  const SavedMap second = LoadMap(line.Positional(1));
  const auto difference = CameraDifference({first.camera, first.rectified_from_left},
                                           {second.camera, second.rectified_from_left});
  if (difference) {
    throw InputError(line.Positional(1) + ": expected a map of the camera of " +
                     line.Positional(0) + ", found another one: " + *difference);
  }
  if (first.camera.baseline > 0 && request.first_from_second.scale != 1) {
    FailTransform(fmt::format("the scale {:g} for maps of measured depth, whose scale is 1",
                              request.first_from_second.scale));
  }
  const Map merged = MergeMaps(first.map, second.map, request.first_from_second);
  SaveMap(request.out, first.camera, first.rectified_from_left, merged);
  std::cout << fmt::format("{}: {} keyframes, {} points, {} lines\n",
                           request.out,
                           merged.keyframes().size(),
                           merged.points().size(),
                           merged.lines().size());
  return 0;
}

}  // namespace plumbline
