// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/stamp_order.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// An entry of a list of images.
struct ListedImage {
  StampedRow row;
  std::filesystem::path path;
};

// Returns the images of a list in order of time, without repeated times (OrderOfTime).
std::vector<ListedImage> InOrderOfTime(const std::filesystem::path& list,
                                       const std::vector<ListedImage>& images,
                                       std::vector<std::string>& notes);

// Returns true if the file or folder exists. Throws InputError if that is unknown.
bool PathExists(const std::filesystem::path& path);

// Throws InputError if a second sensor ("right", "depth") has other files but no list of its
// images, so that it is not ignored silently.
void CheckSecondList(const std::filesystem::path& list, const char* images);

// The image files of one frame.
struct FrameFiles {
  std::filesystem::path left;
  std::optional<std::filesystem::path> right;
  std::optional<std::filesystem::path> depth;
  std::optional<std::filesystem::path> left_mask = std::nullopt, right_mask = std::nullopt;
};

// Makes a data set of image files. files[i] belongs to info.stamps_ns[i]. Listed but missing images
// become a note. Masks are found by the names of the images: mask0/NAME.png of left/NAME.*, and
// mask1 for the right camera, in the folder of the data set (or mav0 in it); a note says how many.
// Throws InputError if there are no frames, or if no left, no right or no depth image exists or can
// be read at all, or as CheckFirstFrame.
std::unique_ptr<Dataset> MakeImageDataset(DatasetInfo info, std::vector<FrameFiles> files);

// Returns the size of the images of a camera of a data set; nullopt if it is not known.
std::optional<ImageSize> SizeOfCamera(const DatasetInfo& info, bool right);

// Returns the share of the pixels of a mask that are black, which are not used.
double MaskedShare(const GrayImage& mask);

// The masks of the images of a camera: how many there are, of how many images, and where, "in
// data/mask0".
struct FoundMasks {
  std::size_t masks = 0, images = 0;
  std::string place;
};

// Notes how many images have a mask, and of some of them, evenly spread, what share of the image
// they leave out and which cannot be used; `read` gives mask i < masks. Cost: decoding these.
void NoteMasks(const FoundMasks& masks,
               const std::function<Expected<GrayImage, ImageFailure>(std::size_t)>& read,
               DatasetInfo& info);

// Returns the failure of one image; if its size differs from `wanted`, that of the calibration, the
// reason tells both.
ImageFailure FailureOf(ImageFailure failure, ImageSize wanted);

// Returns the failure of a mask; the reason tells both sizes if it differs from that of its images.
ImageFailure MaskFailureOf(ImageFailure failure, std::optional<ImageSize> wanted);

// Reads frames until one can be read, so that a calibration of another size is detected before the
// run. Throws InputError if none can be read, or if the first ten images that can be decoded have
// another size than the calibration.
void CheckFirstFrame(const Dataset& dataset);

// Adds a note if the first image has 16 bits; its brightest level is `brightest`
// (BrightestOf16Bits). These grey levels lose their lower 8 bits, so that images of a 12-bit camera
// that are not shifted up are almost black.
void NoteBits(std::optional<int> brightest, DatasetInfo& info);

// Adds a note if the stamps are implausibly close (most of more than ten less than a millisecond
// apart): usually their unit differs from that of the format.
void NoteRate(DatasetInfo& info);

// The requested sensor is missing in the data.
class MissingSensor : public InputError {
 public:
  using InputError::InputError;
};

// Sets name, path, format, available and sensor: the requested sensor, or the richest one. Throws
// MissingSensor if the data does not have it.
DatasetInfo DescribeDataset(const std::filesystem::path& path,
                            DatasetFormat format,
                            std::vector<SensorKind> available,
                            const DatasetOptions& options);

// Returns the camera file named by the user or in the data set's folder (CameraFileIn); nullopt if
// there is neither. Throws InputError if `sensor` is stereo and the file has only one camera.
std::optional<CameraFile> GivenCamera(const std::filesystem::path& folder,
                                      const DatasetOptions& options,
                                      std::optional<SensorKind> sensor = std::nullopt);

// Sets the calibration for info.sensor, without the second camera or the depth factor if they are
// not used.
void UseCamera(CameraFile camera, DatasetInfo& info);

// Returns the name displayed to users.
std::string SensorName(SensorKind sensor);

// Returns the names of the image files in a folder, without hidden ones, in natural order: runs of
// digits count as numbers, so that 2.png comes before 10.png, and as fractions after a decimal
// point, so that 0.05.png comes before 0.1.png. Throws InputError if the folder is missing, and if
// two names have the same number (3.png, 000003.png).
std::vector<std::string> ListImages(const std::filesystem::path& folder);

// Returns the message for a data set without calibration, with instructions.
std::string NoCalibration(const std::filesystem::path& path);

}  // namespace plumbline
