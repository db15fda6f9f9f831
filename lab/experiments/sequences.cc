// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/sequences.h"

#include "plumbline/base/crc32.h"
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/io/cameras/camera_file.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/trajectory_io.h"
#include "worlds/sequence_cache.h"
#include "worlds/world.h"
#include "worlds/world_catalog.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <system_error>

#include <fmt/format.h>
#include <fnmatch.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxDepth = 4;
constexpr int kTestFrames = 150;
constexpr double kTestScale = 0.5;
const std::string kWorlds = "worlds/";

// The built-in camera of sequences that come without calibration.
std::optional<std::string> CameraOf(const std::string& folder) {
  if (folder == "icl") return "icl_nuim";
  return std::nullopt;
}

// Images of a run over it, in megapixels a frame.
double MegapixelsOf(const DatasetInfo& info) {
  const double image = 1e-6 * info.calibration.left.width() * info.calibration.left.height();
  return info.sensor == SensorKind::kStereo ? 2 * image : image;
}

// Returns true if a name is that of the choice: its pattern, or a part of a paper's sequence.
bool IsChosenName(const std::string& name, const SequenceChoice& choice) {
  if (MatchesPattern(name, choice.pattern)) return true;
  return !choice.paper.empty() && MatchesPattern(name, choice.pattern + "_first*");
}

std::string Labelled(const std::string& name, const SequenceChoice& choice) {
  return choice.label.empty() ? name : name + "@" + choice.label;
}

bool IsSequence(const fs::path& path) {
  const auto format = FindFormat(path);
  return format && *format != DatasetFormat::kImages;
}

// Sorted, so that the order does not depend on the file system.
std::vector<fs::path> FoldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory(error)) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

void FindBelow(const fs::path& folder, int depth, std::vector<fs::path>& found) {
  for (const fs::path& path : FoldersIn(folder)) {
    if (IsSequence(path)) {
      found.push_back(path);
    } else if (depth < kMaxDepth) {
      FindBelow(path, depth + 1, found);
    }
  }
}

