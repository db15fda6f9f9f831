// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/statistics.h"
#include "plumbline/geometry/epipolar.h"
#include "plumbline/geometry/triangulation.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/landmark_creation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

namespace plumbline {
namespace {

// The search along the epipolar line covers depths between these two factors times the median
// depth, in both views. Factors are dimensionless, because a single camera has no metric scale.
constexpr double kNearestDepth = 0.05;
constexpr double kFarthestDepth = 1e4;
constexpr double kEpipolarChi2 = 3.84;  // 95 %, one degree of freedom
constexpr double kDepthSigmas = 3;      // range of a measured but poor depth, in deviations
// Largest ratio of the sizes that octave and distance give a point in the two views.
constexpr double kMaxScaleRatio = 1.8;
// The descriptors of the two views may differ by this Hamming distance, of 256 bits, and by this
// ratio to the distance of the second best. Both are stricter than in tracking, since there is no
// pose that a wrong landmark would contradict.
constexpr int kMaxDistance = 50;
constexpr double kMaxRatio = 0.8;
// Least angle between the two rays of a new point; a smaller one leaves its depth open.
constexpr double kMinParallax = 0.3 * std::numbers::pi / 180;

// The piece of the epipolar line in the second image that a point of the first image must lie on.
struct SearchWindow {
  Eigen::Vector2d centre;
  Eigen::Vector2d radius;
};

std::optional<SearchWindow> EpipolarWindow(const RectifiedCamera& camera,
                                           const Rigid3& b_from_a,
                                           const PointFeature& feature,
                                           const std::optional<Disparity>& disparity,
                                           double median_depth,
                                           double slack_px) {
  const Eigen::Vector3d ray = camera.Unproject(feature.px);
  const double nearest = kNearestDepth * median_depth;
  double near = nearest;
  double far = kFarthestDepth * median_depth;
  if (disparity) {
    const double high = disparity->px + kDepthSigmas * disparity->sigma_px;
    const double low = disparity->px - kDepthSigmas * disparity->sigma_px;
    near = std::max(near, camera.DepthFromDisparity(high));
    if (low > 0) far = std::max(near, camera.DepthFromDisparity(low));
  }
  // The depth in the second view is slope * depth + offset; it must be large enough there, too.
  const double slope = (b_from_a.rotation * ray).z();
  const double offset = b_from_a.translation.z();
  if (slope > 0) near = std::max(near, (nearest - offset) / slope);
  if (slope < 0) far = std::min(far, (nearest - offset) / slope);
  const Eigen::Vector3d p = b_from_a * (near * ray);
  const Eigen::Vector3d q = b_from_a * (far * ray);
  if (near > far || std::min(p.z(), q.z()) < 0.5 * nearest) return std::nullopt;
  const Eigen::Vector2d a = camera.Project(p);
  const Eigen::Vector2d b = camera.Project(q);
  const Eigen::Vector2d slack(slack_px, slack_px);
  return SearchWindow{0.5 * (a + b), 0.5 * (a - b).cwiseAbs() + slack};
}

// The point features of a frame that show no landmark, ordered by image cell.
class FreePoints {
 public:
  FreePoints(const RectifiedCamera& camera, const Frame& frame) : points_(frame.features().points) {
    std::vector<Eigen::Vector2d> positions;
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
      if (frame.points[i].valid()) continue;
      positions.push_back(points_[i].px);
      features_.push_back(i);
    }
    grid_ = PointGrid(positions, camera.width, camera.height);
  }

  // Returns the indices of features in the frame, in the order of the cells.
  const std::vector<std::size_t>& InWindow(const SearchWindow& window) {
    const auto place_of = [&](int i) -> const auto& {
      return points_[features_[static_cast<std::size_t>(i)]].px;
    };
    grid_.InWindow(window.centre, window.radius, place_of, &places_);
    found_.clear();
    for (const int place : places_) found_.push_back(features_[static_cast<std::size_t>(place)]);
    return found_;
  }

 private:
  const std::vector<PointFeature>& points_;
  std::vector<std::size_t> features_;  // feature of each place in the grid
  PointGrid grid_;
  std::vector<int> places_;
  std::vector<std::size_t> found_;
};

// Matches the features without landmark of one keyframe with those of another.
class PairSearch {
 public:
  PairSearch(const RectifiedCamera& camera, const Frame& a, const Frame& b, double median_depth)
      : camera_(camera),
        a_(a),
        b_(b),
        median_depth_(median_depth),
        b_from_a_(b.cam_from_world * Inverse(a.cam_from_world)),
        F_ba_(FundamentalMatrix(camera, b_from_a_)),
        free_in_b_(camera, b) {}

