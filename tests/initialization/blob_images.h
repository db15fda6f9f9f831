// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/initializer.h"

#include "tests/support/synthetic_world.h"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace plumbline::testing {

// A world of soft blobs on dark ground, all of their own size and brightness: corners for KLT whose
// places in the image are known.
struct Blobs {
  SyntheticWorld world = MakeSyntheticWorld(900, 0);

  std::shared_ptr<const GrayImage> Image(const Rigid3& pose) const {
    std::vector<double> light(static_cast<std::size_t>(world.camera.width) *
                                  static_cast<std::size_t>(world.camera.height),
                              30);
    for (std::size_t i = 0; i < world.points.size(); ++i) {
      const Eigen::Vector3d p = pose * world.points[i].position;
      if (p.z() > 0.5) Draw(world.camera.Project(p), i, light);
    }
    auto image = std::make_shared<GrayImage>(world.camera.width, world.camera.height, 0);
    for (int y = 0; y < image->height(); ++y) {
      for (int x = 0; x < image->width(); ++x) {
        const double value = light[Place(x, y)];
        image->row(y)[x] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
      }
    }
    return image;
  }

 private:
  std::size_t Place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(world.camera.width) +
           static_cast<std::size_t>(x);
  }
  void Draw(const Eigen::Vector2d& px, std::size_t index, std::vector<double>& light) const {
    const double radius = 2 + 0.5 * static_cast<double>(index % 5);
    const double height = index % 2 == 0 ? 180 : -25;
    for (int y = static_cast<int>(px.y()) - 12; y <= px.y() + 12; ++y) {
      for (int x = static_cast<int>(px.x()) - 12; x <= px.x() + 12; ++x) {
        if (x < 0 || y < 0 || x >= world.camera.width || y >= world.camera.height) continue;
        const double squared = (Eigen::Vector2d(x, y) - px).squaredNorm();
        light[Place(x, y)] += height * std::exp(-squared / (2 * radius * radius));
      }
    }
  }
};

inline InitializationFrame FrameAt(const Blobs& blobs, const Rigid3& pose, int index, Rng& rng) {
  const SyntheticFrame frame =
      Sense(blobs.world, pose, {.depth = false, .noise = 0.3, .missed = 0}, rng);
  return {FrameId{index}, index * 50'000'000, frame.indexed, blobs.Image(pose)};
}

}  // namespace plumbline::testing
