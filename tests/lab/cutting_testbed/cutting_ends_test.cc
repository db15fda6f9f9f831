// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/cutting_testbed/scene.h"
#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/tracking/line_cutting.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr double kNoise = 0.015;

// A simulated scene as tracking has it: lines measured where the estimated ones show, so that all
// of each is offered to be cut; their information says nothing of how the ends were simulated.
struct TrackedScene {
  CuttingProblem simulated;
  std::vector<LineModel> models;
  PoseProblem problem;

  explicit TrackedScene(std::uint64_t index) {
    simulated = MakeCuttingScene({.noise = kNoise}, index).problem;
    simulated.other_information.setZero();
    problem.camera = simulated.camera;
    for (CuttableLine& line : simulated.lines) {
      const Segment3& segment = line.segment_in_cam;
      LineModel model;
      model.line = LineThroughPoints(segment.start, segment.end);
      model.start = model.line.ParameterOf(segment.start);
      model.end = model.line.ParameterOf(segment.end);
      model.information = 1e4 * Eigen::Matrix4d::Identity();
      PoseProblem::LineMatch match;
      match.line_in_world = model.line;
      match.ends = segment;
      match.measurement.segment = {problem.camera.Project(segment.start),
                                   problem.camera.Project(segment.end)};
      match.group = static_cast<int>(models.size());
      line.image_line = LineThrough(match.measurement.segment);
      models.push_back(model);
      problem.lines.push_back(match);
    }
  }

  std::vector<Segment3> PiecesInTracking(CuttingEnds ends) const {
    std::vector<CutCandidate> candidates;
    for (std::size_t i = 0; i < models.size(); ++i) {
      candidates.push_back({&models[i], simulated.lines[i].sigma_px});
    }
    const CuttingOptions cutting{.method = "greedy", .ends = ends, .end_sigma = kNoise};
    std::vector<Segment3> pieces;
    for (const auto& match : WithCutLines(problem, candidates, {}, {cutting}).lines) {
      pieces.push_back(match.ends);
    }
    return pieces;
  }
};

double Difference(const Segment3& a, const Segment3& b) {
  return std::max((a.start - b.start).norm(), (a.end - b.end).norm());
}

TEST(CuttingEnds, AlikeInInverseDepthAreCutInTrackingAsInTheTestbed) {
  int cut = 0;
  int otherwise = 0;
  for (std::uint64_t index = 0; index < 5; ++index) {
    const TrackedScene scene(index);
    const auto cuts = CutLines(scene.simulated);
    const auto alike = scene.PiecesInTracking(CuttingEnds::kInverseDepth);
    const auto by_information = scene.PiecesInTracking(CuttingEnds::kLandmark);
    ASSERT_EQ(alike.size(), cuts.size());
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const Segment3 expected = CutSegment(scene.simulated.lines[i].segment_in_cam, cuts[i]);
      EXPECT_LT(Difference(alike[i], expected), 1e-3) << index << ' ' << i;
      cut += cuts[i] != LineCut{};
      otherwise += Difference(by_information[i], expected) > 0.05;
    }
  }
  EXPECT_GT(cut, 25);
  EXPECT_GT(otherwise, 5);
}

}  // namespace
}  // namespace plumbline
