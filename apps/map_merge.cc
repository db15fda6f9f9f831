// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/map_merge.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/features/front_end_fingerprint.h"
#include "plumbline/geometry/camera_difference.h"
#include "plumbline/geometry/sim3.h"
#include "plumbline/io/map_io.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/map/gathering.h"
#include "plumbline/slam/options.h"

#include "apps/command_line.h"
#include "apps/map_commands.h"
#include <cmath>
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

CommandSyntax Syntax() {
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

// What is asked for, before a file is read.
struct MergeRequest {
  std::string first, second;
  std::optional<Similarity3> first_from_second;  // none: to be found
  std::string out;
};

MergeRequest ReadRequest(const CommandLine& line) {
  MergeRequest request{line.Positional(0), line.Positional(1), {}, {}};
  const auto out = line.Value("--out");
  if (!out) throw InputError("map merge: expected --out FILE");
  request.out = *out;
  if (const auto transform = line.Value("--transform")) {
    request.first_from_second = ParseTransform(*transform);
  }
  for (const std::string& file : {request.first, request.second}) {
    RefuseToReplaceInput(*out, file);
  }
  return request;
}

SavedAtlas LoadMaps(const std::string& file) {
  SavedAtlas saved = LoadAtlas(file);
  if (saved.atlas.empty()) throw InputError(file + ": expected a map, found none in the file");
  return saved;
}

void CheckCameras(const MergeRequest& request,
                  const AtlasContext& first,
                  const AtlasContext& second) {
  auto difference = CameraDifference({first.camera, first.rectified_from_left},
                                     {second.camera, second.rectified_from_left});
  if (!difference && first.octave_scale != second.octave_scale) {
    difference = fmt::format(
        "octaves {} and {} times as large as the next", first.octave_scale, second.octave_scale);
  }
  if (!difference) return;
  throw InputError(request.second + ": expected a map of the camera of " + request.first +
                   ", found another one: " + *difference);
}

void JoinAsTold(const MergeRequest& request, MapId second, SavedAtlas& saved) {
  const double scale = request.first_from_second->scale;
  if (saved.context.camera.baseline > 0 && scale != 1) {
    FailTransform(
        fmt::format("the scale {:g} for maps of measured depth, whose scale is 1", scale));
  }
  saved.atlas.Join(saved.atlas.active_id(), second, *request.first_from_second);
}

std::string WhyNotMerged(MergeRefusal refusal) {
  switch (refusal) {
    case MergeRefusal::kNoOverlap:
      return "no place that both show for certain";
    case MergeRefusal::kAmbiguous:
      return "places that look alike: the second map may lie in more than one way";
    case MergeRefusal::kContradicted:
      return "places that both show, but shapes of the maps that contradict each other";
  }
  throw BugError("a reason without words");
}

// The options that the first map was made with, as far as this program knows them.
SlamOptions OptionsOf(const MergeRequest& request, const AtlasContext& first) {
  SlamOptions options;
  if (first.options_yaml.empty()) return options;
  try {
    OptionTable(options).LoadText(first.options_yaml, request.first);
  } catch (const InputError& error) {
    std::cerr << fmt::format("{}; merging with the default options\n", error.what());
    return {};
  }
  return options;
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

void JoinBySight(const MergeRequest& request, MapId second, SavedAtlas& saved) {
  const ImagingModel imaging{saved.context.camera, saved.context.octave_scale};
  const auto merged = MergeBySight(
      saved.atlas, saved.atlas.active_id(), second, imaging, OptionsOf(request, saved.context));
  if (!merged) {
    throw InputError(fmt::format("{} and {}: expected maps that show the same place, found {}",
                                 request.first,
                                 request.second,
                                 WhyNotMerged(merged.error())));
  }
  saved.atlas = merged->atlas;
  std::cout << fmt::format(
      "{} pairs of keyframes show the same places; first_from_second {}\n"
      "{} keyframes of the second map fused with the first\n",
      merged->overlap.size(),
      ToText(merged->first_from_second),
      merged->ties);
}

SavedAtlas Merge(const MergeRequest& request) {
  SavedAtlas first = LoadMaps(request.first);
  const SavedAtlas second = LoadMaps(request.second);
  CheckCameras(request, first.context, second.context);
  for (const std::string& difference :
       Differences(first.context.front_end, second.context.front_end)) {
    std::cerr << fmt::format("{}: {} (now: {})\n", request.first, difference, request.second);
  }
  GatheredAtlases gathered = Gather(std::move(first), second);
  const auto join = request.first_from_second ? JoinAsTold : JoinBySight;
  join(request, gathered.second, gathered.saved);
  SettleJoined(gathered.saved);
  return std::move(gathered.saved);
}

}  // namespace

int MapMergeCommand(std::span<const std::string> arguments) {
  const CommandLine line(Syntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(Syntax());
    return 0;
  }
  const MergeRequest request = ReadRequest(line);
  const SavedAtlas saved = Merge(request);
  SaveAtlas(request.out, saved.atlas, saved.context);
  const Map& map = saved.atlas.active();
  std::cout << fmt::format("{}: {} keyframes, {} points, {} lines\n",
                           request.out,
                           map.keyframes().size(),
                           map.points().size(),
                           map.lines().size());
  return 0;
}

}  // namespace plumbline
