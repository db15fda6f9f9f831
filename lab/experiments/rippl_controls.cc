// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/rippl_controls.h"

#include <string>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// A part of the method left out of the variant that it is compared with. One option differs;
// lab/notes/rippl-tables.md says what else changes with it.
struct Control {
  std::string name;
  std::vector<std::string> settings;
  std::string against;
};

Variant ControlVariant(const Control& control, const char* more_settings) {
  // As the paper's table 1: 2000 points, without lines.
  Variant variant{control.name, {"features.lines=false"}, {"--preset", "rippl"}};
  variant.reference = control.against;
  variant.settings.insert(variant.settings.end(), control.settings.begin(), control.settings.end());
  if (*more_settings != '\0') variant.settings.emplace_back(more_settings);
  return variant;
}

// The parts of the start. Chained lengths need no completed tracks, so that without factorization
// nothing is interpolated either: it is compared with a factorization that interpolates nothing.
std::vector<Control> PartControls() {
  const std::string triangulated = "initialization.pairwise.missing=triangulate";
  return {{"left_out", {"initialization.pairwise.missing=leave_out"}, "proposed"},
          {"triangulated", {triangulated}, "proposed"},
          {"no_factorization", {triangulated, "initialization.factorize=false"}, "triangulated"},
          {"no_rejection", {"initialization.pairwise.reject_outliers=false"}, "proposed"},
          {"no_reweighting", {"initialization.reweighting=0"}, "proposed"}};
}

std::vector<Variant> ControlVariants() {
  const char* points = "features.point_count=2000";
  std::vector<Variant> variants = {ControlVariant({"proposed", {}, ""}, points)};
  for (const Control& control : PartControls()) variants.push_back(ControlVariant(control, points));
  for (const char* frames : {"5", "10"}) {
    variants.push_back(ControlVariant(
        {std::string("m") + frames, {std::string("initialization.frames=") + frames}, "proposed"},
        points));
  }
  const std::string two_view = "initialization.method=two_view";
  variants.push_back(ControlVariant({"two_view", {two_view}, "proposed"}, points));
  const char* fewer = "features.point_count=500";
  variants.push_back(ControlVariant({"p500", {}, "proposed"}, fewer));
  variants.push_back(ControlVariant(
      {"no_rejection_p500", {"initialization.pairwise.reject_outliers=false"}, "p500"}, fewer));
  variants.push_back(ControlVariant({"two_view_p500", {two_view}, "p500"}, fewer));
  // The bundle adjustment of the first map can hide what went before it.
  std::vector<Control> as_found = PartControls();
  as_found.insert(as_found.begin(), {"proposed", {}, ""});
  for (Control& control : as_found) {
    control.against = control.against.empty() ? "proposed" : control.against + "_as_found";
    control.name += "_as_found";
    control.settings.emplace_back("initialization.pairwise.adjust=false");
    variants.push_back(ControlVariant(control, points));
  }
  return variants;
}

}  // namespace

Experiment RipplControls() {
  const auto world = [](const char* pattern) {
    return SequenceChoice{pattern, {"frames=200", "depth=true", "depth_noise=0"}, "depth"};
  };
  Experiment e;
  e.name = "rippl-controls";
  e.help =
      "Lee and Hwang 2019, section 2: starts without factorization, interpolation, rejection of "
      "outliers, reweighting, by frames and points, and from two views, start by start";
  e.sequences = {{"euroc/*"},
                 {"kitti/*"},
                 {"tum/*"},
                 {"icl/*"},
                 world("worlds/planar"),
                 world("worlds/forward"),
                 world("worlds/office")};
  e.variants = ControlVariants();
  e.metrics = {"starts",
               "possible",
               "success",
               "wrong",
               "late",
               "waiting",
               "map_frames",
               "map_seconds",
               "map_parallax",
               "rotation_error",
               "direction_error",
               "depth_error",
               "map_points"};
  e.plots = {"success", "wrong", "direction_error"};
  e.runs = 1;
  e.command = RunCommandKind::kStarts;
  e.size = WorldSize::kFull;
  e.test_arguments = {"--every", "10"};
  e.reference = "proposed";
  e.ratios = {"rotation_error", "direction_error", "depth_error", "map_seconds", "map_parallax"};
  return e;
}

}  // namespace plumbline
