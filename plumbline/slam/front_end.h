// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/helper_thread.h"
#include "plumbline/features/extractor.h"
#include "plumbline/features/valid_region.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"
#include "plumbline/map/frame.h"
#include "plumbline/slam/load_shedding.h"
#include "plumbline/slam/stage_clock.h"

#include <cstdint>
#include <memory>

namespace plumbline {

// A frame with what the images by themselves give for its pose (ExtractFeatures).
struct MeasuredFrame {
  std::int64_t stamp_ns = 0;
  RectifiedFrame images;
  std::shared_ptr<const IndexedFeatures> indexed;
  StageClock clock;  // goes on with the frame
  Shed shed = Shed::kNothing;
};

// From sensor to features: the stage that needs no map and no earlier frame.
class FrontEnd {
 public:
  // Throws InputError for a calibration that cannot be used.
  FrontEnd(const Calibration& calibration, const FeatureOptions& features);

  // Rectifies the images and measures features. Throws InputError when an image has another size
  // than the calibration says. Thread-safe; same frame, same features. Of lines and points, `shed`
  // measures fewer.
  MeasuredFrame Measure(SensorFrame frame, StageClock clock = {}, Shed shed = Shed::kNothing) const;

  // Features of a frame, which may have been corrected since they were measured, with the places of
  // its lines in the right image: what landmarks are made of, beside what a pose is found from.
  // They are looked for once: features that have such places are returned as they are. `shed` is
  // that of Measure.
  std::shared_ptr<const IndexedFeatures> WithRightLines(
      const RectifiedFrame& images,
      Shed shed,
      const std::shared_ptr<const IndexedFeatures>& indexed) const;

  const Rectifier& rectifier() const { return rectifier_; }

 private:
  FeatureInput InputOf(const RectifiedFrame& images) const;

  FeatureOptions options_;
  std::unique_ptr<HelperThread> helper_;  // none where features are measured in one thread
  Rectifier rectifier_;
  ValidRegion left_valid_;
  ValidRegion right_valid_;
};

}  // namespace plumbline
