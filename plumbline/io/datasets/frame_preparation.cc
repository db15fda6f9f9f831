// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/frame_preparation.h"

#include "plumbline/base/counted.h"
#include "plumbline/base/error.h"
#include "plumbline/image/resample.h"
#include "plumbline/io/datasets/image_dataset.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

ImageSize SizeOfImages(const Camera& camera) { return {camera.width(), camera.height()}; }

// The size of images that are turned.
ImageSize TurnedSize(ImageSize size, const Orientation& turn) {
  return turn.transpose ? ImageSize{size.height, size.width} : size;
}

// Pixel centres are whole numbers, so that the border of the image is at -0.5.
Camera Reduced(const Camera& camera, ImageSize size) {
  CameraIntrinsics in = camera.intrinsics();
  const double x = static_cast<double>(size.width) / in.width;
  const double y = static_cast<double>(size.height) / in.height;
  in.fx *= x;
  in.fy *= y;
  in.cx = (in.cx + 0.5) * x - 0.5;
  in.cy = (in.cy + 0.5) * y - 0.5;
  in.width = size.width;
  in.height = size.height;
  return Camera(in);
}

std::string NoteOf(const ImageTurn& turn, bool has_calibration) {
  const char* calibration = !has_calibration             ? ""
                            : turn.calibration_of_turned ? "; the calibration is of turned images"
                                                         : ", and the calibration with them";
  return fmt::format("images are {}{}{}",
                     Describe(turn.orientation),
                     turn.as_noted ? " as the file asks" : "",
                     calibration);
}

std::uint8_t WhiteUnlessBlack(std::uint8_t level) { return level != 0 ? 255 : 0; }

// Reads a mask of the images of a camera. Throws InputError if it cannot be read, or has another
// size.
GrayImage MaskOfCamera(const std::string& path, const Camera& camera) {
  const ImageSize size = SizeOfImages(camera);
  const Expected<GrayImage, ImageFailure> mask = ReadMask(path, size);
  if (mask) return *mask;
  std::error_code error;
  const bool like_topic = path.starts_with('/') && !std::filesystem::path(path).has_extension();
  if (like_topic && !std::filesystem::exists(path, error)) {
    throw InputError(path + ": no such file, nor are there topics, which bags and MCAP files have");
  }
  throw InputError(path + ": " + MaskFailureOf(mask.error(), size).why);
}

class PreparedDataset : public Dataset {
 public:
  PreparedDataset(std::unique_ptr<Dataset> recorded,
                  FramePreparation preparation,
                  const ImageTurn& turn)
      : Dataset(Prepared(recorded->info(), preparation, turn)),
        recorded_(std::move(recorded)),
        preparation_(std::move(preparation)) {}

  Expected<SensorFrame, ImageFailure> Read(std::size_t i) const override {
    Expected<SensorFrame, ImageFailure> read = recorded_->Read(i);
    if (!read) return read;
    return preparation_.Apply(*std::move(read));
  }

  Expected<ColorImage, ImageFailure> ReadColor(std::size_t i) const override {
    Expected<ColorImage, ImageFailure> read = recorded_->ReadColor(i);
    if (!read) return read;
    return WithEachChannel(*std::move(read), [this](GrayImage channel) {
      return preparation_.Apply(std::move(channel));
    });
  }

 private:
  std::unique_ptr<Dataset> recorded_;
  FramePreparation preparation_;
};

}  // namespace

Orientation TurnOf(Rotation rotation, const Orientation& noted) {
  constexpr int kQuarter = 90;
  switch (rotation) {
    case Rotation::kAuto:
      return noted;
    case Rotation::kNone:
      return {};
    case Rotation::k90:
      return ClockwiseTurn(kQuarter);
    case Rotation::k180:
      return ClockwiseTurn(2 * kQuarter);
    case Rotation::k270:
      return ClockwiseTurn(3 * kQuarter);
  }
  throw BugError("a rotation without an orientation");
}

