// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/keyframe_images.h"

#include "plumbline/base/error.h"
#include "plumbline/base/statistics.h"
#include "plumbline/features/lbd.h"
#include "plumbline/features/line_detection.h"
#include "plumbline/features/orb.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/image/filters.h"
#include "plumbline/io/datasets/frame_preparation.h"
#include "plumbline/io/datasets/ground_truth.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/map_file/map_view_angle.h"
#include "plumbline/io/trajectory_io.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

// Returns the index of the frame of exactly this time.
std::optional<std::size_t> FrameAt(const Dataset& dataset, std::int64_t stamp_ns) {
  const std::vector<std::int64_t>& stamps = dataset.info().stamps_ns;
  const auto found = std::lower_bound(stamps.begin(), stamps.end(), stamp_ns);
  if (found == stamps.end() || *found != stamp_ns) return std::nullopt;
  return static_cast<std::size_t>(found - stamps.begin());
}

// Returns the differences between the rectified left camera of the data and the camera of the map.
// The baseline does not matter.
std::optional<std::string> LeftCameraDifference(const Rectifier& rectifier, const SavedMap& saved) {
  RectifiedCamera camera = rectifier.camera();
  camera.baseline = saved.camera.baseline;
  return CameraDifference({saved.camera, saved.rectified_from_left},
                          {camera, rectifier.rectified_left_from_left()});
}

// True if the pinhole images of a camera have another size than those that it delivers.
bool HasOtherSize(const Dataset& dataset) {
  const RectifiedCamera camera = Rectifier(dataset.calibration()).camera();
  const Camera& left = dataset.calibration().left;
  return camera.width != left.width() || camera.height != left.height();
}

// Returns the width of reduced images whose lens has this focal length in its middle; nullopt if
// they would not be smaller.
std::optional<int> WidthOfFocal(const Dataset& dataset, double focal) {
  const Calibration& calibration = dataset.calibration();
  double of_lens = calibration.left.CentreFocal();
  if (calibration.right) of_lens = 0.5 * (of_lens + calibration.right->CentreFocal());
  const long width = std::lround(calibration.left.width() * focal / of_lens);
  if (width < 1 || width >= calibration.left.width()) return std::nullopt;
  return static_cast<int>(width);
}

// The images get the size of the map's camera: the run reduced larger ones. Rotated images are
// those of one camera.
DatasetOptions AsUsedFor(const SavedMap& saved, DatasetOptions options) {
  if (!options.max_width) options.max_width = saved.camera.width;
  options.ground_truth = kNoGroundTruth;
  if (!options.sensor && !TurnOf(options.rotate).IsIdentity()) options.sensor = SensorKind::kMono;
  return options;
}

bool IsInside(const GrayImage& image, const Segment2& segment) {
  return std::min(segment.start.minCoeff(), segment.end.minCoeff()) >= 0 &&
         std::max(segment.start.x(), segment.end.x()) < image.width() &&
         std::max(segment.start.y(), segment.end.y()) < image.height();
}

// Returns in how many bits the descriptors of a keyframe differ from those that the image has at
// the same places, one number for each feature.
std::vector<double> DifferingBits(const Features& features,
                                  const GrayImage& image,
                                  double octave_scale) {
  std::vector<double> bits;
  const auto points =
      DescribeOrbAt(BuildOrbPyramid(image, {.scale_factor = octave_scale}), features.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i]) continue;
    bits.push_back(HammingDistance(*points[i], features.points[i].descriptor));
  }
  std::vector<LineFeature> measured = features.lines;
  std::erase_if(measured, [&](const LineFeature& line) { return !IsInside(image, line.segment); });
  std::vector<LineFeature> lines = measured;
  if (!lines.empty()) DescribeLines(ComputeGradient(image, kLineBlurPx), &lines);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    bits.push_back(HammingDistance(lines[i].descriptor, measured[i].descriptor));
  }
  return bits;
}

