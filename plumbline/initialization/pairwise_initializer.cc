// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/pairwise_initializer.h"

#include "plumbline/base/ids.h"
#include "plumbline/base/random.h"
#include "plumbline/base/units.h"
#include "plumbline/solvers/relative_pose.h"

#include <cstddef>
#include <limits>
#include <utility>

namespace plumbline {
namespace {

// Fewest landmarks of a map; with fewer the next frame could not be tracked.
constexpr std::size_t kFewestLandmarks = 30;

}  // namespace

PairwiseInitializer::PairwiseInitializer(const CameraAndPyramid& imaging,
                                         const InitializationOptions& options,
                                         std::uint64_t seed)
    : camera_(imaging.camera),
      options_(options),
      factorization_{.factorize = options.factorize,
                     // The paper decides about an interpolated place by the angle alone.
                     .max_interpolation_sigma = std::numeric_limits<double>::infinity(),
                     .min_line_angle = options.min_line_angle_deg * kDegree,
                     .reweighting = options.reweighting},
      seed_(seed),
      window_(imaging, InitialMatching::kDescriptors) {}

InitializationResult PairwiseInitializer::Add(const InitializationFrame& frame) {
  InitializationResult result = window_.Offer(frame, options_.frames);
  if (result.wait != InitializationStatus::kNone) return result;
  const std::vector<int> frames = window_.NewestFrames(options_.frames);
  FeatureTracks tracks = window_.CollectTracks(frames, std::numeric_limits<int>::max());
  const std::vector<Rigid3> poses = EstimatePoses(frame.id, tracks);
  if (poses.empty()) {
    result.wait = InitializationStatus::kTooLittleParallax;
    return result;
  }
  ++counts_.pairwise_factorizations;
  const auto found = FactorizePairwise(tracks, poses, options_.pairwise.missing, factorization_);
  if (found) {
    counts_.interpolated_places += found->interpolated;
    result.map = MakeMap(frames, found->reconstruction);
  }
  if (!result.map) result.wait = InitializationStatus::kInaccurate;
  return result;
}

std::vector<Rigid3> PairwiseInitializer::EstimatePoses(FrameId newest, FeatureTracks& tracks) {
  std::vector<Rigid3> poses;
  for (std::size_t i = 0; i < tracks.views.size(); ++i) {
    ViewPoints& view = tracks.views[i];
    Rng rng(seed_, "pairwise pose", static_cast<std::uint64_t>(newest.value) * 64 + i);
    const auto pose = EstimatePairwisePose(MatchesBetween(tracks.reference, view), rng);
    if (!pose) return {};
    ++counts_.pairwise_poses;
    poses.push_back(pose->b_from_a);
    if (!options_.pairwise.reject_outliers) continue;
    std::size_t match = 0;
    for (double& sigma : view.sigmas) {
      if (sigma > 0 && !pose->is_inlier[match++]) sigma = 0;
    }
  }
  return poses;
}

std::optional<InitialMap> PairwiseInitializer::MakeMap(const std::vector<int>& frames,
                                                       const Reconstruction& found) const {
  std::vector<InitialView> views{{window_.reference(), Rigid3{}}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    views.push_back({window_.frame(frames[i]), found.cam_from_reference[i]});
  }
  InitialMap map = TriangulateMap(camera_,
                                  std::move(views),
                                  window_.PointObservations(frames),
                                  window_.LineObservations(frames));
  if (map.points.size() + map.lines.size() < kFewestLandmarks || map.points.empty()) {
    return std::nullopt;
  }
  ScaleToMedianDepth(map);
  if (!options_.pairwise.adjust) return map;
  AdjustMap(camera_, map);
  if (map.points.size() + map.lines.size() < kFewestLandmarks || map.points.empty()) {
    return std::nullopt;
  }
  return map;
}

}  // namespace plumbline
