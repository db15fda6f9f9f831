// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/camera_formats.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/dataset_formats.h"
#include "plumbline/io/datasets/ground_truth.h"
#include "plumbline/io/datasets/image_dataset.h"
#include "plumbline/io/datasets/stamp_order.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/io/trajectory_io.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// Paths of the images and times of a sequence.
struct KittiLayout {
  bool raw = false;  // a drive of KITTI raw; else a sequence of KITTI odometry
  KittiCameras cameras;

  bool grey() const { return cameras.left == 0; }
  // "image_0", of KITTI raw "image_00".
  std::string Camera(int number) const { return fmt::format("image_{:0{}}", number, raw ? 2 : 1); }
  fs::path Images(const fs::path& path, int number) const {
    return raw ? path / Camera(number) / "data" : path / Camera(number);
  }
  fs::path Times(const fs::path& path) const {
    return raw ? path / Camera(cameras.left) / "timestamps.txt" : path / "times.txt";
  }
};

// Finds out which cameras there are: the grey ones, else those with colours.
KittiLayout FindLayout(const fs::path& path) {
  for (const bool raw : {false, true}) {
    for (const int left : {0, 2}) {
      KittiLayout layout{raw, {left, std::nullopt}};
      if (!PathExists(path / layout.Camera(left))) continue;
      if (PathExists(path / layout.Camera(left + 1))) layout.cameras.right = left + 1;
      return layout;
    }
  }
  return {false, {0, PathExists(path / "image_1") ? std::optional(1) : std::nullopt}};
}