// Returns true if an image may be that of a keyframe. On MH_01, KITTI 07 and a rendered room, the
// median over the features of a keyframe is 0 for the image itself, 8 if the run applied a box
// filter of 5 x 5 pixels to it and 52 with 21 x 21, about 100 for the next image of a moving
// camera, and at least 115 for an image of another scene.
bool MayShow(const GrayImage& image, const KeyFrame& keyframe, double octave_scale) {
  constexpr std::size_t kFewest = 30;
  constexpr double kMostBits = 80;
  const std::vector<double> bits =
      DifferingBits(MeasuredFeatures(*keyframe.frame.indexed), image, octave_scale);
  return bits.size() < kFewest || UpperMedian(bits) <= kMostBits;
}

[[noreturn]] void FailCamera(const std::filesystem::path& path, const std::string& difference) {
  throw InputError(path.string() + ": expected the camera that the map was made with, found " +
                   "another one: " + difference);
}

GrayImage Rectified(const Rectifier& rectifier, GrayImage left) {
  SensorFrame frame;
  frame.left = std::move(left);
  return rectifier.Apply(std::move(frame)).left;
}

ColorImage Rectified(const Rectifier& rectifier, ColorImage left) {
  if (IsGray(left)) return ToColor(Rectified(rectifier, std::move(left.red)));
  return WithEachChannel(
      std::move(left), [&](GrayImage channel) { return Rectified(rectifier, std::move(channel)); });
}

}  // namespace

std::map<KeyFrameId, std::string> KeyFrameImageNames(const Map& map) {
  std::map<KeyFrameId, std::string> names;
  std::map<std::int64_t, int> seen;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const std::int64_t stamp = keyframe.frame.stamp_ns;
    const int count = ++seen[stamp];
    names[id] = count == 1 ? fmt::format("{}.png", stamp) : fmt::format("{}_{}.png", stamp, count);
  }
  return names;
}

// Opens data for each of their sensors, reduced as the run may have done, until the camera is that
// of the map. Returns the difference for the first sensor, if none is.
std::optional<std::string> KeyFrameImages::Open(const std::filesystem::path& path,
                                                const DatasetOptions& given,
                                                const SavedMap& saved) {
  DatasetOptions options = AsUsedFor(saved, given);
  const std::optional<std::string> difference = OpenAs(path, options, saved);
  if (!difference) return std::nullopt;
  std::vector<SensorKind> sensors = dataset_->info().available;
  if (options.sensor) sensors = {*options.sensor};
  for (const SensorKind sensor : sensors) {
    options = AsUsedFor(saved, given);
    options.sensor = sensor;
    if (!OpenAs(path, options, saved)) return std::nullopt;
    if (given.max_width) continue;
    // The map's camera may have another width than the images: these are reduced as by default, or
    // until the middle of the lens has the focal length of the map.
    options.max_width.reset();
    if (!OpenAs(path, options, saved)) return std::nullopt;
    options.max_width = WidthOfFocal(*dataset_, saved.camera.fx);
    if (options.max_width && !OpenAs(path, options, saved)) return std::nullopt;
  }
  return difference;
}

// The same for one sensor and width, with the view angle of the map unless one is given.
std::optional<std::string> KeyFrameImages::OpenAs(const std::filesystem::path& path,
                                                  DatasetOptions options,
                                                  const SavedMap& saved) {
  const auto open = [&] {
    dataset_ = OpenDataset(path, options);
    rectifier_ = std::make_unique<Rectifier>(dataset_->calibration());
    return LeftCameraDifference(*rectifier_, saved);
  };
  std::optional<std::string> difference = open();
  if (!difference || options.view_angle_deg) return difference;
  options.view_angle_deg = ViewAngleOfMap(saved.camera, dataset_->calibration());
  return options.view_angle_deg ? open() : difference;
}

KeyFrameImages::KeyFrameImages(const std::filesystem::path& path,
                               const DatasetOptions& given,
                               const SavedMap& saved)
    : octave_scale_(saved.octave_scale) {
  if (const auto difference = Open(path, given, saved)) {
    FailCamera(path, DifferenceAsStored(path, *difference, given, saved));
  }
  CheckKeyFrames(saved);
}

