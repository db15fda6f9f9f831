// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/box_plot.h"
#include "lab/experiments/curve_plot.h"
#include "lab/experiments/cutting_testbed_figures.h"
#include "lab/experiments/surface_plot.h"
#include "plumbline/base/options.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr std::array kDrawnPoses = {PoseVariant::kFull,
                                    PoseVariant::kCut,
                                    PoseVariant::kWeighted,
                                    PoseVariant::kCutWeighted,
                                    PoseVariant::kDrop,
                                    PoseVariant::kAdjusted};

std::string NameOfVariant(PoseVariant variant) { return NameOf(variant); }

Figure CameraPathPlot(const TestbedTrials& trials) {
  constexpr std::array kQuartiles = {"25 %", "50 %", "75 %"};
  std::vector<CurvePanel> panels;
  for (const TestbedTrials::Path& path : trials.paths) {
    CurvePanel panel{fmt::format("noise {}", path.options.noise),
                     "angle between optical axis and line [deg]",
                     "best ratios a <= b",
                     {}};
    for (const bool second : {false, true}) {
      for (std::size_t q = 0; q < 3; ++q) {
        Curve curve{fmt::format("{} {}", second ? "b" : "a", kQuartiles[q]), {}};
        for (const CameraPathPoint& point : path.points) {
          curve.points.emplace_back(point.angle_deg, (second ? point.second : point.first)[q]);
        }
        panel.curves.push_back(std::move(curve));
      }
    }
    panel.end_y = 1.02;
    panels.push_back(std::move(panel));
  }
  return CurvePlot(panels);
}

// For one kind of scenes: values of each optimizer, all noises and numbers of lines.
template <class Value>
Figure JointPlot(const TestbedTrials& trials,
                 SceneKind kind,
                 const std::string& label,
                 const Value& value) {
  std::vector<Box> boxes;
  for (const auto& [optimizer, name] : EnumNames(std::type_identity<JointOptimizer>{})) {
    Box box{name, {}};
    for (const auto& cell : trials.joint) {
      if (cell.options.kind != kind) continue;
      for (const JointTrial& trial : cell.trials) box.values.push_back(value(trial, optimizer));
    }
    boxes.push_back(std::move(box));
  }
  return BoxPlot(label, boxes);
}

double MedianError(const TrialCell<PoseTrial>& cell, PoseVariant variant) {
  std::vector<double> errors;
  for (const PoseTrial& trial : cell.trials) {
    errors.push_back(1000 * trial.at(variant).translation_m);
  }
  std::sort(errors.begin(), errors.end());
  return errors[errors.size() / 2];
}

Figure PoseErrorPlot(const TestbedTrials& trials) {
  std::vector<CurvePanel> panels;
  std::map<std::string, std::size_t> panel_of;
  for (const auto& cell : trials.poses) {
    const std::string title =
        fmt::format("{}, noise {}", NameOf(cell.options.kind), cell.options.noise);
    if (!panel_of.contains(title)) {
      panel_of[title] = panels.size();
      CurvePanel panel{title, "lines", "translation error, median [mm]", {}};
      for (const PoseVariant variant : kDrawnPoses) {
        panel.curves.push_back({NameOfVariant(variant), {}});
      }
      panel.dots = true;
      panels.push_back(std::move(panel));
    }
    CurvePanel& panel = panels[panel_of[title]];
    for (std::size_t v = 0; v < kDrawnPoses.size(); ++v) {
      panel.curves[v].points.emplace_back(cell.options.lines, MedianError(cell, kDrawnPoses[v]));
    }
  }
  return CurvePlot(panels);
}

}  // namespace

std::vector<PagePlot> CuttingTestbedPlots(const TestbedTrials& trials) {
  std::vector<PagePlot> plots;
  if (!trials.poses.empty()) plots.push_back({"pose_error", ToSvg(PoseErrorPlot(trials))});
  plots.push_back({"camera_path", ToSvg(CameraPathPlot(trials))});
  constexpr std::array kShapes = {"full_length", "piece", "point"};
  for (std::size_t i = 0; i < trials.surfaces.size(); ++i) {
    const SurfaceExample& example = trials.surfaces[i];
    plots.push_back({fmt::format("surface_{}", kShapes.at(i)),
                     ToSvg(SurfacePlot(example.surface,
                                       example.best,
                                       "log det, light is more",
                                       "first ratio",
                                       "second ratio"))});
  }
  for (const SceneKind kind : {SceneKind::kHomogeneousPoints, SceneKind::kInverseDepthPoints}) {
    plots.push_back({"joint_gain_" + NameOf(kind),
                     ToSvg(JointPlot(trials, kind, "log det over full length", [](auto& t, auto o) {
                       return t.outcomes.at(o).log_determinant -
                              t.outcomes.at(JointOptimizer::kFull).log_determinant;
                     }))});
  }
  return plots;
}

}  // namespace plumbline
