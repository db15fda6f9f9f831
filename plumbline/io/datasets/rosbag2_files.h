// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace plumbline {

// The files of a recording of ROS 2, in their order.
struct Rosbag2Files {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> notes;  // one sentence for each missing part
};

// Returns true for the name of a recording file: it ends with .db3 or .mcap, optionally followed by
// .zstd.
bool IsRosbag2Name(const std::string& name);

// Returns true for a folder of `ros2 bag`: it has recording files, and metadata.yaml or nothing
// else but their journals and camera files.
bool IsRosbag2Folder(const std::filesystem::path& folder);

// Finds the files of a folder of `ros2 bag record`, by its metadata.yaml; if that is missing or
// damaged, by their names, which end with numbers. A listed but missing file is searched with and
// without .zstd, which `ros2 bag play` unpacks beside it. Of a path to a file this file alone.
// Throws InputError if there is none, or if it is ambiguous which files belong together.
Rosbag2Files FindRosbag2Files(const std::filesystem::path& path);

}  // namespace plumbline
