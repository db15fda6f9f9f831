// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/colmap_model.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/cameras/colmap_camera_models.h"
#include "plumbline/map/reprojection.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>

namespace plumbline {
namespace {

constexpr double kHalfPixel = 0.5;  // COLMAP counts pixels from the corner of the image
constexpr Color kUnknownColor{128, 128, 128};

// Where a feature is in an exported image; outside of it if the lens shows nothing there.
Eigen::Vector2d ColmapPixelOf(const ExportCamera& camera, const Eigen::Vector2d& rectified_px) {
  const Eigen::Vector2d nowhere(-1, -1);
  return camera.PixelOf(rectified_px).value_or(nowhere) + Eigen::Vector2d::Constant(kHalfPixel);
}

ColmapModel::Image ImageOf(const ExportCamera& camera,
                           const KeyFrame& keyframe,
                           const std::string& name) {
  ColmapModel::Image image{
      ColmapImageId(keyframe.id), camera.PoseOf(keyframe.frame.cam_from_world), name, {}};
  for (const PointFeature& feature : keyframe.frame.features().points) {
    image.keypoints.push_back({ColmapPixelOf(camera, feature.px)});
  }
  return image;
}

// Returns the distance in an exported image between a feature and the projection of a point.
std::optional<double> ErrorIn(const ExportCamera& camera,
                              const Frame& frame,
                              int feature,
                              const Eigen::Vector3d& in_world) {
  const auto projected = camera.Project(frame.cam_from_world * in_world);
  const auto measured =
      camera.PixelOf(frame.features().points[static_cast<std::size_t>(feature)].px);
  if (!projected || !measured) return std::nullopt;
  return (*projected - *measured).norm();
}

// Returns the point with its views; nullopt if there are too few for COLMAP, or do not tell how far
// it is.
std::optional<ColmapModel::Point> PointOf(const SavedMap& saved,
                                          const ExportCamera& camera,
                                          const MapPoint& point) {
  constexpr std::size_t kMinViews = 2;
  if (!HasKnownDistance(saved.camera, saved.map, point)) return std::nullopt;
  ColmapModel::Point result;
  result.id = point.id.value + 1;
  result.position = point.position;
  double sum = 0;
  for (const auto& [keyframe, feature] : point.observations) {
    const Frame& frame = saved.map.Find(keyframe)->frame;
    const auto error = ErrorIn(camera, frame, feature, point.position);
    if (!error) continue;
    sum += *error;
    result.track.push_back({ColmapImageId(keyframe), static_cast<std::uint32_t>(feature)});
  }
  if (result.track.size() < kMinViews) return std::nullopt;
  result.error = sum / static_cast<double>(result.track.size());
  return result;
}

// Appends the shortest text that gives each number back exactly.
template <class... Numbers>
void Append(std::string& text, const Numbers&... numbers) {
  std::size_t place = 0;
  (fmt::format_to(std::back_inserter(text), "{}{}", place++ == 0 ? "" : " ", numbers), ...);
}

std::string CamerasText(const ColmapModel& model) {
  const ColmapModel::Camera& c = model.camera;
  std::string text =
      "# Cameras, one line each: CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
      "# Number of cameras: 1\n";
  Append(text, ColmapModel::kCameraId, c.model, c.width, c.height);
  for (const double parameter : c.parameters) {
    text += ' ';
    Append(text, parameter);
  }
  return text + "\n";
}

std::string ImagesText(const ColmapModel& model) {
  std::string text = fmt::format(
      "# Images, two lines each: IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "#                         POINTS2D[] as (X, Y, POINT3D_ID)\n"
      "# Number of images: {}\n",
      model.images.size());
  for (const ColmapModel::Image& image : model.images) {
    const Eigen::Quaterniond& q = image.cam_from_world.rotation;
    const Eigen::Vector3d& t = image.cam_from_world.translation;
    Append(text, image.id, q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z());
    text += ' ';
    Append(text, ColmapModel::kCameraId, image.name);
    text += '\n';
    for (std::size_t i = 0; i < image.keypoints.size(); ++i) {
      const ColmapModel::Keypoint& keypoint = image.keypoints[i];
      if (i > 0) text += ' ';
      Append(text, keypoint.px.x(), keypoint.px.y(), keypoint.point);
    }
    text += '\n';
  }
  return text;
}

std::string PointsText(const ColmapModel& model) {
  std::string text = fmt::format(
      "# 3D points, one line each: POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, "
      "POINT2D_IDX)\n"
      "# Number of points: {}\n",
      model.points.size());
  for (const ColmapModel::Point& point : model.points) {
    const Eigen::Vector3d& p = point.position;
    const Color& c = point.color;
    Append(text, point.id, p.x(), p.y(), p.z(), int{c.r}, int{c.g}, int{c.b}, point.error);
    for (const ColmapModel::View& view : point.track) {
      text += ' ';
      Append(text, view.image, view.keypoint);
    }
    text += '\n';
  }
  return text;
}

template <class... Numbers>
void Put(ByteWriter& writer, const Numbers&... numbers) {
  (writer(numbers), ...);
}

std::string CamerasBinary(const ColmapModel& model) {
  const ColmapModel::Camera& c = model.camera;
  const auto known = std::ranges::find(kColmapCameraModels, c.model, &ColmapCameraModel::name);
  PLUMBLINE_CHECK(known != kColmapCameraModels.end(), "a camera model of COLMAP");
  ByteWriter writer;
  Put(writer, std::uint64_t{1}, ColmapModel::kCameraId, known->id);
  Put(writer, static_cast<std::uint64_t>(c.width), static_cast<std::uint64_t>(c.height));
  for (const double parameter : c.parameters) writer(parameter);
  return writer.Take();
}

std::string ImagesBinary(const ColmapModel& model) {
  ByteWriter writer;
  writer(static_cast<std::uint64_t>(model.images.size()));
  for (const ColmapModel::Image& image : model.images) {
    const Eigen::Quaterniond& q = image.cam_from_world.rotation;
    const Eigen::Vector3d& t = image.cam_from_world.translation;
    Put(writer, image.id, q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z());
    writer(ColmapModel::kCameraId);
    for (const char c : image.name) writer(c);
    writer('\0');
    writer(static_cast<std::uint64_t>(image.keypoints.size()));
    for (const ColmapModel::Keypoint& keypoint : image.keypoints) {
      Put(writer, keypoint.px.x(), keypoint.px.y(), keypoint.point);
    }
  }
  return writer.Take();
}

std::string PointsBinary(const ColmapModel& model) {
  ByteWriter writer;
  writer(static_cast<std::uint64_t>(model.points.size()));
  for (const ColmapModel::Point& point : model.points) {
    const Eigen::Vector3d& p = point.position;
    const Color& c = point.color;
    Put(writer, point.id, p.x(), p.y(), p.z(), c.r, c.g, c.b, point.error);
    writer(static_cast<std::uint64_t>(point.track.size()));
    for (const ColmapModel::View& view : point.track) Put(writer, view.image, view.keypoint);
  }
  return writer.Take();
}

std::string ImageList(const Map& map, const std::map<KeyFrameId, std::string>& names) {
  std::string text = fmt::format("{}\n", map.keyframes().size());
  for (const auto& [id, keyframe] : map.keyframes()) {
    text += fmt::format("{} {}\n", ColmapImageId(id), names.at(id));
  }
  return text;
}

std::string Detections(const Map& map, const ExportCamera& camera) {
  std::string text = fmt::format("{}\n", map.keyframes().size());
  for (const auto& [id, keyframe] : map.keyframes()) {
    const std::vector<LineFeature>& lines = keyframe.frame.features().lines;
    text += fmt::format("{} {}\n", ColmapImageId(id), lines.size());
    for (const LineFeature& line : lines) {
      const Eigen::Vector2d start = ColmapPixelOf(camera, line.segment.start);
      const Eigen::Vector2d end = ColmapPixelOf(camera, line.segment.end);
      text += fmt::format("{} {} {} {}\n", start.x(), start.y(), end.x(), end.y());
    }
  }
  return text;
}

std::string Tracks(const Map& map) {
  std::string text = fmt::format("{}\n", map.lines().size());
  std::size_t index = 0;
  for (const auto& [id, line] : map.lines()) {
    // A keyframe shows a line with one segment.
    const std::size_t views = line.observations.size();
    text += fmt::format("{} {} {}\n", index++, views, views);
    const Segment3 segment = line.Interval();
    for (const Eigen::Vector3d& end : {segment.start, segment.end}) {
      text += fmt::format("{} {} {}\n", end.x(), end.y(), end.z());
    }
    std::string images, segments;
    for (const auto& [keyframe, feature] : line.observations) {
      const char* blank = images.empty() ? "" : " ";
      images += fmt::format("{}{}", blank, ColmapImageId(keyframe));
      segments += fmt::format("{}{}", blank, feature);
    }
    text += images + "\n" + segments + "\n";
  }
  return text;
}

}  // namespace

std::optional<ColmapModel::Camera> ColmapCameraOf(const CameraIntrinsics& intrinsics) {
  CameraIntrinsics in = intrinsics;
  if (Camera(in).IsIdeal()) {
    in.model = DistortionModel::kNone;
    in.distortion = {};
  }
  // A radtan lens is a rational one without denominator.
  const bool is_rational = in.model == DistortionModel::kRadTan;
  for (const ColmapCameraModel& one : kColmapCameraModels) {
    const bool same =
        one.model == in.model || (is_rational && one.model == DistortionModel::kRational);
    const auto rest = in.distortion.begin() + static_cast<std::ptrdiff_t>(one.coefficients);
    if (!same || one.focal_lengths != 2) continue;
    if (std::any_of(rest, in.distortion.end(), [](double k) { return k != 0; })) continue;
    ColmapModel::Camera camera{std::string(one.name), in.width, in.height, {}};
    camera.parameters = {in.fx, in.fy, in.cx + kHalfPixel, in.cy + kHalfPixel};
    camera.parameters.insert(camera.parameters.end(), in.distortion.begin(), rest);
    return camera;
  }
  return std::nullopt;
}

ColmapModel MakeColmapModel(const SavedMap& saved,
                            const ExportCamera& camera,
                            const std::map<KeyFrameId, std::string>& names,
                            const PointColors& colors,
                            std::span<const PosedImage> others) {
  const std::optional<ColmapModel::Camera> known = ColmapCameraOf(camera.intrinsics());
  PLUMBLINE_CHECK(known.has_value(), "a camera that COLMAP knows");
  ColmapModel model;
  model.camera = *known;
  std::map<std::uint32_t, std::size_t> image_of;  // index of the image of each id
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    image_of[ColmapImageId(id)] = model.images.size();
    model.images.push_back(ImageOf(camera, keyframe, names.at(id)));
  }
  std::uint32_t next_id = model.images.empty() ? 1 : model.images.back().id + 1;
  for (const PosedImage& other : others) {
    model.images.push_back({next_id++, camera.PoseOf(other.cam_from_world), other.name, {}});
  }
  for (const auto& [id, point] : saved.map.points()) {
    std::optional<ColmapModel::Point> exported = PointOf(saved, camera, point);
    if (!exported) continue;
    const auto color = colors.find(id);
    for (const ColmapModel::View& view : exported->track) {
      model.images[image_of.at(view.image)].keypoints[view.keypoint].point = exported->id;
    }
    exported->color = color == colors.end() ? kUnknownColor : color->second;
    model.points.push_back(std::move(*exported));
  }
  return model;
}

