// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/byte_format.h"
#include "plumbline/image/byte_format.h"
#include "plumbline/map/edit.h"
#include "plumbline/mapping/local_mapper.h"

namespace plumbline {

// Transfer (base/byte_format.h) of the state that mapping keeps.

template <class Archive, Like<MappingStep> T>
void Transfer(Archive& archive, T& step) {
  TransferAll(archive, step.name, step.milliseconds);
}
template <class Archive, Like<edit::RemovePointObservation> T>
void Transfer(Archive& archive, T& removal) {
  TransferAll(archive, removal.id, removal.keyframe);
}
template <class Archive, Like<AdjustedLines> T>
void Transfer(Archive& archive, T& lines) {
  TransferAll(archive, lines.count, lines.bytes);
}

template <class Archive, Like<KeyFramePatches> T>
void Transfer(Archive& archive, T& patches) {
  TransferAll(archive, patches.keyframe, patches.samples);
  if constexpr (Archive::kReading) {
    if (patches.samples.width() != KeyFramePatches::kSamples) {
      throw InputError(archive.source() + ": expected patches of another size");
    }
  }
}

}  // namespace plumbline
