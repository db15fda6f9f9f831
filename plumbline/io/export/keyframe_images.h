// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/image/color_image.h"
#include "plumbline/image/rectify.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/export/export_camera.h"
#include "plumbline/io/map_file/map_io.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace plumbline {

// Form of an exported image: as delivered by the camera, turned and reduced as for the run, or that
// of the map's camera, a pinhole without distortion, rectified for stereo.
enum class ImageForm { kDelivered, kUndistorted };

// An exported frame that is no keyframe: the name of its image, and the pose of the rectified left
// camera.
struct PosedImage {
  std::int64_t stamp_ns = 0;
  std::string name;
  Rigid3 cam_from_world;
};

// Returns the names of the images of keyframes in an exported map: the time stamp in nanoseconds,
// "1403636580863555584.png". Further keyframes of one time, in the order of their ids, get
// "<stamp>_2.png", "<stamp>_3.png" and so on.
std::map<KeyFrameId, std::string> KeyFrameImageNames(const Map& map);

// The images of a map's keyframes, and of other frames, in colour if the data have colour. They are
// found by their time stamps in the data of the map.
//
// Equal stamps do not prove that the data are the same: the stamps of a reversed run are mirrored,
// and sessions of one map may have the same stamps. Descriptors are therefore computed again at the
// keyframe's features: the same image gives the same descriptors. An image that was blurred for the
// run (--blur) is close enough.
class KeyFrameImages {
 public:
  // Opens the data. `options` without a sensor: the sensor whose images fit the map; without a
  // maximum width: that of the map's camera, or the one that gives the map's focal length, so that
  // images are reduced as in the run; without a view angle: that of the map (ViewAngleOfMap).
  // Throws InputError if the data's camera is not that of the map, or the data has no frame at the
  // time of a keyframe.
  KeyFrameImages(const std::filesystem::path& path,
                 const DatasetOptions& options,
                 const SavedMap& saved);
  // The same for open data, with the sensor they were opened as.
  KeyFrameImages(std::shared_ptr<const Dataset> dataset, const SavedMap& saved);

  // Reads the left image. Throws InputError if it cannot be read, and if it differs from that of
  // the keyframe. The comparison needs a map with an octave_scale; keyframes with very few features
  // are not compared.
  ColorImage Read(const KeyFrame& keyframe, ImageForm form = ImageForm::kUndistorted) const;

  // Returns true if the data have a frame of exactly this time.
  bool HasFrame(std::int64_t stamp_ns) const;
  // Reads the left image of an existing frame, without comparison with a keyframe. Throws
  // InputError if it cannot be read.
  ColorImage ReadAt(std::int64_t stamp_ns, ImageForm form = ImageForm::kUndistorted) const;

  // Camera of the images as delivered; that of the map where both are the same.
  ExportCamera DeliveredCamera() const;
  // The data.
  const std::filesystem::path& path() const { return dataset_->info().path; }

 private:
  std::optional<std::string> Open(const std::filesystem::path& path,
                                  const DatasetOptions& given,
                                  const SavedMap& saved);
  std::optional<std::string> OpenAs(const std::filesystem::path& path,
                                    DatasetOptions options,
                                    const SavedMap& saved);
  std::string DifferenceAsStored(const std::filesystem::path& path,
                                 const std::string& difference,
                                 const DatasetOptions& given,
                                 const SavedMap& saved);
  void CheckKeyFrames(const SavedMap& saved) const;
  ColorImage ReadRaw(std::int64_t stamp_ns) const;
  ColorImage InForm(ColorImage raw, ImageForm form) const;

  std::optional<double> octave_scale_;
  std::shared_ptr<const Dataset> dataset_;
  std::unique_ptr<Rectifier> rectifier_;
};

}  // namespace plumbline
