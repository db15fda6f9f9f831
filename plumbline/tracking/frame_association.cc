// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/frame_association.h"

#include <algorithm>
#include <map>
#include <optional>

namespace plumbline {
namespace {

std::vector<bool> Taken(const std::vector<int>& match_of_feature) {
  std::vector<bool> taken(match_of_feature.size());
  for (std::size_t i = 0; i < taken.size(); ++i) taken[i] = match_of_feature[i] >= 0;
  return taken;
}

int CountMatches(const std::vector<int>& match_of_feature) {
  return static_cast<int>(std::count_if(
      match_of_feature.begin(), match_of_feature.end(), [](int match) { return match >= 0; }));
}

// Projects the candidates, writes down which of them are visible, and returns those that have no
// match yet.
template <class Candidate, class Project>
auto ProjectUnmatched(const std::vector<Candidate>& candidates,
                      const std::vector<int>& match_of_feature,
                      const Project& project,
                      std::vector<int>& expected) {
  std::vector<decltype(project(candidates[0].model))> projected(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    projected[i] = project(candidates[i].model);
    if (projected[i]) expected.push_back(static_cast<int>(i));
  }
  for (const int match : match_of_feature) {
    if (match >= 0) projected[static_cast<std::size_t>(match)].reset();
  }
  return projected;
}

void Record(const std::vector<LandmarkMatch>& matches, std::vector<int>& match_of_feature) {
  for (const LandmarkMatch& match : matches) {
    match_of_feature[static_cast<std::size_t>(match.feature)] = match.landmark;
  }
}

template <class LandmarkId, class Candidate>
void Associate(const std::vector<LandmarkId>& ids,
               const MapSnapshot& snapshot,
               std::vector<Candidate>& candidates,
               std::vector<int>& match_of_feature) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto* landmark = ids[i].valid() ? snapshot.Find(ids[i]) : nullptr;
    if (landmark == nullptr) continue;
    match_of_feature[i] = static_cast<int>(candidates.size());
    candidates.push_back({.id = ids[i], .model = *landmark});
  }
}

template <class Candidate>
void CopyKind(const std::vector<Candidate>& candidates,
              const std::vector<int>& match_of_feature,
              bool of_map,
              std::vector<Candidate>& out,
              std::vector<int>& out_match_of_feature) {
  for (std::size_t i = 0; i < match_of_feature.size(); ++i) {
    if (match_of_feature[i] < 0 || out_match_of_feature[i] >= 0) continue;
    const Candidate& candidate = candidates[static_cast<std::size_t>(match_of_feature[i])];
    if (candidate.id.valid() != of_map) continue;
    out_match_of_feature[i] = static_cast<int>(out.size());
    out.push_back(candidate);
  }
}

template <class Candidate>
void TakeOutYoungKind(const MapSnapshot& snapshot,
                      int views,
                      const std::vector<Candidate>& candidates,
                      std::vector<int>& match_of_feature,
                      std::vector<int>& young_match_of_feature) {
  for (std::size_t i = 0; i < match_of_feature.size(); ++i) {
    if (match_of_feature[i] < 0) continue;
    const auto id = candidates[static_cast<std::size_t>(match_of_feature[i])].id;
    const auto* landmark = id.valid() ? snapshot.Find(id) : nullptr;
    const int shown_by = landmark != nullptr ? landmark->observation_count : 0;
    (shown_by < views ? match_of_feature : young_match_of_feature)[i] = -1;
  }
}

int CountCommon(const std::vector<int>& a, const std::vector<int>& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] >= 0 && b[i] >= 0;
  return count;
}

void PutBackKind(const std::vector<int>& from, std::vector<int>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i] < 0) to[i] = from[i];
  }
}

template <class Candidate>
int CountOfMap(const std::vector<Candidate>& candidates, const std::vector<int>& matches) {
  return static_cast<int>(std::count_if(matches.begin(), matches.end(), [&](int match) {
    return match >= 0 && candidates[static_cast<std::size_t>(match)].id.valid();
  }));
}

template <class LandmarkId, class Candidate>
std::vector<LandmarkId> IdsOfMatches(const std::vector<int>& match_of_feature,
                                     const std::vector<Candidate>& candidates) {
  std::vector<LandmarkId> ids(match_of_feature.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (match_of_feature[i] >= 0)
      ids[i] = candidates[static_cast<std::size_t>(match_of_feature[i])].id;
  }
  return ids;
}

