// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <stdlib.h>

namespace plumbline {

// A folder of files for a reader under test; removed when the program ends.
class InputFolder {
 public:
  InputFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "plumbline_fuzz_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw BugError("cannot make " + name);
    path_ = name;
  }
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;
  ~InputFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path Write(const std::string& name, std::string_view contents) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary | std::ios::trunc) << contents;
    return file;
  }

 private:
  std::filesystem::path path_;
};

// A file of a data set with contents that can be read.
struct InputFile {
  std::string name;
  std::string good;
};

inline std::string_view AsText(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Runs `parse` with one of the files replaced: the first byte ('0', '1', ...) says which, the rest
// are its contents. Anything but an InputError that comes out is a fault.
template <class Parse>
void ParseWithOneFileReplaced(const InputFolder& folder,
                              const std::vector<InputFile>& files,
                              std::string_view input,
                              const Parse& parse) {
  if (input.empty()) return;
  const auto which = static_cast<std::size_t>(static_cast<unsigned char>(input[0] - '0'));
  const InputFile& file = files[which % files.size()];
  folder.Write(file.name, input.substr(1));
  try {
    parse();
  } catch (const InputError&) {
  }
  folder.Write(file.name, file.good);
}

// A grey image of 8x6 pixels (PGM).
inline std::string SmallImage() { return "P5\n8 6\n255\n" + std::string(48, '\x40'); }

}  // namespace plumbline
