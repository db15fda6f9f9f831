// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/saved_atlas.h"

#include <memory>

namespace plumbline::python {

// The maps of a file or of a system at one moment; nobody changes them.
struct PyAtlas {
  std::shared_ptr<const SavedAtlas> saved;
};

// One of them, which keeps all alive.
struct PyMap {
  std::shared_ptr<const SavedAtlas> saved;
  const Map* map = nullptr;
};

}  // namespace plumbline::python
