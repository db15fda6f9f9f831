// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_manifest.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/atomic_file.h"

#include <algorithm>
#include <regex>
#include <system_error>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kKey = "plumbline_run";
constexpr int kVersion = 1;

[[noreturn]] void FailManifest(const fs::path& file) {
  throw InputError(file.string() +
                   ": expected the list of files that a run writes, found something else; choose "
                   "another --out");
}

}  // namespace

bool RunManifest::Lists(const std::string& name) const {
  return std::find(files.begin(), files.end(), name) != files.end();
}

bool IsRunFile(const std::string& name) {
  static const std::regex written(
      R"((trajectory|trajectory_causal|trajectory_covariance|keyframes)(_map[0-9]+)?\.txt|)"
      R"(overlay_[0-9]{6,}\.png|)"
      R"(options\.yaml|(frames|timing)\.csv|(timing|summary)\.json|map\.(plb|ply)|lines\.(obj|dxf)|)"
      R"(report\.html)");
  return std::regex_match(name, written);
}

std::vector<std::string> RunFilesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::string name = entry.path().filename().string();
    if (IsRunFile(name)) names.push_back(std::move(name));
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<RunManifest> ReadRunManifest(const fs::path& folder) {
  const fs::path file = folder / RunManifest::kFile;
  if (!IsTaken(file)) return std::nullopt;
  const auto text = ReadFileIfThere(file);
  if (!text) FailManifest(file);
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object() || json.value(kKey, Json()) != kVersion ||
      !json.value("complete", Json()).is_boolean() || !json.value("files", Json()).is_array()) {
    FailManifest(file);
  }
  RunManifest manifest;
  manifest.complete = json["complete"];
  for (const Json& name : json["files"]) {
    if (name.is_string() && IsRunFile(name)) manifest.files.push_back(name);
  }
  return manifest;
}

void WriteRunManifest(const fs::path& folder, const RunManifest& manifest) {
  const Json json = {{kKey, kVersion}, {"complete", manifest.complete}, {"files", manifest.files}};
  WriteFileAtomically(folder / RunManifest::kFile, json.dump(1) + "\n");
}

}  // namespace plumbline
