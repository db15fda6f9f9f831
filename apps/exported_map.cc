// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/exported_map.h"

#include "plumbline/base/counted.h"
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/export/colmap_model.h"
#include "plumbline/io/export/nerfstudio.h"
#include "plumbline/io/export/png.h"
#include "plumbline/io/geometry_files.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/map/keyframe_trajectory.h"
#include "plumbline/map/reprojection.h"
#include "plumbline/report/run_files.h"

#include "apps/command_line.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <system_error>

#include <fmt/format.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// An export that was told to stop before there was anything whole to write.
struct ExportStopped {};

void EndIfAsked(const StopCheck& stop) {
  if (IsToStop(stop)) throw ExportStopped{};
}

// The lines that a run gives out, too.
std::vector<Segment3> LinesToExport(const SavedMap& saved,
                                    const MapExport& wanted,
                                    const StopCheck& stop) {
  std::vector<Segment3> segments =
      SegmentsOf(MakeLineMap(saved.map, wanted.imaging, wanted.line_map, stop));
  EndIfAsked(stop);
  return segments;
}

// The mean colour of each point in the images that were added.
class PointColorMeans {
 public:
  // `camera` is that of the image.
  void Add(const KeyFrame& keyframe, const ExportCamera& camera, const ColorImage& image) {
    const Frame& frame = keyframe.frame;
    const Features measured = MeasuredFeatures(*frame.indexed);
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
      if (!frame.points[i].valid()) continue;
      const Eigen::Vector2d& rectified = measured.points[i].px;
      const Eigen::Vector2d px = camera.PixelOf(rectified).value_or(rectified);
      const auto x = std::clamp<long>(std::lround(px.x()), 0, image.width() - 1);
      const auto y = std::clamp<long>(std::lround(px.y()), 0, image.height() - 1);
      const Color color = image.at(static_cast<int>(x), static_cast<int>(y));
      Sum& sum = sums_[frame.points[i]];
      sum.r += color.r;
      sum.g += color.g;
      sum.b += color.b;
      ++sum.count;
    }
  }

  PointColors Means() const {
    PointColors means;
    for (const auto& [id, sum] : sums_) {
      const auto mean = [count = sum.count](int of) {
        return static_cast<std::uint8_t>(of / count);
      };
      means[id] = {mean(sum.r), mean(sum.g), mean(sum.b)};
    }
    return means;
  }

 private:
  struct Sum {
    int r = 0, g = 0, b = 0, count = 0;
  };
  std::map<PointId, Sum> sums_;
};

// An image to read: of a keyframe, or of another frame if that is null.
struct WantedImage {
  std::int64_t stamp_ns = 0;
  std::string name;
  const KeyFrame* keyframe = nullptr;
};

// In the order of time, in which videos are read fast.
std::vector<WantedImage> WantedImages(const SavedMap& saved,
                                      const std::map<KeyFrameId, std::string>& names,
                                      const MapExport& wanted) {
  std::vector<WantedImage> images;
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    images.push_back({keyframe.frame.stamp_ns, names.at(id), &keyframe});
  }
  for (const PosedImage& other : wanted.others) {
    if (!wanted.images->HasFrame(other.stamp_ns)) {
      throw InputError(
          fmt::format("{}: expected a frame at {} s, where the run has a pose, found "
                      "none",
                      wanted.images->path().string(),
                      FormatStamp(other.stamp_ns)));
    }
    images.push_back({other.stamp_ns, other.name, nullptr});
  }
  std::stable_sort(images.begin(), images.end(), [](const WantedImage& a, const WantedImage& b) {
    return a.stamp_ns < b.stamp_ns;
  });
  return images;
}

