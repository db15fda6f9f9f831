// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/point_alignment.h"

#include "plumbline/base/elementary.h"
#include "plumbline/features/image_patch.h"
#include "plumbline/features/single_precision.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumbline {
namespace {

constexpr int kRadius = KeyFramePatches::kRadius;
constexpr int kSamples = KeyFramePatches::kSamples;
constexpr int kWideSide = KeyFramePatches::kWideSide;
constexpr PatchShiftLimits kLimits{.converged_px = 0.03};
constexpr double kMinRoundness = 0.15;
// Views whose areas differ by more have too little in common to be compared.
constexpr double kMaxAreaRatio = 50;
// Deviation of the place of a corner, in pixels of its octave. The shifts that alignment finds
// suggest 0.3 px. Corners count for more, since errors of alignment are common to the points of a
// surface, while those of corners are not (lab/notes/single-camera.md).
constexpr double kCornerSigma = 0.2;

const PyramidLevel& LevelOf(const ImagePyramid& pyramid, int level) {
  return pyramid[static_cast<std::size_t>(
      std::clamp(level, 0, static_cast<int>(pyramid.size()) - 1))];
}

// Writes the samples of a patch in steps of its octave, by bilinear interpolation; zeros if the
// patch leaves the image. All samples have the same sub-pixel position, which takes a fraction of
// the time of SamplePatch; a thousand corners of each keyframe need it.
void TakePatch(const PointFeature& feature, const ImagePyramid& pyramid, std::uint8_t* row) {
  const PyramidLevel& level = LevelOf(pyramid, feature.octave);
  const GrayImage& image = level.image;
  const Eigen::Vector2d corner =
      level.FromFull(feature.px) - Eigen::Vector2d::Constant(kRadius + 1);
  std::fill_n(row, kSamples, std::uint8_t{0});
  if (!(corner.minCoeff() >= 0) || !(corner.x() < image.width() - kWideSide) ||
      !(corner.y() < image.height() - kWideSide)) {
    return;
  }
  const int x = static_cast<int>(corner.x());
  const int y = static_cast<int>(corner.y());
  const auto fx = static_cast<float>(corner.x() - x);
  const auto fy = static_cast<float>(corner.y() - y);
  for (int v = 0; v < kWideSide; ++v) {
    const std::uint8_t* above = image.row(y + v) + x;
    const std::uint8_t* below = image.row(y + v + 1) + x;
    for (int u = 0; u < kWideSide; ++u) {
      const float upper =
          (1 - fx) * static_cast<float>(above[u]) + fx * static_cast<float>(above[u + 1]);
      const float lower =
          (1 - fx) * static_cast<float>(below[u]) + fx * static_cast<float>(below[u + 1]);
      *row++ = static_cast<std::uint8_t>((1 - fy) * upper + fy * lower + 0.5F);
    }
  }
}

// Returns the shift from a corner on which corner and patch agree best, each weighed by its
// covariance.
Eigen::Vector2d WeighedWithCorner(const PatchPlace& place) {
  const Eigen::Matrix2d corner = Eigen::Matrix2d::Identity() * (kCornerSigma * kCornerSigma);
  const Eigen::Matrix2d both = corner + place.covariance;
  return corner * both.inverse() * place.shift;
}

std::optional<ImagePatch> PatchOf(const KeyFramePatches& patches, std::size_t feature) {
  const std::uint8_t* row = patches.samples.row(static_cast<int>(feature));
  PatchSamples wide(kSamples);
  for (int i = 0; i < kSamples; ++i) wide(i) = row[i];
  return MakePatch(wide, kRadius);
}

}  // namespace

