// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/rank1_initializer.h"

#include "plumbline/base/units.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

constexpr int kMaxTracks = 200;            // most tracks from which the decision is made
constexpr std::size_t kMinLandmarks = 30;  // fewest landmarks of a map
// Largest standard deviation of an interpolated place that is used; that of corners is 0.2 to 1
// pixel.
constexpr double kMaxInterpolationPx = 2;

}  // namespace

Rank1Initializer::Rank1Initializer(const CameraAndPyramid& imaging,
                                   const InitializationOptions& options,
                                   std::uint64_t seed,
                                   HelperThread* helper)
    : camera_(imaging.camera),
      frames_(options.frames),
      selection_{
          {.factorize = options.factorize,
           .interpolate = options.interpolate,
           .max_interpolation_sigma = kMaxInterpolationPx / (0.5 * (camera_.fx + camera_.fy)),
           .min_line_angle = options.min_line_angle_deg * kDegree,
           .reweighting = options.reweighting},
          options.relative_pose},
      seed_(seed),
      window_(imaging, options.matching, helper) {}

InitializationResult Rank1Initializer::Add(const InitializationFrame& frame) {
  InitializationResult result = window_.Offer(frame, frames_);
  // The window has another reference now.
  if (result.wait == InitializationStatus::kTooFewMatches) prior_.Clear();
  if (result.wait != InitializationStatus::kNone) return result;
  const std::vector<int> frames = window_.SelectFrames(frames_);
  const FeatureTracks tracks = window_.CollectTracks(frames, kMaxTracks);
  ++counts_.model_selections;
  counts_.aligned_images += window_.FollowsImages() ? 1 : 0;
  Rng rng(seed_, "initialization", static_cast<std::uint64_t>(frame.id.value));
  const ModelSelection selection = SelectModel(tracks, selection_, prior_, rng, TurnsOf(frames));
  result.wait = selection.wait;
  result.parallax_deg = selection.parallax_deg;
  if (!selection.reconstruction) return result;

  std::vector<InitialView> views{{window_.reference(), Rigid3{}}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    views.push_back({window_.frame(frames[i]), selection.reconstruction->cam_from_reference[i]});
  }
  InitialMap map = TriangulateMap(camera_,
                                  std::move(views),
                                  window_.PointObservations(frames),
                                  window_.LineObservations(frames));
  ScaleToMedianDepth(map);
  if (map.points.size() + map.lines.size() < kMinLandmarks) {
    result.wait = InitializationStatus::kInaccurate;
    return result;
  }
  result.map = std::move(map);
  return result;
}

// Returns the turns from the reference to the frames; nullopt unless a gyroscope measured all.
std::optional<MeasuredTurns> Rank1Initializer::TurnsOf(const std::vector<int>& frames) const {
  if (gyroscope_ == nullptr || !gyroscope_->agrees()) return std::nullopt;
  MeasuredTurns turns{{}, gyroscope_->covariance()};
  for (const int frame : frames) {
    const auto turn = gyroscope_->Turn(window_.reference().stamp_ns, window_.frame(frame).stamp_ns);
    if (!turn) return std::nullopt;
    turns.of_views.push_back(*turn);
  }
  return turns;
}

void Rank1Initializer::Reset() {
  window_.Reset();
  prior_.Clear();
}

}  // namespace plumbline
