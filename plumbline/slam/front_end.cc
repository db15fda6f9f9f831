// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/front_end.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/slam/load_control.h"

#include <utility>

namespace plumbline {
namespace {

ValidRegion RegionOf(const GrayImage& mask) {
  return mask.empty() ? ValidRegion(0, 0) : ValidRegion(mask);
}

}  // namespace

void CheckImages(const Calibration& calibration, const SensorFrame& frame) {
  if (calibration.right && !frame.right) {
    throw InputError("images: expected a left and a right image, as calibrated, found one image");
  }
  if (!calibration.right && calibration.depth_factor && !frame.depth) {
    throw InputError("images: expected an image and a depth image, as calibrated, found one image");
  }
}

FrontEnd::FrontEnd(const Calibration& calibration, const FeatureOptions& features)
    : options_(features),
      helper_(features.parallel ? std::make_unique<HelperThread>() : nullptr),
      rectifier_(calibration),
      left_valid_(RegionOf(rectifier_.left_mask())),
      right_valid_(RegionOf(rectifier_.right_mask())) {}

FrontEnd::FrameMasks FrontEnd::MasksOf(const RectifiedFrame& images) {
  FrameMasks masks;
  if (!images.left_mask.empty()) masks.left.emplace(images.left_mask);
  if (!images.right_mask.empty()) masks.right.emplace(images.right_mask);
  return masks;
}

FeatureInput FrontEnd::InputOf(const RectifiedFrame& images, const FrameMasks& masks) const {
  FeatureInput input;
  input.left = &images.left;
  input.left_valid = masks.left ? &*masks.left : &left_valid_;
  if (images.right) {
    input.right = &*images.right;
    input.right_valid = masks.right ? &*masks.right : &right_valid_;
  }
  if (images.depth) input.depth = &*images.depth;
  return input;
}

std::shared_ptr<const FrameFeatures> FrontEnd::WithRightLines(
    const RectifiedFrame& images,
    LoadLevel shed,
    const std::shared_ptr<const FrameFeatures>& indexed) const {
  if (!indexed->features.line_right.values().empty()) return indexed;
  const FrameMasks masks = MasksOf(images);
  return plumbline::WithRightLines(indexed,
                                   FindRightLines(rectifier_.camera(),
                                                  InputOf(images, masks),
                                                  ReducedOptions(options_, shed),
                                                  indexed->features.lines));
}

ExtractedFrame FrontEnd::Extract(SensorFrame frame, StageClock clock, LoadLevel shed) const {
  CheckImages(rectifier_.calibration(), frame);
  ExtractedFrame extracted;
  extracted.shed = shed;
  extracted.stamp_ns = frame.stamp_ns;
  extracted.images = rectifier_.Apply(std::move(frame), helper_.get());
  clock.Done("rectify");
  const RectifiedCamera& camera = rectifier_.camera();
  ImagePyramid pyramid;
  const FrameMasks masks = MasksOf(extracted.images);
  Features features = ExtractFeatures(camera,
                                      InputOf(extracted.images, masks),
                                      ReducedOptions(options_, shed),
                                      helper_.get(),
                                      &pyramid);
  extracted.indexed = IndexFeatures(camera, std::move(features));
  if (!MeasuresDepth(camera)) {
    extracted.left_pyramid = std::make_shared<const ImagePyramid>(std::move(pyramid));
  }
  clock.Done("features");
  extracted.clock = std::move(clock);
  return extracted;
}

}  // namespace plumbline
