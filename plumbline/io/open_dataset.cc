// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/open_dataset.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/euroc.h"
#include "plumbline/io/frame_preparation.h"
#include "plumbline/io/image_dataset.h"
#include "plumbline/io/image_folder.h"
#include "plumbline/io/kitti.h"
#include "plumbline/io/recorded_dataset.h"
#include "plumbline/io/tum_rgbd.h"
#include "plumbline/io/video.h"
#include "plumbline/recording/mcap.h"
#include "plumbline/recording/ros_bag.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// Refuses a file of ROS 2 that another recorder than that of MCAP wrote, whatever its name. It
// would pass for a damaged bag or for a video.
void RefuseSqliteFile(const fs::path& path) {
  if (!FileBeginsWith(path, "SQLite format 3")) return;
  throw InputError(path.string() +
                   ": expected MCAP, found a ROS 2 bag of SQLite; ros2 bag convert makes one");
}

// Refuses a folder as `ros2 bag` writes it, and names the file in it that is to be given.
void RefuseRos2Folder(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path / "metadata.yaml", error)) return;
  std::set<std::string> names;  // in the same order everywhere
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    names.insert(entry.path().filename().string());
  }
  for (const std::string& name : names) {
    if (name.ends_with(".mcap")) {
      throw InputError(path.string() + ": expected a file, found a folder of ros2 bag; give " +
                       Printable(name) + " in it");
    }
  }
  for (const std::string& name : names) {
    if (name.ends_with(".db3")) RefuseSqliteFile(path / name);
  }
}

DatasetFormat DetectFormat(const fs::path& path) {
  RefuseSqliteFile(path);
  if (const std::optional<DatasetFormat> format = FindFormat(path)) return *format;
  RefuseRos2Folder(path);
  throw InputError(path.string() +
                   ": expected a EuRoC folder (mav0/), a TUM or ICL folder (rgb.txt), a KITTI "
                   "sequence (image_0/, calib.txt) or a folder of images, found none of them");
}

// Returns the format of a file by its first bytes, or by its name where these are damaged.
DatasetFormat FormatOfFile(const fs::path& path) {
  std::array<std::uint8_t, 16> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(begin.data()), begin.size());
  const std::span<const std::uint8_t> bytes(begin.data(), static_cast<std::size_t>(file.gcount()));
  if (BeginsAsBag(bytes)) return DatasetFormat::kBag;
  if (BeginsAsMcap(bytes)) return DatasetFormat::kMcap;
  if (path.extension() == ".bag") return DatasetFormat::kBag;
  if (path.extension() == ".mcap") return DatasetFormat::kMcap;
  return DatasetFormat::kVideo;
}

bool IsFolder(DatasetFormat format) {
  return format != DatasetFormat::kVideo && format != DatasetFormat::kBag &&
         format != DatasetFormat::kMcap;
}

}  // namespace

std::optional<DatasetFormat> FindFormat(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) return FormatOfFile(path);
  const auto has = [&](const char* name) { return fs::exists(path / name, error); };
  if (has("mav0") || has("cam0")) return DatasetFormat::kEuroc;
  if (has("rgb.txt")) return DatasetFormat::kTum;
  if (has("image_0") || has("calib.txt")) return DatasetFormat::kKitti;
  if (!ListImages(path).empty()) return DatasetFormat::kImages;
  return std::nullopt;
}

namespace {

// OpenDataset before PrepareFrames, but for videos and folders of images: these know how their
// images ask to be turned, and are prepared already.
std::unique_ptr<Dataset> OpenByFormat(const fs::path& path, const DatasetOptions& options) {
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(path.string() + ": no such file or folder");
  const bool folder = fs::is_directory(path, error);
  if (!folder && !fs::is_regular_file(path, error)) {
    throw InputError(path.string() + ": expected a folder or a file, found " + KindOf(path));
  }
  const DatasetFormat format = options.format ? *options.format : DetectFormat(path);
  if (folder != IsFolder(format)) {
    const bool video = format == DatasetFormat::kVideo;
    throw InputError(path.string() + (folder ? (video ? ": expected a video file, found a folder"
                                                      : ": expected a file, found a folder")
                                             : ": expected a folder, found a file"));
  }
  if (!options.topics.empty() && format != DatasetFormat::kBag && format != DatasetFormat::kMcap) {
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
  return PrepareFrames(std::move(dataset), {TurnOf(options.rotate)}, options.max_width);
}

}  // namespace plumbline
