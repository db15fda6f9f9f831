// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/tracking/landmark_matches.h"

#include <algorithm>
#include <iterator>
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

// Returns the result of `project` for each landmark; nullopt for those not visible.
template <class Landmark, class Project>
auto ProjectAll(const std::vector<Landmark>& landmarks, const Project& project) {
  std::vector<decltype(project(landmarks[0]))> projected;
  projected.reserve(landmarks.size());
  for (const Landmark& landmark : landmarks) projected.push_back(project(landmark));
  return projected;
}

template <class Projection>
void LeaveOutMatched(const std::vector<int>& match_of_feature,
                     std::vector<std::optional<Projection>>& projected) {
  for (const int match : match_of_feature) {
    if (match >= 0) projected[static_cast<std::size_t>(match)].reset();
  }
}

template <class Landmark, class Projection>
auto VisibleOf(const std::vector<Landmark>& landmarks,
               const std::vector<std::optional<Projection>>& projected) {
  std::vector<decltype(Landmark::id)> visible;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (projected[i]) visible.push_back(landmarks[i].id);
  }
  return visible;
}

// Leaves out the landmarks of the snapshot that features show already.
template <class Landmark, class Candidate, class Projection>
void LeaveOutFound(const MapSnapshot& snapshot,
                   const std::vector<Landmark>& landmarks,
                   const std::vector<Candidate>& candidates,
                   const std::vector<int>& match_of_feature,
                   std::vector<std::optional<Projection>>& projected) {
  for (const int match : match_of_feature) {
    if (match < 0) continue;
    const auto id = candidates[static_cast<std::size_t>(match)].id;
    const Landmark* landmark = id.valid() ? snapshot.Find(id) : nullptr;
    if (landmark == nullptr) continue;
    projected[static_cast<std::size_t>(landmark - landmarks.data())].reset();
  }
}

