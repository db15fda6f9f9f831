// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"

#include <filesystem>
#include <memory>

namespace plumbline::python {

// Immutable maps of a file or of a system at one moment.
struct PyAtlas {
  std::shared_ptr<const SavedAtlas> saved;
  std::filesystem::path file = {};  // source file; absolute; empty: none
};

// One of these maps, which keeps all alive.
struct PyMap {
  std::shared_ptr<const SavedAtlas> saved;
  const Map* map = nullptr;
  std::filesystem::path file = {};  // file of the atlas
};

}  // namespace plumbline::python
