// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/datasets/ground_truth.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/datasets/stamp_order.h"
#include "plumbline/io/text_rows.h"

#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
constexpr std::int64_t kMaxDepthDelayNs = 20'000'000;

// Reads rgb.txt or depth.txt, `seconds file`, in order of time.
std::vector<ListedImage> ReadList(const fs::path& list, std::vector<std::string>& notes) {
  std::vector<ListedImage> images;
  for (const TextRow& row : ReadRows(list, ' ')) {
    if (row.fields.size() != 2) {
      FailAt(list,
             row.line,
             "a time stamp and a file name",
             std::to_string(row.fields.size()) + " columns");
    }
    const std::optional<std::int64_t> stamp = ParseSeconds(row.fields[0]);
    if (!stamp) FailAt(list, row.line, "a time stamp in seconds", InQuotes(row.fields[0]));
    images.push_back({{*stamp, row.line}, list.parent_path() / row.fields[1]});
  }
  if (images.empty()) throw InputError(list.string() + ": expected images, found no rows");
  return InOrderOfTime(list, images, notes);
}

std::vector<std::int64_t> StampsOf(const std::vector<ListedImage>& images) {
  std::vector<std::int64_t> stamps;
  for (const ListedImage& image : images) stamps.push_back(image.row.stamp_ns);
  return stamps;
}

std::vector<FrameFiles> JoinDepth(const std::vector<ListedImage>& color,
                                  const std::vector<ListedImage>& depth,
                                  DatasetInfo& info) {
  std::vector<FrameFiles> files;
  for (const auto& [i, nearest] : PairByStamp(StampsOf(color), StampsOf(depth), kMaxDepthDelayNs)) {
    info.stamps_ns.push_back(color[i].row.stamp_ns);
    files.push_back({color[i].path, std::nullopt, depth[nearest].path});
  }
  if (files.empty()) {
    throw InputError(info.path.string() +
                     ": expected depth images within 20 ms of colour images, found none");
  }
  if (const std::size_t alone = color.size() - files.size(); alone > 0) {
    info.notes.push_back(
        fmt::format("{} colour images without depth within 20 ms are left out", alone));
  }
  return files;
}

// Returns the camera of a data set's name: rgbd_dataset_freiburg2_desk gives tum_fr2.
std::optional<std::string> CameraOfName(const std::string& name) {
  constexpr std::string_view kStart = "rgbd_dataset_freiburg";
  if (!name.starts_with(kStart) || name.size() <= kStart.size()) return std::nullopt;
  const char number = name[kStart.size()];
  if (number < '1' || number > '3') return std::nullopt;
  return std::string("tum_fr") + number;
}

std::optional<CameraFile> ReadCalibration(const fs::path& path, const DatasetOptions& options) {
  if (std::optional<CameraFile> camera = GivenCamera(path, options)) return camera;
  const std::string name = fs::absolute(path / ".").lexically_normal().parent_path().filename();
  if (const std::optional<std::string> camera = CameraOfName(name)) return FindCamera(*camera);
  if (options.allow_missing_camera) return std::nullopt;
  throw InputError(NoCalibration(path));
}

}  // namespace

std::unique_ptr<Dataset> OpenTum(const fs::path& path, const DatasetOptions& options) {
  if (!PathExists(path / "rgb.txt")) {
    throw InputError(path.string() + ": expected a TUM or ICL folder, found no rgb.txt in it");
  }
  std::optional<CameraFile> camera = ReadCalibration(path, options);
  const bool has_depth = PathExists(path / "depth.txt") || PathExists(path / "depth");
  const bool has_factor = !camera || camera->calibration.depth_factor.has_value();
  if (has_depth && !has_factor && options.sensor == SensorKind::kRgbd) {
    throw InputError(path.string() + ": expected depth_factor in the camera file, found none");
  }
  std::vector<SensorKind> available = {SensorKind::kMono};
  if (has_depth && has_factor) available.insert(available.begin(), SensorKind::kRgbd);
  DatasetInfo info = DescribeDataset(path, DatasetFormat::kTum, std::move(available), options);
  info.has_calibration = false;
  if (camera) UseCamera(*std::move(camera), info);
  if (has_depth && !has_factor) {
    info.notes.emplace_back("the depth images are not used: no depth_factor in the camera file");
  }

  const std::vector<ListedImage> color = ReadList(path / "rgb.txt", info.notes);
  std::vector<FrameFiles> files;
  if (info.sensor == SensorKind::kRgbd) {
    CheckSecondList(path / "depth.txt", "depth");
    files = JoinDepth(color, ReadList(path / "depth.txt", info.notes), info);
  } else {
    for (const ListedImage& image : color) {
      info.stamps_ns.push_back(image.row.stamp_ns);
      files.push_back({image.path, std::nullopt, std::nullopt});
    }
  }
  AddGroundTruth({{path / "groundtruth.txt"}}, options, info);
  return MakeImageDataset(std::move(info), std::move(files));
}

}  // namespace plumbline
