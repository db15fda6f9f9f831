// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/datasets/frame_preparation.h"
#include "plumbline/io/datasets/ground_truth.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/datasets/image_file.h"
#include "plumbline/io/text_rows.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

std::optional<CameraFile> ReadCalibration(const fs::path& path, const DatasetOptions& options) {
  if (std::optional<CameraFile> camera = GivenCamera(path, options)) return camera;
  if (options.allow_missing_camera) return std::nullopt;
  throw InputError(NoCalibration(path));
}

// Decides how the images of a folder are turned. It is the orientation of the first image that
// counts for all of them: a phone that is turned notes another one, while lens and sensor, of which
// the calibration is, stay as they are.
ImageTurn TurnOfImages(const std::vector<FrameFiles>& files,
                       const DatasetOptions& options,
                       DatasetInfo& info) {
  std::optional<ImageSize> size;
  int first = 1;
  for (std::size_t i = 0; i < files.size() && !size; ++i) {
    const auto read = ReadImageSize(files[i].left);
    if (!read) continue;
    size = *read;
    first = ReadExifOrientation(files[i].left);
  }
  const auto others = std::count_if(files.begin(), files.end(), [&](const FrameFiles& file) {
    return ReadExifOrientation(file.left) != first;
  });
  const ImageTurn turn =
      ChooseTurn(options.rotate, OrientationOfExif(first), size.value_or(ImageSize{}), info);
  if (others > 0 && options.rotate == Rotation::kAuto) {
    info.notes.push_back(fmt::format(
        "{} of {} images ask for another orientation than the first one; its orientation is taken "
        "for all, since they are of one camera",
        others,
        files.size()));
  }
  return turn;
}

}  // namespace

std::unique_ptr<Dataset> OpenImageFolder(const fs::path& path, const DatasetOptions& options) {
  DatasetInfo info = DescribeDataset(path, DatasetFormat::kImages, {SensorKind::kMono}, options);
  std::optional<CameraFile> camera = ReadCalibration(path, options);
  info.has_calibration = false;
  if (camera) UseCamera(*std::move(camera), info);
  AddGroundTruth({}, options, info);
  if (!info.calibration.rate_hz) {
    if (!options.allow_missing_camera) {
      throw InputError(
          path.string() +
          ": expected rate_hz in the camera file, as images have no times; found none");
    }
    info.notes.emplace_back(
        "the frame rate is not known; one image a second is assumed (a run needs rate_hz in the "
        "camera file)");
  }
  const double period_ns = 1e9 / info.calibration.rate_hz.value_or(1);
  std::vector<FrameFiles> files;
  for (const std::string& name : ListImages(path)) {
    const double stamp_ns = static_cast<double>(files.size()) * period_ns;
    if (stamp_ns > static_cast<double>(kLatestStampNs)) {
      throw InputError(path.string() + ": expected a higher rate_hz, found one by which image " +
                       name + " is taken after 126 years");
    }
    info.stamps_ns.push_back(std::llround(stamp_ns));
    files.push_back({path / name, std::nullopt, std::nullopt});
  }
  if (files.empty()) throw InputError(path.string() + ": expected frames, found none");
  const ImageTurn turn = TurnOfImages(files, options, info);
  return PrepareFrames(
      MakeImageDataset(std::move(info), std::move(files)), turn, PreparationOf(options));
}

}  // namespace plumbline
