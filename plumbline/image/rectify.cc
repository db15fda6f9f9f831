// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/rectify.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/base/parallel.h"
#include "plumbline/base/processor.h"
#include "plumbline/base/units.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/image/opencv_bridge.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace plumbline {

namespace {

constexpr int kUnit = 32;  // parts of a pixel

struct Place {
  int first;
  int next_weight;  // weight in parts of kUnit
};

// Returns the pixel at or before a place, and the weight of the next pixel. Both pixels are in the
// image, whatever the place.
Place PlaceOf(float place, int size) {
  constexpr float kLimit = 131072;  // more than any side; its parts are exact in single precision
  // Rounds to the nearest number, ties to even.
  const auto units = static_cast<int>(std::nearbyint(std::clamp(place, -kLimit, kLimit) * kUnit));
  const int first = units >> 5;
  if (first < 0) return {0, 0};
  if (first >= size - 1) return {size - 2, kUnit};
  return {first, units & (kUnit - 1)};
}

// There is always a next pixel: a single row or column is its own neighbour.
int AtLeastTwo(int size) { return std::max(size, 2); }

GrayImage Doubled(const GrayImage& image) {
  GrayImage result(AtLeastTwo(image.width()), AtLeastTwo(image.height()));
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      result.at(x, y) = image.at(std::min(x, image.width() - 1), std::min(y, image.height() - 1));
    }
  }
  return result;
}

struct InterpolateRow {
  [[gnu::always_inline]] static inline void Run(const std::uint8_t* from,
                                                std::ptrdiff_t from_width,
                                                const std::int32_t* firsts,
                                                const std::uint8_t* right,
                                                const std::uint8_t* below,
                                                int count,
                                                std::uint8_t* out) {
    ForBlocks<32>(
        count, [&](int begin, auto size) __attribute__((always_inline)) {
          std::uint16_t upper[size], lower[size];  // two pixels each, the left one in the low byte
          for (int i = 0; i < size; ++i) {
            const std::uint8_t* first = from + firsts[begin + i];
            std::memcpy(&upper[i], first, 2);
            std::memcpy(&lower[i], first + from_width, 2);
          }
          std::uint8_t block[size];
          for (int i = 0; i < size; ++i) {
            const std::uint16_t x = right[begin + i];
            const std::uint16_t y = below[begin + i];
            const auto left = static_cast<std::uint16_t>(kUnit - x);
            const auto above = static_cast<std::uint32_t>(kUnit - y);
            const auto a =
                static_cast<std::uint16_t>((upper[i] & 255) * left + (upper[i] >> 8) * x);
            const auto b =
                static_cast<std::uint16_t>((lower[i] & 255) * left + (lower[i] >> 8) * x);
            constexpr std::uint32_t kHalf = kUnit * kUnit / 2;
            block[i] = static_cast<std::uint8_t>((a * above + b * y + kHalf) / (kUnit * kUnit));
          }
          std::memcpy(out + begin, block, size);
        });
  }
};

}  // namespace

BilinearMap::BilinearMap(const Image<float>& x, const Image<float>& y, int width, int height)
    : from_width_(width), from_height_(height), width_(x.width()), height_(x.height()) {
  static_assert(std::endian::native == std::endian::little, "pairs of pixels are read at once");
  PLUMBLINE_CHECK(width >= 1 && height >= 1, "an image to interpolate in");
  PLUMBLINE_CHECK(x.width() == y.width() && x.height() == y.height(), "a place for each pixel");
  const auto count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  first_.reserve(count);
  right_.reserve(count);
  below_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Place column = PlaceOf(x.data()[i], AtLeastTwo(width));
    const Place row = PlaceOf(y.data()[i], AtLeastTwo(height));
    first_.push_back(row.first * AtLeastTwo(width) + column.first);
    right_.push_back(static_cast<std::uint8_t>(column.next_weight));
    below_.push_back(static_cast<std::uint8_t>(row.next_weight));
  }
}

