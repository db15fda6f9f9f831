// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/kitti.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/plausible_calibration.h"
#include "plumbline/io/camera_file.h"
#include "plumbline/io/ground_truth.h"
#include "plumbline/io/image_dataset.h"
#include "plumbline/io/stamp_order.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/io/trajectory_io.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/core.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using Matrix34 = Eigen::Matrix<double, 3, 4>;

// A row of calib.txt.
struct Projection {
  Matrix34 matrix;
  int line = 0;
};

// Returns the one row of this name; throws InputError where there is none, or where two differ.
TextRow OnlyRow(const fs::path& file, const std::string& name) {
  std::optional<TextRow> found;
  for (const TextRow& row : ReadRows(file, ' ')) {
    if (row.fields[0] != name) continue;
    if (found && found->fields != row.fields) {
      FailAt(file,
             row.line,
             fmt::format("one row '{}'", name),
             fmt::format("another one after that of line {}", found->line));
    }
    found = row;
  }
  if (found) return *found;
  throw InputError(fmt::format("{}: expected a row '{}', found none", file.string(), name));
}

// Reads a row `P0: 12 numbers` of calib.txt as an ideal pinhole; throws InputError otherwise.
Projection ReadProjection(const fs::path& file, const std::string& name) {
  const TextRow row = OnlyRow(file, name + ":");
  if (row.fields.size() != 13) {
    FailAt(file, row.line, "12 numbers after " + name + ":", std::to_string(row.fields.size() - 1));
  }
  Matrix34 p;
  for (std::size_t i = 0; i < 12; ++i) {
    p(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
        NumberField(file, row, i + 1);
  }
  if (p(0, 0) <= 0 || p(1, 1) <= 0 || p(0, 1) != 0 || p(1, 0) != 0 ||
      p.row(2).head<3>() != Eigen::RowVector3d(0, 0, 1)) {
    FailAt(file, row.line, "the projection of a rectified camera", "another matrix");
  }
  return {p, row.line};
}

// Throws InputError at the line of the file where there is a fault (plausible_calibration.h).
void Refuse(const std::optional<std::string>& fault, const fs::path& file, int line) {
  if (fault) throw InputError(fmt::format("{}:{}: {}", file.string(), line, *fault));
}

Camera ToCamera(const Projection& projection, const fs::path& file, int width, int height) {
  const Matrix34& p = projection.matrix;
  CameraIntrinsics k;
  k.fx = p(0, 0);
  k.fy = p(1, 1);
  k.cx = p(0, 2);
  k.cy = p(1, 2);
  k.width = width;
  k.height = height;
  Refuse(SizeFault(width, height), file, projection.line);
  Refuse(IntrinsicsFault(k), file, projection.line);
  return Camera(k);
}

// Returns the size of most images, judged by a few that are spread over the sequence, since
// calib.txt has none. An image of another size is then the one at fault, even where it is the
// first.
ImageSize SizeOfMost(const fs::path& path, const std::vector<FrameFiles>& files) {
  constexpr std::size_t kAsked = 9;
  const std::size_t step = std::max<std::size_t>(1, files.size() / kAsked);
  std::vector<std::pair<ImageSize, int>> votes;
  // The other images are read only where none of the few can be read.
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
    throw InputError(path.string() +
                     ": expected images in image_0, found none that can be decoded");
  }
  return std::max_element(votes.begin(),
                          votes.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

CameraFile ReadCalibration(const fs::path& path,
                           const DatasetOptions& options,
                           const std::vector<FrameFiles>& files,
                           SensorKind sensor) {
  if (std::optional<CameraFile> camera = GivenCamera(path, options, sensor)) return *camera;
  const fs::path file = path / "calib.txt";
  CameraFile camera{{}, file.string() + " (KITTI calib.txt)"};
  Calibration& calibration = camera.calibration;
  const Projection left = ReadProjection(file, "P0");
  const auto [width, height] = SizeOfMost(path, files);
  calibration.left = ToCamera(left, file, width, height);
  calibration.rectified = true;
  if (sensor == SensorKind::kStereo) {
    const Projection right = ReadProjection(file, "P1");
    calibration.right = ToCamera(right, file, width, height);
    const double baseline = -right.matrix(0, 3) / right.matrix(0, 0);
    if (!(baseline > 0) || right.matrix.leftCols<3>() != left.matrix.leftCols<3>()) {
      const bool same = right.matrix.leftCols<3>() == left.matrix.leftCols<3>();
      FailAt(file,
             right.line,
             "P1 to be P0 with a baseline above 0",
             same ? fmt::format("a baseline of {:g} m", baseline)
                  : fmt::format("fx {:g} fy {:g} cx {:g} cy {:g} beside fx {:g} fy {:g} cx {:g} "
                                "cy {:g}",
                                right.matrix(0, 0),
                                right.matrix(1, 1),
                                right.matrix(0, 2),
                                right.matrix(1, 2),
                                left.matrix(0, 0),
                                left.matrix(1, 1),
                                left.matrix(0, 2),
                                left.matrix(1, 2)));
    }
    calibration.right_from_left.translation.x() = -baseline;
    Refuse(PairFault(calibration), file, right.line);
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

// Returns the file of frame i, or where it would be beside the others.
fs::path ImageAt(const std::map<std::size_t, fs::path>& images,
                 const fs::path& folder,
                 std::size_t i) {
  const auto found = images.find(i);
  if (found != images.end()) return found->second;
  const std::string extension =
      images.empty() ? ".png" : images.begin()->second.extension().string();
  return folder / fmt::format("{:06}{}", i, extension);
}

}  // namespace

std::vector<fs::path> KittiPosesFiles(const fs::path& sequence) {
  const std::string name = fs::absolute(sequence / ".").lexically_normal().parent_path().filename();
  return {sequence / "poses.txt", sequence / ".." / ".." / "poses" / (name + ".txt")};
}

std::unique_ptr<Dataset> OpenKitti(const fs::path& path, const DatasetOptions& options) {
  std::vector<SensorKind> available = {SensorKind::kMono};
  if (PathExists(path / "image_1")) available.insert(available.begin(), SensorKind::kStereo);
  DatasetInfo info = DescribeDataset(path, DatasetFormat::kKitti, std::move(available), options);
  const bool stereo = info.sensor == SensorKind::kStereo;

  const std::vector<StampedRow> times = ReadKittiTimes(path / "times.txt");
  const std::map<std::size_t, fs::path> left = NumberedImages(path / "image_0");
  if (left.empty()) {
    throw InputError((path / "image_0").string() + ": expected images, found none");
  }
  if (left.rbegin()->first >= times.size()) {
    throw InputError(fmt::format("{}: expected a time for each image up to {}, found {} times",
                                 (path / "times.txt").string(),
                                 left.rbegin()->second.filename().string(),
                                 times.size()));
  }
  std::map<std::size_t, fs::path> right;
  if (stereo) right = NumberedImages(path / "image_1");
  std::vector<FrameFiles> files;
  for (const std::size_t i : OrderOfTime(path / "times.txt", times, info.notes)) {
    info.stamps_ns.push_back(times[i].stamp_ns);
    FrameFiles frame{ImageAt(left, path / "image_0", i), std::nullopt, std::nullopt};
    if (stereo) frame.right = ImageAt(right, path / "image_1", i);
    files.push_back(std::move(frame));
  }
  UseCamera(ReadCalibration(path, options, files, info.sensor), info);
  AddGroundTruth({KittiPosesFiles(path), GroundTruth::Frame::kCamera, &times}, options, info);
  return MakeImageDataset(std::move(info), std::move(files));
}

}  // namespace plumbline