std::uint32_t Checksum(const std::string& text) {
  return Crc32(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

// All that a data set says before its images are read.
std::string IdentityOf(const Dataset& dataset) {
  const DatasetInfo& info = dataset.info();
  std::string text = NameOf(info.format) + NameOf(info.sensor) + FormatCamera(info.calibration);
  for (const std::int64_t stamp : info.stamps_ns) text += FormatStamp(stamp) + "\n";
  if (info.ground_truth) {
    for (const StampedPose& pose : info.ground_truth->poses) {
      const Rigid3& p = pose.world_from_camera;
      text += fmt::format("{} {} {} {} {} {} {} {}\n",
                          pose.stamp_ns,
                          p.translation.x(),
                          p.translation.y(),
                          p.translation.z(),
                          p.rotation.w(),
                          p.rotation.x(),
                          p.rotation.y(),
                          p.rotation.z());
    }
  }
  return fmt::format("{} frames, checksum {:08x}", dataset.size(), Checksum(text));
}

ExperimentSequence Recorded(const std::string& folder, const fs::path& path) {
  ExperimentSequence sequence{folder + "/" + path.filename().string(), path};
  try {
    DatasetOptions options;
    options.allow_missing_camera = true;
    auto dataset = OpenDataset(path, options);
    const auto camera = CameraOf(folder);
    if (!dataset->info().has_calibration && camera) {
      sequence.arguments = {"--camera", *camera};
      options.camera = camera;
      dataset = OpenDataset(path, options);
    }
    sequence.identity = IdentityOf(*dataset);
    sequence.has_truth = dataset->info().ground_truth.has_value();
    sequence.frames = dataset->size();
    sequence.megapixels = MegapixelsOf(dataset->info());
  } catch (const InputError& error) {
    // The identity does not depend on the path of the data.
    const std::string message = error.what(), root = path.string();
    const auto place = message.find(root);
    sequence.identity = message;
    if (place != std::string::npos) sequence.identity.replace(place, root.size(), sequence.name);
  }
  return sequence;
}

std::vector<ExperimentSequence> RecordedSequences(const SequenceChoice& choice,
                                                  const SequenceSources& sources) {
  std::vector<ExperimentSequence> sequences;
  const std::string folder = choice.pattern.substr(0, choice.pattern.find('/'));
  if (!sources.data) return sequences;
  std::vector<fs::path> paths;
  FindBelow(*sources.data / folder, 1, paths);
  for (const fs::path& path : paths) {
    if (!IsChosenName(folder + "/" + path.filename().string(), choice)) continue;
    sequences.push_back(Recorded(folder, path));
    ExperimentSequence& sequence = sequences.back();
    sequence.paper = choice.paper;
    sequence.part = !choice.paper.empty() && !MatchesPattern(sequence.name, choice.pattern);
    sequence.name = Labelled(sequence.name, choice);
    auto& arguments = sequence.arguments;
    arguments.insert(arguments.end(), choice.arguments.begin(), choice.arguments.end());
  }
  return sequences;
}

// All that this module knows of the options of worlds.
SynthOptions OptionsOf(const WorldEntry& world, const SequenceChoice& choice, WorldSize size) {
  SynthOptions options;
  if (world.adjust != nullptr) world.adjust(options);
  if (size == WorldSize::kTest) options.scale *= kTestScale;
  OptionTable table(options);
  for (const std::string& setting : choice.world_settings) table.Set(setting);
  if (size == WorldSize::kTest && (options.frames == 0 || options.frames > kTestFrames)) {
    options.frames = kTestFrames;
  }
  return options;
}

std::vector<ExperimentSequence> RenderedSequences(const SequenceChoice& choice,
                                                  const SequenceSources& sources) {
  std::vector<ExperimentSequence> sequences;
  for (const WorldEntry& world : Worlds()) {
    if (!MatchesPattern(kWorlds + world.name, choice.pattern)) continue;
    const SynthOptions options = OptionsOf(world, choice, sources.size);
    ExperimentSequence sequence;
    sequence.name = Labelled(kWorlds + world.name, choice);
    sequence.identity = SequenceKey(world.name, options);
    sequence.path = sources.cache / sequence.identity;
    sequence.frames = static_cast<std::size_t>(options.frames);
    sequence.arguments = choice.arguments;
    constexpr double kMegapixels = 2 * 0.752 * 0.480;  // a pair of the usual camera
    sequence.megapixels = kMegapixels * options.scale * options.scale;
    sequence.paper = choice.paper;
    sequence.rendered = RenderedWorld{world.name, options};
    sequences.push_back(std::move(sequence));
  }
  return sequences;
}

// Adds the source of the data for users.
std::string Described(const SequenceChoice& choice) {
  const std::string name = Labelled(choice.pattern, choice);
  if (choice.paper.empty() && choice.source.empty()) return name;
  const std::string between = choice.paper.empty() || choice.source.empty() ? "" : "; ";
  return name + " (" + choice.paper + between + choice.source + ")";
}

}  // namespace

FoundSequences FindSequences(const std::vector<SequenceChoice>& choices,
                             const SequenceSources& sources) {
  std::error_code error;
  if (sources.data && !fs::is_directory(*sources.data, error)) {
    throw InputError(sources.data->string() + ": expected the folder of the sequences, found none");
  }
  FoundSequences found;
  std::map<std::string, fs::path> names;
  for (const SequenceChoice& choice : choices) {
    auto sequences = choice.pattern.starts_with(kWorlds) ? RenderedSequences(choice, sources)
                                                         : RecordedSequences(choice, sources);
    if (sequences.empty()) found.missing.push_back(Described(choice));
    for (ExperimentSequence& sequence : sequences) {
      const auto [other, added] = names.emplace(sequence.name, sequence.path);
      if (!added && other->second != sequence.path) {
        throw InputError("two sequences are called " + sequence.name + ": " +
                         other->second.string() + " and " + sequence.path.string());
      }
      if (added) found.sequences.push_back(std::move(sequence));
    }
  }
  return found;
}

bool MatchesPattern(const std::string& name, const std::string& pattern) {
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

}  // namespace plumbline
