// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/parallel.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/image/image.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

// Resamples an image: each pixel is interpolated linearly between the four pixels around its source
// position, which is rounded to 1/32 of a pixel. The source image is continued with its border
// pixels. The result equals that of cv::remap to the last bit, in integers.
class BilinearMap {
 public:
  // x, y: source position of each pixel in an image of width x height pixels, clamped to +-131072.
  // Cost: some passes over the images, once.
  BilinearMap(const Image<float>& x, const Image<float>& y, int width, int height);

  // Maps an image, which must have the size given to the constructor (BugError otherwise). Cost:
  // about 2 ns a pixel.
  GrayImage Apply(const GrayImage& from) const;

 private:
  int from_width_, from_height_;
  int width_, height_;
  // For each pixel: the first of the four source pixels, and the weights in 32nds of those to its
  // right and below it.
  std::vector<std::int32_t> first_;
  std::vector<std::uint8_t> right_, below_;
};

// A frame as seen by the rectified camera.
struct RectifiedFrame {
  std::int64_t stamp_ns = 0;
  GrayImage left;
  std::optional<GrayImage> right;
  std::optional<DepthImage> depth;
  // Rectified masks of the frame: 255 for pixels that are interpolated from real pixels that are
  // used alone, otherwise 0. Empty if the frame has no mask: then Rectifier::left_mask() holds.
  GrayImage left_mask, right_mask;
};

// Rectifies raw images to those of an ideal pinhole camera, and stereo pairs to pairs with
// corresponding points in the same row.
//
// Stereo: both images are rotated so that x runs along the baseline and z along the mean of the two
// optical axes. Mono, RGB-D: only the distortion is removed. The ideal camera has square pixels.
//
// Of cameras without distortion or with kRadTan it has the input's size, and as focal length the
// smallest at which (nearly) every pixel of both images comes from a real pixel, kept within 0.5 to
// 1.3 of the raw one. Of the other lenses, and of all with Calibration::view_angle_deg, its focal
// length is that of the middle of the lens (Camera::CentreFocal), so that no resolution is lost
// there; its image reaches as far as every pixel comes from a real one, but not beyond the view
// angle (110 degrees by default), across and down, and so may be larger or smaller than the input.
// Images that need no change are passed through.
class Rectifier {
 public:
  // Throws InputError if the two cameras of a pair differ in size, the second one is not to the
  // right of the first, or `rectified` is set but the numbers contradict it. O(pixels), some 10 ms.
  explicit Rectifier(const Calibration& calibration);
  ~Rectifier();
  Rectifier(Rectifier&&) noexcept;
  Rectifier& operator=(Rectifier&&) noexcept;

  // The ideal camera; its baseline is the true one (stereo), a virtual one (RGB-D) or 0 (mono).
  const RectifiedCamera& camera() const { return camera_; }
  const Calibration& calibration() const { return calibration_; }
  // Rotation from the left camera as delivered to its rectified frame, which has the same centre.
  const Eigen::Quaterniond& rectified_left_from_left() const { return rectified_left_from_left_; }

  // Returns the rectified images of a frame; pass an rvalue to save copies if nothing changes.
  // Linear interpolation at 1/32 px, depth by the nearest neighbour. Pixels from beyond the raw
  // image repeat its border (depth: 0). Right or depth images without a calibration are dropped;
  // missing ones stay missing. Throws InputError for images of another size than calibrated.
  // Thread-safe. A helper, if given, processes the right or depth image.
  RectifiedFrame Apply(SensorFrame frame, HelperThread* helper = nullptr) const;

  // 255 for pixels interpolated from real pixels alone, otherwise 0; same size as the images. Edges
  // along the border of this region are not edges of the scene.
  const GrayImage& left_mask() const { return left_mask_; }
  const GrayImage& right_mask() const { return right_mask_; }  // empty without a right camera

  // What the left pinhole image shows of the left camera.
  struct Coverage {
    double across_deg = 0, down_deg = 0;   // view of the pinhole image
    double lens_deg = 0;                   // widest view of the lens in the image, over its centre
    double used = 0;                       // share of the raw pixels that are in the pinhole image
    double resolution = 0;                 // focal length relative to the middle of the lens
    std::vector<Eigen::Vector2d> outline;  // of the pinhole image, raw pixels, around it once
  };
  Coverage LeftCoverage() const;
  // Returns true if images pass unchanged.
  bool PassesUnchanged() const { return left_maps_ == nullptr; }

  // Returns the rectified position of a raw pixel, without rounding. Returns nullopt beyond the
  // domain of the camera model or behind the rectified image plane.
  std::optional<Eigen::Vector2d> RectifyLeft(const Eigen::Vector2d& raw_px) const;
  std::optional<Eigen::Vector2d> RectifyRight(const Eigen::Vector2d& raw_px) const;

 private:
  struct Maps;  // maps as of cv::remap; null if images pass unchanged

  Calibration calibration_;
  RectifiedCamera camera_;
  Eigen::Quaterniond rectified_left_from_left_ = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond rectified_right_from_right_ = Eigen::Quaterniond::Identity();
  GrayImage left_mask_;
  GrayImage right_mask_;
  std::unique_ptr<Maps> left_maps_;
  std::unique_ptr<Maps> right_maps_;
};

// Returns what is used of a lens, for users: "110 x 110 of 195 degrees, 62 % of the image, as
// 546x546 pixels of 100 % of the resolution in the middle".
std::string ViewText(const Rectifier& rectifier);

}  // namespace plumbline