GrayImage BilinearMap::Apply(const GrayImage& from) const {
  PLUMBLINE_CHECK(from.width() == from_width_ && from.height() == from_height_,
                  "an image of the map's size");
  if (std::min(from_width_, from_height_) < 2) {
    BilinearMap doubled = *this;
    doubled.from_width_ = AtLeastTwo(from_width_);
    doubled.from_height_ = AtLeastTwo(from_height_);
    return doubled.Apply(Doubled(from));
  }
  GrayImage result(width_, height_);
  for (int y = 0; y < height_; ++y) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * width_;
    RunBest<InterpolateRow>(from.data(),
                            from.width(),
                            first_.data() + row,
                            right_.data() + row,
                            below_.data() + row,
                            width_,
                            result.row(y));
  }
  return result;
}

namespace {

// Focal length of the ideal camera relative to the raw one.
constexpr double kMinZoom = 0.5;
constexpr double kMaxZoom = 1.3;
// Tangent of the widest half angle that the ideal image may need (75 degrees).
constexpr double kMaxTangent = 3.732;
// View of the pinhole image of a wide lens, unless the calibration tells another one: beyond it the
// border has three times the pixels that the lens has there.
constexpr double kViewAngleDeg = 110;

struct View {
  const Camera* camera = nullptr;
  Eigen::Quaterniond rectified_from_raw;
};

// A rectangle on the plane z = 1 of the rectified frame.
struct Extent {
  double x0 = -kMaxTangent, x1 = kMaxTangent, y0 = -kMaxTangent, y1 = kMaxTangent;
};

std::optional<Eigen::Vector2d> RectifiedTangents(const View& view, const Eigen::Vector2d& raw_px) {
  const std::optional<Eigen::Vector3d> ray = view.camera->Ray(raw_px);
  if (!ray) return std::nullopt;
  const Eigen::Vector3d turned = view.rectified_from_raw * *ray;
  if (!(turned.z() > 0)) return std::nullopt;
  return Eigen::Vector2d(turned.head<2>() / turned.z());
}

// Returns the tangents of the outermost pixel with a ray between the principal point and a pixel of
// the border.
std::optional<Eigen::Vector2d> OutermostTangents(const View& view, const Eigen::Vector2d& border) {
  const Eigen::Vector2d centre(view.camera->intrinsics().cx, view.camera->intrinsics().cy);
  std::optional<Eigen::Vector2d> tangents = RectifiedTangents(view, centre);
  double low = 0, high = 1;
  while (high - low > 1e-4) {
    const double middle = 0.5 * (low + high);
    const auto here = RectifiedTangents(view, centre + middle * (border - centre));
    if (here) tangents = here;
    (here ? low : high) = middle;
  }
  return tangents;
}

// Shrinks the extent until its sides are inside the raw image's curved border, or, where a whole
// side of it has no rays, inside what the lens shows towards the middle of that side.
void ShrinkToInside(const View& view, Extent& extent) {
  constexpr int kSamples = 64;
  const double right = view.camera->width() - 1;
  const double bottom = view.camera->height() - 1;
  // Calls shrink(tangents) for the pixels of one side.
  const auto for_side = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to, auto shrink) {
    bool any = false;
    for (int i = 0; i <= kSamples; ++i) {
      const double share = static_cast<double>(i) / kSamples;
      if (const auto p = RectifiedTangents(view, (1 - share) * from + share * to)) {
        shrink(*p);
        any = true;
      }
    }
    if (any) return;
    if (const auto p = OutermostTangents(view, 0.5 * (from + to))) shrink(*p);
  };
  const Eigen::Vector2d corners[] = {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}};
  using Tangents = Eigen::Vector2d;
  for_side(
      corners[0], corners[3], [&](const Tangents& p) { extent.x0 = std::max(extent.x0, p.x()); });
  for_side(
      corners[1], corners[2], [&](const Tangents& p) { extent.x1 = std::min(extent.x1, p.x()); });
  for_side(
      corners[0], corners[1], [&](const Tangents& p) { extent.y0 = std::max(extent.y0, p.y()); });
  for_side(
      corners[3], corners[2], [&](const Tangents& p) { extent.y1 = std::min(extent.y1, p.y()); });
}

