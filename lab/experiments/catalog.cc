// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/catalog.h"

#include "lab/experiments/computed.h"
#include "lab/experiments/paper_catalog.h"
#include "lab/experiments/start_catalog.h"
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"

#include <string>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

// One choice among several from which the variants of an experiment are combined.
struct Setting {
  std::string name;
  std::vector<std::string> settings;
};

// Not every kind of line can be held parallel to others: where kinds are compared, none is.
void HoldNoLinesParallel(std::vector<Variant>& variants) {
  for (Variant& variant : variants) {
    variant.settings.emplace_back("mapping.window.parallel_lines=false");
  }
}

// Lines by every way to have them, with several cameras or depth where there is.
Experiment LineExperiment() {
  Experiment experiment;
  experiment.name = "lines";
  experiment.help = "points alone and with lines by each way to parametrize, weigh and make them";
  experiment.sequences = {{"worlds/*"}, {"euroc/*"}, {"kitti/*"}, {"tum/*"}, {"icl/*"}};
  experiment.variants = {{"points", {"features.lines=false"}},
                         {"plucker", {}},
                         {"plucker_left", {"lines.residual=plucker_left"}},
                         {"endpoints", {"lines.residual=endpoints"}},
                         {"projected", {"lines.residual=projected_ends"}},
                         {"projected_endpoints", {"lines.residual=projected_endpoints"}},
                         {"two_view", {"lines.reconstruction=two_view"}},
                         {"scalar", {"lines.weighting=scalar"}},
                         {"unweighted", {"lines.weighting=none"}},
                         {"constant", {"lines.weighting=none", "lines.constant_sigma_px=0.3"}}};
  HoldNoLinesParallel(experiment.variants);
  experiment.metrics = {"ate",
                        "ate_causal",
                        "rpe_mean",
                        "rpe_rmse",
                        "roe_rmse",
                        "lost",
                        "keyframes",
                        "lines",
                        "line_recall",
                        "line_precision",
                        "line_angle",
                        "line_distance",
                        "line_multiplicity",
                        "map_line_bytes",
                        "adjusted_line_bytes",
                        "adjust_ms",
                        "adjust_p95_ms",
                        "cpu_ms",
                        "memory_mb"};
  experiment.plots = {"ate", "rpe_rmse", "line_recall", "line_precision", "adjust_ms"};
  experiment.runs = 10;
  experiment.size = WorldSize::kFull;
  experiment.reference = "plucker";
  experiment.ratios = {"ate", "ate_causal"};
  return experiment;
}

// The same with the left camera alone: points and lines after each way to begin.
Experiment MonocularLineExperiment() {
  const std::vector<std::string> mono = {"--sensor", "mono"};
  Experiment experiment = LineExperiment();
  experiment.name = "lines_mono";
  experiment.help = "points alone and with lines from one camera, by each way to begin the map";
  experiment.variants = {{"points", {"features.lines=false"}, mono},
                         {"plucker", {}, mono},
                         {"plucker_left", {"lines.residual=plucker_left"}, mono},
                         {"endpoints", {"lines.residual=endpoints"}, mono},
                         {"two_view_lines", {"lines.reconstruction=two_view"}, mono},
                         {"klt_start", {"initialization.method=rank1_klt"}, mono},
                         {"two_view_start", {"initialization.method=two_view"}, mono}};
  HoldNoLinesParallel(experiment.variants);
  experiment.metrics.insert(experiment.metrics.begin() + 1, {"scale_drift"});
  return experiment;
}

// Table 1 to 3 of the second paper: what is tracked, how lines are weighted and whether they are
// cut, against the last frame (the paper's setting, with its residuals) and against the map (ours),
// on sharp and on blurred images. Weights do not matter to points alone; PL has those of the
// defaults as well.
// PL80: the 80 points and lines that tell most about the pose, chosen together.
std::vector<Variant> CuttingVariants() {
  const std::vector<Setting> references = {
      {"last", {"tracking.reference=last_frame", "lines.residual=projected_ends"}}, {"map", {}}};
  const std::vector<Setting> kinds = {{"P", {"features.lines=false"}},
                                      {"L", {"features.points=false"}},
                                      {"L+Cut", {"features.points=false", "cutting.method=greedy"}},
                                      {"PL", {}},
                                      {"PL+Cut", {"cutting.method=greedy"}},
                                      {"PL80", {"cutting.method=best_80"}},
                                      {"PL80+Cut", {"cutting.method=best_80_greedy"}}};
  std::vector<Variant> variants;
  for (const bool blurred : {false, true}) {
    for (const Setting& reference : references) {
      for (const Setting& kind : kinds) {
        for (const std::string weighting : {"none", "scalar", "covariance"}) {
          const bool points_alone = kind.name == "P";
          if (points_alone && weighting != "none") continue;
          const bool whole_with_points = kind.name == "PL" || kind.name == "PL80";
          if (!whole_with_points && weighting == "covariance") continue;
          Variant variant{reference.name + "_" + kind.name, reference.settings};
          variant.settings.insert(
              variant.settings.end(), kind.settings.begin(), kind.settings.end());
          if (!points_alone) {
            variant.name += "_" + weighting;
            variant.settings.push_back("lines.weighting=" + weighting);
          }
          if (blurred) {
            variant.name += "_blur";
            variant.arguments = {"--blur", "5"};
          }
          variants.push_back(std::move(variant));
        }
      }
    }
  }
  return variants;
}

