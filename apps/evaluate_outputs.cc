// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/evaluate_outputs.h"

#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"
#include "plumbline/io/datasets/path_overlap.h"
#include "plumbline/io/trajectory_io.h"
#include "plumbline/report/figure.h"

#include "apps/command_outputs.h"
#include "apps/figure_file.h"
#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAlignedHead = "# aligned by plumbline evaluate";

// The last `count` parts of a path, joined.
std::string LastParts(const fs::path& path, std::size_t count) {
  std::vector<std::string> parts;
  for (const fs::path& part : path) {
    if (part != "/" && part != "." && part != ".." && !part.empty()) parts.push_back(part.string());
  }
  if (parts.empty()) return "estimate";
  if (fs::path(parts.back()).extension() == ".txt") {
    parts.back() = fs::path(parts.back()).stem().string();
  }
  std::string name;
  for (std::size_t i = parts.size() - std::min(count, parts.size()); i < parts.size(); ++i) {
    name += (name.empty() ? "" : "_") + parts[i];
  }
  return name;
}

using NamedOutput = std::pair<std::string_view, fs::path>;

std::vector<NamedOutput> Named(const EvaluateOutputs& outputs) {
  std::vector<NamedOutput> named;
  if (outputs.json) named.emplace_back("--json", *outputs.json);
  if (outputs.plot) named.emplace_back("--plot", *outputs.plot);
  for (const fs::path& file : outputs.aligned) named.emplace_back("--save-aligned", file);
  return named;
}

// evaluate writes the one beginning for one estimate, the other for several.
bool IsJsonOfEvaluate(const fs::path& file) {
  return FileBeginsWith(file, "{\n  \"alignment\": ") ||
         FileBeginsWith(file, "{\n  \"estimates\": ");
}

// Returns true if the file begins as ToSvg writes it.
bool IsDrawing(const fs::path& file) {
  std::string text(400, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text.starts_with(kSvgHead) && text.find(kSvgGround) != std::string::npos;
}

// Each output may take the place of files of its own kind only.
FileKind KindOfOutput(std::string_view option, const fs::path& file) {
  if (option == "--json") return {"JSON of evaluate", "{\n  \"", IsJsonOfEvaluate};
  if (option == "--save-aligned") return {"a trajectory aligned by evaluate", kAlignedHead};
  if (file.extension() == ".png") return {"a PNG file", "\x89PNG\r\n\x1a\n"};
  return {"a drawing by plumbline", "<svg ", IsDrawing};
}

void ReadAligned(const std::string& text,
                 const std::vector<std::string>& names,
                 EvaluateOutputs& outputs) {
  constexpr const char* kOption = "--save-aligned";
  const fs::path path = text;
  std::error_code error;
  const bool folder = fs::is_directory(path, error);
  if (text == "-") throw InputError(std::string(kOption) + ": expected a file or folder, found -");
  if (names.size() == 1 && !folder && path.has_filename()) {
    outputs.aligned.push_back(path);
    return;
  }
  if (!folder && fs::exists(path, error)) {
    throw InputError(std::string(kOption) + " " + text +
                     ": expected a folder for several estimates, found another file");
  }
  if (!folder) outputs.new_folder = path;
  for (const std::string& name : names) outputs.aligned.push_back(path / (name + ".txt"));
}

}  // namespace

std::vector<std::string> ShortNames(const std::vector<std::string>& paths) {
  constexpr std::size_t kMostParts = 64;
  std::vector<std::string> names;
  for (const std::string& path : paths) names.push_back(LastParts(path, 1));
  for (std::size_t count = 2; count <= kMostParts; ++count) {
    const std::vector<std::string> shorter = names;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (std::count(shorter.begin(), shorter.end(), shorter[i]) > 1) {
        names[i] = LastParts(paths[i], count);
      }
    }
  }
  std::set<std::string> taken;
  for (std::string& name : names) {
    const std::string plain = name;
    for (int k = 2; !taken.insert(name).second; ++k) name = plain + "-" + std::to_string(k);
  }
  return names;
}

EvaluateOutputs ReadOutputs(const CommandLine& line, const std::vector<std::string>& names) {
  EvaluateOutputs outputs;
  if (const auto path = line.Value("--json")) {
    outputs.json_to_stdout = *path == "-";
    if (!outputs.json_to_stdout) outputs.json = *path;
  }
  if (const auto path = line.Value("--plot")) outputs.plot = *path;
  if (outputs.plot) CheckFigureName(*outputs.plot);
  if (const auto path = line.Value("--save-aligned")) ReadAligned(*path, names, outputs);
  return outputs;
}

void CheckOutputs(const EvaluateOutputs& outputs,
                  const fs::path& reference,
                  const std::vector<fs::path>& read) {
  std::error_code error;
  const bool of_data_set = fs::is_directory(reference, error);
  for (const auto& [option, path] : Named(outputs)) {
    if (of_data_set && IsWithin(path, reference)) {
      throw InputError(std::string(option) + " " + path.string() + ": expected a file outside of " +
                       reference.string() + ", which is read");
    }
    CheckOutput(option, path, read, KindOfOutput(option, path));
  }
  CheckApartFromEachOther(Named(outputs));
}

FileContents AlignedFile(const fs::path& file, const Trajectory& aligned) {
  CheckTum(file, aligned);
  return {file,
          std::string(kAlignedHead) + "\n# timestamp tx ty tz qx qy qz qw\n" + FormatTum(aligned)};
}

void WriteOutputs(const EvaluateOutputs& outputs, const std::vector<FileContents>& files) {
  if (outputs.new_folder) MakeFolder(*outputs.new_folder);
  try {
    WriteFilesAtomically(files);
  } catch (...) {
    std::error_code ignored;  // if it is not empty
    if (outputs.new_folder) fs::remove(*outputs.new_folder, ignored);
    throw;
  }
}

}  // namespace plumbline
