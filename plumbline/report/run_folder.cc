// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_folder.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/path_overlap.h"

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

constexpr const char* kPart = ".part";
// Room on the disk for the manifests, which is given back when they are written.
constexpr const char* kReserve = ".reserve";
constexpr std::size_t kReserveBytes = 32 << 10;
constexpr const char* kHeld = "another run is writing into this folder; choose another --out";

void MoveFile(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) {
    throw InputError(
        fmt::format("cannot move {} to {}: {}", from.string(), to.string(), error.message()));
  }
}

void RemoveFile(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw InputError("cannot remove " + path.string() + ": " + error.message());
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(fs::symlink_status(path, error));
}

// Returns true for a temporary file left by a run that was killed while it wrote (AtomicFile).
bool IsTemporary(const std::string& name) {
  static const std::regex temporary(R"(\.(.+)\.[0-9]+\.tmp(\.[a-z]+)?)");
  std::smatch parts;
  if (!std::regex_match(name, parts, temporary)) return false;
  const std::string written = parts.str(1) + parts.str(2);
  return written == RunManifest::kFile || IsRunFile(written);
}

// Removes only files of a run. Everything else stays, and then the folder does, too.
void RemovePart(const fs::path& part) {
  std::error_code error;
  std::vector<fs::path> ours;
  for (const auto& entry : fs::directory_iterator(part, error)) {
    const std::string name = entry.path().filename().string();
    if (IsRunFile(name) || IsTemporary(name) || name == kReserve) ours.push_back(entry.path());
  }
  for (const fs::path& path : ours) fs::remove(path, error);
  fs::remove(part / RunManifest::kFile, error);
  fs::remove(part, error);
}

// Returns true if a file of the journal has no rows; FormatFrames has a header.
bool HasNoRows(const fs::path& file) {
  std::ifstream stream(file);
  std::string header, row;
  if (file.filename() == "frames.csv") std::getline(stream, header);
  return !std::getline(stream, row);
}

// Returns true if a run ended before its first frame: all that is left are its options, and files
// of the journal without rows.
bool HoldsNoFrames(const fs::path& part) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(part, error)) {
    const std::string name = entry.path().filename().string();
    const bool of_journal =
        name == "frames.csv" || (IsRunFile(name) && entry.path().extension() == ".txt");
    const bool empty = name == "options.yaml" || name == kReserve || name == RunManifest::kFile ||
                       IsTemporary(name) || (of_journal && HasNoRows(entry.path()));
    if (!empty) return false;
  }
  return !error;
}

// Returns true if a file may be replaced because a run wrote it.
bool IsOurs(const RunManifest& manifest, const fs::path& folder, const std::string& name) {
  return manifest.Lists(name) && !IsFolder(folder / name);
}

// Returns the first of `names` that stands in the folder and was not written by a run.
std::optional<std::string> Foreign(const fs::path& folder,
                                   const RunManifest& manifest,
                                   const std::vector<std::string>& names) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return IsTaken(folder / name) && !IsOurs(manifest, folder, name);
  });
  return found == names.end() ? std::nullopt : std::optional(*found);
}

// Begins the exchange, or continues an interrupted one: the program may be killed after any step.
// The files of a complete part replace those of the folder; then the other files of the earlier run
// are removed.
void MoveIntoPlace(const fs::path& part, const fs::path& folder) {
  const RunManifest next = ReadRunManifest(part).value_or(RunManifest{});
  const RunManifest earlier = ReadRunManifest(folder).value_or(RunManifest{});
  RunManifest both{true, {}};
  std::set_union(earlier.files.begin(),
                 earlier.files.end(),
                 next.files.begin(),
                 next.files.end(),
                 std::back_inserter(both.files));
  WriteRunManifest(folder, both);
  for (const std::string& name : next.files) {
    if (IsTaken(part / name)) MoveFile(part / name, folder / name);
  }
  for (const std::string& name : earlier.files) {
    if (!next.Lists(name) && IsOurs(earlier, folder, name)) RemoveFile(folder / name);
  }
  WriteRunManifest(folder, next);
  RemovePart(part);
}

}  // namespace

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
  const bool result = IsRunFile(name) || name == RunManifest::kFile;
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
    RemoveFolders();
  } catch (const std::exception&) {  // files that cannot be removed stay
  }
}

void RunFolder::Open() {
  fs::path above = folder_;
  while (!above.empty() && !IsTaken(above) && above != above.parent_path()) {
    made_.insert(made_.begin(), above);
    above = above.parent_path();
  }
  MakeFolder(folder_);
  lock_.emplace(folder_, kHeld);
  const auto here = ReadRunManifest(folder_).value_or(RunManifest{});
  RefuseForeignFiles(folder_, "run", [&](const std::string& name) {
    return IsRunFile(name) && !IsOurs(here, folder_, name);
  });
  TakeCareOfPart();
  StartPart();
}

