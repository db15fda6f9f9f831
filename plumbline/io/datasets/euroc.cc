// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/geometry/calibration.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/datasets/ground_truth.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/text_rows.h"

#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// Reads camN/data.csv, `nanoseconds,file name`, in order of time.
std::vector<ListedImage> ReadList(const fs::path& camera_folder, std::vector<std::string>& notes) {
  const fs::path csv = camera_folder / "data.csv";
  std::vector<ListedImage> images;
  for (const TextRow& row : ReadRows(csv, ',')) {
    if (row.fields.size() != 2 || row.fields[1].empty()) {
      FailAt(csv,
             row.line,
             "a time stamp and a file name",
             std::to_string(row.fields.size()) + " columns");
    }
    const std::optional<std::int64_t> stamp = ParseNanoseconds(row.fields[0]);
    if (!stamp) {
      FailAt(csv, row.line, "a time stamp in whole nanoseconds", InQuotes(row.fields[0]));
    }
    images.push_back({{*stamp, row.line}, camera_folder / "data" / row.fields[1]});
  }
  if (images.empty()) throw InputError(csv.string() + ": expected images, found no rows");
  return InOrderOfTime(csv, images, notes);
}

// Returns pairs of equal stamps; both lists must be in order of time.
std::vector<FrameFiles> PairUp(const std::vector<ListedImage>& left,
                               const std::vector<ListedImage>& right,
                               DatasetInfo& info) {
  std::vector<FrameFiles> files;
  std::size_t r = 0;
  for (const ListedImage& image : left) {
    while (r < right.size() && right[r].row.stamp_ns < image.row.stamp_ns) ++r;
    if (r == right.size() || right[r].row.stamp_ns != image.row.stamp_ns) continue;
    info.stamps_ns.push_back(image.row.stamp_ns);
    files.push_back({image.path, right[r].path, std::nullopt});
  }
  if (files.empty()) {
    throw InputError(info.path.string() +
                     ": expected equal time stamps in cam0/data.csv and cam1/data.csv, found none");
  }
  if (const std::size_t alone = left.size() - files.size(); alone > 0) {
    info.notes.push_back(fmt::format("{} left images without a right one are left out", alone));
  }
  if (const std::size_t alone = right.size() - files.size(); alone > 0) {
    info.notes.push_back(fmt::format("{} right images without a left one are left out", alone));
  }
  return files;
}

// Fails at the resolution that is wrong, which the images of the left camera tell.
[[noreturn]] void FailResolution(const fs::path& mav,
                                 const YamlSection& left_root,
                                 const YamlSection& right_root,
                                 const Calibration& calibration) {
  const Camera& left = calibration.left;
  std::vector<std::string> notes;  // ignored: only the error matters
  const auto size = ReadImageSize(ReadList(mav / "cam0", notes).front().path);
  if (size && (size->width != left.width() || size->height != left.height())) {
    left_root.Fail("resolution",
                   fmt::format("expected {}x{} pixels as the images have, found {}x{}",
                               size->width,
                               size->height,
                               left.width(),
                               left.height()));
  }
  right_root.Fail("resolution", PairFault(calibration).value());
}

YamlSection RootOf(const fs::path& file) {
  return YamlSection::Parse(ReadInputFile(file, kLargestSettings), file.string());
}

CameraFile ReadCalibration(const fs::path& path,
                           const fs::path& mav,
                           const DatasetOptions& options,
                           SensorKind sensor) {
  const fs::path left_file = mav / "cam0" / "sensor.yaml";
  if (std::optional<CameraFile> camera = GivenCamera(path, options, sensor)) {
    if (!camera->calibration.body_from_left && PathExists(left_file)) {
      camera->calibration.body_from_left = ReadEurocSensor(left_file).body_from_camera;
    }
    return *camera;
  }
  CameraFile camera{{}, left_file.string()};
  const YamlSection left_root = RootOf(left_file);
  const EurocSensor left = ReadEurocSensor(left_root);
  camera.calibration.left = left.camera;
  camera.calibration.rate_hz = left.rate_hz;
  camera.calibration.body_from_left = left.body_from_camera;
  if (sensor == SensorKind::kStereo) {
    const YamlSection right_root = RootOf(mav / "cam1" / "sensor.yaml");
    const EurocSensor right = ReadEurocSensor(right_root);
    camera.calibration.right = right.camera;
    camera.calibration.right_from_left = Inverse(right.body_from_camera) * left.body_from_camera;
    if (left.camera.width() != right.camera.width() ||
        left.camera.height() != right.camera.height()) {
      FailResolution(mav, left_root, right_root, camera.calibration);
    }
    if (const auto fault = PairFault(camera.calibration)) right_root.Fail("T_BS", *fault);
    camera.source += " and that of cam1";
  }
  camera.source += " (EuRoC sensor.yaml)";
  return camera;
}

}  // namespace

std::unique_ptr<Dataset> OpenEuroc(const fs::path& path, const DatasetOptions& options) {
  const fs::path mav = PathExists(path / "mav0") ? path / "mav0" : path;
  if (!PathExists(mav / "cam0")) {
    throw InputError(path.string() + ": expected a EuRoC folder, found no mav0/cam0 in it");
  }
  std::vector<SensorKind> available = {SensorKind::kMono};
  if (PathExists(mav / "cam1")) available.insert(available.begin(), SensorKind::kStereo);
  DatasetInfo info = DescribeDataset(path, DatasetFormat::kEuroc, std::move(available), options);
  const bool stereo = info.sensor == SensorKind::kStereo;
  if (stereo) CheckSecondList(mav / "cam1" / "data.csv", "right");
  UseCamera(ReadCalibration(path, mav, options, info.sensor), info);

  const std::vector<ListedImage> left = ReadList(mav / "cam0", info.notes);
  std::vector<FrameFiles> files;
  if (stereo) {
    files = PairUp(left, ReadList(mav / "cam1", info.notes), info);
  } else {
    for (const ListedImage& image : left) {
      info.stamps_ns.push_back(image.row.stamp_ns);
      files.push_back({image.path, std::nullopt, std::nullopt});
    }
  }
  AddGroundTruth({{mav / "state_groundtruth_estimate0" / "data.csv"}, GroundTruth::Frame::kBody},
                 options,
                 info);
  return MakeImageDataset(std::move(info), std::move(files));
}

}  // namespace plumbline