// Returns the camera of the images of a format: that of the images as delivered, if the format
// knows its lens, otherwise that of the map.
ExportCamera CameraOfImages(const SavedMap& saved, const MapExport& wanted) {
  const ExportCamera undistorted(saved.camera);
  if (wanted.images == nullptr || wanted.undistort) return undistorted;
  const ExportCamera delivered = wanted.images->DeliveredCamera();
  const bool known =
      (wanted.format == ExportFormat::kColmap && ColmapCameraOf(delivered.intrinsics())) ||
      (wanted.format == ExportFormat::kNerfstudio && NerfstudioKnows(delivered.intrinsics()));
  return known ? delivered : undistorted;
}

// Returns the number of images and, if they are not as the camera delivers them, or are but need a
// lens model, what they are.
std::string ImagesText(const MapExport& wanted, const ExportCamera& camera, std::size_t count) {
  const std::string images = Counted(count, "image");
  if (wanted.images == nullptr) return images + " (not written; --images PATH writes them)";
  const ExportCamera delivered = wanted.images->DeliveredCamera();
  if (!delivered.IsDelivered()) return images;
  const std::string_view lens = FormOf(delivered.intrinsics().model).name;
  if (camera.IsDelivered()) return fmt::format("{} as delivered ({})", images, lens);
  if (wanted.undistort) return images + " without distortion";
  return fmt::format("{} without distortion (no model {} there)", images, lens);
}

// Reads all images of this camera, writes them into `folder` unless it is empty, and returns the
// colours of the points in those of the keyframes; no colours without images.
PointColors ReadImages(const SavedMap& saved,
                       const ExportCamera& camera,
                       const std::map<KeyFrameId, std::string>& names,
                       const MapExport& wanted,
                       const fs::path& folder,
                       const StopCheck& stop) {
  if (wanted.images == nullptr) return {};
  if (!folder.empty()) MakeFolder(folder);
  const ImageForm form = camera.IsDelivered() ? ImageForm::kDelivered : ImageForm::kUndistorted;
  PointColorMeans colors;
  for (const WantedImage& one : WantedImages(saved, names, wanted)) {
    EndIfAsked(stop);
    const ColorImage image = one.keyframe != nullptr ? wanted.images->Read(*one.keyframe, form)
                                                     : wanted.images->ReadAt(one.stamp_ns, form);
    if (one.keyframe != nullptr) colors.Add(*one.keyframe, camera, image);
    if (!folder.empty()) WriteColorPng(folder / one.name, image);
  }
  return colors.Means();
}

// Writes the points of known distance with their colours, if these are known, and lines. Returns
// how many points these are, and how many are left out.
std::string WritePoints(const fs::path& path,
                        const SavedMap& saved,
                        const PointColors& colors,
                        const std::vector<Segment3>& lines) {
  std::vector<Eigen::Vector3d> points;
  std::vector<Color> in_order;
  for (const MapPoint* point : PointsOfKnownDistance(saved.camera, saved.map)) {
    points.push_back(point->position);
    if (!colors.empty()) in_order.push_back(colors.at(point->id));
  }
  WritePly(path, points, lines, in_order);
  const std::size_t left_out = saved.map.points().size() - points.size();
  return Counted(points.size(), "point") +
         (left_out == 0 ? std::string()
                        : fmt::format(" ({} of unknown distance left out)", left_out));
}

std::string ExportColmap(const SavedMap& saved, const MapExport& wanted, const StopCheck& stop) {
  const std::map<KeyFrameId, std::string> names = KeyFrameImageNames(saved.map);
  AtomicFolder folder(wanted.out);
  const fs::path& path = folder.temporary_path();
  const ExportCamera camera = CameraOfImages(saved, wanted);
  const PointColors colors = ReadImages(saved, camera, names, wanted, path / "images", stop);
  const ColmapModel model = MakeColmapModel(saved, camera, names, colors, wanted.others);
  WriteColmapFolder(path, saved.map, camera, model, names, wanted.colmap_files);
  folder.Commit();
  const std::size_t left_out = saved.map.points().size() - model.points.size();
  return fmt::format("{}, {}{}, {}",
                     ImagesText(wanted, camera, model.images.size()),
                     Counted(model.points.size(), "point"),
                     left_out == 0
                         ? std::string()
                         : fmt::format(" ({} of one image or unknown distance left out)", left_out),
                     Counted(saved.map.lines().size(), "line"));
}

