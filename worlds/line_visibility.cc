// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/line_visibility.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNear = 0.02;           // metres before the camera
constexpr double kPull = 0.001;          // metres before the line
constexpr double kEndAccuracy = 0.005;   // metres
constexpr double kWidestTangent = 5.67;  // of 80 degrees

}  // namespace

// The stretch of a line within the view of a frame, as shares of the line, and its ideal image.
struct LineVisibility::Window {
  double from = 0, to = 1;
  Vector3d start, end;   // camera frame
  double length_px = 0;  // without distortion

  // Share of the line at a place on the ideal image of the window, 0 to 1.
  double ShareAt(double place) const {
    const double s = place * start.z() / ((1 - place) * end.z() + place * start.z());
    return from + s * (to - from);
  }
};

// One line in one frame: samples along its image, looked at when needed.
class LineVisibility::Sweep {
 public:
  Sweep(const LineVisibility& parent, const Segment3& line, std::size_t frame, const Window& window)
      : parent_(parent), line_(line), frame_(frame) {
    const double step = std::min(8.0, parent.limits_.min_visible_px / 5);
    const int count = 2 + static_cast<int>(window.length_px / step);
    samples_.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      samples_[static_cast<std::size_t>(i)].share = window.ShareAt(i / (count - 1.0));
    }
    stride_ = std::max(1, static_cast<int>(parent.limits_.min_visible_px / step) - 1);
  }

  // Looks for pieces that are long enough: for one at all, and for all that lie at least partly
  // outside `hull` (shares of the line), which they widen. True when there is one.
  bool Widen(Stretch* hull);

 private:
  struct Sample {
    double share = 0;
    std::optional<std::optional<Vector2d>> px;  // outer: looked at; inner: seen, where
  };

  // Pixel of a visible position on the line.
  std::optional<Vector2d> Look(double share) const;
  const std::optional<Vector2d>& At(int i) {
    Sample& sample = samples_[static_cast<std::size_t>(i)];
    if (!sample.px) sample.px = Look(sample.share);
    return *sample.px;
  }
  double Share(int i) const { return samples_[static_cast<std::size_t>(i)].share; }
  // Last place seen on the way from a sample that is seen to its neighbour that is not.
  std::pair<double, Vector2d> Border(int seen, int hidden);
  double LengthPx(int first, int last);

  const LineVisibility& parent_;
  const Segment3& line_;
  std::size_t frame_;
  std::vector<Sample> samples_;
  int stride_ = 1;
};

std::optional<Vector2d> LineVisibility::Sweep::Look(double share) const {
  const Vector3d point = line_.start + share * (line_.end - line_.start);
  auto px = parent_.camera_.Project(parent_.camera_from_world_[frame_] * point);
  if (!px || !parent_.camera_.Contains(*px)) return std::nullopt;
  const Vector3d& eye = parent_.views_[frame_].world_from_camera.translation;
  const Vector3d before = point + kPull * (eye - point).normalized();
  if (!parent_.sees_(eye, before, frame_)) return std::nullopt;
  return px;
}

std::pair<double, Vector2d> LineVisibility::Sweep::Border(int seen, int hidden) {
  double inside = Share(seen), outside = Share(hidden);
  Vector2d px = *At(seen);
  const double accuracy = kEndAccuracy / line_.Length();
  for (int i = 0; i < 12 && std::abs(outside - inside) > accuracy; ++i) {
    const double middle = 0.5 * (inside + outside);
    if (const auto there = Look(middle)) {
      inside = middle;
      px = *there;
    } else {
      outside = middle;
    }
  }
  return {inside, px};
}

double LineVisibility::Sweep::LengthPx(int first, int last) {
  double length = 0;
  for (int i = first; i < last; ++i) length += (*At(i + 1) - *At(i)).norm();
  return length;
}

bool LineVisibility::Sweep::Widen(Stretch* hull) {
  const int count = static_cast<int>(samples_.size());
  const double enough = parent_.limits_.min_visible_px;
  bool found = false;
  int begin = 0;  // samples before it are done with
  while (begin < count) {
    // A piece that is long enough holds `stride_` samples in a row: it cannot slip through.
    const int probe = std::min(begin + stride_ - 1, count - 1);
    const bool known = Share(probe) >= hull->from && Share(probe) <= hull->to;
    if ((found && known) || !At(probe)) {
      begin = probe + 1;
      continue;
    }
    int first = probe, last = probe;
    while (first > begin && At(first - 1)) --first;
    double length = LengthPx(first, last);
    while (last + 1 < count && At(last + 1)) {
      if (length >= enough && Share(last) > hull->from && Share(last) < hull->to) break;
      length += (*At(last + 1) - *At(last)).norm();
      ++last;
    }
    begin = last + 1;
    double from = Share(first), to = Share(last);
    if (first > 0 && (length < enough || from < hull->from) && !At(first - 1)) {
      const auto [share, px] = Border(first, first - 1);
      length += (px - *At(first)).norm();
      from = share;
    }
    if (last + 1 < count && (length < enough || to > hull->to) && !At(last + 1)) {
      const auto [share, px] = Border(last, last + 1);
      length += (px - *At(last)).norm();
      to = share;
    }
    if (length < enough) continue;
    found = true;
    *hull = {std::min(hull->from, from), std::max(hull->to, to)};
  }
  return found;
}

