// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_folder.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/datasets/path_overlap.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>
#include <new>
#include <regex>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kListKey = "plumbline_run";
constexpr int kListVersion = 1;
constexpr const char* kPart = ".part";

void MoveFile(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) {
    throw InputError(
        fmt::format("cannot move {} to {}: {}", from.string(), to.string(), error.message()));
  }
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(fs::symlink_status(path, error));
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    names.push_back(it->path().filename().string());
  }
  return names;
}

// Hidden files of a part are temporary ones of a program that was killed (AtomicFile), and its
// list.
bool IsOfPart(const std::string& name) { return IsRunFile(name) || name.front() == '.'; }

void RemovePart(const fs::path& part) {
  std::error_code ignored;
  for (const std::string& name : NamesIn(part)) {
    if (IsOfPart(name)) fs::remove(part / name, ignored);
  }
  fs::remove(part, ignored);
}

// Returns true if a run left at least one pose, in any of its maps.
bool HoldsPoses(const fs::path& part) {
  for (const std::string& name : NamesIn(part)) {
    std::error_code error;
    if (name.starts_with("trajectory") && fs::file_size(part / name, error) > 0 && !error) {
      return true;
    }
  }
  return false;
}

// Returns true if a file may be replaced because a run wrote it.
bool IsOurs(const std::vector<std::string>& listed,
            const fs::path& folder,
            const std::string& name) {
  return Contains(listed, name) && !IsFolder(folder / name);
}

// Moves the files of a complete part into the folder and removes the others of the earlier run. The
// program may be killed after any step: the list of the part goes last, and every step can be done
// again.
void MoveIntoPlace(const fs::path& part, const fs::path& folder) {
  const std::vector<std::string> next = ReadRunList(part).value_or(std::vector<std::string>());
  const std::vector<std::string> earlier = ReadRunList(folder).value_or(std::vector<std::string>());
  for (const std::string& name : next) {
    if (!IsTaken(part / name) || !IsTaken(folder / name) || IsOurs(earlier, folder, name)) continue;
    throw InputError(fmt::format("{}: came there during the run; the results are in {}",
                                 (folder / name).string(),
                                 part.string()));
  }
  std::error_code ignored;
  for (const std::string& name : earlier) {
    if (!Contains(next, name) && !IsFolder(folder / name)) fs::remove(folder / name, ignored);
  }
  for (const std::string& name : next) {
    if (IsTaken(part / name)) MoveFile(part / name, folder / name);
  }
  MoveFile(part / kRunList, folder / kRunList);
  RemovePart(part);
}

[[noreturn]] void FailList(const fs::path& file) {
  throw InputError(file.string() +
                   ": expected the list of files that a run writes, found something else; choose "
                   "another --out");
}

}  // namespace

bool IsRunFile(const std::string& name) {
  static const std::regex written(
      R"((trajectory|trajectory_causal|trajectory_covariance|keyframes)(_map[0-9]+)?\.txt|)"
      R"(overlay_[0-9]{6,}\.png|)"
      R"(options\.yaml|(frames|timing)\.csv|(timing|summary)\.json|map\.(plb|ply)|lines\.(obj|dxf)|)"
      R"(report\.html)");
  return std::regex_match(name, written);
}