std::string ExportNerfstudio(const SavedMap& saved,
                             const MapExport& wanted,
                             const StopCheck& stop) {
  const std::map<KeyFrameId, std::string> names = KeyFrameImageNames(saved.map);
  AtomicFolder folder(wanted.out);
  const fs::path& path = folder.temporary_path();
  const ExportCamera camera = CameraOfImages(saved, wanted);
  const PointColors colors = ReadImages(saved, camera, names, wanted, path / "images", stop);
  const std::string points = WritePoints(path / "points.ply", saved, colors, {});
  WriteNerfstudioTransforms(
      path / "transforms.json", saved, camera, names, "points.ply", wanted.others);
  folder.Commit();
  return fmt::format(
      "{}, {}", ImagesText(wanted, camera, names.size() + wanted.others.size()), points);
}

std::string ExportTum(const SavedMap& saved, const MapExport& wanted) {
  const Trajectory trajectory = KeyFrameTrajectory(saved.map, saved.rectified_from_left);
  WriteTum(wanted.out, trajectory);
  const std::size_t left_out = saved.map.keyframes().size() - trajectory.size();
  return fmt::format(
      "{}{}",
      Counted(trajectory.size(), "keyframe"),
      left_out == 0 ? std::string() : fmt::format(" ({} of the same times left out)", left_out));
}

std::string ExportLines(const SavedMap& saved, const MapExport& wanted, const StopCheck& stop) {
  const std::vector<Segment3> lines = LinesToExport(saved, wanted, stop);
  if (wanted.format == ExportFormat::kPly) {
    const PointColors colors = ReadImages(
        saved, CameraOfImages(saved, wanted), KeyFrameImageNames(saved.map), wanted, {}, stop);
    return fmt::format(
        "{}, {}", WritePoints(wanted.out, saved, colors, lines), Counted(lines.size(), "line"));
  }
  if (wanted.format == ExportFormat::kObj) {
    WriteObjLines(wanted.out, lines);
  } else {
    WriteDxfLines(wanted.out, lines);
  }
  return Counted(lines.size(), "line");
}

bool IsFolder(ExportFormat format) {
  return format == ExportFormat::kColmap || format == ExportFormat::kNerfstudio;
}

// Returns true if two poses are equal up to the decimals of files.
bool AreSame(const Rigid3& a, const Rigid3& b) {
  constexpr double kTolerance = 1e-6;
  return (a.translation - b.translation).norm() < kTolerance * (1 + b.translation.norm()) &&
         AngularDistance(a.rotation, b.rotation) < kTolerance;
}

}  // namespace

FileKind KindOfExport(ExportFormat format) {
  switch (format) {
    case ExportFormat::kPly:
      return {"a PLY file by plumbline", "ply\nformat ascii 1.0\ncomment Plumbline map"};
    case ExportFormat::kObj:
      return {"lines that were exported", "# Plumbline line segments"};
    case ExportFormat::kDxf:
      return {"a DXF file by plumbline", "0\nSECTION\n"};
    case ExportFormat::kTum:
      return TrajectoryFileKind();
    case ExportFormat::kColmap:
    case ExportFormat::kNerfstudio:
      return {"a folder", {}};
  }
  throw BugError("a form without a kind of file");
}

int ParseExportedFrames(std::string_view text) {
  constexpr std::string_view kEvery = "every:";
  if (text == "keyframes") return 0;
  if (text == "all") return 1;
  if (text.starts_with(kEvery)) {
    return ParseCount("--frames every", text.substr(kEvery.size()), {1, kMostFrames});
  }
  const std::array<std::string, 3> names = {"keyframes", "all", "every:N"};
  FailChoice("--frames", names, text);
}

