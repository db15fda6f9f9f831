// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/map_join.h"

#include "plumbline/base/error.h"
#include "plumbline/slam/atlas_places.h"

#include <algorithm>

namespace plumbline {

JoinedMaps JoinMaps(const LoopEdge& edge, Atlas& atlas) {
  const Map* query = MapOf(atlas, edge.query);
  const Map* candidate = MapOf(atlas, edge.candidate);
  PLUMBLINE_CHECK(query != nullptr && candidate != nullptr && query != candidate,
                  "an edge that does not tie two maps");
  const Similarity3 candidate_from_query = CandidateWorldFromQueryWorld(*query, *candidate, edge);
  const JoinedMaps joined{std::min(query->id(), candidate->id()),
                          std::max(query->id(), candidate->id())};
  const bool candidate_stays = joined.kept == candidate->id();
  atlas.Join(joined.kept,
             joined.gone,
             candidate_stays ? candidate_from_query : Inverse(candidate_from_query));
  atlas.Activate(joined.kept);
  return joined;
}

}  // namespace plumbline
