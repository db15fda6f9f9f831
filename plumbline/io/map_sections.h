// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/section_file.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/saved_atlas.h"

#include <cstdint>
#include <string>

namespace plumbline {

// The sections of a map file (docs/adr/0009-map-file-format.md), which other files may hold as
// well, from the context to the one that says that the maps are complete.

// Kinds of sections from this one on are free for what comes after the maps.
inline constexpr std::uint32_t kAfterMaps = 16;

// Writes all maps of the atlas, with `active` as the one to go on with, into a file that the caller
// opens and commits. SaveAtlas makes a map file of nothing else.
void WriteMapSections(const Atlas& atlas,
                      const AtlasContext& context,
                      MapId active,
                      SectionWriter& file);

// Reads the maps that WriteMapSections wrote. Throws InputError as LoadAtlas does, which reads a
// file of nothing else.
SavedAtlas ReadMapSections(SectionReader& file);

// The contents of the next section, which must be of this kind (InputError).
std::string NextSectionOfKind(SectionReader& file, std::uint32_t kind);

}  // namespace plumbline
