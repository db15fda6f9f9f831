// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/error.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/open_dataset.h"

#include "fuzz/input_folder.h"
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumbline {

// A data set of a few small files, of which one at a time is replaced by invented contents. Its
// images stay: others fuzz their decoding.
class FuzzedDataset {
 public:
  struct TextFile {
    std::string name;
    std::string good;  // contents that can be read
  };

  FuzzedDataset(std::vector<TextFile> texts, const std::vector<std::string>& images)
      : texts_(std::move(texts)) {
    for (const TextFile& file : texts_) folder_.Write(file.name, file.good);
    for (const std::string& name : images) {
      folder_.Write(name, "P5\n8 6\n255\n" + std::string(48, '\x40'));  // PGM, 8x6 pixels
    }
  }

  // The first byte ('0', '1', ...) says which file, the rest are its contents. Anything but an
  // InputError that comes out of opening the data is a fault.
  void OpenWith(std::string_view input) const {
    if (input.empty()) return;
    const auto which = static_cast<std::size_t>(static_cast<unsigned char>(input[0] - '0'));
    const TextFile& file = texts_[which % texts_.size()];
    folder_.Write(file.name, input.substr(1));
    try {
      (void)OpenDataset(folder_.path());
    } catch (const InputError&) {
    }
    folder_.Write(file.name, file.good);
  }

 private:
  std::vector<TextFile> texts_;
  InputFolder folder_;
};

// The data set of a target: each gives its own; dataset_fuzz.cc does the rest.
FuzzedDataset MakeFuzzedDataset();

}  // namespace plumbline