ImageSize ReducedSize(ImageSize size, std::optional<int> max_width) {
  const auto of_width = [&](int width) {
    const double height = static_cast<double>(size.height) * width / size.width;
    return ImageSize{width, std::max(1, static_cast<int>(std::lround(height)))};
  };
  const auto pixels = [](ImageSize of) { return std::int64_t{of.width} * of.height; };
  if (max_width && *max_width < 1) {
    throw InputError(fmt::format("expected a greatest width of 1 or more, found {}", *max_width));
  }
  if (max_width) return *max_width < size.width ? of_width(*max_width) : size;
  if (pixels(size) <= kMostPixelsByDefault) return size;
  const double shape = static_cast<double>(size.width) / size.height;
  const double width = std::sqrt(static_cast<double>(kMostPixelsByDefault) * shape);
  ImageSize reduced = of_width(std::clamp(static_cast<int>(width), 1, size.width));
  while (pixels(reduced) > kMostPixelsByDefault && reduced.width > 1) {
    reduced = of_width(reduced.width - 1);
  }
  reduced.height = std::min(reduced.height, size.height);
  return reduced;
}

FramePreparation::FramePreparation(const Calibration& calibration,
                                   const Orientation& turn,
                                   const PreparationOptions& options)
    : turn_(turn),
      turned_(TurnedSize(SizeOfImages(calibration.left), turn)),
      reduced_(ReducedSize(turned_, options.max_width)),
      view_angle_(options.view_angle_deg.has_value()) {
  if (calibration.right && !turn.IsIdentity()) {
    throw InputError(
        "expected one camera whose images can be turned, found a stereo pair, whose cameras would "
        "not lie side by side any more");
  }
  const std::size_t cameras = calibration.right ? 2 : 1;
  if (options.masks.size() > cameras) {
    throw InputError(fmt::format("expected at most {}, one for each camera, found {}",
                                 Counted(cameras, "mask"),
                                 options.masks.size()));
  }
  if (!options.masks.empty()) left_mask_ = ReadMaskOf(calibration.left, options.masks[0]);
  if (options.masks.size() > 1) right_mask_ = ReadMaskOf(*calibration.right, options.masks[1]);
  if (options.masks.size() == 1 && calibration.right) {
    mask_notes_.push_back("--mask is of the left camera; once more it is of the right one");
  }
  calibration_ = Turned(calibration, turn);
  if (options.view_angle_deg) calibration_.view_angle_deg = options.view_angle_deg;
  if (reduced_ == turned_) return;
  calibration_.left = Reduced(calibration_.left, reduced_);
  if (calibration_.right) calibration_.right = Reduced(*calibration_.right, reduced_);
}

FramePreparation::Mask FramePreparation::ReadMaskOf(const Camera& camera, const std::string& path) {
  if (path.empty()) return nullptr;
  const GrayImage mask = MaskOfCamera(path, camera);
  const double share = MaskedShare(mask);
  if (share == 1) {
    throw InputError(path +
                     ": expected a mask with pixels that are used, which are not black, "
                     "found none");
  }
  mask_notes_.push_back(fmt::format("the mask {} leaves out {:.3g} % of the image{}",
                                    path,
                                    100 * share,
                                    share > 0.5  ? "; is it inverted? What is black is not used"
                                    : share == 0 ? ": nothing in it is black"
                                                 : ""));
  return PreparedMask(mask);
}

std::optional<std::string> FramePreparation::ReductionNote() const {
  if (reduced_ == turned_) return std::nullopt;
  return fmt::format("images of {}x{} pixels are reduced to {}x{}, and the calibration with them",
                     turned_.width,
                     turned_.height,
                     reduced_.width,
                     reduced_.height);
}

GrayImage FramePreparation::Apply(GrayImage image) const {
  if (!turn_.IsIdentity()) image = Turned(image, turn_);
  if (reduced_ == turned_ || ImageSize{image.width(), image.height()} != turned_) return image;
  return AreaAveraged(image, reduced_.width, reduced_.height);
}

DepthImage FramePreparation::Apply(DepthImage depth) const {
  if (!turn_.IsIdentity()) depth = Turned(depth, turn_);
  if (reduced_ == turned_ || ImageSize{depth.width(), depth.height()} != turned_) return depth;
  return NearestPixels(depth, reduced_.width, reduced_.height);
}

