// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/appearance.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumbline {
namespace {

constexpr std::size_t kMaxObservations = 12;

struct View {
  const KeyFrame* keyframe;
  std::size_t feature;
};

// The newest observations whose keyframes are in the map, oldest first.
std::vector<View> NewestViews(const std::map<KeyFrameId, KeyFrame>& keyframes,
                              const Observations& observations) {
  std::vector<View> views;
  for (const auto& [id, feature] : observations) {
    const auto it = keyframes.find(id);
    if (it != keyframes.end()) views.push_back({&it->second, static_cast<std::size_t>(feature)});
  }
  if (views.size() > kMaxObservations) {
    views.erase(views.begin(), views.end() - static_cast<std::ptrdiff_t>(kMaxObservations));
  }
  return views;
}

Eigen::Vector3d CameraCentre(const KeyFrame& keyframe) {
  return Inverse(keyframe.frame.cam_from_world).translation;
}

Eigen::Vector3d MeanViewDirection(const std::vector<View>& views, const Eigen::Vector3d& position) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const View& view : views) sum += (position - CameraCentre(*view.keyframe)).normalized();
  return sum.normalized();
}

Descriptor MostTypical(const std::vector<Descriptor>& descriptors) {
  std::size_t best = 0;
  int best_median = 257;
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    std::vector<int> distances;
    distances.reserve(descriptors.size());
    for (const Descriptor& other : descriptors) {
      distances.push_back(HammingDistance(descriptors[i], other));
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>((distances.size() - 1) / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    if (*middle < best_median) {
      best_median = *middle;
      best = i;
    }
  }
  return descriptors[best];
}

}  // namespace

void RefreshAppearance(const std::map<KeyFrameId, KeyFrame>& keyframes, MapPoint& point) {
  const std::vector<View> views = NewestViews(keyframes, point.observations);
  if (views.empty()) return;
  std::vector<Descriptor> descriptors;
  descriptors.reserve(views.size());
  for (const View& v : views) {
    descriptors.push_back(v.keyframe->frame.features().points[v.feature].descriptor);
  }
  point.descriptor = MostTypical(descriptors);
  point.view_direction = MeanViewDirection(views, point.position);
  const View& newest = views.back();
  point.reference_distance = (point.position - CameraCentre(*newest.keyframe)).norm();
  point.reference_octave = newest.keyframe->frame.features().points[newest.feature].octave;
}

void RefreshAppearance(const std::map<KeyFrameId, KeyFrame>& keyframes, MapLine& line) {
  const std::vector<View> views = NewestViews(keyframes, line.observations);
  if (views.empty()) return;
  std::vector<Descriptor> descriptors;
  descriptors.reserve(views.size());
  for (const View& v : views) {
    descriptors.push_back(v.keyframe->frame.features().lines[v.feature].descriptor);
  }
  line.descriptor = MostTypical(descriptors);
  line.view_direction = MeanViewDirection(views, line.Interval().Midpoint());
}

}  // namespace plumbline
