// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"
#include "plumbline/image/color_image.h"
#include "plumbline/io/export/export_camera.h"
#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/map/map.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace plumbline {

// A sparse model as COLMAP defines it: pixel centres at (0.5, 0.5), one camera (id 1), poses
// cam_from_world, camera frame x right, y down, z forward.
struct ColmapModel {
  static constexpr std::uint32_t kCameraId = 1;
  static constexpr std::int64_t kNoPoint = -1;

  struct Camera {
    std::string model = "PINHOLE";  // one of kColmapCameraModels
    int width = 0, height = 0;
    std::vector<double> parameters;  // in the order of the model
    friend bool operator==(const Camera&, const Camera&) = default;
  };
  struct Keypoint {
    Eigen::Vector2d px = Eigen::Vector2d::Zero();
    std::int64_t point = kNoPoint;  // id of the 3D point
  };
  struct Image {
    std::uint32_t id = 0;
    Rigid3 cam_from_world;
    std::string name;
    std::vector<Keypoint> keypoints;
  };
  struct View {
    std::uint32_t image = 0;     // id of the image
    std::uint32_t keypoint = 0;  // index of the keypoint in the image
    friend bool operator==(const View&, const View&) = default;
  };
  struct Point {
    std::int64_t id = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Color color;
    double error = 0;  // mean reprojection error of the track, pixels
    std::vector<View> track;
  };

  Camera camera;
  std::vector<Image> images;  // ordered by id
  std::vector<Point> points;  // ordered by id
};

using PointColors = std::map<PointId, Color>;

// Returns the camera of a lens in COLMAP, in the model with two focal lengths and the fewest
// coefficients that is the same; nullopt if it has none.
std::optional<ColmapModel::Camera> ColmapCameraOf(const CameraIntrinsics& intrinsics);

// Returns a map as a COLMAP model: the camera of the images, an image for each keyframe with all of
// its point features, and the points observed by at least two keyframes. COLMAP refuses to adjust a
// model with other points. Ids are those of the map plus 1. Observations of a point not in front of
// the camera are left out.
//
//   camera  one of which ColmapCameraOf knows the lens
//   names   names of the images of all keyframes
//   colors  colours of points, if known; other points are grey, 128
//   others  images of other frames: their ids follow those of the keyframes, in this order; they
//           have no features
ColmapModel MakeColmapModel(const SavedMap& saved,
                            const ExportCamera& camera,
                            const std::map<KeyFrameId, std::string>& names,
                            const PointColors& colors = {},
                            std::span<const PosedImage> others = {});

// Returns the id of the image of a keyframe.
inline std::uint32_t ColmapImageId(KeyFrameId id) {
  return static_cast<std::uint32_t>(id.value + 1);
}

// Write cameras, images and points3D as .txt or .bin into an existing folder. Both keep every
// number to the last bit. Throw InputError if a file cannot be written.
void WriteColmapText(const std::filesystem::path& folder, const ColmapModel& model);
void WriteColmapBinary(const std::filesystem::path& folder, const ColmapModel& model);

// Writes the lines of a map with their observed segments in the text form of LIMAP into an existing
// folder. Ids of images and pixels (centres at 0.5, 0.5) are those of the COLMAP model
// (ColmapImageId), so that the files fit the model:
//
//   image_list.txt  number of images; for each its id and name
//   detections.txt  number of images; for each its id and number of segments, then x1 y1 x2 y2
//   alltracks.txt   number of lines; for each its index, number of segments and of images that show
//                   it, then its two ends in the world, the ids of the images, and the indices of
//                   the segments among the detections of these images
//
// The lines are the landmarks, from end to end of their intervals, weak ones included; they are
// counted from 0 in the order of their ids. Segments are straight in rectified images alone; in
// others their ends are where they are. Throws InputError if a file cannot be written.
void WriteLimapLines(const std::filesystem::path& folder,
                     const Map& map,
                     const ExportCamera& camera,
                     const std::map<KeyFrameId, std::string>& names);

// File formats of a COLMAP model.
enum class ColmapFiles { kText, kBinary, kBoth };
constexpr auto EnumNames(std::type_identity<ColmapFiles>) {
  return std::array{std::pair{ColmapFiles::kText, "text"},
                    std::pair{ColmapFiles::kBinary, "binary"},
                    std::pair{ColmapFiles::kBoth, "both"}};
}

// Writes a map for COLMAP and LIMAP into an existing folder: sparse/0/ with the model in the
// formats `files`, and lines/ with the lines (WriteLimapLines). Images are not written. Throws
// InputError if a folder or file cannot be written.
void WriteColmapFolder(const std::filesystem::path& folder,
                       const Map& map,
                       const ExportCamera& camera,
                       const ColmapModel& model,
                       const std::map<KeyFrameId, std::string>& names,
                       ColmapFiles files = ColmapFiles::kBoth);

}  // namespace plumbline