// Returns the pinhole camera of the input's size.
RectifiedCamera PinholeOfInputSize(const Extent& extent, const Camera& left, double raw_focal) {
  RectifiedCamera ideal;
  ideal.width = left.width();
  ideal.height = left.height();
  const double span_x = std::max(extent.x1 - extent.x0, 1e-6);
  const double span_y = std::max(extent.y1 - extent.y0, 1e-6);
  const double inside = std::max((ideal.width - 1) / span_x, (ideal.height - 1) / span_y);
  const double focal = std::clamp(inside, kMinZoom * raw_focal, kMaxZoom * raw_focal);
  ideal.fx = focal;
  ideal.fy = focal;
  ideal.cx = 0.5 * (ideal.width - 1) - 0.5 * focal * (extent.x0 + extent.x1);
  ideal.cy = 0.5 * (ideal.height - 1) - 0.5 * focal * (extent.y0 + extent.y1);
  return ideal;
}

// Returns the pinhole camera of this focal length that shows the extent.
RectifiedCamera PinholeOfFocal(const Extent& extent, double focal) {
  const auto pixels = [&](double span) {
    const double most = std::sqrt(static_cast<double>(kMostPixels));
    return static_cast<int>(std::clamp(std::floor(focal * span + 1e-6) + 1, 2.0, most));
  };
  RectifiedCamera ideal;
  ideal.fx = focal;
  ideal.fy = focal;
  ideal.width = pixels(extent.x1 - extent.x0);
  ideal.height = pixels(extent.y1 - extent.y0);
  ideal.cx = 0.5 * (ideal.width - 1) - 0.5 * focal * (extent.x0 + extent.x1);
  ideal.cy = 0.5 * (ideal.height - 1) - 0.5 * focal * (extent.y0 + extent.y1);
  return ideal;
}

// True for a lens whose pinhole image keeps the input's size.
bool KeepsSize(const Camera& camera) {
  const DistortionModel model = camera.intrinsics().model;
  return model == DistortionModel::kNone || model == DistortionModel::kRadTan;
}

RectifiedCamera ChooseCamera(const View& left,
                             const View* right,
                             std::optional<double> view_angle_deg) {
  const bool keeps_size = KeepsSize(*left.camera) && !view_angle_deg;
  Extent extent;
  if (!keeps_size) {
    const double most =
        std::min(kMaxTangent, math::Tan(0.5 * kDegree * view_angle_deg.value_or(kViewAngleDeg)));
    extent = {-most, most, -most, most};
  }
  ShrinkToInside(left, extent);
  if (right != nullptr) ShrinkToInside(*right, extent);
  if (keeps_size) {
    double raw_focal = 0.5 * (left.camera->intrinsics().fx + left.camera->intrinsics().fy);
    if (right != nullptr) {
      const CameraIntrinsics& in = right->camera->intrinsics();
      raw_focal = 0.5 * raw_focal + 0.25 * (in.fx + in.fy);
    }
    return PinholeOfInputSize(extent, *left.camera, raw_focal);
  }
  double focal = left.camera->CentreFocal();
  if (right != nullptr) focal = 0.5 * (focal + right->camera->CentreFocal());
  return PinholeOfFocal(extent, focal);
}

RectifiedCamera IdealOf(const Camera& camera) {
  const CameraIntrinsics& in = camera.intrinsics();
  return {.fx = in.fx,
          .fy = in.fy,
          .cx = in.cx,
          .cy = in.cy,
          .baseline = 0,
          .width = in.width,
          .height = in.height};
}

bool SamePinhole(const Camera& a, const Camera& b) {
  constexpr double kTolerance = 1e-6;  // pixels
  const CameraIntrinsics& p = a.intrinsics();
  const CameraIntrinsics& q = b.intrinsics();
  return a.IsIdeal() && b.IsIdeal() && std::abs(p.fx - q.fx) < kTolerance &&
         std::abs(p.fy - q.fy) < kTolerance && std::abs(p.cx - q.cx) < kTolerance &&
         std::abs(p.cy - q.cy) < kTolerance;
}

