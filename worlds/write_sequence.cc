// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "worlds/write_sequence.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/atomic_file.h"
#include "worlds/sequence_formats.h"
#include "worlds/true_world.h"

#include <array>
#include <iomanip>
#include <locale>
#include <mutex>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWorldFile = "world.yaml";
constexpr const char* kPartFile = "world.yaml.part";              // while the folder is not whole
constexpr const char* kDescriptionFile = "described_world.yaml";  // a copy of a user's file

constexpr const char* kRendered = "# Rendered by Plumbline";

std::string WorldYaml(const SyntheticSequence& sequence, SequenceFormat format) {
  SynthOptions options = sequence.options();
  return std::string(kRendered) +
         "; the same options give the same bytes again.\nworld: " + sequence.world() +
         "\nformat: " + NameOf(format) + "\n" + OptionTable(options).Dump();
}

// Returns true if an earlier call wrote a folder, complete or not, by the beginning of its
// world.yaml. The file is empty if a call ended early.
bool IsRendered(const fs::path& folder) {
  if (fs::exists(folder / kWorldFile)) return FileBeginsWith(folder / kWorldFile, kRendered);
  const fs::path part = folder / kPartFile;
  return FileBeginsWith(part, kRendered) || ReadFileIfThere(part) == "";
}

// Files and folders of a sequence, of all formats.
constexpr std::array kNames = {kWorldFile,
                               "mav0",
                               "rgb",
                               "depth",
                               "rgb.txt",
                               "depth.txt",
                               "groundtruth.txt",
                               "camera.yaml",
                               "imu.csv",
                               "imu_ideal.csv",
                               "lines.csv",
                               "surfaces.csv",
                               "mask0",
                               "mask1",
                               "mask_text.png",
                               kDescriptionFile};

// Returns true if an earlier call, which may not have ended, had an option that renders masks:
// `person` or `text`. Masks of other programs have the same names.
bool WasRenderedWith(const char* option, const fs::path& folder) {
  const std::string set = std::string("\n") + option + ": true";
  for (const char* name : {kWorldFile, kPartFile}) {
    const auto world = ReadFileIfThere(folder / name);
    if (world && world->find(set) != std::string::npos) return true;
  }
  return false;
}

// Returns true for a file with the name of a mask that no earlier call wrote.
bool IsForeignMask(const fs::path& file, const fs::path& folder) {
  const std::string name = file.filename().string();
  if (name == "mask_text.png") return !WasRenderedWith("text", folder);
  return name == "mask0" || name == "mask1";  // rendered ones are folders
}

// Returns true if a file in one of its folders has a final or temporary name of rendering.
bool IsRenderedName(const std::string& path, bool masks) {
  static const std::regex mask(R"(mask[01]/([0-9]+|[0-9]+\.[0-9]{9})\.png)");
  static const std::regex rendered(
      R"(mav0/(cam[01]|depth0)/(sensor\.yaml|data\.csv|data/[0-9]+\.png)|)"
      R"(mav0/imu0/(sensor\.yaml|data\.csv|data_ideal\.csv)|)"
      R"(mav0/state_groundtruth_estimate0/data\.csv|)"
      R"((rgb|depth)/[0-9]+\.[0-9]{9}\.png|)"
      R"((.+/)?\.[^/]+\.[0-9]+\.tmp(\.[a-z]+)?)");
  return std::regex_match(path, rendered) || (masks && std::regex_match(path, mask));
}

// The first file by name that somebody put into the folders of a sequence, or in place of a mask.
std::optional<fs::path> ForeignFile(const fs::path& folder) {
  std::error_code error;
  std::optional<fs::path> foreign;
  const bool masks = WasRenderedWith("person", folder);
  const auto add = [&](const fs::path& path) {
    if (!foreign || path < *foreign) foreign = path;
  };
  for (const char* name : kNames) {
    if (!fs::exists(folder / name, error)) continue;
    if (!fs::is_directory(folder / name, error)) {
      if (IsForeignMask(folder / name, folder)) add(folder / name);
      continue;
    }
    fs::recursive_directory_iterator entry(folder / name, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
      const fs::path& path = entry->path();
      if (fs::is_directory(entry->symlink_status(error))) continue;
      if (IsRenderedName(path.lexically_relative(folder).generic_string(), masks)) continue;
      add(path);
    }
    if (error) {
      throw InputError("cannot look into " + (folder / name).string() + ": " + error.message());
    }
  }
  return foreign;
}

