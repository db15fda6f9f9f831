// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/map_correction.h"

#include <optional>

namespace plumbline {
namespace {

// Returns the similarity of the world that moves a keyframe, with all that is around it, from its
// place before the correction to that after it.
Similarity3 MotionOf(const MapCorrection::KeyFramePlace& place) {
  const Rigid3 world_from_after = Inverse(place.after);
  const Similarity3 scaled{place.scale, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()};
  return ToSimilarity(world_from_after) * scaled * ToSimilarity(place.before);
}

bool SamePlace(const Rigid3& a, const Rigid3& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation == b.translation;
}

// Finds the pose of the keyframe itself or of its nearest ancestor in the correction; nullptr if it
// has none.
const MapCorrection::KeyFramePlace* PlaceFor(const MapCorrection& correction,
                                             const Map& today,
                                             KeyFrameId id) {
  while (id.valid()) {
    const auto place = correction.keyframes.find(id);
    if (place != correction.keyframes.end()) return &place->second;
    id = today.ParentOf(id);
  }
  return nullptr;
}

}  // namespace

MapEdit RebaseCorrection(const MapCorrection& correction, const Map& today) {
  if (correction.empty()) return {};
  edit::MoveKeyFrames motion;
  MapEdit exact;
  for (const auto& [id, keyframe] : today.keyframes()) {
    const auto* place = PlaceFor(correction, today, id);
    if (place == nullptr) continue;
    motion.new_from_old.emplace(id, MotionOf(*place));
    if (correction.keyframes.contains(id) &&
        SamePlace(keyframe.frame.cam_from_world, place->before)) {
      exact.push_back(edit::SetPose{id, place->after});
    }
  }
  for (const auto& [id, place] : correction.points) {
    const MapPoint* point = today.Find(id);
    if (point == nullptr || point->position != place.before) continue;
    exact.push_back(edit::MovePoint{id, place.after});
  }
  MapEdit edit{std::move(motion)};
  if (correction.lens) {
    edit.push_back(edit::CorrectFeatures{{today.correction().stereo, *correction.lens}});
  }
  edit.insert(edit.end(), exact.begin(), exact.end());
  edit.insert(edit.end(), correction.outliers.begin(), correction.outliers.end());
  return edit;
}

}  // namespace plumbline