template <class Landmark, class Candidate>
void AddMatched(const std::vector<LandmarkMatch>& matches,
                const std::vector<Landmark>& landmarks,
                std::vector<Candidate>& candidates,
                std::vector<int>& match_of_feature) {
  for (const LandmarkMatch& match : matches) {
    const Landmark& landmark = landmarks[static_cast<std::size_t>(match.landmark)];
    match_of_feature[static_cast<std::size_t>(match.feature)] = static_cast<int>(candidates.size());
    candidates.push_back({.id = landmark.id, .model = landmark});
  }
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
void SplitMatchesOfKind(const MapSnapshot& snapshot,
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

void MergeMatchesOfKind(const std::vector<int>& from, std::vector<int>& to) {
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

// Adds one to a count of the score of each landmark. The ids ascend, so that each score is found
// beside the one before.
template <class LandmarkId>
void CountEach(const std::vector<LandmarkId>& ids,
               int TrackingScore::*count,
               std::map<LandmarkId, TrackingScore>& scores) {
  auto beside = scores.begin();
  for (const LandmarkId id : ids) {
    const auto score = scores.try_emplace(beside, id, TrackingScore{0, 0});
    ++(score->second.*count);
    beside = std::next(score);
  }
}

template <class LandmarkId, class Candidate>
std::vector<LandmarkId> FoundOfMap(const std::vector<int>& match_of_feature,
                                   const std::vector<Candidate>& candidates) {
  std::vector<LandmarkId> found = IdsOfMatches<LandmarkId>(match_of_feature, candidates);
  std::erase_if(found, [](LandmarkId id) { return !id.valid(); });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

LandmarkMatches AssociationOf(const Frame& frame, const MapSnapshot& snapshot) {
  LandmarkMatches association(frame.points.size(), frame.lines.size());
  Associate(frame.points, snapshot, association.points, association.matches.point_of_feature);
  Associate(frame.lines, snapshot, association.lines, association.matches.line_of_feature);
  return association;
}

void CopyMatches(const LandmarkMatches& from, bool of_map, LandmarkMatches& to) {
  CopyKind(
      from.points, from.matches.point_of_feature, of_map, to.points, to.matches.point_of_feature);
  CopyKind(from.lines, from.matches.line_of_feature, of_map, to.lines, to.matches.line_of_feature);
}

int MatchesOfMap(const LandmarkMatches& association) {
  return CountOfMap(association.points, association.matches.point_of_feature) +
         CountOfMap(association.lines, association.matches.line_of_feature);
}

int FrameMatches::Points() const { return CountMatches(point_of_feature); }
int FrameMatches::Lines() const { return CountMatches(line_of_feature); }

FrameMatches SplitMatches(const MapSnapshot& snapshot, int views, LandmarkMatches& association) {
  FrameMatches& matches = association.matches;
  FrameMatches young = matches;
  SplitMatchesOfKind(
      snapshot, views, association.points, matches.point_of_feature, young.point_of_feature);
  SplitMatchesOfKind(
      snapshot, views, association.lines, matches.line_of_feature, young.line_of_feature);
  return young;
}

void MergeMatches(const FrameMatches& from, FrameMatches& to) {
  MergeMatchesOfKind(from.point_of_feature, to.point_of_feature);
  MergeMatchesOfKind(from.line_of_feature, to.line_of_feature);
}

int CommonMatches(const FrameMatches& a, const FrameMatches& b) {
  return CountCommon(a.point_of_feature, b.point_of_feature) +
         CountCommon(a.line_of_feature, b.line_of_feature);
}

void SetLandmarks(const LandmarkMatches& association, Frame& frame) {
  const FrameMatches& matches = association.matches;
  frame.points = IdsOfMatches<PointId>(matches.point_of_feature, association.points);
  frame.lines = IdsOfMatches<LineId>(matches.line_of_feature, association.lines);
}

void CountSeen(const LandmarkIds& expected,
               const LandmarkMatches& association,
               TrackingScores& scores) {
  const FrameMatches& matches = association.matches;
  CountEach(expected.points, &TrackingScore::visible, scores.points);
  CountEach(expected.lines, &TrackingScore::visible, scores.lines);
  CountEach(FoundOfMap<PointId>(matches.point_of_feature, association.points),
            &TrackingScore::found,
            scores.points);
  CountEach(FoundOfMap<LineId>(matches.line_of_feature, association.lines),
            &TrackingScore::found,
            scores.lines);
}

void MatchCandidates(const CameraAndPyramid& imaging,
                     const FrameFeatures& image,
                     const Rigid3& cam_from_world,
                     const ProjectionSearchOptions& options,
                     LandmarkMatches& association) {
  FrameMatches& matches = association.matches;
  auto points = ProjectAll(association.points, [&](const PointCandidate& point) {
    return ProjectPoint(imaging, cam_from_world, point.model);
  });
  auto lines = ProjectAll(association.lines, [&](const LineCandidate& line) {
    return ProjectLine(imaging, cam_from_world, line.model);
  });
  LeaveOutMatched(matches.point_of_feature, points);
  LeaveOutMatched(matches.line_of_feature, lines);
  Record(MatchProjectedPoints(image, points, Taken(matches.point_of_feature), options),
         matches.point_of_feature);
  Record(MatchProjectedLines(image, lines, Taken(matches.line_of_feature), options),
         matches.line_of_feature);
}

LandmarkIds MatchSnapshot(const CameraAndPyramid& imaging,
                          const FrameFeatures& image,
                          const Rigid3& cam_from_world,
                          const ProjectionSearchOptions& options,
                          const MapSnapshot& snapshot,
                          LandmarkMatches& association) {
  std::vector<PointCandidate>& candidate_points = association.points;
  std::vector<LineCandidate>& candidate_lines = association.lines;
  FrameMatches& matches = association.matches;
  auto points = ProjectAll(snapshot.points, [&](const PointModel& point) {
    return ProjectPoint(imaging, cam_from_world, point);
  });
  auto lines = ProjectAll(snapshot.lines, [&](const LineModel& line) {
    return ProjectLine(imaging, cam_from_world, line);
  });
  LandmarkIds expected{VisibleOf(snapshot.points, points), VisibleOf(snapshot.lines, lines)};
  LeaveOutFound(snapshot, snapshot.points, candidate_points, matches.point_of_feature, points);
  LeaveOutFound(snapshot, snapshot.lines, candidate_lines, matches.line_of_feature, lines);
  AddMatched(MatchProjectedPoints(image, points, Taken(matches.point_of_feature), options),
             snapshot.points,
             candidate_points,
             matches.point_of_feature);
  AddMatched(MatchProjectedLines(image, lines, Taken(matches.line_of_feature), options),
             snapshot.lines,
             candidate_lines,
             matches.line_of_feature);
  return expected;
}

}  // namespace plumbline
