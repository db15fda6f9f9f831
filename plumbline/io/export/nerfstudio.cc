// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/nerfstudio.h"

#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"

#include <array>
#include <cstddef>
#include <optional>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using Json = nlohmann::ordered_json;

Json RowsOf(const Eigen::Matrix4d& matrix) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < 4; ++r) {
    rows.push_back({matrix(r, 0), matrix(r, 1), matrix(r, 2), matrix(r, 3)});
  }
  return rows;
}

// The camera; nullopt if there is no model that is the same. A third radial coefficient is named
// only if it is not zero.
std::optional<Json> CameraJson(const CameraIntrinsics& in) {
  constexpr double kHalfPixel = 0.5;
  const bool fisheye = in.model == DistortionModel::kEquidistant;
  const bool ideal = Camera(in).IsIdeal();
  if (!fisheye && !ideal && in.model != DistortionModel::kRadTan) return std::nullopt;
  Json json = {{"camera_model", fisheye ? "OPENCV_FISHEYE" : "OPENCV"},
               {"w", in.width},
               {"h", in.height},
               {"fl_x", in.fx},
               {"fl_y", in.fy},
               {"cx", in.cx + kHalfPixel},
               {"cy", in.cy + kHalfPixel}};
  const std::array<const char*, 4> names =
      fisheye ? std::array{"k1", "k2", "k3", "k4"} : std::array{"k1", "k2", "p1", "p2"};
  for (std::size_t i = 0; i < names.size(); ++i) json[names[i]] = ideal ? 0.0 : in.distortion[i];
  if (!fisheye && !ideal && in.distortion[4] != 0) json["k3"] = in.distortion[4];
  return json;
}

}  // namespace

bool NerfstudioKnows(const CameraIntrinsics& intrinsics) {
  return CameraJson(intrinsics).has_value();
}

void WriteNerfstudioTransforms(const std::filesystem::path& path,
                               const SavedMap& saved,
                               const ExportCamera& camera,
                               const std::map<KeyFrameId, std::string>& names,
                               const std::string& ply_file,
                               std::span<const PosedImage> others) {
  const std::optional<Json> known = CameraJson(camera.intrinsics());
  PLUMBLINE_CHECK(known.has_value(), "a camera that nerfstudio knows");
  Json json = *known;
  json["ply_file_path"] = ply_file;
  json["frames"] = Json::array();
  const Eigen::Vector4d opengl_axes(1, -1, -1, 1);
  const auto add = [&](const std::string& name, const Rigid3& cam_from_world) {
    const Eigen::Matrix4d world_from_camera = Inverse(camera.PoseOf(cam_from_world)).Matrix();
    json["frames"].push_back(
        {{"file_path", "images/" + name},
         {"transform_matrix", RowsOf(world_from_camera * opengl_axes.asDiagonal())}});
  };
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    add(names.at(id), keyframe.frame.cam_from_world);
  }
  for (const PosedImage& other : others) add(other.name, other.cam_from_world);
  WriteFileAtomically(path, json.dump(2) + "\n");
}

}  // namespace plumbline