Experiment CuttingExperiment() {
  Experiment experiment;
  experiment.name = "cutting";
  experiment.help =
      "line cutting and line weights against the last frame and against the map, sharp and blurred";
  experiment.sequences = {{"worlds/lowtexture"}, {"worlds/vicon_*"}, {"euroc/*"}};
  experiment.variants = CuttingVariants();
  experiment.metrics = {"rpe_causal_mean",
                        "rpe_causal_rmse",
                        "roe_causal_mean",
                        "roe_causal_rmse",
                        "coverage",
                        "lost",
                        "cpu_ms"};
  experiment.plots = {"rpe_causal_mean", "roe_causal_mean"};
  experiment.runs = 10;
  experiment.size = WorldSize::kFull;
  experiment.tolerated_failures = 2;
  return experiment;
}

// Each weight of lines with and without cutting, and what else leaves uncertain parts of lines
// out. Lines weigh as much as points do at a constant 0.2 and 0.3 px; at the 1 px of `none` they
// count for little and their gates are wide. Lines that are cut are trimmed to what is measured as
// well (WithCutLines).
Experiment CuttingControlExperiment(bool points) {
  Experiment experiment;
  experiment.name = points ? "cutting_controls" : "cutting_controls_lines";
  experiment.help = "line cutting at each weight of lines, and what it is compared with";
  if (!points) experiment.help += ", lines alone";
  for (const bool blurred : {false, true}) {
    const std::vector<std::string> blur =
        blurred ? std::vector<std::string>{"--blur", "5"} : std::vector<std::string>{};
    for (const char* pattern : {"worlds/lowtexture", "worlds/vicon_*", "euroc/*"}) {
      experiment.sequences.push_back({pattern, {}, blurred ? "blurred" : "", blur});
    }
  }
  const std::vector<Setting> weights = {
      {"1px", {"lines.weighting=none"}},
      {"03px", {"lines.weighting=none", "lines.constant_sigma_px=0.3"}},
      {"02px", {"lines.weighting=none", "lines.constant_sigma_px=0.2"}},
      {"covariance", {"lines.weighting=covariance"}}};
  const std::vector<Setting> cuts = {
      {"", {}},
      {"+Cut", {"cutting.method=greedy"}},
      {"+Cut_printed", {"cutting.method=greedy", "cutting.information=printed"}},
      {"+Cut_alike",
       {"cutting.method=greedy", "cutting.ends=inverse_depth", "cutting.end_sigma=0.015"}},
      {"+Drop", {"cutting.method=drop"}}};
  const Setting lines = points ? Setting{"PL", {}} : Setting{"L", {"features.points=false"}};
  for (const Setting& weight : weights) {
    for (const Setting& cut : cuts) {
      Variant variant{
          lines.name + cut.name + "_" + weight.name,
          {"loop.enabled=false", "tracking.reference=last_frame", "lines.residual=projected_ends"}};
      for (const Setting& part : {lines, weight, cut}) {
        variant.settings.insert(variant.settings.end(), part.settings.begin(), part.settings.end());
      }
      experiment.variants.push_back(std::move(variant));
    }
  }
  experiment.metrics = {"rpe_causal_mean", "roe_causal_mean", "coverage", "lost"};
  experiment.plots = {"rpe_causal_mean", "roe_causal_mean"};
  experiment.runs = 1;
  experiment.reference = lines.name + "_1px";
  experiment.ratios = {"rpe_causal_mean", "roe_causal_mean"};
  return experiment;
}