void CheckExport(ExportFormat format, bool has_images, int every, bool undistort) {
  if (has_images && !IsFolder(format) && format != ExportFormat::kPly) {
    throw InputError("--images: goes with --to ply, colmap and nerfstudio only");
  }
  if (every > 0 && !IsFolder(format)) {
    throw InputError("--frames: goes with --to colmap and nerfstudio only");
  }
  if (undistort && (!has_images || !IsFolder(format))) {
    throw InputError("--undistort: goes with --images and --to colmap or nerfstudio only");
  }
  if (has_images) return;
  constexpr std::string_view kImages =
      "expected --images PATH, the data that the map was made from";
  if (format == ExportFormat::kNerfstudio) {
    throw InputError(
        fmt::format("--to nerfstudio: {}: a data set of nerfstudio consists of images", kImages));
  }
  if (every > 0) throw InputError(fmt::format("--frames: {}", kImages));
}

fs::path TrajectoryBeside(const fs::path& map_file, MapId map) {
  const fs::path folder = map_file.parent_path();
  std::error_code error;
  for (const TrajectoryNames& names : {TrajectoryNames(map), TrajectoryNames()}) {
    if (fs::is_regular_file(folder / names.final_estimate, error)) {
      return folder / names.final_estimate;
    }
  }
  throw InputError(fmt::format(
      "--frames: expected the poses of all frames in {}, beside the map as in the folder of a run, "
      "found no such file: --trajectory FILE names another one",
      (folder / TrajectoryNames().final_estimate).string()));
}

std::vector<PosedImage> FramesBetween(const SavedMap& saved,
                                      const std::string& source,
                                      const Trajectory& trajectory,
                                      int every) {
  PLUMBLINE_CHECK(every > 0, "every n-th frame");
  std::multimap<std::int64_t, const KeyFrame*> keyframes;
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    keyframes.emplace(keyframe.frame.stamp_ns, &keyframe);
  }
  const Rigid3 rectified{saved.rectified_from_left, Eigen::Vector3d::Zero()};
  const auto fail = [&](std::int64_t stamp_ns, KeyFrameId id, const char* found) {
    throw InputError(fmt::format(
        "{}: expected the poses of the run that made the map, found {} at {} s, where the map has "
        "keyframe {}",
        source,
        found,
        FormatStamp(stamp_ns),
        id.value));
  };
  bool has_keyframe = false;
  std::vector<PosedImage> frames;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::int64_t stamp_ns = trajectory[i].stamp_ns;
    const Rigid3 cam_from_world = rectified * Inverse(trajectory[i].world_from_camera);
    const auto [first, last] = keyframes.equal_range(stamp_ns);
    if (first == last) {
      if (i % static_cast<std::size_t>(every) == 0) {
        frames.push_back({stamp_ns, fmt::format("{}.png", stamp_ns), cam_from_world});
      }
      continue;
    }
    has_keyframe = true;
    const bool agrees = std::any_of(first, last, [&](const auto& entry) {
      return AreSame(cam_from_world, entry.second->frame.cam_from_world);
    });
    if (!agrees) fail(stamp_ns, first->second->id, "another one");
  }
  if (!has_keyframe && !keyframes.empty()) {
    fail(keyframes.begin()->first, keyframes.begin()->second->id, "none");
  }
  return frames;
}

std::optional<std::string> ExportMap(const SavedMap& saved,
                                     const MapExport& wanted,
                                     const StopCheck& stop) {
  try {
    EndIfAsked(stop);
    switch (wanted.format) {
      case ExportFormat::kColmap:
        return ExportColmap(saved, wanted, stop);
      case ExportFormat::kNerfstudio:
        return ExportNerfstudio(saved, wanted, stop);
      case ExportFormat::kTum:
        return ExportTum(saved, wanted);
      default:
        return ExportLines(saved, wanted, stop);
    }
  } catch (const ExportStopped&) {
    return std::nullopt;
  }
}

}  // namespace plumbline