void WriteColmapText(const std::filesystem::path& folder, const ColmapModel& model) {
  WriteFileAtomically(folder / "cameras.txt", CamerasText(model));
  WriteFileAtomically(folder / "images.txt", ImagesText(model));
  WriteFileAtomically(folder / "points3D.txt", PointsText(model));
}

void WriteColmapBinary(const std::filesystem::path& folder, const ColmapModel& model) {
  WriteFileAtomically(folder / "cameras.bin", CamerasBinary(model));
  WriteFileAtomically(folder / "images.bin", ImagesBinary(model));
  WriteFileAtomically(folder / "points3D.bin", PointsBinary(model));
}

void WriteLimapLines(const std::filesystem::path& folder,
                     const Map& map,
                     const ExportCamera& camera,
                     const std::map<KeyFrameId, std::string>& names) {
  WriteFileAtomically(folder / "image_list.txt", ImageList(map, names));
  WriteFileAtomically(folder / "detections.txt", Detections(map, camera));
  WriteFileAtomically(folder / "alltracks.txt", Tracks(map));
}

void WriteColmapFolder(const std::filesystem::path& folder,
                       const Map& map,
                       const ExportCamera& camera,
                       const ColmapModel& model,
                       const std::map<KeyFrameId, std::string>& names,
                       ColmapFiles files) {
  const std::filesystem::path sparse = folder / "sparse" / "0";
  MakeFolder(sparse);
  if (files != ColmapFiles::kBinary) WriteColmapText(sparse, model);
  if (files != ColmapFiles::kText) WriteColmapBinary(sparse, model);
  MakeFolder(folder / "lines");
  WriteLimapLines(folder / "lines", map, camera, names);
}

}  // namespace plumbline
