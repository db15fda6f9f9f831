// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/parallel.h"
#include "plumbline/features/extractor.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"
#include "plumbline/slam/extracted_frame.h"

#include <memory>
#include <optional>

namespace plumbline {

// Throws InputError if an image is missing that the calibration requires.
void CheckImages(const Calibration& calibration, const SensorFrame& frame);

// Extracts features from images: the stage that needs no map and no earlier frame.
class FrontEnd {
 public:
  // Throws InputError for an unusable calibration.
  FrontEnd(const Calibration& calibration, const FeatureOptions& features);

  // Rectifies the images and extracts features, none where the masks of the frame are black. Throws
  // InputError if an image is missing (CheckImages) or its size differs from the calibration.
  // Thread-safe; the same frame gives the same features. With `shed`, fewer lines or points are
  // extracted.
  ExtractedFrame Extract(SensorFrame frame,
                         StageClock clock = {},
                         LoadLevel shed = LoadLevel::kNothing) const;

  // Returns the features with the positions of the lines in the right image, which new line
  // landmarks need. Features that have these positions already are returned unchanged. The features
  // may have been corrected since their extraction. `shed` is that of Extract.
  std::shared_ptr<const FrameFeatures> WithRightLines(
      const RectifiedFrame& images,
      LoadLevel shed,
      const std::shared_ptr<const FrameFeatures>& indexed) const;

  const Rectifier& rectifier() const { return rectifier_; }
  // The thread that shares the work on images; null if features are extracted in one thread.
  HelperThread* helper() const { return helper_.get(); }

 private:
  // The masks of a frame, where it has any.
  struct FrameMasks {
    std::optional<ValidRegion> left, right;
  };
  static FrameMasks MasksOf(const RectifiedFrame& images);
  // The result points to both arguments.
  FeatureInput InputOf(const RectifiedFrame& images, const FrameMasks& masks) const;

  FeatureOptions options_;
  std::unique_ptr<HelperThread> helper_;
  Rectifier rectifier_;
  ValidRegion left_valid_;
  ValidRegion right_valid_;
};

}  // namespace plumbline