// Returns the rotation that turns x to the baseline and z to the mean optical axis, as near as that
// allows.
Eigen::Quaterniond StereoRotation(const Rigid3& left_from_right) {
  const Eigen::Vector3d x = left_from_right.translation.normalized();
  const Eigen::Vector3d axis =
      Eigen::Vector3d::UnitZ() + left_from_right.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d y = axis.cross(x).normalized();
  Eigen::Matrix3d rows;
  rows << x.transpose(), y.transpose(), x.cross(y).transpose();
  return Eigen::Quaterniond(rows).normalized();
}

std::string SizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

// Throws InputError for a fault. Calibrations read from a file have already passed the same checks.
void Refuse(const std::optional<std::string>& fault) {
  if (fault) throw InputError("calibration: " + *fault);
}

template <class T>
void CheckSize(const Image<T>& image, const Camera& camera, const std::string& name) {
  if (image.width() == camera.width() && image.height() == camera.height()) return;
  throw InputError(name + " image: expected " + SizeText(camera.width(), camera.height()) +
                   ", found " + SizeText(image.width(), image.height()));
}

struct FloatMaps {
  Image<float> x, y;  // raw pixel of each ideal pixel
  GrayImage mask;
};

FloatMaps ComputeMaps(const RectifiedCamera& ideal, const View& view) {
  constexpr float kNowhere = -10000.0F;
  FloatMaps maps;
  maps.x = Image<float>(ideal.width, ideal.height);
  maps.y = Image<float>(ideal.width, ideal.height);
  maps.mask = GrayImage(ideal.width, ideal.height);
  const Eigen::Matrix3d raw_from_rectified = view.rectified_from_raw.conjugate().toRotationMatrix();
  for (int v = 0; v < ideal.height; ++v) {
    float* row_x = maps.x.row(v);
    float* row_y = maps.y.row(v);
    for (int u = 0; u < ideal.width; ++u) {
      const Eigen::Vector3d ray =
          raw_from_rectified * ideal.Unproject({static_cast<double>(u), static_cast<double>(v)});
      const std::optional<Eigen::Vector2d> px = view.camera->Project(ray);
      row_x[u] = px ? static_cast<float>(px->x()) : kNowhere;
      row_y[u] = px ? static_cast<float>(px->y()) : kNowhere;
      maps.mask.at(u, v) = px && view.camera->Contains(*px) ? 255 : 0;
    }
  }
  return maps;
}

}  // namespace

struct Rectifier::Maps {
  BilinearMap linear;
  cv::Mat nearest_px;

  Maps(const FloatMaps& maps, const Camera& raw, bool with_depth)
      : linear(maps.x, maps.y, raw.width(), raw.height()) {
    cv::Mat unused;
    if (with_depth) {
      cv::convertMaps(AsMat(maps.x), AsMat(maps.y), nearest_px, unused, CV_16SC2, true);
    }
  }

  DepthImage Apply(const DepthImage& raw) const {
    DepthImage ideal(nearest_px.cols, nearest_px.rows);
    cv::Mat target = AsMat(ideal);
    cv::remap(AsMat(raw), target, nearest_px, cv::Mat(), cv::INTER_NEAREST, cv::BORDER_CONSTANT);
    return ideal;
  }
};

Rectifier::~Rectifier() = default;
Rectifier::Rectifier(Rectifier&&) noexcept = default;
Rectifier& Rectifier::operator=(Rectifier&&) noexcept = default;

