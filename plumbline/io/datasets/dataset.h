// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/image/color_image.h"
#include "plumbline/image/image.h"
#include "plumbline/io/datasets/image_file.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Contents of a frame: one image, a stereo pair, or an image with depth.
enum class SensorKind { kMono, kStereo, kRgbd };
constexpr auto EnumNames(std::type_identity<SensorKind>) {
  return std::array{std::pair{SensorKind::kMono, "mono"},
                    std::pair{SensorKind::kStereo, "stereo"},
                    std::pair{SensorKind::kRgbd, "rgbd"}};
}

// Storage format of a sequence. kStream is the format of a live source and not selectable.
enum class DatasetFormat { kEuroc, kTum, kKitti, kImages, kVideo, kBag, kMcap, kRosbag2, kStream };
constexpr auto EnumNames(std::type_identity<DatasetFormat>) {
  return std::array{std::pair{DatasetFormat::kEuroc, "euroc"},
                    std::pair{DatasetFormat::kTum, "tum"},
                    std::pair{DatasetFormat::kKitti, "kitti"},
                    std::pair{DatasetFormat::kImages, "images"},
                    std::pair{DatasetFormat::kVideo, "video"},
                    std::pair{DatasetFormat::kBag, "bag"},
                    std::pair{DatasetFormat::kMcap, "mcap"},
                    std::pair{DatasetFormat::kRosbag2, "rosbag2"}};
}

// Reference poses as delivered with a data set, not transformed.
struct GroundTruth {
  // The moving frame: the left camera, or a body that carries it (Calibration::body_from_left).
  enum class Frame { kCamera, kBody };

  Trajectory poses;  // world_from_camera is world_from_body if frame is kBody
  Frame frame = Frame::kCamera;
  std::filesystem::path path;  // file of the poses

  // Returns the poses of the left camera, world_from_body * body_from_left. Throws BugError if
  // `frame` is kBody and the calibration has no body_from_left, which OpenDataset excludes.
  Trajectory OfCamera(const Calibration& calibration) const;
};

// Description of a recorded sequence, known before any image is read.
struct DatasetInfo {
  std::string name;  // last part of the path
  std::filesystem::path path;
  DatasetFormat format = DatasetFormat::kImages;
  std::string layout;                     // variant of the format, for display; may be empty
  SensorKind sensor = SensorKind::kMono;  // sensor it was opened as
  std::vector<SensorKind> available;      // sensors in the data, richest first
  std::vector<std::int64_t> stamps_ns;    // one per frame, strictly increasing
  // Has `right` and `depth_factor` only if they are used.
  Calibration calibration;
  std::string calibration_source;           // origin of the calibration, for display
  bool has_calibration = true;              // false only with DatasetOptions::allow_missing_camera
  std::optional<GroundTruth> ground_truth;  // nullopt if there is no usable one
  // "FILE:LINE: expected ..., found ...": reason why delivered ground truth is unusable.
  std::optional<std::string> ground_truth_fault;
  // One sentence for each missing or left-out part.
  std::vector<std::string> notes;
};

// A recorded sequence: frames in time order, read on demand.
class Dataset {
 public:
  // Base class of the readers of formats, which pass the description.
  explicit Dataset(DatasetInfo info) : info_(std::move(info)) {}
  Dataset(const Dataset&) = delete;
  Dataset& operator=(const Dataset&) = delete;
  virtual ~Dataset() = default;

  // Description of the sequence.
  const DatasetInfo& info() const { return info_; }
  // Calibration of the cameras in use.
  const Calibration& calibration() const { return info_.calibration; }
  // Contents of the frames.
  SensorKind sensor() const { return info_.sensor; }
  // Number of frames.
  std::size_t size() const { return info_.stamps_ns.size(); }
  // Time stamp of frame i < size(), nanoseconds.
  std::int64_t stamp_ns(std::size_t i) const { return info_.stamps_ns.at(i); }

  // Decodes frame i < size(). Fails, for this frame only, if an image is missing, undecodable or
  // truncated. Thread-safe. Cost: the decoding, some milliseconds an image.
  virtual Expected<SensorFrame, ImageFailure> Read(std::size_t i) const = 0;

  // Decodes only the left image of frame i < size(), in colour if stored so; a grey one has the
  // same level in all channels. Its ToGray is the left image of Read. Fails like Read. Default: the
  // grey image of Read; data sets that may have colours, or wrap another one, override it.
  virtual Expected<ColorImage, ImageFailure> ReadColor(std::size_t i) const;

 private:
  DatasetInfo info_;
};

// Clockwise rotation of images before use. kAuto: as the file says, a video by its display matrix
// and image files of a folder by their EXIF orientation (which may mirror them); all other images
// are not rotated.
enum class Rotation { kAuto, kNone, k90, k180, k270 };
constexpr auto EnumNames(std::type_identity<Rotation>) {
  return std::array{std::pair{Rotation::kAuto, "auto"},
                    std::pair{Rotation::kNone, "none"},
                    std::pair{Rotation::k90, "90"},
                    std::pair{Rotation::k180, "180"},
                    std::pair{Rotation::k270, "270"}};
}

// Options for opening a data set, beyond its own description.
struct DatasetOptions {
  std::optional<SensorKind> sensor = std::nullopt;     // nullopt: the richest in the data
  std::optional<DatasetFormat> format = std::nullopt;  // nullopt: detected from the folder
  // A camera file (camera_file.h) or the name of a built-in camera, for example "tum_fr1". It
  // replaces a camera file in the folder (CameraFileIn) and the calibration of the data.
  std::optional<std::string> camera = std::nullopt;
  // A file of poses (trajectory_io.h) in place of the ground truth of the data, of the same frame,
  // or "none" for none. nullopt: that of the data, if there is a usable one.
  std::optional<std::string> ground_truth = std::nullopt;
  // Bags and MCAP files: the topics of the images, in the order left, right, depth. Empty: chosen
  // automatically.
  std::vector<std::string> topics = {};
  // If true, data without a calibration can be opened for viewing, with a placeholder
  // `calibration`. If false, a missing calibration is an InputError.
  bool allow_missing_camera = false;
  // Rotation of the images and their calibration (frame_preparation.h). The camera frame is that of
  // the images as used.
  Rotation rotate = Rotation::kAuto;
  // Wider images, and their calibration, are reduced to this width. nullopt: images above 2
  // megapixels are reduced to that size.
  std::optional<int> max_width = std::nullopt;
  // Calibration::view_angle_deg of the data set.
  std::optional<double> view_angle_deg = std::nullopt;
  // Image files of masks, of the left and of the right camera, for all frames: black is not used.
  // In a recording also topics of images. They are as the images are stored, and go with masks that
  // the data have for each frame.
  std::vector<std::string> masks = {};
};

}  // namespace plumbline
