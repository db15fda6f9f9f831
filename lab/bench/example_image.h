// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/bench/sequence_images.h"
#include "plumbline/features/valid_region.h"

#include "tests/features/render.h"
#include <cstdlib>
#include <string>
#include <utility>

namespace plumbline::bench {

// 752x480: the middle image of MH_01 from the folder PLUMBLINE_DATA, otherwise synthetic squares.
struct ExampleImage {
  std::string name;
  GrayImage image;
  ValidRegion valid;
};

inline ExampleImage MakeExampleImage() {
  if (const char* folder = std::getenv("PLUMBLINE_DATA")) {
    if (auto images = ReadImages(folder, kSequences[0], 1)) {
      return {"MH_01", std::move(images->left.at(0)), ValidRegion(images->mask)};
    }
  }
  const SquareTexture texture(60, 188, 120);
  const GrayImage image =
      Render(752, 480, [&](const Eigen::Vector2d& px) { return texture(0.25 * px); });
  return {"squares", image, ValidRegion(image.width(), image.height())};
}

}  // namespace plumbline::bench