// Returns the size of most images, by a few spread over the sequence, since calib.txt has none. An
// image of another size is then left out, even the first.
ImageSize SizeOfMost(const fs::path& path,
                     const KittiLayout& layout,
                     const std::vector<FrameFiles>& files) {
  constexpr std::size_t kAsked = 9;
  const std::size_t step = std::max<std::size_t>(1, files.size() / kAsked);
  std::vector<std::pair<ImageSize, int>> votes;
  // The other images are read only if none of the few can be read.
  for (std::size_t first = 0; first < step && votes.empty(); ++first) {
    for (std::size_t i = first; i < files.size(); i += step) {
      const Expected<ImageSize, ImageFailure> size = ReadImageSize(files[i].left);
      if (!size) continue;
      const auto same = std::find_if(
          votes.begin(), votes.end(), [&](const auto& vote) { return vote.first == *size; });
      if (same == votes.end()) {
        votes.emplace_back(*size, 1);
      } else {
        ++same->second;
      }
    }
  }
  if (votes.empty()) {
    throw InputError(fmt::format("{}: expected images in {}, found none that can be decoded",
                                 path.string(),
                                 layout.Camera(layout.cameras.left)));
  }
  return std::max_element(votes.begin(),
                          votes.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

// Returns calib_cam_to_cam.txt of the drive: it lies in the folder of the day, beside the drives.
fs::path RawCalibrationFile(const fs::path& path) {
  constexpr const char* kName = "calib_cam_to_cam.txt";
  for (const fs::path& file : {path / kName, path / ".." / kName}) {
    if (PathExists(file)) return file;
  }
  throw InputError(
      fmt::format("{}: expected {} in this folder or the one around it, found none; "
                  "--camera FILE takes another calibration",
                  path.string(),
                  kName));
}

// Returns the kind of images by the name of a drive.
KittiImages ImagesByName(const fs::path& path) {
  const std::string name = fs::absolute(path / ".").lexically_normal().parent_path().filename();
  return name.ends_with("_extract") ? KittiImages::kAsTaken : KittiImages::kRectified;
}

// The calibration of a sequence.
struct KittiCamera {
  CameraFile file;
  std::string images;  // kind of images, for display; may be empty
  // Poses of KITTI are of the rectified camera 0, which may differ from the left one.
  GroundTruth::Frame truth = GroundTruth::Frame::kCamera;
};

// Reads the calibration of the data. `cameras` may be fewer than there are.
KittiCamera ReadOwnCalibration(const fs::path& path,
                               const KittiLayout& layout,
                               const KittiCameras& cameras,
                               const std::vector<FrameFiles>& files) {
  KittiCamera camera;
  const fs::path file = layout.raw ? RawCalibrationFile(path) : path / "calib.txt";
  const ImageSize size = SizeOfMost(path, layout, files);
  Calibration& calibration = camera.file.calibration;
  if (layout.raw) {
    KittiImages images = KittiImages::kRectified;
    calibration = ReadKittiRawCalibration(file, cameras, size, ImagesByName(path), &images);
    camera.file.source = file.string() + " (KITTI calib_cam_to_cam.txt)";
    camera.images = images == KittiImages::kRectified ? ", rectified" : ", as taken";
  } else {
    calibration = ReadKittiCalibration(file, cameras, size);
    camera.file.source = file.string() + " (KITTI calib.txt)";
  }
  if (calibration.body_from_left) camera.truth = GroundTruth::Frame::kBody;
  return camera;
}

KittiCamera ReadCalibration(const fs::path& path,
                            const DatasetOptions& options,
                            const KittiLayout& layout,
                            const KittiCameras& cameras,
                            const std::vector<FrameFiles>& files,
                            SensorKind sensor) {
  std::optional<CameraFile> given = GivenCamera(path, options, sensor);
  if (!given) return ReadOwnCalibration(path, layout, cameras, files);
  KittiCamera camera{*std::move(given), "", GroundTruth::Frame::kCamera};
  if (layout.grey()) return camera;
  camera.truth = GroundTruth::Frame::kBody;
  std::optional<Rigid3>& body_from_left = camera.file.calibration.body_from_left;
  if (body_from_left) return camera;
  try {  // the given camera suffices if the data has no calibration of its own
    const KittiCameras left = {cameras.left, std::nullopt};
    body_from_left = ReadOwnCalibration(path, layout, left, files).file.calibration.body_from_left;
  } catch (const InputError&) {
  }
  return camera;
}

// Returns the file of each frame, with the number of the frame from the file name.
std::map<std::size_t, fs::path> NumberedImages(const fs::path& folder) {
  std::map<std::size_t, fs::path> images;
  for (const std::string& name : ListImages(folder)) {
    const std::optional<std::int64_t> number = ParseNanoseconds(fs::path(name).stem().string());
    if (!number) {
      throw InputError((folder / name).string() + ": expected a number as file name (000000.png)");
    }
    images[static_cast<std::size_t>(*number)] = folder / name;
  }
  return images;
}

// Returns the file of frame i, or its expected path beside the others.
fs::path ImageAt(const std::map<std::size_t, fs::path>& images,
                 const fs::path& folder,
                 std::size_t i) {
  const auto found = images.find(i);
  if (found != images.end()) return found->second;
  if (images.empty()) return folder / fmt::format("{:06}.png", i);
  const fs::path& like = images.begin()->second;
  return folder /
         fmt::format("{:0{}}{}", i, like.stem().string().size(), like.extension().string());
}

// Reads the times of the rows of image_00/timestamps.txt: "2011-09-26 13:02:25.964389445".
std::vector<StampedRow> ReadTimestamps(const fs::path& file) {
  std::vector<StampedRow> times;
  for (const TextRow& row : ReadRows(file, ' ')) {
    const std::optional<std::int64_t> stamp =
        row.fields.size() == 2 ? ParseDateAndTime(row.fields[0], row.fields[1]) : std::nullopt;
    if (!stamp) {
      std::string found;
      for (const std::string& field : row.fields) found += (found.empty() ? "" : " ") + field;
      FailAt(file,
             row.line,
             "a date and a time such as 2011-09-26 13:02:25.964389445",
             InQuotes(found));
    }
    times.push_back({*stamp, row.line});
  }
  if (times.empty()) throw InputError(file.string() + ": expected times, found no rows");
  return times;
}

// Returns the files of the images that belong to the rows of the list of times.
std::vector<FrameFiles> ListFrames(const fs::path& path,
                                   const KittiLayout& layout,
                                   const KittiCameras& cameras,
                                   std::size_t rows) {
  const fs::path folder = layout.Images(path, cameras.left);
  const std::map<std::size_t, fs::path> left = NumberedImages(folder);
  if (left.empty()) throw InputError(folder.string() + ": expected images, found none");
  if (left.rbegin()->first >= rows) {
    throw InputError(fmt::format("{}: expected a time for each image up to {}, found {} times",
                                 layout.Times(path).string(),
                                 left.rbegin()->second.filename().string(),
                                 rows));
  }
  std::map<std::size_t, fs::path> right;
  if (cameras.right) right = NumberedImages(layout.Images(path, *cameras.right));
  std::vector<FrameFiles> files;
  for (std::size_t i = 0; i < rows; ++i) {
    FrameFiles frame{ImageAt(left, folder, i), std::nullopt, std::nullopt};
    if (cameras.right) frame.right = ImageAt(right, layout.Images(path, *cameras.right), i);
    files.push_back(std::move(frame));
  }
  return files;
}

// "odometry, grey cameras 0 and 1".
std::string Describe(const KittiLayout& layout, const KittiCameras& cameras, const char* images) {
  const std::string color = layout.grey() ? "grey" : "colour";
  return fmt::format("{}{}, {} ", layout.raw ? "raw" : "odometry", images, color) +
         (cameras.right ? fmt::format("cameras {} and {}", cameras.left, *cameras.right)
                        : fmt::format("camera {}", cameras.left));
}

}  // namespace

std::vector<fs::path> KittiPosesFiles(const fs::path& sequence) {
  const std::string name = fs::absolute(sequence / ".").lexically_normal().parent_path().filename();
  return {sequence / "poses.txt", sequence / ".." / ".." / "poses" / (name + ".txt")};
}

std::unique_ptr<Dataset> OpenKitti(const fs::path& path, const DatasetOptions& options) {
  const KittiLayout layout = FindLayout(path);
  std::vector<SensorKind> available = {SensorKind::kMono};
  if (layout.cameras.right) available.insert(available.begin(), SensorKind::kStereo);
  DatasetInfo info = DescribeDataset(path, DatasetFormat::kKitti, std::move(available), options);
  KittiCameras cameras = layout.cameras;
  if (info.sensor == SensorKind::kMono) cameras.right.reset();

  const std::vector<StampedRow> times =
      layout.raw ? ReadTimestamps(layout.Times(path)) : ReadKittiTimes(layout.Times(path));
  const std::vector<FrameFiles> rows = ListFrames(path, layout, cameras, times.size());
  std::vector<FrameFiles> files;
  for (const std::size_t row : OrderOfTime(layout.Times(path), times, info.notes)) {
    info.stamps_ns.push_back(times[row].stamp_ns);
    files.push_back(rows[row]);
  }
  KittiCamera camera = ReadCalibration(path, options, layout, cameras, files, info.sensor);
  UseCamera(std::move(camera.file), info);
  info.layout = Describe(layout, cameras, camera.images.c_str());
  AddGroundTruth({KittiPosesFiles(path), camera.truth, &times}, options, info);
  return MakeImageDataset(std::move(info), std::move(files));
}

}  // namespace plumbline
