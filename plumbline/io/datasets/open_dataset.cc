// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/open_dataset.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/datasets/frame_preparation.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/datasets/rosbag2_files.h"
#include "plumbline/io/recordings/recording_formats.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <system_error>
#include <utility>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

DatasetFormat DetectFormat(const fs::path& path) {
  if (const std::optional<DatasetFormat> format = FindFormat(path)) return *format;
  throw InputError(
      path.string() +
      ": expected a EuRoC folder (mav0/), a TUM or ICL folder (rgb.txt), a KITTI "
      "sequence (image_0/, calib.txt) or a drive of KITTI raw (image_00/timestamps.txt), "
      "a folder of ros2 bag (.db3, .mcap) or a folder of images, found none of them");
}

// Returns the format of a file by its first bytes, or by its name if these are damaged.
DatasetFormat FormatOfFile(const fs::path& path) {
  std::array<std::uint8_t, 16> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(begin.data()), begin.size());
  const std::span<const std::uint8_t> bytes(begin.data(), static_cast<std::size_t>(file.gcount()));
  if (BeginsAsBag(bytes)) return DatasetFormat::kBag;
  if (BeginsAsMcap(bytes)) return DatasetFormat::kMcap;
  if (BeginsAsSqlite(bytes)) return DatasetFormat::kRosbag2;
  if (path.extension() == ".bag") return DatasetFormat::kBag;
  if (path.extension() == ".mcap") return DatasetFormat::kMcap;
  if (IsRosbag2Name(path.filename().string())) return DatasetFormat::kRosbag2;
  return DatasetFormat::kVideo;
}

bool IsRecording(DatasetFormat format) {
  return format == DatasetFormat::kBag || format == DatasetFormat::kMcap ||
         format == DatasetFormat::kRosbag2;
}

// A recording of ROS 2 may be either.
bool IsFolder(DatasetFormat format, bool folder) {
  if (format == DatasetFormat::kRosbag2) return folder;
  return format != DatasetFormat::kVideo && !IsRecording(format);
}

}  // namespace

std::optional<DatasetFormat> FindFormat(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) return FormatOfFile(path);
  const auto has = [&](const char* name) { return fs::exists(path / name, error); };
  if (has("mav0") || has("cam0")) return DatasetFormat::kEuroc;
  if (has("rgb.txt")) return DatasetFormat::kTum;
  if (has("image_0") || has("image_2") || has("calib.txt")) return DatasetFormat::kKitti;
  if (has("image_00/timestamps.txt") || has("image_02/timestamps.txt"))
    return DatasetFormat::kKitti;
  if (IsRosbag2Folder(path)) return DatasetFormat::kRosbag2;
  if (!ListImages(path).empty()) return DatasetFormat::kImages;
  return std::nullopt;
}

namespace {

// OpenDataset before PrepareFrames, but for videos and folders of images: these know how their
// images ask to be turned, and are prepared already.
std::unique_ptr<Dataset> OpenByFormat(const fs::path& path, const DatasetOptions& options) {
  CheckExists(path, "file or folder");
  std::error_code error;
  const bool folder = fs::is_directory(path, error);
  if (!folder && !fs::is_regular_file(path, error)) {
    throw InputError(path.string() + ": expected a folder or a file, found " + KindOf(path));
  }
  const DatasetFormat format = options.format ? *options.format : DetectFormat(path);
  if (folder != IsFolder(format, folder)) {
    const bool video = format == DatasetFormat::kVideo;
    throw InputError(path.string() + (folder ? (video ? ": expected a video file, found a folder"
                                                      : ": expected a file, found a folder")
                                             : ": expected a folder, found a file"));
  }
  if (!options.topics.empty() && !IsRecording(format)) {
    throw InputError(path.string() + ": expected a bag or an MCAP file to choose topics of");
  }
  switch (format) {
    case DatasetFormat::kEuroc:
      return OpenEuroc(path, options);
    case DatasetFormat::kTum:
      return OpenTum(path, options);
    case DatasetFormat::kKitti:
      return OpenKitti(path, options);
    case DatasetFormat::kImages:
      return OpenImageFolder(path, options);
    case DatasetFormat::kVideo:
      return OpenVideo(path, options);
    case DatasetFormat::kBag:
    case DatasetFormat::kMcap:
    case DatasetFormat::kRosbag2:
      return OpenRecording(path, format, options);
    case DatasetFormat::kStream:
      break;
  }
  throw BugError("a format without a reader");
}

}  // namespace

std::unique_ptr<Dataset> OpenDataset(const fs::path& path, const DatasetOptions& options) {
  auto dataset = OpenByFormat(path, options);
  const DatasetFormat format = dataset->info().format;
  if (format == DatasetFormat::kVideo || format == DatasetFormat::kImages) return dataset;
  PreparationOptions preparation = PreparationOf(options);
  std::error_code error;
  for (std::string& mask : preparation.masks) {
    // The masks of a recording that are no files are topics, which it gives its frames itself.
    if (IsRecording(format) && !fs::is_regular_file(mask, error)) mask.clear();
  }
  return PrepareFrames(std::move(dataset), {TurnOf(options.rotate)}, preparation);
}

}  // namespace plumbline
