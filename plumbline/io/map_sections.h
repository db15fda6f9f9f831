// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/io/section_file.h"
#include "plumbline/map/atlas.h"
#include "plumbline/map/saved_atlas.h"

#include <cstdint>
#include <string>

namespace plumbline {

// The sections of a map file (docs/adr/0009-map-file-format.md), from the context to the one that
// says that the maps are complete. Other files may hold them, too.

// Kinds of sections from this one on are free for what comes after the maps.
inline constexpr std::uint32_t kAfterMaps = 16;

// Writes all maps of the atlas, with `active` as the one to go on with, into a file that the caller
// opens and commits. A map file has these sections and nothing else.
void WriteMapSections(const Atlas& atlas,
                      const AtlasContext& context,
                      MapId active,
                      SectionWriter& file);

// Reads the maps that WriteMapSections wrote. Throws the InputErrors of LoadAtlas.
SavedAtlas ReadMapSections(SectionReader& file);

// Returns the contents of the next section, which must be of this kind (InputError).
std::string NextSectionOfKind(SectionReader& file, std::uint32_t kind);

}  // namespace plumbline