SensorFrame FramePreparation::Apply(SensorFrame frame) const {
  frame.left = Apply(std::move(frame.left));
  if (frame.right) frame.right = Apply(*std::move(frame.right));
  if (frame.depth) frame.depth = Apply(*std::move(frame.depth));
  frame.left_mask = Joined(frame.left_mask, left_mask_);
  frame.right_mask = Joined(frame.right_mask, right_mask_);
  return frame;
}

FramePreparation::Mask FramePreparation::PreparedMask(const GrayImage& mask) const {
  GrayImage used(mask.width(), mask.height());
  std::transform(
      mask.data(), mask.data() + mask.width() * mask.height(), used.data(), WhiteUnlessBlack);
  used = Apply(std::move(used));
  std::transform(
      used.data(), used.data() + used.width() * used.height(), used.data(), [](std::uint8_t level) {
        return level == 255 ? level : std::uint8_t{0};
      });
  return std::make_shared<const GrayImage>(std::move(used));
}

FramePreparation::Mask FramePreparation::Joined(const Mask& of_frame, const Mask& of_all) const {
  if (!of_frame) return of_all;
  const Mask prepared = PreparedMask(*of_frame);
  const bool same_size =
      of_all && of_all->width() == prepared->width() && of_all->height() == prepared->height();
  if (!same_size) return prepared;
  GrayImage both = *prepared;
  std::transform(both.data(),
                 both.data() + both.width() * both.height(),
                 of_all->data(),
                 both.data(),
                 [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); });
  return std::make_shared<const GrayImage>(std::move(both));
}

ImageTurn ChooseTurn(Rotation rotation,
                     const Orientation& noted,
                     ImageSize stored,
                     DatasetInfo& info) {
  ImageTurn turn{TurnOf(rotation, noted)};
  if (turn.orientation.IsIdentity()) {
    if (!noted.IsIdentity()) {
      info.notes.push_back(fmt::format(
          "the file asks for images that are {}; they are used as stored", Describe(noted)));
    }
    return turn;
  }
  turn.as_noted = turn.orientation == noted;
  const ImageSize camera = SizeOfImages(info.calibration.left);
  turn.calibration_of_turned =
      info.has_calibration && camera != stored && camera == TurnedSize(stored, turn.orientation);
  if (turn.calibration_of_turned) {
    info.calibration = Turned(info.calibration, Inverse(turn.orientation));
  }
  return turn;
}

DatasetInfo Prepared(DatasetInfo info, const FramePreparation& preparation, const ImageTurn& turn) {
  if (!turn.orientation.IsIdentity()) info.notes.push_back(NoteOf(turn, info.has_calibration));
  if (info.has_calibration) {
    info.calibration = preparation.calibration();
    if (auto note = preparation.ReductionNote()) info.notes.push_back(*std::move(note));
  }
  const std::vector<std::string>& of_masks = preparation.MaskNotes();
  info.notes.insert(info.notes.end(), of_masks.begin(), of_masks.end());
  if (!info.ground_truth || info.ground_truth->frame != GroundTruth::Frame::kCamera) return info;
  if (turn.orientation.IsIdentity() || turn.orientation.Mirrors()) return info;
  const Rigid3 stored_from_turned = Inverse(TurnedFromStored(turn.orientation));
  for (StampedPose& pose : info.ground_truth->poses) {
    pose.world_from_camera = pose.world_from_camera * stored_from_turned;
  }
  return info;
}

std::unique_ptr<Dataset> PrepareFrames(std::unique_ptr<Dataset> recorded,
                                       const ImageTurn& turn,
                                       const PreparationOptions& options) {
  try {
    FramePreparation preparation(recorded->calibration(), turn.orientation, options);
    if (preparation.IsIdentity()) return recorded;
    return std::make_unique<PreparedDataset>(std::move(recorded), std::move(preparation), turn);
  } catch (const InputError& error) {
    throw InputError(recorded->info().path.string() + ": " + error.what());
  }
}

}  // namespace plumbline