// Lines of several systems, which all begin in the same way; `points` measure as many points and
// no lines. The adjustment at the end finds all lines anew from many views and hides where they
// came from: each runs with it and without. `endpoints` differ from `plucker` in parameters and in
// the interval, which adjustments move and nothing cuts to a view (search, tracking and the depth
// of the scene use it). EPL, as section 4 of the first paper, is also made of two views, with
// residuals of end points in tracking and adjustment.
Experiment LineControlExperiment(bool mono) {
  Experiment experiment;
  experiment.name = mono ? "line_controls_mono" : "line_controls";
  experiment.help = "lines of systems begun alike, with and without the adjustment at the end";
  if (mono) experiment.help += ", one camera";
  for (const char* world : {"room", "office", "planar", "lowtexture", "vicon_medium", "lights"}) {
    experiment.sequences.push_back({std::string("worlds/") + world});
  }
  for (const char* pattern : {"euroc/*", "kitti/*", "tum/*"}) {
    experiment.sequences.push_back({pattern});
  }
  const std::vector<Setting> kinds = {
      {"points", {"features.lines=false"}},
      {"plucker", {}},
      {"endpoints", {"lines.residual=endpoints"}},
      {"EPL", {"lines.residual=projected_endpoints", "lines.reconstruction=two_view"}}};
  for (const bool at_end : {true, false}) {
    for (const Setting& kind : kinds) {
      Variant variant{kind.name + (at_end ? "" : "_no_end"),
                      {"loop.enabled=false",
                       "initialization.method=two_view",
                       "features.point_count=500",
                       "features.line_count=300"}};
      if (mono) variant.arguments = {"--sensor", "mono"};
      variant.settings.insert(variant.settings.end(), kind.settings.begin(), kind.settings.end());
      if (!at_end) variant.settings.push_back("mapping.final_adjustment_keyframes=0");
      experiment.variants.push_back(std::move(variant));
    }
  }
  HoldNoLinesParallel(experiment.variants);
  experiment.metrics = {"ate", "ate_causal", "rpe_mean", "lost", "maps", "keyframes", "lines"};
  experiment.plots = {"ate", "ate_causal"};
  experiment.runs = 2;
  experiment.reference = "plucker";
  experiment.ratios = {"ate", "ate_causal"};
  return experiment;
}

// What lines bring where lamps are switched. One seed of a world is one draw of lamps, furniture
// and path: what holds for the situation shows in the interval over several.
Experiment SwitchedLampsExperiment() {
  constexpr int kSeeds = 24;
  Experiment experiment;
  experiment.name = "lines_lights";
  experiment.help = "points alone and with lines in `lights` of 24 seeds";
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const std::string number = std::to_string(seed);
    experiment.sequences.push_back({"worlds/lights", {"seed=" + number}, "seed" + number});
  }
  experiment.variants = {{"points", {"features.lines=false"}}, {"both", {}}};
  experiment.metrics = {"ate", "ate_causal", "rpe_rmse", "roe_rmse", "lost", "keyframes"};
  experiment.plots = {"ate", "ate_causal"};
  experiment.runs = 2;
  experiment.reference = "points";
  experiment.ratios = {"ate", "ate_causal", "rpe_rmse", "roe_rmse"};
  return experiment;
}

// How well promised covariances hold, where the world is known and in recordings.
Experiment ConsistencyExperiment() {
  Experiment experiment;
  experiment.name = "consistency";
  experiment.help = "errors of features, landmarks and motions against their covariances";
  experiment.sequences = {{"worlds/room"},
                          {"worlds/office"},
                          {"worlds/vicon_medium"},
                          {"worlds/town"},
                          {"euroc/*"},
                          {"kitti/*"},
                          {"tum/*"}};
  experiment.variants = {{"default", {}},
                         {"constant", {"lines.weighting=none", "lines.constant_sigma_px=0.2"}}};
  experiment.metrics = {"ate",
                        "ate_causal",
                        "roe_rmse",
                        "inside_least",
                        "inside_most",
                        "inside_point",
                        "inside_disparity",
                        "inside_line",
                        "inside_right_line",
                        "inside_segment",
                        "inside_right_segment",
                        "inside_point_landmark",
                        "inside_line_landmark",
                        "inside_causal_1s",
                        "inside_causal_5s",
                        "inside_final_1s",
                        "inside_final_5s"};
  experiment.plots = {"inside_line", "inside_point"};
  experiment.runs = 3;
  experiment.reference = "default";
  experiment.ratios = {"ate", "ate_causal", "roe_rmse"};
  return experiment;
}