void RunFolder::TakeCareOfPart() {
  std::error_code error;
  if (!IsTaken(part_)) return;
  const std::optional<RunManifest> left = IsFolder(part_) ? ReadRunManifest(part_) : std::nullopt;
  if (!left) {
    if (IsFolder(part_) && fs::is_empty(part_, error)) return;
    throw InputError(part_.string() +
                     ": not of a run of plumbline; move it away or choose another --out");
  }
  if (left->complete) {
    MoveIntoPlace(part_, folder_);
    notes_.push_back(folder_.string() +
                     ": an earlier run was killed while its results took their places; they are "
                     "complete now");
    return;
  }
  if (HoldsNoFrames(part_)) RemovePart(part_);
  if (!IsTaken(part_)) return;
  for (int k = 1;; ++k) {
    const fs::path kept = folder_ / fmt::format("interrupted-{}", k);
    if (IsTaken(kept)) continue;
    MoveFile(part_, kept);
    fs::remove(kept / kReserve, error);
    notes_.push_back(fmt::format("{}: an earlier run was killed; what it had written is in {}",
                                 folder_.string(),
                                 kept.string()));
    return;
  }
}

void RunFolder::StartPart() {
  MakeFolder(part_);
  part_made_ = true;
  WriteRunManifest(part_, {});
  try {
    WriteFileAtomically(part_ / kReserve, std::string(kReserveBytes, ' '));
  } catch (const InputError&) {  // on such a full disk the run may end without its manifest
    return;
  }
}

// Removes the folders that this made, as far as they are empty.
void RunFolder::RemoveFolders() {
  std::error_code error;
  if (part_made_) RemovePart(part_);
  lock_.reset();
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) fs::remove(*folder, error);
}

void RunFolder::Restore() {
  if (lock_->IsInPlace() && IsTaken(part_ / RunManifest::kFile)) return;
  MakeFolder(folder_);
  if (!lock_->IsInPlace()) lock_.emplace(folder_, kHeld);
  StartPart();
}

bool RunFolder::Write(const RunFile& file) {
  const auto fail = [&](const std::string& why) {
    failures_.push_back({file.name, why});
    return false;
  };
  try {
    Restore();
    file.write(part_ / file.name);
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
  std::string text = "cannot write ";
  for (std::size_t i = 0; i < failures_.size(); ++i) {
    const Failure& failure = failures_[i];
    const bool goes_on = i > 0 && failure.why == failures_[i - 1].why;
    if (i > 0) text += goes_on ? ", " : ": " + failures_[i - 1].why + "; ";
    text += goes_on ? failure.name : (folder_ / failure.name).string();
  }
  return text + ": " + failures_.back().why;
}

void RunFolder::KeepOnly(const std::vector<std::string>& names) const {
  std::error_code ignored;
  if (!IsTaken(part_)) return;
  for (const std::string& name : RunFilesIn(part_)) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      fs::remove(part_ / name, ignored);
    }
  }
}

bool RunFolder::WouldLose() const {
  if (failures_.empty()) return false;
  const auto earlier = ReadRunManifest(folder_);
  return earlier && !earlier->files.empty();
}

std::optional<EarlierRun> RunFolder::Earlier() const {
  if (!ReadRunManifest(folder_)) return std::nullopt;
  EarlierRun earlier;
  std::ifstream poses(folder_ / "trajectory.txt");
  for (std::string row; std::getline(poses, row);) ++earlier.poses;
  if (earlier.poses == 0) return std::nullopt;
  std::ifstream file(folder_ / "summary.json");
  const auto summary = nlohmann::json::parse(file, nullptr, false);
  if (summary.is_object()) {
    const auto data = summary.find("data");
    if (data != summary.end() && data->is_string()) earlier.data = *data;
  }
  return earlier;
}

void RunFolder::Commit() {
  Restore();
  RemoveFile(part_ / kReserve);
  const std::vector<std::string> names = RunFilesIn(part_);
  const auto here = ReadRunManifest(folder_).value_or(RunManifest{});
  if (const auto name = Foreign(folder_, here, names)) {
    throw InputError(fmt::format("{}: came there during the run; the results are in {}",
                                 (folder_ / *name).string(),
                                 part_.string()));
  }
  WriteRunManifest(part_, {true, names});
  MoveIntoPlace(part_, folder_);
}

}  // namespace plumbline
