// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/image/color_image.h"
#include "plumbline/image/image.h"
#include "plumbline/io/image_file.h"

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

// What a frame consists of: one image, a stereo pair, or an image with depth.
enum class SensorKind { kMono, kStereo, kRgbd };
constexpr auto EnumNames(std::type_identity<SensorKind>) {
  return std::array{std::pair{SensorKind::kMono, "mono"},
                    std::pair{SensorKind::kStereo, "stereo"},
                    std::pair{SensorKind::kRgbd, "rgbd"}};
}

// How a sequence is stored. kStream is the format of a live source; nobody can ask for it.
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
  // What moves: the left camera, or a body that carries it (Calibration::body_from_left).
  enum class Frame { kCamera, kBody };

  Trajectory poses;  // world_from_camera holds world_from_body where frame is kBody
  Frame frame = Frame::kCamera;
  std::filesystem::path path;  // the file from which the poses were read

  // Returns the poses of the left camera, world_from_body * body_from_left. Throws BugError where
  // `frame` is kBody and the calibration has no body_from_left, which OpenDataset rules out.
  Trajectory OfCamera(const Calibration& calibration) const;
};

// What is known about a recorded sequence before any image is read.
struct DatasetInfo {
  std::string name;  // last part of the path
  std::filesystem::path path;
  DatasetFormat format = DatasetFormat::kImages;
  std::string layout;                     // which data of this format, for people; may be empty
  SensorKind sensor = SensorKind::kMono;  // what it was opened as
  std::vector<SensorKind> available;      // what the data offers, richest first
  std::vector<std::int64_t> stamps_ns;    // one per frame, strictly increasing
  // Has `right` and `depth_factor` only where they are used.
  Calibration calibration;
  std::string calibration_source;           // where it was read from, for people
  bool has_calibration = true;              // false only with DatasetOptions::allow_missing_camera
  std::optional<GroundTruth> ground_truth;  // nullopt: there is none that can be used
  // "FILE:LINE: expected ..., found ...": why what was delivered as ground truth cannot be used.
  std::optional<std::string> ground_truth_fault;
  // One sentence for each thing that is missing or left out.
  std::vector<std::string> notes;
};

// A recorded sequence: frames in time order, read on demand.
class Dataset {
 public:
  // Readers of formats derive from this class and pass what they found out.
  explicit Dataset(DatasetInfo info) : info_(std::move(info)) {}
  Dataset(const Dataset&) = delete;
  Dataset& operator=(const Dataset&) = delete;
  virtual ~Dataset() = default;

  // All that is known without reading images.
  const DatasetInfo& info() const { return info_; }
  // The calibration of the cameras in use.
  const Calibration& calibration() const { return info_.calibration; }
  // What the frames consist of.
  SensorKind sensor() const { return info_.sensor; }
  // The number of frames.
  std::size_t size() const { return info_.stamps_ns.size(); }
  // The time stamp of frame i < size(), nanoseconds.
  std::int64_t stamp_ns(std::size_t i) const { return info_.stamps_ns.at(i); }

  // Decodes frame i < size(). Fails, for this frame only, when an image is missing, cannot be
  // decoded or is cut short. Thread-safe. Cost: the decoding, some milliseconds an image.
  virtual Expected<SensorFrame, ImageFailure> Read(std::size_t i) const = 0;

  // Decodes the left image alone of frame i < size(), in colour where it is stored so; a grey one
  // has the same in all channels. ToGray of it is the left image of Read. Fails as Read does. Here:
  // the grey image of Read; a data set that may hold colours, or wraps another one, overrides it.
  virtual Expected<ColorImage, ImageFailure> ReadColor(std::size_t i) const;

 private:
  DatasetInfo info_;
};

// By which angle images are turned clockwise before they are used. kAuto: as the file asks, a video
// by its display matrix and still images of a folder by their EXIF orientation (which may mirror
// them); all other images stay as they are stored.
enum class Rotation { kAuto, kNone, k90, k180, k270 };
constexpr auto EnumNames(std::type_identity<Rotation>) {
  return std::array{std::pair{Rotation::kAuto, "auto"},
                    std::pair{Rotation::kNone, "none"},
                    std::pair{Rotation::k90, "90"},
                    std::pair{Rotation::k180, "180"},
                    std::pair{Rotation::k270, "270"}};
}

// How to open a data set, where it does not say so itself.
struct DatasetOptions {
  std::optional<SensorKind> sensor = std::nullopt;     // nullopt: the richest the data offers
  std::optional<DatasetFormat> format = std::nullopt;  // nullopt: found out from the folder
  // A camera file (camera_file.h) or the name of a built-in camera such as "tum_fr1". It takes the
  // place of a camera file in the folder (CameraFileIn) and of the calibration of the data.
  std::optional<std::string> camera = std::nullopt;
  // A file of poses (trajectory_io.h) in place of the ground truth of the data, of the same frame,
  // or "none" for none. nullopt: that of the data, where there is some that can be used.
  std::optional<std::string> ground_truth = std::nullopt;
  // Bags and MCAP files: the topics of the images, in the order left, right, depth. Empty: they are
  // chosen from those in the file.
  std::vector<std::string> topics = {};
  // Whether to open the data even where there is no calibration, in order to look at it.
  // `calibration` is a placeholder then. If false, a missing calibration is an InputError.
  bool allow_missing_camera = false;
  // How images are turned, and the calibration with them (frame_preparation.h). The camera frame is
  // that of the images as used.
  Rotation rotate = Rotation::kAuto;
  // Images of more columns are reduced to this width, and the calibration with them. nullopt: to 2
  // megapixels, where they have more.
  std::optional<int> max_width = std::nullopt;
};

}  // namespace plumbline
