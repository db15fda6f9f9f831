// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/line_map_plots.h"
#include "lab/experiments/paper_plots.h"
#include "lab/rivals/laboratory_methods.h"
#include "plumbline/base/base64.h"
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/geometry/trimming.h"
#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/io/export/png.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/matching/projection_search.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/line_cutting.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr Color kMeasured{0, 200, 0}, kPiece{230, 0, 0};

// Pose of the keyframe that made a line: the first one that shows it.
std::optional<Rigid3> PoseOfMaker(const Map& map, const MapLine& line) {
  if (line.observations.empty()) return std::nullopt;
  const auto maker = map.keyframes().find(line.observations.begin()->first);
  if (maker == map.keyframes().end()) return std::nullopt;
  return maker->second.frame.cam_from_world;
}

// The lines of a keyframe as tracking would cut them at its final pose, all whole yet.
struct LinesOfKeyFrame {
  PoseProblem problem;
  std::vector<CutCandidate> candidates;
};

LinesOfKeyFrame CollectLines(const SavedMap& saved, const KeyFrame& keyframe) {
  LinesOfKeyFrame lines;
  lines.problem.camera = saved.camera;
  lines.problem.cam_from_world = keyframe.frame.cam_from_world;
  const Features& features = keyframe.frame.features();
  for (std::size_t i = 0; i < keyframe.frame.points.size(); ++i) {
    if (const MapPoint* point = saved.map.Find(keyframe.frame.points[i])) {
      lines.problem.points.push_back({point->position, MeasurePoint(features, i)});
    }
  }
  for (std::size_t i = 0; i < keyframe.frame.lines.size(); ++i) {
    const MapLine* line = saved.map.Find(keyframe.frame.lines[i]);
    if (line == nullptr) continue;
    const LineMeasurement measurement = MeasureLeftLine(features, i, LineWeighting::kNone);
    const auto visible =
        TrimToSegment(saved.camera, keyframe.frame.cam_from_world, line->line, measurement.segment);
    if (!visible) continue;
    lines.problem.lines.push_back(
        {line->line, measurement, static_cast<int>(i), SegmentOf(line->line, *visible)});
    lines.candidates.push_back({line, features.lines[i].sigma_px, PoseOfMaker(saved.map, *line)});
  }
  return lines;
}

Overlay DrawCuts(const LinesOfKeyFrame& lines, const SlamOptions& options) {
  const SystemMethods& methods = LaboratoryMethods();
  const PoseProblem cut = WithCutLines(lines.problem,
                                       lines.candidates,
                                       methods.Lines(options.lines),
                                       {options.cutting, methods.choose_features});
  Overlay overlay;
  for (const auto& match : lines.problem.lines) {
    overlay.segments.push_back({match.measurement.segment, kMeasured});
  }
  for (std::size_t i = 0; i < cut.lines.size(); ++i) {
    const Rigid3& pose = cut.cam_from_world;
    const Segment3 piece{pose * cut.lines[i].ends.start, pose * cut.lines[i].ends.end};
    const auto segment = ProjectSegment(cut.camera, piece);
    if (!segment) continue;
    overlay.segments.push_back({*segment, kPiece});
    // A line that is cut to a point would not be seen.
    overlay.points.push_back({segment->start, kPiece});
    overlay.points.push_back({segment->end, kPiece});
  }
  return overlay;
}

}  // namespace

std::string CutLinePlot(const Plan& plan, const Job& job) {
  const SavedMap saved = LoadMap(job.folder / "map.plb");
  const KeyFrame& keyframe = KeyFrameWithMostLines(saved.map);
  SlamOptions options;
  OptionTable(options, LaboratoryMethods().added).LoadFile(job.folder / "options.yaml");
  const GrayImage image =
      ToGray(KeyFrameImages(plan.SequenceOf(job).path, {}, saved).Read(keyframe));
  const std::string png = EncodeOverlayPng(image, DrawCuts(CollectLines(saved, keyframe), options));
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
      "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\"><image width=\"{0}\" height=\"{1}\" "
      "xlink:href=\"data:image/png;base64,{2}\"/></svg>\n",
      image.width(),
      image.height(),
      EncodeBase64(png));
}

}  // namespace plumbline
