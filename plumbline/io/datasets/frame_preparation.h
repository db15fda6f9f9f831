// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/image/resample.h"
#include "plumbline/io/datasets/dataset.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Images of more pixels are reduced unless a width is given: 2 megapixels, enough for 1920x1080.
constexpr std::int64_t kMostPixelsByDefault = std::int64_t{1} << 21;

// Returns the rotation of images: as requested or, with Rotation::kAuto, as `noted` in the file.
Orientation TurnOf(Rotation rotation, const Orientation& noted = {});

// Returns the size of reduced images: of at most `max_width` columns or, if that is not given, of
// at most kMostPixelsByDefault; the aspect ratio stays. Smaller images keep their size. Throws
// InputError for a width below 1.
ImageSize ReducedSize(ImageSize size, std::optional<int> max_width);

// What is done to frames beside their rotation.
struct PreparationOptions {
  std::optional<int> max_width = std::nullopt;
  std::optional<double> view_angle_deg = std::nullopt;
  std::vector<std::string> masks = {};  // files, as DatasetOptions::masks; empty names: none
};

// Returns those of options for a data set or a live source.
template <class Options>
PreparationOptions PreparationOf(const Options& options) {
  return {options.max_width, options.view_angle_deg, options.masks};
}

// Preparation of frames between reading and use: first they are masked, then rotated, then reduced.
// The camera frame is that of the images as used.
class FramePreparation {
 public:
  // `calibration` is that of the images as stored. Throws InputError for the rotation of a stereo
  // pair, since its cameras would not lie side by side, and for masks that cannot be read, have
  // another size or leave nothing.
  FramePreparation(const Calibration& calibration,
                   const Orientation& turn,
                   const PreparationOptions& options);

  // Returns true if frames do not change.
  bool IsIdentity() const {
    return turn_.IsIdentity() && reduced_ == turned_ && !left_mask_ && !right_mask_ && !view_angle_;
  }
  // Calibration of the frames as used.
  const Calibration& calibration() const { return calibration_; }
  // Returns a sentence about the reduction of images; nullopt if they are not reduced.
  std::optional<std::string> ReductionNote() const;
  // Returns a sentence for each mask of all frames: what share of the image it leaves out.
  const std::vector<std::string>& MaskNotes() const { return mask_notes_; }

  // Returns an image as used: reduced by area means. An image whose size differs from the
  // calibration is only rotated.
  GrayImage Apply(GrayImage image) const;
  // Returns depth as used: reduced to the nearest pixels, which are not mixed across edges.
  DepthImage Apply(DepthImage depth) const;
  SensorFrame Apply(SensorFrame frame) const;

 private:
  using Mask = std::shared_ptr<const GrayImage>;
  // Reads a mask of all frames; null for an empty name.
  Mask ReadMaskOf(const Camera& camera, const std::string& path);
  // A mask of the images as used: of a pixel that is a mean, all of it must be used.
  Mask PreparedMask(const GrayImage& mask) const;
  // The mask of a frame with that of all frames, of which either may be null.
  Mask Joined(const Mask& of_frame, const Mask& of_all) const;

  Orientation turn_;
  ImageSize turned_, reduced_;
  bool view_angle_ = false;
  Mask left_mask_, right_mask_;  // of all frames, as used
  std::vector<std::string> mask_notes_;
  Calibration calibration_;
};

// Rotation of the images of a data set, and its reason.
struct ImageTurn {
  Orientation orientation;
  bool as_noted = false;  // true if the file requests it
  // true if the delivered calibration was of the rotated images
  bool calibration_of_turned = false;
};

// Decides the rotation of images of size `stored` whose file notes an orientation. If the
// calibration of `info` fits only the rotated images, it is rotated back to the images as stored.
// If it fits both, it is that of the images as stored, which the sensor delivers.
ImageTurn ChooseTurn(Rotation rotation,
                     const Orientation& noted,
                     ImageSize stored,
                     DatasetInfo& info);

// Returns the description of a sequence of prepared frames, with notes about the preparation.
// Ground truth of the camera rotates with it. Without a calibration (DatasetInfo::has_calibration),
// images are only rotated.
DatasetInfo Prepared(DatasetInfo info, const FramePreparation& preparation, const ImageTurn& turn);

// Returns a data set with the frames of `recorded` after a FramePreparation, or `recorded` itself
// if that changes nothing.
std::unique_ptr<Dataset> PrepareFrames(std::unique_ptr<Dataset> recorded,
                                       const ImageTurn& turn,
                                       const PreparationOptions& options);

}  // namespace plumbline