std::optional<std::vector<std::string>> ReadRunList(const fs::path& folder) {
  const fs::path file = folder / kRunList;
  if (!IsTaken(file)) return std::nullopt;
  const auto text = ReadFileIfThere(file);
  const Json json = text ? Json::parse(*text, nullptr, false) : Json();
  if (!json.is_object() || json.value(kListKey, Json()) != kListVersion ||
      !json.value("files", Json()).is_array()) {
    FailList(file);
  }
  // Version 0.2.0 had a list in the part from the beginning of a run on.
  if (json.value("complete", Json()) == false) return std::nullopt;
  std::vector<std::string> names;
  for (const Json& name : json["files"]) {
    if (name.is_string() && IsRunFile(name)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

void WriteRunList(const fs::path& folder, std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  const Json json = {{kListKey, kListVersion}, {"files", names}};
  WriteFileAtomically(folder / kRunList, json.dump(1) + "\n");
}

void CheckApart(const fs::path& out, std::span<const RunInput> inputs) {
  for (const RunInput& input : inputs) {
    const char* how = nullptr;
    if (IsSamePath(out, input.path)) {
      how = "is";
    } else if (IsWithin(out, input.path)) {
      how = "lies in";
    } else if (!input.may_lie_in_out && IsWithin(input.path, out)) {
      how = "holds";
    }
    if (how == nullptr) continue;
    throw InputError(fmt::format("--out {}: {} {}, which is read; choose another folder",
                                 out.string(),
                                 how,
                                 input.path.string()));
  }
}

void CheckFileApart(std::string_view option,
                    const fs::path& file,
                    std::span<const RunInput> inputs) {
  for (const RunInput& input : inputs) {
    if (IsSamePath(file, input.path)) {
      throw InputError(
          fmt::format("{} {}: expected another file than one that is read", option, file.string()));
    }
    if (IsWithin(file, input.path)) {
      throw InputError(fmt::format("{} {}: expected a file outside of {}, which is read",
                                   option,
                                   file.string(),
                                   input.path.string()));
    }
  }
}

void CheckNoResult(std::string_view option, const fs::path& file, const fs::path& out) {
  const std::string name = file.filename().string();
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const bool result = IsRunFile(name) || name == kRunList;
  if (!IsWithin(file, out / kPart) && !(result && IsSamePath(folder, out))) return;
  throw InputError(fmt::format("{} {}: expected another name, found one that the results in {} use",
                               option,
                               file.string(),
                               out.string()));
}

RunFolder::RunFolder(fs::path folder) : folder_(std::move(folder)), part_(folder_ / kPart) {
  try {
    Open();
  } catch (...) {
    RemoveFolders();
    throw;
  }
}

RunFolder::~RunFolder() {
  if (keep_) return;
  try {
    RemovePart(part_);
    RemoveFolders();
  } catch (...) {
    // Memory ran out: the next run in the folder removes the part.
  }
}

void RunFolder::Open() {
  fs::path above = folder_;
  while (!above.empty() && !IsTaken(above) && above != above.parent_path()) {
    made_.insert(made_.begin(), above);
    above = above.parent_path();
  }
  MakeFolder(folder_);
  lock_.emplace(folder_, "another run is writing into this folder; choose another --out");
  const auto is_foreign = [](const std::string& name) { return !IsOfPart(name); };
  const std::vector<std::string> left = NamesIn(part_);
  if (std::any_of(left.begin(), left.end(), is_foreign) || (IsTaken(part_) && !IsFolder(part_))) {
    throw InputError(part_.string() +
                     ": not of a run of plumbline; move it away or choose another --out");
  }
  if (ReadRunList(part_)) {
    MoveIntoPlace(part_, folder_);
    notes_.push_back(folder_.string() +
                     ": an earlier run was killed while its results took their places; they are "
                     "complete now");
  }
  const auto here = ReadRunList(folder_).value_or(std::vector<std::string>());
  RefuseForeignFiles(folder_, "run", [&](const std::string& name) {
    return IsRunFile(name) && !IsOurs(here, folder_, name);
  });
  SetPartAside();
  MakeFolder(part_);
}

// Keeps what a killed run left, if it has a pose.
void RunFolder::SetPartAside() {
  if (!HoldsPoses(part_)) return RemovePart(part_);
  int k = 1;
  const auto kept = [&] { return folder_ / fmt::format("interrupted-{}", k); };
  while (IsTaken(kept())) ++k;
  MoveFile(part_, kept());
  notes_.push_back(
      fmt::format("{}: an earlier run was cut off or failed; what it had written is in {}",
                  folder_.string(),
                  kept().string()));
}

// Removes the folders that this made, as far as they are empty.
void RunFolder::RemoveFolders() {
  std::error_code error;
  lock_.reset();
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) fs::remove(*folder, error);
}

bool RunFolder::Write(const RunFile& file) {
  const auto fail = [&](const std::string& why) {
    failures_.push_back({file.name, why});
    return false;
  };
  try {
    MakeFolder(part_);
    file.write(part_ / file.name);
    written_.push_back(file.name);
    return true;
  } catch (const WriteError& error) {
    return fail(error.why());
  } catch (const std::bad_alloc&) {
    return fail("out of memory");
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}

std::optional<std::string> RunFolder::Failures() const {
  if (failures_.empty()) return std::nullopt;
  std::string text = "cannot write " + folder_.string() + "/";
  for (const Failure& failure : failures_) {
    text += (&failure == failures_.data() ? "" : "; ") + failure.name + ": " + failure.why;
  }
  return text;
}

bool RunFolder::WouldLose() const {
  return !failures_.empty() && !ReadRunList(folder_).value_or(std::vector<std::string>()).empty();
}

std::optional<EarlierRun> RunFolder::Earlier() const {
  if (!ReadRunList(folder_)) return std::nullopt;
  EarlierRun earlier;
  std::ifstream poses(folder_ / "trajectory.txt");
  for (std::string row; std::getline(poses, row);) ++earlier.poses;
  if (earlier.poses == 0) return std::nullopt;
  std::ifstream file(folder_ / "summary.json");
  const Json summary = Json::parse(file, nullptr, false);
  const Json data = summary.is_object() ? summary.value("data", Json()) : Json();
  if (data.is_string()) earlier.data = data;
  return earlier;
}

void RunFolder::Commit() {
  MakeFolder(part_);
  std::vector<std::string> names = {"frames.csv"};
  const std::vector<std::string> part = NamesIn(part_);
  const auto is_causal = [](const auto& name) { return name.starts_with("trajectory_causal"); };
  if (std::count_if(part.begin(), part.end(), is_causal) == 1) {
    names.emplace_back("trajectory_causal.txt");
  }
  for (const std::string& name : written_) {
    if (!Contains(names, name)) names.push_back(name);
  }
  std::erase_if(names, [&](const std::string& name) { return !IsTaken(part_ / name); });
  std::error_code ignored;
  for (const std::string& name : part) {
    if (IsOfPart(name) && !Contains(names, name)) fs::remove(part_ / name, ignored);
  }
  while (true) {
    try {
      WriteRunList(part_, names);
      break;
    } catch (const WriteError& error) {
      if (names.empty()) throw;
      failures_.push_back({names.back(), error.why()});
      fs::remove(part_ / names.back(), ignored);
      names.pop_back();
    }
  }
  MoveIntoPlace(part_, folder_);
}

}  // namespace plumbline