// What the first paper's rules for line matches do: lengths alike, and no more turn in the image
// than the cameras have.
Experiment LineMatchingExperiment() {
  Experiment experiment = LineControlExperiment(true);
  experiment.name = "line_matching_mono";
  experiment.help = "lines matched by the first paper's rules, one camera";
  const Variant plucker = experiment.variants[1];
  const std::vector<Setting> rules = {
      {"", {}},
      {"_lengths", {"lines.min_length_ratio=0.8"}},
      {"_rotation", {"lines.rotation_gate=true"}},
      {"_both", {"lines.min_length_ratio=0.8", "lines.rotation_gate=true"}}};
  experiment.variants.clear();
  for (const Setting& rule : rules) {
    Variant variant = plucker;
    variant.name += rule.name;
    variant.settings.insert(variant.settings.end(), rule.settings.begin(), rule.settings.end());
    experiment.variants.push_back(std::move(variant));
  }
  return experiment;
}

// Recorded sequences in ways on which nothing was tuned.
Experiment RobustnessExperiment() {
  Experiment experiment;
  experiment.name = "robustness";
  experiment.help = "recordings as they are, played backwards, with fewer images, and blurred";
  experiment.sequences = {{"euroc/*"}, {"kitti/*"}, {"tum/*"}, {"icl/*"}};
  experiment.variants = {{"as_recorded", {}},
                         {.name = "reversed", .settings = {}, .reversed = true},
                         {"every_2nd", {}, {"--stride", "2"}},
                         {"every_3rd", {}, {"--stride", "3"}},
                         {"every_4th", {}, {"--stride", "4"}},
                         {"every_5th", {}, {"--stride", "5"}},
                         {"blurred", {}, {"--blur", "5"}}};
  experiment.metrics = {
      "ate", "ate_causal", "rpe_rmse", "coverage", "lost", "initializing", "maps", "keyframes"};
  experiment.plots = {"ate", "coverage"};
  experiment.reference = "as_recorded";
  return experiment;
}

// The same with the left camera alone. ICL-NUIM has no other and is in the experiment above.
Experiment MonocularRobustnessExperiment() {
  Experiment experiment = RobustnessExperiment();
  experiment.name = "robustness_mono";
  experiment.help = "recordings in the same ways, from the left camera alone";
  experiment.sequences = {{"euroc/*"}, {"kitti/*"}, {"tum/*"}};
  for (Variant& variant : experiment.variants) {
    variant.arguments.insert(variant.arguments.end(), {"--sensor", "mono"});
  }
  experiment.metrics.emplace_back("scale_drift");
  return experiment;
}

// This program beside an earlier version of it, which --earlier names: each plays what the other
// does, one after the other.
Experiment VersionsExperiment(bool mono) {
  Experiment experiment;
  experiment.name = mono ? "versions_mono" : "versions";
  experiment.help = "this program beside an earlier version of it";
  if (mono) experiment.help += ", one camera";
  experiment.sequences = {{"worlds/*"}, {"euroc/*"}, {"kitti/*"}, {"tum/*"}};
  if (!mono) experiment.sequences.push_back({"icl/*"});  // which has one camera in any case
  experiment.variants = {{"earlier", {}}, {"this", {}}};
  experiment.variants.front().by_earlier = true;
  if (mono) {
    for (Variant& variant : experiment.variants) variant.arguments = {"--sensor", "mono"};
  }
  experiment.metrics = {"ate",
                        "ate_causal",
                        "rpe_rmse",
                        "roe_rmse",
                        "lost",
                        "maps",
                        "dropped",
                        "keyframes",
                        "cpu_ms",
                        "frame_ms",
                        "frame_p95_ms",
                        "memory_mb"};
  experiment.plots = {"ate", "cpu_ms"};
  experiment.runs = 3;
  experiment.reference = "earlier";
  experiment.ratios = {"ate", "ate_causal", "cpu_ms", "frame_ms", "frame_p95_ms", "memory_mb"};
  experiment.exclusive = true;
  return experiment;
}

