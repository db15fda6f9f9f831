// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

// A frame with all that the images by themselves give.
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

  const Rectifier& rectifier() const { return rectifier_; }

 private:
  FeatureOptions options_;
  Rectifier rectifier_;
  ValidRegion left_valid_;
  ValidRegion right_valid_;
};

}  // namespace plumbline
