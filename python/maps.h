// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"

#include <filesystem>
#include <memory>

namespace plumbline::python {

// The maps of a file or of a system at one moment; nobody changes them.
struct PyAtlas {
  std::shared_ptr<const SavedAtlas> saved;
  std::filesystem::path file = {};  // it was read from; absolute, empty: from none
};

// One of them, which keeps all alive.
struct PyMap {
  std::shared_ptr<const SavedAtlas> saved;
  const Map* map = nullptr;
  std::filesystem::path file = {};  // that of the atlas
};

}  // namespace plumbline::python
