// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/map_file/map_io.h"

#include "tests/support/misfits.h"
#include <filesystem>

#include <gtest/gtest.h>

namespace plumbline {

// Expects that at most 0.5 % of the observations of points, and of lines, in a saved map are
// further than 5 sigma from their landmarks.
inline void ExpectLandmarksFit(const std::filesystem::path& map_file) {
  constexpr double kMaxShare = 0.005;
  const SavedAtlas saved = LoadAtlas(map_file);
  for (const auto& [id, map] : saved.atlas.maps()) {
    const Misfits misfits = CountMisfits(map, saved.context.camera);
    EXPECT_GT(misfits.points.all + misfits.lines.all, 0);
    EXPECT_LE(misfits.points.Share(), kMaxShare) << misfits.points.all << " observations of points";
    EXPECT_LE(misfits.lines.Share(), kMaxShare) << misfits.lines.all << " observations of lines";
  }
}

}  // namespace plumbline