// The difference in words of users: the view angle, if that alone differs, or the sizes of the
// images before their reduction to the width of the map's, which they do not know.
std::string KeyFrameImages::DifferenceAsStored(const std::filesystem::path& path,
                                               const std::string& difference,
                                               const DatasetOptions& given,
                                               const SavedMap& saved) {
  DatasetOptions options = given;
  options.view_angle_deg.reset();
  if (given.view_angle_deg && !Open(path, options, saved)) {
    Calibration asked = dataset_->calibration();
    asked.view_angle_deg = given.view_angle_deg;
    return ViewAngleDifference(saved.camera, asked).value_or(difference);
  }
  options = AsUsedFor(saved, given);
  dataset_ = OpenDataset(path, options);
  const bool same_height =
      Rectifier(dataset_->calibration()).camera().height == saved.camera.height;
  if (same_height || HasOtherSize(*dataset_)) return difference;
  options.max_width = given.max_width.value_or(std::numeric_limits<int>::max());
  dataset_ = OpenDataset(path, options);
  const Camera& camera = dataset_->calibration().left;
  const bool upright = saved.camera.height > saved.camera.width;
  return fmt::format("images of {}x{} and {}x{} pixels{}",
                     saved.camera.width,
                     saved.camera.height,
                     camera.width(),
                     camera.height(),
                     upright != (camera.height() > camera.width()) ? ", one of them turned" : "");
}

KeyFrameImages::KeyFrameImages(std::shared_ptr<const Dataset> dataset, const SavedMap& saved)
    : octave_scale_(saved.octave_scale), dataset_(std::move(dataset)) {
  rectifier_ = std::make_unique<Rectifier>(dataset_->calibration());
  if (const auto difference = LeftCameraDifference(*rectifier_, saved)) {
    FailCamera(path(), *difference);
  }
  CheckKeyFrames(saved);
}

void KeyFrameImages::CheckKeyFrames(const SavedMap& saved) const {
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    if (HasFrame(keyframe.frame.stamp_ns)) continue;
    throw InputError(
        fmt::format("{}: expected a frame at {} s, where the map has keyframe {}, found none",
                    path().string(),
                    FormatStamp(keyframe.frame.stamp_ns),
                    id.value));
  }
}

bool KeyFrameImages::HasFrame(std::int64_t stamp_ns) const {
  return FrameAt(*dataset_, stamp_ns).has_value();
}

ColorImage KeyFrameImages::ReadRaw(std::int64_t stamp_ns) const {
  const auto index = FrameAt(*dataset_, stamp_ns);
  PLUMBLINE_CHECK(index.has_value(), "a frame of the data");
  Expected<ColorImage, ImageFailure> read = dataset_->ReadColor(*index);
  if (!read) throw InputError(read.error().path.string() + ": " + read.error().why);
  return *std::move(read);
}

ExportCamera KeyFrameImages::DeliveredCamera() const {
  const RectifiedCamera& rectified = rectifier_->camera();
  if (rectifier_->PassesUnchanged()) return ExportCamera(rectified);
  return {rectified, rectifier_->rectified_left_from_left(), dataset_->calibration().left};
}

ColorImage KeyFrameImages::InForm(ColorImage raw, ImageForm form) const {
  return form == ImageForm::kDelivered ? raw : Rectified(*rectifier_, std::move(raw));
}

ColorImage KeyFrameImages::ReadAt(std::int64_t stamp_ns, ImageForm form) const {
  return InForm(ReadRaw(stamp_ns), form);
}

ColorImage KeyFrameImages::Read(const KeyFrame& keyframe, ImageForm form) const {
  ColorImage image = ReadRaw(keyframe.frame.stamp_ns);
  const bool compare = octave_scale_.has_value();
  if (compare && !MayShow(Rectified(*rectifier_, ToGray(image)), keyframe, *octave_scale_)) {
    throw InputError(
        fmt::format("{}: expected the images that the map was made of, found another one at {} s, "
                    "where the map has keyframe {} (another session?)",
                    path().string(),
                    FormatStamp(keyframe.frame.stamp_ns),
                    keyframe.id.value));
  }
  return InForm(std::move(image), form);
}

}  // namespace plumbline
