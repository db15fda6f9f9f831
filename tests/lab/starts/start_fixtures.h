// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/starts/start_truth.h"
#include "plumbline/initialization/initializer.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace plumbline {

inline RectifiedCamera StartCamera() { return {500, 500, 319.5, 239.5, 0, 640, 480}; }

// A camera that goes sideways by 2 cm a frame, turning a little, before points 1.5 to 3 m away.
class SidewaysTruth : public StartTruth {
 public:
  explicit SidewaysTruth(double step = 0.02) : step_(step) {}

  std::optional<Rigid3> WorldFromCamera(int frame) const override {
    return Rigid3{ExpSo3({0, 0.004 * frame, 0}), {step_ * frame, 0.2 * step_ * frame, 0}};
  }
  std::shared_ptr<const TrueDepth> DepthAt(int frame) const override {
    std::vector<TrueDepthOfPoints::Point> points;
    for (const Eigen::Vector3d& point : PointsOf(frame)) points.push_back({point, true});
    return std::make_shared<TrueDepthOfPoints>(std::move(points), StartCamera());
  }
  Rigid3 Motion(int from, int to) const {
    return Inverse(*WorldFromCamera(to)) * *WorldFromCamera(from);
  }
  // In the camera of the frame.
  static std::vector<Eigen::Vector3d> PointsOf(int frame) {
    std::vector<Eigen::Vector3d> points;
    for (int y = 20; y < 480; y += 40) {
      for (int x = 20; x < 640; x += 40) {
        const double depth = 2.25 + 0.75 * std::sin(0.1 * x + 0.07 * y + frame);
        points.emplace_back(depth * StartCamera().Unproject({x, y}));
      }
    }
    return points;
  }
  // The map that an initializer should give, but for its scale.
  InitialMap Map(int reference, int newest, double scale) const {
    InitialMap map;
    for (const int frame : {reference, newest}) {
      InitialView view;
      view.frame.id = FrameId{frame};
      view.cam_from_world = Motion(reference, frame);
      view.cam_from_world.translation *= scale;
      map.views.push_back(view);
    }
    for (const Eigen::Vector3d& point : PointsOf(reference)) {
      map.points.push_back({scale * point, {{0, 0}, {1, 0}}});
    }
    return map;
  }

 private:
  double step_;
};

// Gives a map with the frame of this number, or never.
class FakeInitializer : public Initializer {
 public:
  FakeInitializer(std::optional<int> when, InitialMap map) : when_(when), map_(std::move(map)) {}

  InitializationResult Add(const InitializationFrame& frame) override {
    InitializationResult result;
    if (frame.id.value == when_) {
      result.map = map_;
      result.parallax_deg = 3;
    } else {
      result.wait = InitializationStatus::kTooLittleParallax;
    }
    return result;
  }
  void Reset() override {}

 private:
  std::optional<int> when_;
  InitialMap map_;
};

// A frame every 50 ms; number 3 cannot be read.
inline std::optional<InitializationFrame> BlankFrame(int index) {
  if (index == 3) return std::nullopt;
  return InitializationFrame{
      FrameId{index}, 1'000'000'000 + 50'000'000LL * index, nullptr, nullptr};
}

}  // namespace plumbline
