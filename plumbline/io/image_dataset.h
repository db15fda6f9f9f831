// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/io/camera_file.h"
#include "plumbline/io/dataset.h"
#include "plumbline/io/stamp_order.h"

#include <cstdint>
#include <filesystem>
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

// Returns the images of a list in order of time, each time once (OrderOfTime).
std::vector<ListedImage> InOrderOfTime(const std::filesystem::path& list,
                                       const std::vector<ListedImage>& images,
                                       std::vector<std::string>& notes);

// Whether there is such a file or folder. Throws InputError where that cannot be found out.
bool PathExists(const std::filesystem::path& path);

// Throws InputError where a second sensor ("right", "depth") has other files but no list of its
// images, so that it is not left out silently.
void CheckSecondList(const std::filesystem::path& list, const char* images);

// The image files of one frame.
struct FrameFiles {
  std::filesystem::path left;
  std::optional<std::filesystem::path> right;
  std::optional<std::filesystem::path> depth;
};

// Makes a data set whose frames are image files. files[i] belongs to info.stamps_ns[i]. Images that
// are listed but missing become a note. Throws InputError when there are no frames, or when no
// left, no right or no depth image exists or can be read at all. An image of another size than the
// calibration's is an InputError when it is read; the first readable frame is read at once.
std::unique_ptr<Dataset> MakeImageDataset(DatasetInfo info, std::vector<FrameFiles> files);

// Returns the failure of one image. Throws InputError if the image is of another size than the
// calibration's, `wanted`, which no image of a sequence may be.
ImageFailure FailureOf(const ImageFailure& failure, ImageSize wanted);

// Reads frames until one can be read, so that a calibration of another size shows before the run.
// Throws InputError when none can be read.
void CheckFirstFrame(const Dataset& dataset);

// Adds a note where the first image has 16 bits; its brightest level is `brightest`
// (BrightestOf16Bits). Such grey levels lose their lower 8 bits, so that images of a camera with 12
// bits that are not shifted up are almost black.
void NoteBits(std::optional<int> brightest, DatasetInfo& info);

// Adds a note where the stamps are so close to each other as no camera takes images (most of them
// less than a millisecond apart, of more than ten): as a rule they are in another unit than the
// format has.
void NoteRate(DatasetInfo& info);

// The data lacks the sensor that is asked for.
class MissingSensor : public InputError {
 public:
  using InputError::InputError;
};

// Fills in name, path, format, available and sensor: the sensor asked for, or the richest one.
// Throws MissingSensor when the data does not offer it.
DatasetInfo DescribeDataset(const std::filesystem::path& path,
                            DatasetFormat format,
                            std::vector<SensorKind> available,
                            const DatasetOptions& options);

// Returns the camera file that the user names or that is in the data set's folder (CameraFileIn);
// nullopt where there is neither. Throws InputError when `sensor` is stereo and the file has only
// one camera.
std::optional<CameraFile> GivenCamera(const std::filesystem::path& folder,
                                      const DatasetOptions& options,
                                      std::optional<SensorKind> sensor = std::nullopt);

// Takes over the calibration for info.sensor, without the second camera or the depth factor where
// they are not used.
void UseCamera(CameraFile camera, DatasetInfo& info);

// Returns the name that is shown to users.
std::string SensorName(SensorKind sensor);

// Returns the names of the image files in a folder, without hidden ones, in natural order: runs of
// digits count as numbers, so that 2.png comes before 10.png, and as fractions behind a decimal
// point, so that 0.05.png comes before 0.1.png. Throws InputError when there is no such folder, and
// when two names have the same number (3.png, 000003.png).
std::vector<std::string> ListImages(const std::filesystem::path& folder);

// Returns the message for a data set without calibration, which tells what to do.
std::string NoCalibration(const std::filesystem::path& path);

}  // namespace plumbline
