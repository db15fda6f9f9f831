// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/nerfstudio.h"

#include "plumbline/io/atomic_file.h"

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

}  // namespace

void WriteNerfstudioTransforms(const std::filesystem::path& path,
                               const SavedMap& saved,
                               const std::string& images,
                               const std::map<KeyFrameId, std::string>& names,
                               const std::string& ply_file,
                               std::span<const PosedImage> others) {
  constexpr double kHalfPixel = 0.5;
  const RectifiedCamera& c = saved.camera;
  Json json = {{"camera_model", "OPENCV"},
               {"w", c.width},
               {"h", c.height},
               {"fl_x", c.fx},
               {"fl_y", c.fy},
               {"cx", c.cx + kHalfPixel},
               {"cy", c.cy + kHalfPixel},
               {"k1", 0.0},
               {"k2", 0.0},
               {"p1", 0.0},
               {"p2", 0.0},
               {"ply_file_path", ply_file}};
  json["frames"] = Json::array();
  const Eigen::Vector4d opengl_axes(1, -1, -1, 1);
  const auto add = [&](const std::string& name, const Rigid3& cam_from_world) {
    const Eigen::Matrix4d world_from_camera = Inverse(cam_from_world).Matrix();
    json["frames"].push_back(
        {{"file_path", images + "/" + name},
         {"transform_matrix", RowsOf(world_from_camera * opengl_axes.asDiagonal())}});
  };
  for (const auto& [id, keyframe] : saved.map.keyframes()) {
    add(names.at(id), keyframe.frame.cam_from_world);
  }
  for (const PosedImage& other : others) add(other.name, other.cam_from_world);
  WriteFileAtomically(path, json.dump(2) + "\n");
}

}  // namespace plumbline
