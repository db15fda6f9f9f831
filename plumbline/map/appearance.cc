// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/map/appearance.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace plumbline {
namespace {

constexpr std::size_t kMaxObservations = 12;

struct View {
  const KeyFrame* keyframe = nullptr;
  std::size_t feature = 0;
};

// The newest observations whose keyframes are in the map, the oldest of them first.
class NewestViews {
 public:
  NewestViews(const IdTable<KeyFrameId, KeyFrame>& keyframes, const Observations& observations) {
    auto observation = observations.end();
    while (observation != observations.begin() && begin_ > 0) {
      --observation;
      const KeyFrame* keyframe = keyframes.Find(observation->first);
      if (keyframe == nullptr) continue;
      views_[--begin_] = {keyframe, static_cast<std::size_t>(observation->second)};
    }
  }

  std::span<const View> views() const { return std::span(views_).subspan(begin_); }

 private:
  std::array<View, kMaxObservations> views_;  // used from begin_ on
  std::size_t begin_ = kMaxObservations;
};

Eigen::Vector3d CameraCentre(const KeyFrame& keyframe) {
  return Inverse(keyframe.frame.cam_from_world).translation;
}

Eigen::Vector3d MeanViewDirection(std::span<const View> views, const Eigen::Vector3d& position) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const View& view : views) sum += (position - CameraCentre(*view.keyframe)).normalized();
  return sum.normalized();
}

// Returns the most typical descriptor of the views. `descriptor_of` returns that of a view.
template <class DescriptorOf>
const Descriptor& MostTypical(std::span<const View> views, const DescriptorOf& descriptor_of) {
  const std::size_t count = views.size();
  std::array<const Descriptor*, kMaxObservations> descriptors{};
  std::array<std::array<int, kMaxObservations>, kMaxObservations> distances{};
  for (std::size_t i = 0; i < count; ++i) {
    descriptors[i] = &descriptor_of(views[i]);
    for (std::size_t j = 0; j < i; ++j) {
      distances[i][j] = distances[j][i] = HammingDistance(*descriptors[i], *descriptors[j]);
    }
  }
  std::size_t best = 0;
  int best_median = 257;
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = distances[i].begin();
    const auto middle = begin + static_cast<std::ptrdiff_t>((count - 1) / 2);
    std::nth_element(begin, middle, begin + static_cast<std::ptrdiff_t>(count));
    if (*middle < best_median) {
      best_median = *middle;
      best = i;
    }
  }
  return *descriptors[best];
}

}  // namespace

void RefreshAppearance(const IdTable<KeyFrameId, KeyFrame>& keyframes, MapPoint& point) {
  const NewestViews newest_views(keyframes, point.observations);
  const std::span<const View> views = newest_views.views();
  if (views.empty()) return;
  const auto feature_of = [](const View& v) -> const PointFeature& {
    return v.keyframe->frame.features().points[v.feature];
  };
  point.descriptor = MostTypical(
      views, [&](const View& v) -> const Descriptor& { return feature_of(v).descriptor; });
  point.view_direction = MeanViewDirection(views, point.position);
  const View& newest = views.back();
  point.reference_distance = (point.position - CameraCentre(*newest.keyframe)).norm();
  point.reference_octave = feature_of(newest).octave;
}

void RefreshAppearance(const IdTable<KeyFrameId, KeyFrame>& keyframes, MapLine& line) {
  const NewestViews newest_views(keyframes, line.observations);
  const std::span<const View> views = newest_views.views();
  if (views.empty()) return;
  line.descriptor = MostTypical(views, [](const View& v) -> const Descriptor& {
    return v.keyframe->frame.features().lines[v.feature].descriptor;
  });
  line.view_direction = MeanViewDirection(views, line.Interval().Midpoint());
}

}  // namespace plumbline
