// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/merge_atlases.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/map/combined_atlases.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/saved_options.h"

#include "apps/program_methods.h"
#include <utility>

#include <fmt/core.h>

namespace plumbline {
namespace {

void CheckHasMap(const NamedAtlas& atlas) {
  if (!atlas.saved.atlas.empty()) return;
  throw InputError(atlas.name + ": expected a map, found none in the file");
}

void CheckCameras(const NamedAtlas& first, const NamedAtlas& second) {
  const AtlasContext &a = first.saved.context, &b = second.saved.context;
  auto difference =
      CameraDifference({a.camera, a.rectified_from_left}, {b.camera, b.rectified_from_left});
  if (!difference && a.octave_scale != b.octave_scale) {
    difference =
        fmt::format("octaves {} and {} times as large as the next", a.octave_scale, b.octave_scale);
  }
  if (!difference) return;
  throw InputError(second.name + ": expected a map of the camera of " + first.name +
                   ", found another one: " + *difference);
}

std::string WhyNotMerged(MergeRefusal refusal) {
  switch (refusal) {
    case MergeRefusal::kNoOverlap:
      return "no place that both show for certain";
    case MergeRefusal::kAmbiguous:
      return "places that look alike: the second map may lie in more than one way";
    case MergeRefusal::kContradicted:
      return "places that both show, but shapes of the maps that contradict each other";
  }
  throw BugError("a reason without words");
}

// The options of the first map, as far as this program knows them.
SlamOptions OptionsOf(const std::string& name, const AtlasContext& first, const Remark& remark) {
  return SavedOptionsOrDefault(
      first,
      name,
      "merging with the default options",
      remark,
      [](SlamOptions& options) { CheckOptions(options, ProgramMethods()); },
      ProgramMethods().added);
}

// Throws if a transform moves a map farther than the largest valid coordinates of files, or scales
// it by more than that: such positions are not computable.
void CheckWithinReach(const Similarity3& transform) {
  const double farthest = transform.translation.cwiseAbs().maxCoeff();
  if (!(farthest <= kFarthest)) {
    throw InputError(fmt::format(
        "transform: expected coordinates within {:g} of 0, found {:g}", kFarthest, farthest));
  }
  if (transform.scale >= 1 / kFarthest && transform.scale <= kFarthest) return;
  throw InputError(fmt::format("transform: expected a scale from {:g} to {:g}, found {:g}",
                               1 / kFarthest,
                               kFarthest,
                               transform.scale));
}

void JoinAsTold(const Similarity3& transform, MapId second, MergedAtlases& merged) {
  Atlas& atlas = merged.saved.atlas;
  CheckWithinReach(transform);
  if (KnowsUnitOfLength(merged.saved.context.camera) && transform.scale != 1) {
    throw InputError(fmt::format(
        "transform: expected a motion of the scale 1, found the scale {:g} for maps of measured "
        "depth, whose scale is 1",
        transform.scale));
  }
  const double lens = atlas.active().correction().lens.border_px();
  const double second_lens = atlas.Find(second)->correction().lens.border_px();
  if (lens != second_lens) {
    throw InputError(fmt::format(
        "transform: expected maps with the same lens correction, found {:.2f} and {:.2f} px, which "
        "only a merge without a transform adjusts to one another",
        lens,
        second_lens));
  }
  atlas.Join(atlas.active_id(), second, transform);
  merged.first_from_second = transform;
}

}  // namespace

MergedAtlases MergeAtlases(NamedAtlas first,
                           const NamedAtlas& second,
                           const std::optional<Similarity3>& transform,
                           const Remark& remark) {
  CheckHasMap(first);
  CheckHasMap(second);
  CheckCameras(first, second);
  for (const std::string& difference :
       FrontEndDifferences(first.saved.context, second.saved.context)) {
    remark(fmt::format("{}: {} (now: {})", first.name, difference, second.name));
  }
  CombinedAtlases gathered = CombineAtlases(std::move(first.saved), second.saved);
  MergedAtlases merged;
  merged.saved = std::move(gathered.saved);
  if (transform) {
    JoinAsTold(*transform, gathered.second, merged);
  } else {
    const AtlasContext& context = merged.saved.context;
    auto found = MergeMaps(merged.saved.atlas,
                           merged.saved.atlas.active_id(),
                           gathered.second,
                           {context.camera, context.octave_scale},
                           OptionsOf(first.name, context, remark),
                           ProgramMethods());
    if (!found) {
      throw InputError(fmt::format("{} and {}: expected maps that show the same place, found {}",
                                   first.name,
                                   second.name,
                                   WhyNotMerged(found.error())));
    }
    merged.saved.atlas = std::move(found->atlas);
    merged.first_from_second = found->first_from_second;
    merged.overlap = std::move(found->overlap);
    merged.ties = found->ties;
  }
  SettleJoined(merged.saved);
  return merged;
}

}  // namespace plumbline