Rectifier::Rectifier(const Calibration& calibration) : calibration_(calibration) {
  // Baseline that turns depth into disparity [m]. It is about that of sensors with structured
  // light, so that the disparities are those that they measured.
  constexpr double kVirtualBaseline = 0.08;
  const Camera& left = calibration_.left;
  const bool stereo = calibration_.right.has_value();
  const bool with_depth = calibration_.depth_factor.has_value();
  Eigen::Quaterniond& right_turn = calibration_.right_from_left.rotation;
  if (stereo) right_turn = UnitRotation(right_turn, "calibration: right_from_left");
  Refuse(CalibrationFault(calibration_));
  const bool any_view = calibration_.view_angle_deg.has_value();
  bool unchanged = left.IsIdeal() && !any_view;
  double baseline = with_depth ? kVirtualBaseline : 0;
  if (stereo) {
    const Rigid3 left_from_right = Inverse(calibration_.right_from_left);
    baseline = left_from_right.translation.norm();
    if (!calibration_.rectified) {
      rectified_left_from_left_ = StereoRotation(left_from_right);
      rectified_right_from_right_ =
          (rectified_left_from_left_ * left_from_right.rotation).normalized();
    }
    constexpr double kNoTurn = 1e-7;
    unchanged = !any_view && SamePinhole(left, *calibration_.right) &&
                LogSo3(rectified_left_from_left_).norm() < kNoTurn &&
                LogSo3(rectified_right_from_right_).norm() < kNoTurn;
  }
  const View left_view{&left, rectified_left_from_left_};
  if (unchanged) {
    rectified_left_from_left_.setIdentity();
    rectified_right_from_right_.setIdentity();
    camera_ = IdealOf(left);
    left_mask_ = GrayImage(left.width(), left.height(), 255);
    if (stereo) right_mask_ = left_mask_;
  } else {
    // Pixels of depth images are looked up by whole numbers of 16 bits.
    constexpr int kWidestDepth = 32766;
    if (with_depth && std::max(left.width(), left.height()) > kWidestDepth) {
      Refuse("expected depth images of a distorted camera of at most " +
             std::to_string(kWidestDepth) + " pixels a side, found " +
             SizeText(left.width(), left.height()));
    }
    const View right_view{stereo ? &*calibration_.right : nullptr, rectified_right_from_right_};
    camera_ = ChooseCamera(left_view, stereo ? &right_view : nullptr, calibration_.view_angle_deg);
    FloatMaps maps = ComputeMaps(camera_, left_view);
    left_maps_ = std::make_unique<Maps>(maps, left, with_depth);
    left_mask_ = std::move(maps.mask);
    if (stereo) {
      maps = ComputeMaps(camera_, right_view);
      right_maps_ = std::make_unique<Maps>(maps, *calibration_.right, false);
      right_mask_ = std::move(maps.mask);
    }
  }
  camera_.baseline = baseline;
}

namespace {

// Returns the mask of a frame as the ideal camera sees it. Pixels beside one that is not used are
// not used either.
GrayImage RectifiedMask(const GrayImage& raw, const BilinearMap* map, const GrayImage& valid) {
  GrayImage used(raw.width(), raw.height());
  std::transform(raw.data(), raw.data() + raw.width() * raw.height(), used.data(), [](auto level) {
    return static_cast<std::uint8_t>(level != 0 ? 255 : 0);
  });
  if (map != nullptr) used = map->Apply(used);
  std::transform(used.data(),
                 used.data() + used.width() * used.height(),
                 valid.data(),
                 used.data(),
                 [](auto of_mask, auto of_lens) {
                   return static_cast<std::uint8_t>(of_mask == 255 && of_lens != 0 ? 255 : 0);
                 });
  return used;
}

}  // namespace

RectifiedFrame Rectifier::Apply(SensorFrame frame, HelperThread* helper) const {
  RectifiedFrame result;
  result.stamp_ns = frame.stamp_ns;
  CheckSize(frame.left, calibration_.left, "left");
  if (frame.right && calibration_.right) {
    CheckSize(*frame.right, *calibration_.right, "right");
    result.right.emplace();
  }
  if (frame.depth && calibration_.depth_factor) {
    CheckSize(*frame.depth, calibration_.left, "depth");
    result.depth.emplace();
  }
  if (frame.left_mask) {
    CheckSize(*frame.left_mask, calibration_.left, "left mask");
    const BilinearMap* map = left_maps_ ? &left_maps_->linear : nullptr;
    result.left_mask = RectifiedMask(*frame.left_mask, map, left_mask_);
  }
  if (frame.right_mask && calibration_.right) {
    CheckSize(*frame.right_mask, *calibration_.right, "right mask");
    const BilinearMap* map = right_maps_ ? &right_maps_->linear : nullptr;
    result.right_mask = RectifiedMask(*frame.right_mask, map, right_mask_);
  }
  const bool left_alone = !result.right && !result.depth;
  ParallelFor(left_alone ? 1 : 2, helper, [&](int image) {
    if (image == 0) {
      result.left = left_maps_ ? left_maps_->linear.Apply(frame.left) : std::move(frame.left);
      return;
    }
    if (result.right) {
      *result.right =
          right_maps_ ? right_maps_->linear.Apply(*frame.right) : std::move(*frame.right);
    }
    if (result.depth) {
      *result.depth = left_maps_ ? left_maps_->Apply(*frame.depth) : std::move(*frame.depth);
    }
  });
  return result;
}

