// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/datasets/rosbag2_files.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/cameras/yaml_section.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPacked = ".zstd";

std::string Unpacked(const std::string& name) {
  return name.ends_with(kPacked) ? name.substr(0, name.size() - kPacked.size()) : name;
}

// Returns the names of the files of ROS 2 in a folder. Of a file that is there as it is and packed,
// the first counts.
std::set<std::string> NamesIn(const fs::path& folder) {
  std::error_code error;
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (IsRosbag2Name(name) && !name.starts_with('.')) names.insert(name);
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  std::erase_if(names, [&](const std::string& name) {
    return name.ends_with(kPacked) && names.contains(Unpacked(name));
  });
  return names;
}

// The name of a file of a recording: "walk_" and 12 of walk_12.db3.
std::pair<std::string, std::string> StemAndNumber(const std::string& name) {
  const std::string stem = fs::path(Unpacked(name)).stem().string();
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  const std::size_t zeros = std::min(stem.find_first_not_of('0', digits), stem.size());
  return {stem.substr(0, digits), stem.substr(zeros)};
}

// Returns the files in the order of their numbers.
std::vector<std::string> InOrder(const fs::path& folder, const std::set<std::string>& names) {
  std::vector<std::string> order(names.begin(), names.end());
  std::sort(order.begin(), order.end(), [](const std::string& a, const std::string& b) {
    const auto key = [](const std::string& name) {
      const auto [stem, number] = StemAndNumber(name);
      return std::tuple(stem, number.size(), number, name);
    };
    return key(a) < key(b);
  });
  const auto stem = [](const std::string& name) { return StemAndNumber(name).first; };
  for (const std::string& name : order) {
    if (stem(name) == stem(order.front())) continue;
    throw InputError(
        fmt::format("{}: expected the files of one recording, found {} and {}; give one "
                    "of them",
                    folder.string(),
                    Printable(order.front()),
                    Printable(name)));
  }
  return order;
}

// Returns the names that metadata.yaml lists. Older versions have the folder before the name.
std::vector<std::string> ListedIn(const fs::path& metadata) {
  const YamlSection root =
      YamlSection::Parse(ReadInputFile(metadata, kLargestSettings), metadata.string());
  std::vector<std::string> names;
  for (const std::string& path :
       root.Child("rosbag2_bagfile_information").Texts("relative_file_paths")) {
    names.push_back(fs::path(path).filename().string());
  }
  return names;
}

// Adds the files listed in the metadata and present in the folder, in that order.
void TakeListed(const fs::path& folder,
                const std::vector<std::string>& listed,
                std::set<std::string> names,
                Rosbag2Files& found) {
  std::set<std::string> seen;
  for (const std::string& name : listed) {
    std::string there = Unpacked(name);
    if (!seen.insert(there).second) {
      found.notes.push_back(fmt::format("{}: metadata.yaml lists it more than once; it counts once",
                                        (folder / Printable(there)).string()));
      continue;
    }
    if (!names.contains(there)) there += kPacked;
    if (names.erase(there) == 0) {
      found.notes.push_back(fmt::format("{}, which metadata.yaml lists, does not exist",
                                        (folder / Printable(name)).string()));
    } else {
      found.files.push_back(folder / there);
    }
  }
  if (names.empty()) return;
  std::vector<std::string> left;
  for (const std::string& name : names) left.push_back(Printable(name));
  found.notes.push_back(fmt::format(
      "{}: metadata.yaml does not list {}: left out", folder.string(), fmt::join(left, ", ")));
}

}  // namespace

bool IsRosbag2Name(const std::string& name) {
  const std::string plain = Unpacked(name);
  return plain.ends_with(".db3") || plain.ends_with(".mcap");
}

bool IsRosbag2Folder(const fs::path& folder) {
  std::error_code error;
  bool files = false, others = false;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool file = IsRosbag2Name(name);
    const bool known = file || name.starts_with('.') || name.ends_with(".yaml") ||
                       name.find(".db3-") != std::string::npos;
    files = files || file;
    others = others || !known;
  }
  return files && (!others || fs::exists(folder / "metadata.yaml", error));
}

Rosbag2Files FindRosbag2Files(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {{path}, {}};
  const std::set<std::string> names = NamesIn(path);
  Rosbag2Files found;
  const fs::path metadata = path / "metadata.yaml";
  std::string without;
  if (fs::exists(metadata, error)) {
    try {
      TakeListed(path, ListedIn(metadata), names, found);
    } catch (const InputError& fault) {
      without = fault.what();
    }
  } else {
    without = metadata.string() + " does not exist";
  }
  if (found.files.empty()) {
    if (names.empty()) {
      const std::string why =
          without.empty() ? fmt::format("{}", fmt::join(found.notes, "; ")) : without;
      throw InputError(fmt::format(
          "{}: expected files .db3 or .mcap of ros2 bag, found none: {}", path.string(), why));
    }
    found = {};
    if (without.empty()) without = metadata.string() + " lists none of the files";
    const std::vector<std::string> order = InOrder(path, names);
    for (const std::string& name : order) found.files.push_back(path / name);
    found.notes.push_back(fmt::format("{}: the files are read in the order of their names: {}",
                                      without,
                                      Printable(fmt::format("{}", fmt::join(order, ", ")))));
  }
  return found;
}

}  // namespace plumbline
