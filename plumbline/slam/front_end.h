// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/helper_thread.h"
#include "plumbline/features/extractor.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"
#include "plumbline/slam/extracted_frame.h"

#include <memory>

namespace plumbline {

// Turns images into features: the stage that needs no map and no earlier frame.
class FrontEnd {
 public:
  // Throws InputError for a calibration that cannot be used.
  FrontEnd(const Calibration& calibration, const FeatureOptions& features);

  // Rectifies the images and measures features. Throws InputError when an image has another size
  // than the calibration says. Thread-safe; the same frame gives the same features. With `shed`,
  // fewer lines or points are measured.
  ExtractedFrame Measure(SensorFrame frame,
                         StageClock clock = {},
                         LoadLevel shed = LoadLevel::kNothing) const;

  // Returns the features together with the places of the lines in the right image, which are needed
  // to make landmarks of lines. Features that have these places already are returned as they are.
  // The features may have been corrected since they were measured. `shed` is that of Measure.
  std::shared_ptr<const FrameFeatures> WithRightLines(
      const RectifiedFrame& images,
      LoadLevel shed,
      const std::shared_ptr<const FrameFeatures>& indexed) const;

  const Rectifier& rectifier() const { return rectifier_; }
  // The thread that shares the work on images; null where features are measured in one thread.
  HelperThread* helper() const { return helper_.get(); }

 private:
  FeatureInput InputOf(const RectifiedFrame& images) const;

  FeatureOptions options_;
  std::unique_ptr<HelperThread> helper_;
  Rectifier rectifier_;
  ValidRegion left_valid_;
  ValidRegion right_valid_;
};

}  // namespace plumbline
