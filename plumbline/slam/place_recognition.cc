// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/place_recognition.h"

#include "plumbline/geometry/measured_depth.h"
#include "plumbline/loop_closing/close_loop.h"
#include "plumbline/loop_closing/scale_conflict.h"
#include "plumbline/loop_closing/verify_loop.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/slam/atlas_places.h"
#include "plumbline/slam/map_join.h"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <set>

namespace plumbline {
namespace {

constexpr std::size_t kCandidates = 3;  // keyframes that a new one is compared with
// A revisited place stands out among keyframes of similar appearance. The candidate ranked last of
// kRanked, or last of all if there are fewer, is as similar as any other place: a true candidate
// scores kStandsOut times as much.
constexpr std::size_t kRanked = 40;
constexpr std::size_t kFewest = 10;  // ranked candidates needed for that comparison
// With fewer than kFewest ranked candidates, one must be more alike than images of another world
// get: these reach up to 0.06 (docs/methods/places.md).
constexpr double kMoreThanElsewhere = 0.06;
constexpr double kStandsOut = 5;
// Newest keyframes, which are too recent to be a place that comes back.
constexpr std::int64_t kRecent = 20;

Recognition Describe(const Map& map,
                     KeyFrameId id,
                     KeyFrameId older,
                     const LoopEvidence& evidence) {
  Recognition place;
  place.frame = map.Find(id)->frame.id;
  place.keyframe = id;
  place.older = older;
  place.points = evidence.inlier_points;
  place.lines = evidence.inlier_lines;
  place.log10_chance = evidence.log10_chance;
  return place;
}

// Describes how the correction moved the keyframe in the world.
void DescribeMotion(const KeyFramePose& before, const KeyFramePose& after, Recognition& place) {
  const Rigid3 motion = Inverse(after.cam_from_world) * before.cam_from_world;
  place.moved =
      (Inverse(after.cam_from_world).translation - Inverse(before.cam_from_world).translation)
          .norm();
  place.turned_deg = LogSo3(motion.rotation).norm() * 180 / std::numbers::pi;
  place.scale = after.scale / before.scale;
}

}  // namespace

PlaceRecognition::PlaceRecognition(const CameraAndPyramid& imaging, const LoopOptions& options)
    : imaging_(imaging), options_(options), closer_(imaging, options) {}

void PlaceRecognition::Follow(const Atlas& atlas) { plumbline::Follow(atlas, &places_); }

std::vector<PlaceToTry> PlaceRecognition::PlacesOf(const Atlas& atlas,
                                                   const Features& features,
                                                   std::size_t most) const {
  const auto allowed = [&](KeyFrameId id) {
    const Map* map = MapOf(atlas, id);
    return map != nullptr && !IsWithdrawn(map->id());
  };
  std::vector<PlaceToTry> places;
  for (const PlaceCandidate& candidate : places_.Query(features, most, allowed)) {
    places.push_back({MapOf(atlas, candidate.id), candidate.id});
  }
  return places;
}

// Returns the keyframes that may show the same place. Keyframes around the given one are left out,
// since they show it without coming back.
std::vector<KeyFrameId> PlaceRecognition::Candidates(const Atlas& atlas,
                                                     const KeyFrame& keyframe) const {
  const Map& active = atlas.active();
  std::set<KeyFrameId> around;
  for (const auto& covisible : Covisible(active, keyframe.id)) around.insert(covisible.id);
  const auto allowed = [&](KeyFrameId id) {
    const Map* map = MapOf(atlas, id);
    if (map == nullptr || around.contains(id) || IsWithdrawn(map->id())) return false;
    return map != &active || map->NumberOf(id) + kRecent < keyframe.number;
  };
  const std::vector<PlaceCandidate> ranked = places_.Query(keyframe.id, kRanked, allowed);
  const double least =
      ranked.size() < kFewest ? kMoreThanElsewhere : kStandsOut * ranked.back().score;
  std::vector<KeyFrameId> ids;
  for (const PlaceCandidate& candidate : ranked) {
    if (ids.size() == kCandidates || candidate.score < least) break;
    ids.push_back(candidate.id);
  }
  return ids;
}

bool PlaceRecognition::Withdraws(const Atlas& atlas, KeyFrameId id) {
  // Keyframes in between, in which the unit of length can run away.
  constexpr std::int64_t kApart = 5;
  const Map& map = atlas.active();
  const KeyFrame& keyframe = *map.Find(id);
  const bool looks = options_.enabled && !KnowsUnitOfLength(imaging_.camera) &&
                     keyframe.number < kYoungKeyFrames && !IsWithdrawn(map.id());
  if (!looks) return false;
  const auto allowed = [&](KeyFrameId other) {
    const KeyFrame* older = map.Find(other);
    return older != nullptr && older->number + kApart <= keyframe.number;
  };
  std::vector<KeyFrameId> alike;
  for (const PlaceCandidate& candidate : places_.Query(keyframe.id, kCandidates, allowed)) {
    alike.push_back(candidate.id);
  }
  if (!FindScaleConflict(map, id, alike, imaging_, options_)) return false;
  withdrawn_.insert(map.id());
  return true;
}

std::optional<KeyFrameId> PlaceRecognition::Recognize(Atlas& atlas, KeyFrameId id) {
  if (!options_.enabled || IsWithdrawn(atlas.active_id())) return std::nullopt;
  const std::vector<KeyFrameId> candidates = Candidates(atlas, *atlas.active().Find(id));
  if (candidates.empty()) return std::nullopt;
  if (const auto older = CloseLoop(atlas, id, candidates)) return older;
  return Join(atlas, id, candidates);
}

std::optional<KeyFrameId> PlaceRecognition::CloseLoop(Atlas& atlas,
                                                      KeyFrameId id,
                                                      const std::vector<KeyFrameId>& candidates) {
  Map& map = atlas.active();
  const std::optional<LoopClosure> closure = closer_.Try(map, id, candidates);
  for (const LoopAttempt& attempt : closer_.attempts()) Tell(atlas, attempt);
  if (!closure) return std::nullopt;
  const LoopEdge& edge = closer_.loops().back();
  Recognition place = Describe(map, id, edge.candidate, edge.evidence);
  const KeyFramePose before = map.PlaceOf(id);
  map.Apply(closure->edit);
  for (const LoopEdge& wrong : closure->withdrawn) map.Apply(UndoLoop(map, wrong));
  DescribeMotion(before, map.PlaceOf(id), place);
  loops_.push_back(place);
  return edge.candidate;
}

// Merges the active map with another one that shows the same place; the newer map becomes part of
// the older one.
std::optional<KeyFrameId> PlaceRecognition::Join(Atlas& atlas,
                                                 KeyFrameId id,
                                                 const std::vector<KeyFrameId>& candidates) {
  const Map& active = atlas.active();
  for (const KeyFrameId candidate : candidates) {
    const Map& other = *MapOf(atlas, candidate);
    if (&other == &active) continue;
    const auto edge = VerifyLoop(active, id, other, candidate, imaging_, options_.verification);
    LoopAttempt attempt;
    attempt.query = id;
    attempt.candidate = candidate;
    if (edge) {
      attempt.edge = *edge;
      attempt.waits = edge->evidence.asked == 0;
    } else {
      attempt.unverified = edge.error();
    }
    Tell(atlas, attempt);
    if (!edge || attempt.waits) continue;
    MapJoin join{Describe(active, id, candidate, edge->evidence), {}, {}};
    const KeyFramePose before = active.PlaceOf(id);
    const JoinedMaps maps = JoinMaps(*edge, atlas);
    join.kept = maps.kept;
    join.gone = maps.gone;
    Map& joined = atlas.active();
    joined.Apply(FusePairs(joined, edge->points, edge->lines));
    closer_.Know(*edge);
    DescribeMotion(before, joined.PlaceOf(id), join.place);
    joins_.push_back(join);
    return candidate;
  }
  return std::nullopt;
}

}  // namespace plumbline
