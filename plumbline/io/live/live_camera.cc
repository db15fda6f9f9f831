// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/live/open_live_source.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {

DatasetInfo DescribeLive(const std::string& name,
                         std::vector<SensorKind> available,
                         const LiveOptions& options) {
  DatasetOptions as_recorded;
  as_recorded.sensor = options.sensor;
  DatasetInfo info =
      DescribeDataset(name, DatasetFormat::kStream, std::move(available), as_recorded);
  info.name = name;
  if (!options.camera) {
    throw InputError(
        fmt::format("{}: expected --camera FILE, the calibration of the camera, found "
                    "none (built-in cameras: {})",
                    name,
                    fmt::join(BuiltInCameras(), ", ")));
  }
  const bool stereo = info.sensor == SensorKind::kStereo;
  CameraFile camera = FindCamera(*options.camera, stereo);
  if (stereo && !camera.calibration.right) {
    throw InputError(*options.camera + ": expected a stereo camera, found one camera");
  }
  UseCamera(std::move(camera), info);
  return info;
}

void CheckLiveSize(const std::string& name, ImageSize size, const Camera& camera) {
  if (size == ImageSize{camera.width(), camera.height()}) return;
  throw InputError(
      fmt::format("{}: expected images of {}x{} pixels as in the calibration, found {}x{}",
                  name,
                  camera.width(),
                  camera.height(),
                  size.width,
                  size.height));
}

}  // namespace plumbline