std::shared_ptr<const FrameFeatures> PointAligner::Align(const Map& map,
                                                         KeyFrameId id,
                                                         const ImagePyramid& pyramid) {
  const Frame& frame = map.Find(id)->frame;
  Features features = MeasuredFeatures(*frame.indexed);
  bool moved = false;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    if (!frame.points[i].valid()) continue;
    const MapPoint& point = *map.Find(frame.points[i]);
    const std::optional<Reference> reference = OldestReference(map, point);
    if (!reference) continue;
    Eigen::Vector2d& px = features.points[i].px;
    const auto found = Find(*reference, point.position, frame, px, pyramid);
    if (!found) continue;
    px = InSinglePrecision(*found);
    moved = true;
  }
  Remember(id, features, pyramid);
  return moved ? IndexFeatures(camera_, std::move(features)) : nullptr;
}

// Returns the observation of a point by the oldest keyframe whose patches are kept. It is never the
// keyframe that is being aligned, whose patches are taken afterwards.
std::optional<PointAligner::Reference> PointAligner::OldestReference(const Map& map,
                                                                     const MapPoint& point) const {
  for (const KeyFramePatches& patches : recent_) {
    const auto observation = point.observations.find(patches.keyframe);
    if (observation == point.observations.end()) continue;
    if (observation->second >= patches.samples.height()) continue;
    return Reference{&map.Find(patches.keyframe)->frame,
                     static_cast<std::size_t>(observation->second),
                     &patches};
  }
  return std::nullopt;
}

std::optional<Eigen::Vector2d> PointAligner::Find(const Reference& reference,
                                                  const Eigen::Vector3d& position,
                                                  const Frame& frame,
                                                  const Eigen::Vector2d& px,
                                                  const ImagePyramid& pyramid) const {
  const Rigid3& reference_from_world = reference.frame->cam_from_world;
  const Eigen::Vector3d before = reference_from_world * position;
  const Eigen::Vector3d now = frame.cam_from_world * position;
  if (!(before.z() > 0) || !(now.z() > 0)) return std::nullopt;
  // The derivative of the motion in the image, for a surface that faces the older camera.
  const Eigen::Matrix3d turn =
      (frame.cam_from_world.rotation * reference_from_world.rotation.conjugate())
          .toRotationMatrix();
  Eigen::Matrix<double, 2, 3> projection;
  projection << camera_.fx, 0, -camera_.fx * now.x() / now.z(), 0, camera_.fy,
      -camera_.fy * now.y() / now.z();
  const Eigen::Vector2d to_space(before.z() / camera_.fx, before.z() / camera_.fy);
  const Eigen::Matrix2d motion = projection * turn.leftCols<2>() * to_space.asDiagonal() / now.z();
  const double area = motion.determinant();
  if (!(area * kMaxAreaRatio > 1) || !(area < kMaxAreaRatio)) return std::nullopt;
  const auto patch = PatchOf(*reference.patches, reference.feature);
  if (!patch || !patch->IsRound(kMinRoundness)) return std::nullopt;
  const int octave = reference.frame->features().points[reference.feature].octave;
  const Eigen::Vector2d& step = LevelOf(pyramid, octave).scale;  // all images have the same size
  const double shrink = std::max(step.x() * std::sqrt(area), 1.0);
  const double octave_now = math::Log(shrink) / math::Log(octave_scale_);
  const PyramidLevel& level = LevelOf(pyramid, static_cast<int>(std::lround(octave_now)));
  const Eigen::Matrix2d axes = level.scale.cwiseInverse().asDiagonal() * motion * step.asDiagonal();
  const Eigen::Vector2d corner = level.FromFull(px);
  const auto found = AlignShift(*patch, level.image, corner, axes, kLimits);
  if (!found) return std::nullopt;
  return level.ToFull(corner + axes * WeighedWithCorner(*found));
}

void PointAligner::Remember(KeyFrameId id, const Features& features, const ImagePyramid& pyramid) {
  const auto count = static_cast<int>(features.points.size());
  if (count == 0) return;
  KeyFramePatches patches{id, GrayImage(kSamples, count)};
  for (int i = 0; i < count; ++i) {
    TakePatch(features.points[static_cast<std::size_t>(i)], pyramid, patches.samples.row(i));
  }
  recent_.push_back(std::move(patches));
  if (recent_.size() > kRecent) recent_.pop_front();
}

}  // namespace plumbline