LineVisibility::LineVisibility(const Camera& camera,
                               std::span<const TimedView> views,
                               const SightTest& sees,
                               const VisibilityLimits& limits)
    : camera_(camera), views_(views), sees_(sees), limits_(limits) {
  PLUMBLINE_CHECK(limits.min_visible_px > 0, "least visible length");
  for (const TimedView& view : views) {
    camera_from_world_.push_back(Inverse(view.world_from_camera));
    rotations_.push_back(camera_from_world_.back().rotation.toRotationMatrix());
  }
  low_ = Vector2d::Constant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  const auto add = [this](double x, double y) {
    const Vector2d border(x, y);
    const auto ray = camera_.Unproject(border);
    // Beyond the end of the lens, or beside the camera: as far as lines count there.
    const Vector2d middle(0.5 * (camera_.width() - 1), 0.5 * (camera_.height() - 1));
    const Vector2d end =
        ray ? Vector2d(ray->head<2>()) : kWidestTangent * (border - middle).normalized();
    low_ = low_.cwiseMin(end).cwiseMax(-kWidestTangent);
    high_ = high_.cwiseMax(end).cwiseMin(kWidestTangent);
  };
  for (int x = 0; x < camera.width(); ++x) {
    for (const int y : {0, camera.height() - 1}) add(x, y);
  }
  for (int y = 0; y < camera.height(); ++y) {
    for (const int x : {0, camera.width() - 1}) add(x, y);
  }
}

LineVisibility::~LineVisibility() = default;

std::optional<LineVisibility::Window> LineVisibility::FindWindow(const Segment3& line,
                                                                 std::size_t frame) const {
  const Eigen::Matrix3d& rotation = rotations_[frame];
  const Vector3d& translation = camera_from_world_[frame].translation;
  const Vector3d a = rotation * line.start + translation, b = rotation * line.end + translation;
  // Distances from the five planes around the view, positive inside.
  const auto distances = [this](const Vector3d& p) {
    return std::array{p.z() - kNear,
                      p.x() - low_.x() * p.z(),
                      high_.x() * p.z() - p.x(),
                      p.y() - low_.y() * p.z(),
                      high_.y() * p.z() - p.y()};
  };
  const auto at_a = distances(a), at_b = distances(b);
  Window window;
  for (std::size_t k = 0; k < at_a.size(); ++k) {
    if (at_a[k] < 0 && at_b[k] < 0) return std::nullopt;
    if (at_a[k] < 0) window.from = std::max(window.from, at_a[k] / (at_a[k] - at_b[k]));
    if (at_b[k] < 0) window.to = std::min(window.to, at_a[k] / (at_a[k] - at_b[k]));
  }
  if (window.from >= window.to) return std::nullopt;
  window.start = a + window.from * (b - a);
  window.end = a + window.to * (b - a);
  const Vector2d on_image =
      window.end.head<2>() / window.end.z() - window.start.head<2>() / window.start.z();
  window.length_px =
      math::Hypot(camera_.intrinsics().fx * on_image.x(), camera_.intrinsics().fy * on_image.y());
  // Distortion stretches no line of a camera in use by half.
  if (window.length_px < limits_.min_visible_px / 1.5) return std::nullopt;
  return window;
}

std::optional<TrueLine> LineVisibility::Trim(const TrueLine& line,
                                             const std::vector<bool>& present) const {
  PLUMBLINE_CHECK(present.empty() || present.size() == views_.size(), "a flag for each frame");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Stretch hull{kInfinity, -kInfinity};
  std::vector<FrameRange> frames;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (!present.empty() && !present[i]) continue;
    const auto window = FindWindow(line.segment, i);
    if (!window || !Sweep(*this, line.segment, i, *window).Widen(&hull)) continue;
    const int frame = static_cast<int>(i);
    if (!frames.empty() && frames.back().last + 1 == frame) {
      frames.back().last = frame;
    } else {
      frames.push_back({frame, frame});
    }
  }
  if (frames.empty()) return std::nullopt;
  const Vector3d way = line.segment.end - line.segment.start;
  return TrueLine{{line.segment.start + hull.from * way, line.segment.start + hull.to * way},
                  line.kind,
                  frames};
}

}  // namespace plumbline