namespace {

std::optional<Eigen::Vector2d> RectifyPixel(const View& view,
                                            const RectifiedCamera& ideal,
                                            const Eigen::Vector2d& raw_px) {
  const std::optional<Eigen::Vector2d> tangents = RectifiedTangents(view, raw_px);
  if (!tangents) return std::nullopt;
  return ideal.Project(tangents->homogeneous());
}

}  // namespace

Rectifier::Coverage Rectifier::LeftCoverage() const {
  constexpr double kSteps = 64;
  const Camera& left = calibration_.left;
  const auto degrees = [](double focal, double from, double to) {
    return (math::Atan(to / focal) - math::Atan(from / focal)) / kDegree;
  };
  Coverage coverage;
  coverage.across_deg = degrees(camera_.fx, -camera_.cx, camera_.width - 1 - camera_.cx);
  coverage.down_deg = degrees(camera_.fy, -camera_.cy, camera_.height - 1 - camera_.cy);
  coverage.resolution = camera_.fx / left.CentreFocal();
  double widest = 0, inside = 0, all = 0;
  for (double y = 0; y <= kSteps; ++y) {
    for (double x = 0; x <= kSteps; ++x) {
      const Eigen::Vector2d px((left.width() - 1) * x / kSteps, (left.height() - 1) * y / kSteps);
      const std::optional<Eigen::Vector3d> ray = left.Ray(px);
      if (ray) widest = std::max(widest, math::Atan2(ray->head<2>().norm(), ray->z()));
      const std::optional<Eigen::Vector2d> seen = RectifyLeft(px);
      inside += seen && camera_.Contains(*seen) ? 1 : 0;
      ++all;
    }
  }
  const double right = camera_.width - 1, bottom = camera_.height - 1;
  const Eigen::Vector2d corners[] = {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}, {0, 0}};
  const Eigen::Quaterniond left_from_rectified = rectified_left_from_left_.conjugate();
  for (int side = 0; side < 4; ++side) {
    for (double share = 0; share < 1; share += 1 / kSteps) {
      const Eigen::Vector2d px = corners[side] + share * (corners[side + 1] - corners[side]);
      const auto raw = left.Project(left_from_rectified * camera_.Unproject(px));
      if (raw) coverage.outline.push_back(*raw);
    }
  }
  coverage.lens_deg = 2 * widest / kDegree;
  coverage.used = inside / all;
  return coverage;
}

std::optional<Eigen::Vector2d> Rectifier::RectifyLeft(const Eigen::Vector2d& raw_px) const {
  return RectifyPixel({&calibration_.left, rectified_left_from_left_}, camera_, raw_px);
}

std::optional<Eigen::Vector2d> Rectifier::RectifyRight(const Eigen::Vector2d& raw_px) const {
  if (!calibration_.right) return std::nullopt;
  return RectifyPixel({&*calibration_.right, rectified_right_from_right_}, camera_, raw_px);
}

std::string ViewText(const Rectifier& rectifier) {
  const Rectifier::Coverage coverage = rectifier.LeftCoverage();
  const auto whole = [](double value) { return std::to_string(std::lround(value)); };
  return whole(coverage.across_deg) + " x " + whole(coverage.down_deg) + " of " +
         whole(coverage.lens_deg) + " degrees, " + whole(100 * coverage.used) +
         " % of the image, as " + SizeText(rectifier.camera().width, rectifier.camera().height) +
         " pixels of " + whole(100 * coverage.resolution) + " % of the resolution in the middle";
}

}  // namespace plumbline
