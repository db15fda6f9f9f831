// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/camera_file.h"
#include "plumbline/io/dataset.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// An entry of a list of images.
struct ListedImage {
  std::int64_t stamp_ns = 0;
  std::filesystem::path path;
};

// Whether there is such a file or folder. InputError where that cannot be found out.
bool PathExists(const std::filesystem::path& path);

// Throws InputError where there is no list of the images of a second sensor ("right", "depth"), of
// which something else is there: it is not to be left out unasked.
void CheckSecondList(const std::filesystem::path& list, const char* images);

// The image files of one frame.
struct FrameFiles {
  std::filesystem::path left;
  std::optional<std::filesystem::path> right;
  std::optional<std::filesystem::path> depth;
};

// A data set whose frames are image files. files[i] belongs to info.stamps_ns[i]. Images listed but
// missing become a note; InputError when there are no frames, or no left, no right or no depth
// image exists or can be read at all. An image of another size than the calibration's is an
// InputError when it is read; the first frame that can be read is read right away.
std::unique_ptr<Dataset> MakeImageDataset(DatasetInfo info, std::vector<FrameFiles> files);

// The failure of one image, unless it is of another size than the calibration's, `wanted`, which no
// image of a sequence may be: InputError then.
ImageFailure FailureOf(const ImageFailure& failure, ImageSize wanted);

// Reads frames until one can be read, so that a calibration of another size shows before the run.
// InputError when none can.
void CheckFirstFrame(const Dataset& dataset);

// Grey levels of 16 bits lose the lower 8, and a camera of 12 bits whose levels are not shifted up
// is almost black then: adds a note where the first image has 16 bits, whose brightest level is
// `brightest` (BrightestOf16Bits).
void NoteBits(std::optional<int> brightest, DatasetInfo& info);

// Fills name, path, format, available and sensor: the sensor asked for, or the richest. InputError
// when the data does not offer it.
DatasetInfo DescribeDataset(const std::filesystem::path& path,
                            DatasetFormat format,
                            std::vector<SensorKind> available,
                            const DatasetOptions& options);

// The camera file that the user names or that was put into the data set's folder (CameraFileIn);
// nullopt where there is neither. InputError when `sensor` is stereo and it has one camera only.
std::optional<CameraFile> GivenCamera(const std::filesystem::path& folder,
                                      const DatasetOptions& options,
                                      std::optional<SensorKind> sensor = std::nullopt);

// Takes the calibration for info.sensor: without the second camera or the depth factor where they
// are not used.
void UseCamera(CameraFile camera, DatasetInfo& info);

// Name shown to users.
std::string SensorName(SensorKind sensor);

// The names of the image files in a folder, by natural order: runs of digits count as numbers, so
// that 2.png comes before 10.png. InputError when there is no such folder, and when two names have
// the same number (3.png, 000003.png).
std::vector<std::string> ListImages(const std::filesystem::path& folder);

// The message of a data set without calibration, telling what to do.
std::string NoCalibration(const std::filesystem::path& path);

}  // namespace plumbline
