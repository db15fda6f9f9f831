// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/klt_tracks.h"

#include "plumbline/base/ids.h"
#include "plumbline/base/parallel.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <opencv2/video/tracking.hpp>

namespace plumbline {
namespace {

constexpr int kWindow = 21;
constexpr int kLevels = 3;
// Largest distance [px] between a point and the result of following it back.
constexpr double kMaxReturnError = 1;
constexpr std::size_t kPointsAtOnce = 32;  // points that a thread follows before it takes others

// The levels of an image, each with its derivatives, as OpenCV's flow wants them.
using FlowPyramid = std::vector<cv::Mat>;

FlowPyramid FlowPyramidOf(const GrayImage& image) {
  FlowPyramid pyramid;
  cv::buildOpticalFlowPyramid(AsMat(image), pyramid, cv::Size(kWindow, kWindow), kLevels);
  return pyramid;
}

struct Flow {
  std::vector<cv::Point2f> to;
  std::vector<unsigned char> found;
};

// Computes the flow of the places `from` from image a to image b. `guess` are places to begin with
// in b.
Flow OpticalFlow(const FlowPyramid& a,
                 const FlowPyramid& b,
                 const std::vector<cv::Point2f>& from,
                 const std::vector<cv::Point2f>& guess) {
  Flow flow{guess, {}};
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(a,
                           b,
                           from,
                           flow.to,
                           flow.found,
                           error,
                           cv::Size(kWindow, kWindow),
                           kLevels,
                           {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01},
                           cv::OPTFLOW_USE_INITIAL_FLOW);
  return flow;
}

// `size` is that of both images.
TrackedPixels FollowThereAndBack(const FlowPyramid& a,
                                 const FlowPyramid& b,
                                 const cv::Size& size,
                                 const std::vector<cv::Point2f>& from) {
  const Flow there = OpticalFlow(a, b, from, from);
  const Flow back = OpticalFlow(b, a, there.to, from);
  TrackedPixels places(from.size());
  for (std::size_t j = 0; j < from.size(); ++j) {
    const cv::Point2f& to = there.to[j];
    const bool inside = to.x >= 0 && to.y >= 0 && to.x <= static_cast<float>(size.width - 1) &&
                        to.y <= static_cast<float>(size.height - 1);
    if (there.found[j] == 0 || back.found[j] == 0 || !inside) continue;
    if (cv::norm(back.to[j] - from[j]) > kMaxReturnError) continue;
    places[j] = Eigen::Vector2d(to.x, to.y);
  }
  return places;
}

}  // namespace

KltTracks::KltTracks(std::shared_ptr<const GrayImage> image, TrackedPixels places)
    : image_(std::move(image)), places_(std::move(places)) {}

int KltTracks::alive() const {
  return static_cast<int>(std::count_if(
      places_.begin(), places_.end(), [](const auto& place) { return place.has_value(); }));
}

void KltTracks::Follow(std::shared_ptr<const GrayImage> image, HelperThread* helper) {
  std::vector<std::size_t> followed;
  std::vector<cv::Point2f> from;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    if (!places_[k]) continue;
    followed.push_back(k);
    from.emplace_back(static_cast<float>(places_[k]->x()), static_cast<float>(places_[k]->y()));
  }
  if (!followed.empty()) {
    const std::array<const GrayImage*, 2> images{image_.get(), image.get()};
    std::array<FlowPyramid, 2> pyramids;
    ParallelFor(2, helper, [&](int i) { pyramids[Index(i)] = FlowPyramidOf(*images[Index(i)]); });
    const cv::Size size(image->width(), image->height());
    ParallelForRanges(from.size(), kPointsAtOnce, helper, [&](std::size_t begin, std::size_t end) {
      const std::vector<cv::Point2f> some(from.data() + begin, from.data() + end);
      const TrackedPixels to = FollowThereAndBack(pyramids[0], pyramids[1], size, some);
      for (std::size_t j = begin; j < end; ++j) places_[followed[j]] = to[j - begin];
    });
  }
  image_ = std::move(image);
}

std::vector<int> NearestFeatures(const FrameFeatures& features,
                                 const TrackedPixels& places,
                                 double radius_px) {
  struct Pair {
    double squared_distance = 0;
    int place = 0;
    int feature = 0;
  };
  std::vector<Pair> pairs;
  std::vector<int> near;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (!places[k]) continue;
    features.PointsInWindow(*places[k], Eigen::Vector2d::Constant(radius_px), &near);
    for (const int f : near) {
      const Eigen::Vector2d& px = features.features.points[static_cast<std::size_t>(f)].px;
      const double squared = (px - *places[k]).squaredNorm();
      if (squared <= radius_px * radius_px) pairs.push_back({squared, static_cast<int>(k), f});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.squared_distance < b.squared_distance;
  });
  std::vector<int> nearest(places.size(), -1);
  std::vector<bool> taken(features.features.points.size(), false);
  for (const Pair& pair : pairs) {
    int& feature = nearest[static_cast<std::size_t>(pair.place)];
    if (feature >= 0 || taken[static_cast<std::size_t>(pair.feature)]) continue;
    feature = pair.feature;
    taken[static_cast<std::size_t>(pair.feature)] = true;
  }
  return nearest;
}

}  // namespace plumbline