  // Returns the index of the feature of b that matches feature i of a.
  std::optional<std::size_t> Find(std::size_t i, const std::vector<bool>& taken_in_b) {
    const PointFeature& feature = a_.features().points[i];
    const auto window = EpipolarWindow(camera_,
                                       b_from_a_,
                                       feature,
                                       a_.features().point_disparity[i],
                                       median_depth_,
                                       2 * feature.sigma_px);
    if (!window) return std::nullopt;
    const Eigen::Vector3d line = F_ba_ * feature.px.homogeneous();
    const double norm2 = line.head<2>().squaredNorm();
    int best = kMaxDistance + 1;
    int second = 257;
    std::optional<std::size_t> match;
    for (const std::size_t j : free_in_b_.InWindow(*window)) {
      if (taken_in_b[j]) continue;
      const PointFeature& other = b_.features().points[j];
      const double distance = line.dot(other.px.homogeneous());
      if (distance * distance > kEpipolarChi2 * other.sigma_px * other.sigma_px * norm2) continue;
      const int hamming = HammingDistance(feature.descriptor, other.descriptor);
      if (hamming < best) {
        second = best;
        best = hamming;
        match = j;
      } else {
        second = std::min(second, hamming);
      }
    }
    if (!match || best > kMaxDistance || best > kMaxRatio * second) return std::nullopt;
    return match;
  }

  std::optional<Eigen::Vector3d> Triangulate(std::size_t i, std::size_t j) const {
    const std::array<PointView, 2> views{View(a_, i), View(b_, j)};
    const auto result = TriangulatePoint(camera_, views, {.min_angle = kMinParallax});
    if (!result || result->chi2 > Chi2Limit95(result->residuals - 3)) return std::nullopt;
    const Eigen::Vector3d& position = result->position;
    const double distance_a = (a_.cam_from_world * position).norm();
    const double distance_b = (b_.cam_from_world * position).norm();
    const double scale_ratio = views[0].sigma_px * distance_a / (views[1].sigma_px * distance_b);
    if (scale_ratio > kMaxScaleRatio || scale_ratio < 1 / kMaxScaleRatio) return std::nullopt;
    return position;
  }

 private:
  static PointView View(const Frame& frame, std::size_t i) {
    const PointFeature& feature = frame.features().points[i];
    return {
        frame.cam_from_world, feature.px, feature.sigma_px, frame.features().point_disparity[i]};
  }

  const RectifiedCamera& camera_;
  const Frame& a_;
  const Frame& b_;
  double median_depth_;
  Rigid3 b_from_a_;
  Eigen::Matrix3d F_ba_;
  FreePoints free_in_b_;
};

// Returns the median depth of the points of a keyframe; nullopt if it has none, or if most of them
// lie behind it.
std::optional<double> MedianDepth(const Map& map, const Frame& frame) {
  std::vector<double> depths;
  for (const PointId id : frame.points) {
    if (id.valid()) depths.push_back((frame.cam_from_world * map.Find(id)->position).z());
  }
  const double median = UpperMedian(depths);
  return median > 0 ? std::optional(median) : std::nullopt;
}

MapPoint NewPoint(const Frame& frame, std::size_t i, const Eigen::Vector3d& position) {
  const Eigen::Vector3d from_camera = position - Inverse(frame.cam_from_world).translation;
  MapPoint point;
  point.position = position;
  point.view_direction = from_camera.normalized();
  point.reference_distance = from_camera.norm();
  point.reference_octave = frame.features().points[i].octave;
  point.descriptor = frame.features().points[i].descriptor;
  return point;
}

}  // namespace

MapEdit CreatePointsFromViews(const Map& map,
                              const CameraAndPyramid& imaging,
                              KeyFrameId id,
                              const LandmarkCreationOptions& options) {
  const Frame& frame = map.Find(id)->frame;
  const std::optional<double> median_depth = MedianDepth(map, frame);
  if (!median_depth) return {};
  std::vector<bool> done(frame.points.size());
  for (std::size_t i = 0; i < done.size(); ++i) done[i] = frame.points[i].valid();
  MapEdit edit;
  PointId next = map.NextPointId();
  for (const auto& neighbour : ClosestCovisible(map, id, options.neighbours)) {
    const Frame& other = map.Find(neighbour.id)->frame;
    PairSearch search(imaging.camera, frame, other, *median_depth);
    std::vector<bool> taken(other.points.size(), false);
    for (std::size_t i = 0; i < done.size(); ++i) {
      if (done[i]) continue;
      const auto j = search.Find(i, taken);
      const auto position = j ? search.Triangulate(i, *j) : std::nullopt;
      if (!position) continue;
      done[i] = true;
      taken[*j] = true;
      MapPoint point = NewPoint(frame, i, *position);
      point.id = next;
      point.created_by = id;
      point.observations = {{id, static_cast<int>(i)}, {neighbour.id, static_cast<int>(*j)}};
      edit.push_back(edit::AddPoint{std::move(point)});
      ++next.value;
    }
  }
  return edit;
}

}  // namespace plumbline
