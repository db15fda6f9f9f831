// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/start_catalog.h"

#include <string>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// Starts on recorded sequences and on the worlds made for them, as large as they are.
Experiment StartExperiment(const std::string& name,
                           const std::string& help,
                           std::vector<Variant> variants,
                           const std::string& abscissa) {
  const auto world = [](const char* pattern, const char* frames) {
    return SequenceChoice{pattern, {frames, "depth=true", "depth_noise=0"}, "depth"};
  };
  // There is too little parallax for any map.
  const auto still = [&](const char* pattern, const char* frames) {
    SequenceChoice choice = world(pattern, frames);
    choice.arguments = {"--least-parallax", "0.5"};
    return choice;
  };
  Experiment experiment;
  experiment.name = name;
  experiment.help = help;
  experiment.sequences = {world("worlds/planar", "frames=500"),
                          world("worlds/forward", "frames=500"),
                          world("worlds/lateral", "frames=500"),
                          world("worlds/office", "frames=400"),
                          world("worlds/lowtexture", "frames=400"),
                          still("worlds/rotation", "frames=300"),
                          still("worlds/static", "frames=200"),
                          {"euroc/*"},
                          {"kitti/*"},
                          {"tum/*"},
                          {"icl/*"}};
  experiment.variants = std::move(variants);
  experiment.metrics = {"starts",
                        "possible",
                        "success",
                        "wrong",
                        "success_in_the_end",
                        "late",
                        "wrong_rate",
                        "waiting",
                        "accepted",
                        "map_frames",
                        "map_frames_p95",
                        "map_seconds",
                        "map_seconds_p95",
                        "map_parallax",
                        "rotation_error",
                        "rotation_error_p95",
                        "direction_error",
                        "direction_error_p95",
                        "depth_error",
                        "depth_error_p95",
                        "depth_outliers",
                        "map_points",
                        "map_lines",
                        "add_ms",
                        "add_p95_ms",
                        "add_max_ms"};
  experiment.plots = {
      "success", "wrong", "map_frames", "rotation_error", "direction_error", "depth_error"};
  experiment.runs = 1;
  experiment.command = RunCommandKind::kStarts;
  experiment.size = WorldSize::kFull;
  // Without ICL, whose depth is not known.
  const std::vector<std::string> synthetic = {"worlds/*"}, real = {"euroc/*", "kitti/*", "tum/*"};
  experiment.pools = {{"synthetic", synthetic}, {"real", real}, {"all", synthetic}};
  experiment.pools.back().patterns.insert(
      experiment.pools.back().patterns.end(), real.begin(), real.end());
  experiment.abscissa = abscissa;
  return experiment;
}

// The default start with parts left out or replaced, down to the conventional start; `printed` has
// some of what the paper says and ours has not. Without interpolation incomplete points count as
// outliers, too.
Experiment StartPartsExperiment() {
  const std::string rank1 = "initialization.method=rank1";
  const std::string descriptors = "initialization.matching=descriptors";
  const std::string incomplete = "initialization.interpolate=false";
  Experiment experiment =
      StartExperiment("initialization_parts",
                      "monocular starts without alignment, completion, factorization, decision",
                      {{"rank1", {rank1}},
                       {"rank1_no_interpolation", {rank1, incomplete}},
                       {"rank1_no_factorization", {rank1, "initialization.factorize=false"}},
                       {"rank1_descriptors", {rank1, descriptors}},
                       {"rank1_descriptors_no_interpolation", {rank1, descriptors, incomplete}},
                       {"rank1_printed",
                        {rank1,
                         descriptors,
                         "initialization.relative_pose=eight_point",
                         "initialization.min_line_angle_deg=5"}},
                       {"two_view_images", {"initialization.method=two_view_images"}},
                       {"two_view", {"initialization.method=two_view"}}},
                      "");
  const auto world = [](const char* pattern, std::vector<std::string> arguments) {
    return SequenceChoice{
        pattern, {"frames=200", "depth=true", "depth_noise=0"}, "depth", std::move(arguments)};
  };
  experiment.sequences = {world("worlds/office", {"--every", "10"}),
                          world("worlds/lowtexture", {"--every", "10"}),
                          world("worlds/rotation", {"--every", "20", "--least-parallax", "0.5"}),
                          {"euroc/*"},
                          {"kitti/*"},
                          {"tum/*"},
                          {"icl/*", {}, "", {"--every", "40"}}};
  experiment.reference = "rank1";
  experiment.ratios = {"rotation_error", "direction_error", "depth_error", "map_seconds"};
  return experiment;
}

// Each method with each value of an option; the variant is named METHOD_LETTERVALUE.
std::vector<Variant> VariantsByValue(const std::vector<std::string>& methods,
                                     const std::string& key,
                                     char letter,
                                     const std::vector<int>& values) {
  std::vector<Variant> variants;
  for (const std::string& method : methods) {
    for (const int value : values) {
      const std::string number = std::to_string(value);
      variants.push_back({method + "_" + letter + number,
                          {"initialization.method=" + method, key + "=" + number},
                          {},
                          method,
                          static_cast<double>(value)});
    }
  }
  return variants;
}

// Figure 7 of the first paper.
std::vector<Variant> FrameVariants() {
  return VariantsByValue(
      {"rank1", "rank1_klt"}, "initialization.frames", 'm', {3, 4, 5, 6, 7, 8, 9, 10});
}

// Figure 8 of the first paper.
std::vector<Variant> PointVariants() {
  return VariantsByValue(
      {"rank1", "rank1_klt", "two_view"}, "features.point_count", 'p', {100, 200, 500, 1000, 2000});
}

}  // namespace

std::vector<Experiment> StartExperiments() {
  return {
      StartExperiment(
          "initialization",
          "how often, how soon and how well a monocular map begins, by several methods",
          {{"rank1", {"initialization.method=rank1"}},
           {"rank1_descriptors",
            {"initialization.method=rank1", "initialization.matching=descriptors"}},
           {"rank1_unweighted", {"initialization.method=rank1", "initialization.reweighting=0"}},
           {"rank1_klt", {"initialization.method=rank1_klt"}},
           {"two_view", {"initialization.method=two_view"}}},
          ""),
      StartPartsExperiment(),
      StartExperiment("initialization_frames",
                      "monocular starts by the number of frames that are solved together",
                      FrameVariants(),
                      "frames after the reference"),
      StartExperiment("initialization_points",
                      "monocular starts by the number of points in an image",
                      PointVariants(),
                      "points in an image"),
  };
}

}  // namespace plumbline
