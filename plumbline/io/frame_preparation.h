// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/orientation.h"
#include "plumbline/image/image.h"
#include "plumbline/io/dataset.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace plumbline {

// Images of more pixels than this are reduced unless a width is asked for: 2 megapixels, which
// images of 1920x1080 have.
constexpr std::int64_t kMostPixelsByDefault = std::int64_t{1} << 21;

// Returns how images are turned: as asked for or, with Rotation::kAuto, as `noted` in the file.
Orientation TurnOf(Rotation rotation, const Orientation& noted = {});

// Returns the size to which images are reduced: of at most `max_width` columns or, where none is
// asked for, of at most kMostPixelsByDefault; the shape stays. Smaller images keep their size.
// Throws InputError for a width below 1.
ImageSize ReducedSize(ImageSize size, std::optional<int> max_width);

// What is done to frames between reading and use: first they are turned, then reduced. The camera
// frame is that of the images as used.
class FramePreparation {
 public:
  // `calibration` is that of the images as stored. Throws InputError for a stereo pair that is to
  // be turned, since its cameras would not lie side by side.
  FramePreparation(const Calibration& calibration,
                   const Orientation& turn,
                   std::optional<int> max_width);

  // Whether frames stay as they are.
  bool IsIdentity() const { return turn_.IsIdentity() && reduced_ == turned_; }
  // The calibration of the frames as used.
  const Calibration& calibration() const { return calibration_; }
  // Says that images are reduced, in one sentence; nullopt where they are not.
  std::optional<std::string> ReductionNote() const;

  // Returns an image as it is used: reduced to the mean of areas. An image of another size than the
  // calibration's is only turned.
  GrayImage Apply(GrayImage image) const;
  // Returns depth as it is used: reduced to the nearest pixels, which are not mixed across edges.
  DepthImage Apply(DepthImage depth) const;
  SensorFrame Apply(SensorFrame frame) const;

 private:
  Orientation turn_;
  ImageSize turned_, reduced_;
  Calibration calibration_;
};

// How the images of a data set are turned, and why.
struct ImageTurn {
  Orientation orientation;
  bool as_noted = false;               // as the file asks
  bool calibration_of_turned = false;  // as delivered, the calibration was of the turned images
};

// Decides how images of size `stored` are turned for which the file notes an orientation. Where the
// calibration of `info` fits the turned images alone, it is turned back, so that it is of the
// images as stored. Where it fits both, it is of the images as stored, which the sensor delivers.
ImageTurn ChooseTurn(Rotation rotation,
                     const Orientation& noted,
                     ImageSize stored,
                     DatasetInfo& info);

// Returns what is known of a sequence whose frames are prepared. What is done becomes notes. Ground
// truth of the camera turns with it. Without a calibration (DatasetInfo::has_calibration), images
// are only turned.
DatasetInfo Prepared(DatasetInfo info, const FramePreparation& preparation, const ImageTurn& turn);

// Returns a data set whose frames are those of `recorded` after a FramePreparation, or `recorded`
// itself where that changes nothing.
std::unique_ptr<Dataset> PrepareFrames(std::unique_ptr<Dataset> recorded,
                                       const ImageTurn& turn,
                                       std::optional<int> max_width);

}  // namespace plumbline