// The candidates are sorted by id as far as they are in the map, so that each score is found beside
// the one before.
template <class Candidate, class LandmarkId>
void CountSeenKind(const std::vector<int>& expected,
                   const std::vector<int>& match_of_feature,
                   const std::vector<Candidate>& candidates,
                   std::map<LandmarkId, TrackingScore>& scores) {
  std::vector<TrackingScore> seen(candidates.size(), TrackingScore{0, 0});
  for (const int candidate : expected) ++seen[static_cast<std::size_t>(candidate)].visible;
  for (const int candidate : match_of_feature) {
    if (candidate >= 0) ++seen[static_cast<std::size_t>(candidate)].found;
  }
  auto beside = scores.begin();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].id.valid() || (seen[i].visible == 0 && seen[i].found == 0)) continue;
    const auto score = scores.try_emplace(beside, candidates[i].id, TrackingScore{0, 0});
    score->second.visible += seen[i].visible;
    score->second.found += seen[i].found;
    beside = std::next(score);
  }
}

}  // namespace

FrameAssociation AssociationOf(const Frame& frame, const MapSnapshot& snapshot) {
  FrameAssociation association(frame.points.size(), frame.lines.size());
  Associate(frame.points, snapshot, association.points, association.matches.point_of_feature);
  Associate(frame.lines, snapshot, association.lines, association.matches.line_of_feature);
  return association;
}

void CopyMatches(const FrameAssociation& from, bool of_map, FrameAssociation& to) {
  CopyKind(
      from.points, from.matches.point_of_feature, of_map, to.points, to.matches.point_of_feature);
  CopyKind(from.lines, from.matches.line_of_feature, of_map, to.lines, to.matches.line_of_feature);
}

int MatchesOfMap(const FrameAssociation& association) {
  return CountOfMap(association.points, association.matches.point_of_feature) +
         CountOfMap(association.lines, association.matches.line_of_feature);
}

int FrameMatches::Points() const { return CountMatches(point_of_feature); }
int FrameMatches::Lines() const { return CountMatches(line_of_feature); }

FrameMatches TakeOutYoung(const MapSnapshot& snapshot, int views, FrameAssociation& association) {
  FrameMatches& matches = association.matches;
  FrameMatches young = matches;
  TakeOutYoungKind(
      snapshot, views, association.points, matches.point_of_feature, young.point_of_feature);
  TakeOutYoungKind(
      snapshot, views, association.lines, matches.line_of_feature, young.line_of_feature);
  return young;
}

void PutBack(const FrameMatches& from, FrameMatches& to) {
  PutBackKind(from.point_of_feature, to.point_of_feature);
  PutBackKind(from.line_of_feature, to.line_of_feature);
}

int CommonMatches(const FrameMatches& a, const FrameMatches& b) {
  return CountCommon(a.point_of_feature, b.point_of_feature) +
         CountCommon(a.line_of_feature, b.line_of_feature);
}

void SetLandmarks(const FrameAssociation& association, Frame& frame) {
  const FrameMatches& matches = association.matches;
  frame.points = IdsOfMatches<PointId>(matches.point_of_feature, association.points);
  frame.lines = IdsOfMatches<LineId>(matches.line_of_feature, association.lines);
}

void CountSeen(const ExpectedLandmarks& expected,
               const FrameAssociation& association,
               TrackingScores& scores) {
  const FrameMatches& matches = association.matches;
  CountSeenKind(expected.points, matches.point_of_feature, association.points, scores.points);
  CountSeenKind(expected.lines, matches.line_of_feature, association.lines, scores.lines);
}

ExpectedLandmarks MatchCandidates(const ImagingModel& imaging,
                                  const IndexedFeatures& image,
                                  const Rigid3& cam_from_world,
                                  const ProjectionSearchOptions& options,
                                  FrameAssociation& association) {
  ExpectedLandmarks expected;
  const auto points = ProjectUnmatched(
      association.points,
      association.matches.point_of_feature,
      [&](const PointModel& m) { return ProjectPoint(imaging, cam_from_world, m); },
      expected.points);
  const auto lines = ProjectUnmatched(
      association.lines,
      association.matches.line_of_feature,
      [&](const LineModel& m) { return ProjectLine(imaging, cam_from_world, m); },
      expected.lines);
  Record(MatchProjectedPoints(image, points, Taken(association.matches.point_of_feature), options),
         association.matches.point_of_feature);
  Record(MatchProjectedLines(image, lines, Taken(association.matches.line_of_feature), options),
         association.matches.line_of_feature);
  return expected;
}

}  // namespace plumbline