// The gyroscope that comes with a sequence used or not, by sensor: as it should be, with what goes
// wrong in inertial sensors, and where few images or fast turns make it hard to find the next pose.
Experiment GyroscopeExperiment() {
  Experiment experiment;
  experiment.name = "gyroscope";
  experiment.help = "the gyroscope that comes with a sequence used (auto) or not (off), by sensor";
  const std::vector<Setting> faults = {{"plain", {}},
                                       {"gap50", {"imu.gap_ms=50"}},
                                       {"gap500", {"imu.gap_ms=500"}},
                                       {"lost", {"imu.lost=0.02"}},
                                       {"jitter", {"imu.jitter_ms=2"}},
                                       {"range", {"imu.rate_range=1.5"}},
                                       {"hz50", {"imu_rate_hz=50"}},
                                       {"hz1000", {"imu_rate_hz=1000"}}};
  const std::vector<std::string> imperfect = {"imu.bias=1", "imu.average=true", "imu.margin_s=0.2"};
  const auto add = [&](const char* world, const Setting& setting, std::vector<std::string> more) {
    std::vector<std::string> settings = imperfect;
    settings.insert(settings.end(), setting.settings.begin(), setting.settings.end());
    experiment.sequences.push_back({world, settings, setting.name, std::move(more)});
  };
  for (const Setting& fault : faults) add("worlds/vicon_difficult", fault, {});
  const std::vector<std::string> third = {"--stride", "3"};
  add("worlds/vicon_difficult", {"slow", {"rate_hz=6.666667", "shutter_ms=20"}}, third);
  add("worlds/rotation", {"fast", {"speed=3", "shutter_ms=20"}}, third);
  experiment.sequences.push_back({"euroc/*"});
  for (const std::string sensor : {"stereo", "mono"}) {
    for (const std::string imu : {"off", "auto"}) {
      Variant variant{sensor + "_" + imu, {}, {"--sensor", sensor, "--imu", imu}};
      if (imu == "auto") variant.reference = sensor + "_off";
      experiment.variants.push_back(std::move(variant));
    }
  }
  experiment.metrics = {"ate", "ate_causal", "roe_rmse", "tracked", "lost", "maps", "cpu_ms"};
  experiment.plots = {"ate_causal", "lost"};
  experiment.reference = "stereo_off";
  experiment.ratios = {"ate", "ate_causal", "cpu_ms"};
  return experiment;
}

// Experiments of our own, beside those of the papers.
std::vector<Experiment> OwnExperiments() {
  return {
      Experiment{
          .name = "sensors",
          .help = "points, lines and both together on every sequence there is",
          .sequences = {{"worlds/*"}, {"euroc/*"}, {"kitti/*"}, {"tum/*"}, {"icl/*"}},
          .variants = {{"points", {"features.lines=false"}},
                       {"lines", {"features.points=false"}},
                       {"both", {}}},
          .metrics = {"ate",          "rpe_mean",    "rpe_rmse",       "roe_mean",  "roe_rmse",
                      "ate_causal",   "lost",        "skipped",        "keyframes", "points",
                      "lines",        "line_recall", "line_precision", "fps",       "frame_ms",
                      "frame_p95_ms", "cpu_ms",      "first_pose_s",   "memory_mb", "dropped"},
          .plots = {"ate", "rpe_rmse", "roe_rmse", "coverage", "frame_ms"}},
      LineExperiment(),
      MonocularLineExperiment(),
      LineControlExperiment(false),
      LineControlExperiment(true),
      LineMatchingExperiment(),
      SwitchedLampsExperiment(),
      ConsistencyExperiment(),
      CuttingExperiment(),
      CuttingControlExperiment(true),
      CuttingControlExperiment(false),
      VersionsExperiment(false),
      VersionsExperiment(true),
      RobustnessExperiment(),
      MonocularRobustnessExperiment(),
      GyroscopeExperiment(),
  };
}

}  // namespace

std::span<const Experiment> Experiments() {
  static const std::vector<Experiment> kExperiments = [] {
    std::vector<Experiment> all = OwnExperiments();
    for (Experiment& experiment : StartExperiments()) all.push_back(std::move(experiment));
    for (Experiment& experiment : PaperExperiments()) all.push_back(std::move(experiment));
    all.push_back(GateExperiment());
    all.push_back(LineGateExperiment());
    return all;
  }();
  return kExperiments;
}

const Experiment& FindExperiment(std::string_view name) {
  std::string names;
  for (const Experiment& experiment : Experiments()) {
    if (experiment.name == name) return experiment;
    names += (names.empty() ? "" : ", ") + experiment.name;
  }
  for (const ComputedExperiment& experiment : ComputedExperiments())
    names += ", " + experiment.name;
  for (const ExperimentGroup& group : ExperimentGroups()) names += ", " + group.name;
  throw InputError("there is no experiment " + InQuotes(name) + "; there are: " + names);
}

}  // namespace plumbline
