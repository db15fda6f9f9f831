// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/reversed_sequence.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/trajectory_io.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> LinesOf(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty() && line.front() != '#') lines.push_back(line);
  }
  return lines;
}

// The stamp of a row, of EuRoC in nanoseconds, and of others in seconds, is behind the mirror.
std::string Mirrored(const std::string& row, std::int64_t mirror_ns) {
  const std::size_t end = std::min(row.find_first_of(", \t"), row.size());
  const std::string rest = row.substr(end);
  std::int64_t stamp_ns = 0;
  const auto read = std::from_chars(row.data(), row.data() + end, stamp_ns);
  if (rest.starts_with(',') && read.ec == std::errc()) {
    return fmt::format("{}{}\n", mirror_ns - stamp_ns, rest);
  }
  stamp_ns = std::llround(1e9 * std::stod(row.substr(0, end)));
  return FormatStamp(mirror_ns - stamp_ns) + rest + "\n";
}

void MirrorList(const fs::path& from, std::int64_t mirror_ns, const fs::path& to) {
  std::string text;
  const std::vector<std::string> rows = LinesOf(from);
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) text += Mirrored(*row, mirror_ns);
  WriteFileAtomically(to, text);
}

void Link(const fs::path& from, const fs::path& to) {
  if (fs::exists(from)) fs::create_symlink(fs::absolute(from), to);
}

void ReverseEuroc(const fs::path& sequence, std::int64_t mirror_ns, const fs::path& folder) {
  fs::create_directories(folder / "mav0");
  Link(sequence / "mav0/body.yaml", folder / "mav0/body.yaml");
  for (const char* camera : {"mav0/cam0", "mav0/cam1"}) {
    if (!fs::exists(sequence / camera)) continue;
    fs::create_directories(folder / camera);
    MirrorList(sequence / camera / "data.csv", mirror_ns, folder / camera / "data.csv");
    for (const char* name : {"data", "sensor.yaml"}) {
      Link(sequence / camera / name, folder / camera / name);
    }
  }
}

// Images are called by their number.
void ReverseKitti(const fs::path& sequence, std::int64_t mirror_ns, const fs::path& folder) {
  MirrorList(sequence / "times.txt", mirror_ns, folder / "times.txt");
  for (const char* camera : {"image_0", "image_1", "image_2", "image_3"}) {
    if (!fs::exists(sequence / camera)) continue;
    std::vector<fs::path> images;
    for (const auto& entry : fs::directory_iterator(sequence / camera)) images.push_back(entry);
    std::sort(images.begin(), images.end());
    fs::create_directories(folder / camera);
    for (std::size_t i = 0; i < images.size(); ++i) {
      Link(images[images.size() - 1 - i], folder / camera / images[i].filename());
    }
  }
}

void ReverseTum(const fs::path& sequence, std::int64_t mirror_ns, const fs::path& folder) {
  for (const char* list : {"rgb.txt", "depth.txt"}) {
    if (fs::exists(sequence / list)) MirrorList(sequence / list, mirror_ns, folder / list);
  }
}

// Folders of images and camera files. Ground truth is written anew, in a file of another name.
void LinkTheRest(const fs::path& sequence, const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(sequence)) {
    const fs::path name = entry.path().filename();
    if (name == "groundtruth.txt" || name == "poses.txt" || fs::exists(folder / name)) continue;
    Link(entry.path(), folder / name);
  }
}

void Write(const fs::path& sequence, const fs::path& folder) {
  DatasetOptions options;
  options.allow_missing_camera = true;
  const auto dataset = OpenDataset(sequence, options);
  const DatasetInfo& info = dataset->info();
  const std::int64_t mirror_ns = info.stamps_ns.front() + info.stamps_ns.back();
  switch (info.format) {
    case DatasetFormat::kEuroc:
      ReverseEuroc(sequence, mirror_ns, folder);
      break;
    case DatasetFormat::kKitti:
      ReverseKitti(sequence, mirror_ns, folder);
      break;
    case DatasetFormat::kTum:
      ReverseTum(sequence, mirror_ns, folder);
      break;
    default:
      throw InputError(
          fmt::format("{}: expected euroc, kitti or tum to be played backwards, found {}",
                      sequence.string(),
                      NameOf(info.format)));
  }
  LinkTheRest(sequence, folder);
  if (!info.ground_truth) return;
  WriteTum(folder / kReversedTruth, TimeReversed(info.ground_truth->poses, mirror_ns));
}

}  // namespace

void WriteReversedSequence(const fs::path& sequence, const fs::path& folder) {
  if (fs::exists(folder)) return;
  fs::path part = folder;
  part += ".part";
  fs::remove_all(part);
  fs::create_directories(part);
  Write(sequence, part);
  fs::rename(part, folder);
}

}  // namespace plumbline