// Returns true if an earlier call left a sequence in a folder, complete or not. Throws InputError
// if anything else is in the way.
bool HasSequence(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::is_empty(folder, error)) return false;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string() + ": expected a folder, found a file");
  }
  if (!IsRendered(folder)) {
    throw InputError(folder.string() +
                     ": expected an empty folder or one with a rendered sequence (world.yaml), "
                     "found other files");
  }
  if (const auto foreign = ForeignFile(folder)) {
    throw InputError(foreign->string() +
                     ": not of a rendered sequence, and would be removed with the one in this "
                     "folder; move it away or choose another folder");
  }
  return true;
}

// Removes the results of an earlier call; refuses to touch anything else.
void ClearFolder(const fs::path& folder) {
  if (!HasSequence(folder)) return;
  std::error_code error;
  for (const char* name : kNames) {
    fs::remove_all(folder / name, error);
    if (error)
      throw InputError("cannot remove " + (folder / name).string() + ": " + error.message());
  }
}

std::vector<Parallelogram> StillSurfaces(const Scene& scene) {
  std::vector<Parallelogram> still;
  for (const Surface& surface : scene.surfaces) {
    if (!surface.body) still.push_back({surface.origin, surface.side_u, surface.side_v});
  }
  return still;
}

}  // namespace

std::ostringstream TextStream(int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(digits);
  return text;
}

std::string ImuCsv(const SyntheticSequence& sequence, const std::vector<ImuSample>& samples) {
  std::ostringstream text = TextStream(12);
  text << "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m "
          "s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
  for (const ImuSample& sample : samples) {
    const Eigen::Vector3d &w = sample.angular_rate, &a = sample.specific_force;
    text << sequence.StampNs(0) + std::llround(sample.time * 1e9) << ',' << w.x() << ',' << w.y()
         << ',' << w.z() << ',' << a.x() << ',' << a.y() << ',' << a.z() << '\n';
  }
  return text.str();
}

InertialCalibration InertialOf(const SyntheticSequence& sequence) {
  const ImuModel model;
  const ImuFaults& faults = sequence.options().imu;
  InertialCalibration calibration;
  calibration.imu_from_left = sequence.calibration().body_from_left;
  calibration.rate_hz = sequence.options().imu_rate_hz;
  InertialNoise noise;
  noise.gyroscope_noise_density = model.gyroscope_density;
  noise.gyroscope_random_walk = model.gyroscope_walk;
  noise.accelerometer_noise_density = model.accelerometer_density;
  noise.accelerometer_random_walk = model.accelerometer_walk;
  if (faults.rate_range > 0) calibration.range.gyroscope = faults.rate_range;
  if (faults.force_range > 0) calibration.range.accelerometer = faults.force_range;
  calibration.noise = noise;
  return calibration;
}

void CheckSequenceFolder(const fs::path& folder) {
  (void)HasSequence(folder);
  MakeFolder(folder);
  CheckWritable(folder / kPartFile);
}

void PrepareSequenceFolder(const fs::path& folder) {
  ClearFolder(folder);
  MakeFolder(folder);
  WriteFileAtomically(folder / kPartFile, "");
}

void WriteSequence(const SyntheticSequence& sequence,
                   SequenceFormat format,
                   const fs::path& folder,
                   int threads,
                   const std::function<void(int)>& progress) {
  PrepareSequenceFolder(folder);
  const std::string description = WorldYaml(sequence, format);
  WriteFileAtomically(folder / kPartFile, description);
  std::mutex mutex;
  int frames_done = 0;
  const auto done = [&](int /*frame*/) {
    const std::lock_guard lock(mutex);
    ++frames_done;
    if (progress) progress(frames_done);
  };
  switch (format) {
    case SequenceFormat::kEuroc:
      WriteEurocFolder(sequence, folder, threads, done);
      break;
    case SequenceFormat::kTum:
      WriteTumFolder(sequence, folder, threads, done);
      break;
  }
  if (!sequence.world_text().empty()) {
    WriteFileAtomically(folder / kDescriptionFile, sequence.world_text());
  }
  WriteTrueLines(folder / "lines.csv", sequence.Lines(threads));
  WriteSurfaces(folder / "surfaces.csv", StillSurfaces(sequence.scene()));
  WriteFileAtomically(folder / kWorldFile, description);
  fs::remove(folder / kPartFile);
}

}  // namespace plumbline
