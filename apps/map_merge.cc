// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/counted.h"
#include "plumbline/base/error.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/io/text_rows.h"

#include "apps/command_line.h"
#include "apps/command_outputs.h"
#include "apps/map_commands.h"
#include "apps/merge_atlases.h"
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

CommandSyntax MapMergeSyntax() {
  return {
      "map merge",
      "Makes one map of two of the same camera, in the world of the first. Where the second map "
      "lies in it\nis found by the places that both show: then landmarks that both have become "
      "one, and the whole map\nis adjusted. With --transform it is given instead, and what both "
      "maps have stays apart. Keyframes and\nlandmarks of the second get numbers behind those "
      "of the first.",
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

// The request, before a file is read.
struct MergeRequest {
  std::string first, second;
  std::optional<Similarity3> first_from_second;  // none: to be found
  std::string out;
};

MergeRequest ReadMergeRequest(const CommandLine& line) {
  MergeRequest request{line.Positional(0), line.Positional(1), {}, {}};
  const auto out = line.Value("--out");
  if (!out) throw InputError("map merge: expected --out FILE");
  request.out = *out;
  if (const auto transform = line.Value("--transform")) {
    request.first_from_second = ParseTransform(*transform);
  }
  const std::array<std::filesystem::path, 2> inputs = {request.first, request.second};
  CheckOutput("--out", *out, inputs, MapFileKind());
  CheckWritable(*out);
  return request;
}

std::string ToText(const Similarity3& transform) {
  const Eigen::Vector3d& t = transform.translation;
  const Eigen::Quaterniond& q = transform.rotation;
  return fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}",
                     t.x(),
                     t.y(),
                     t.z(),
                     q.x(),
                     q.y(),
                     q.z(),
                     q.w(),
                     transform.scale);
}

void PrintOverlap(const MergedAtlases& merged) {
  std::cout << fmt::format(
      "{} pairs of keyframes show the same places; first_from_second {}\n"
      "{} keyframes of the second map fused with the first\n",
      merged.overlap.size(),
      ToText(merged.first_from_second),
      merged.ties);
}

}  // namespace

int MapMergeCommand(std::span<const std::string> arguments) {
  const CommandLine line(MapMergeSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(MapMergeSyntax());
    return 0;
  }
  const MergeRequest request = ReadMergeRequest(line);
  NamedAtlas first{request.first, LoadAtlas(request.first)};
  const NamedAtlas second{request.second, LoadAtlas(request.second)};
  const MergedAtlases merged = MergeAtlases(
      std::move(first), second, request.first_from_second, [](const std::string& remark) {
        std::clog << remark << '\n';
      });
  if (!request.first_from_second) PrintOverlap(merged);
  SaveAtlas(request.out, merged.saved.atlas, merged.saved.context);
  const Map& map = merged.saved.atlas.active();
  std::cout << fmt::format("{}: {}, {}, {}\n",
                           request.out,
                           Counted(map.keyframes().size(), "keyframe"),
                           Counted(map.points().size(), "point"),
                           Counted(map.lines().size(), "line"));
  return 0;
}

}  // namespace plumbline
