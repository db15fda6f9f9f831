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
  std::vector<std::string> notes;  // one sentence for each thing that is missing
};

// Whether a name is that of such a file: it ends with .db3 or .mcap, or with .zstd behind it.
bool IsRosbag2Name(const std::string& name);

// Whether a folder is one of `ros2 bag`: it has such files, and metadata.yaml or nothing else but
// their journals and camera files.
bool IsRosbag2Folder(const std::filesystem::path& folder);

// Finds the files of a folder as `ros2 bag record` makes it, by its metadata.yaml; without it, or
// where it is damaged, by their names, which end with numbers. A file that is named and not there
// is looked for with and without .zstd, which `ros2 bag play` unpacks beside it. Of a path to a
// file this file alone. Throws InputError where there is none, or where nobody can tell which files
// belong together.
Rosbag2Files FindRosbag2Files(const std::filesystem::path& path);

}  // namespace plumbline
