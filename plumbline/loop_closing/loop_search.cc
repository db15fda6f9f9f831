// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/loop_closing/loop_search.h"

#include "plumbline/base/ids.h"
#include "plumbline/features/match_lines.h"
#include "plumbline/features/match_points.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/matching/measurements.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace plumbline {
namespace {

constexpr double kNearRadiusPx = 4;  // search radius in the images of neighbours

ProjectionSearchOptions SearchOptions(double radius_px) {
  ProjectionSearchOptions options;
  options.point_radius_px = radius_px;
  options.point_max_distance = 64;
  options.line_offset_px = radius_px;
  options.line_max_distance = 60;
  return options;
}

template <class Landmark>
bool Before(const Landmark* a, const Landmark* b) {
  return a->id < b->id;
}

// Removes the common elements from both lists, and returns their ids. Both must be ordered by id.
template <class Landmark>
auto TakeOutCommon(std::vector<const Landmark*>& a, std::vector<const Landmark*>& b) {
  std::vector<const Landmark*> common;
  std::set_intersection(
      a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common), Before<Landmark>);
  const auto is_common = [&](const Landmark* landmark) {
    return std::binary_search(common.begin(), common.end(), landmark, Before<Landmark>);
  };
  std::erase_if(a, is_common);
  std::erase_if(b, is_common);
  std::vector<decltype(Landmark::id)> ids;
  for (const Landmark* landmark : common) ids.push_back(landmark->id);
  return ids;
}

// The features of a frame that show landmarks, and their indices in the frame.
template <class Feature>
struct FeaturesOfLandmarks {
  std::vector<Feature> features;
  std::vector<std::size_t> places;
};

template <class Feature, class LandmarkId>
FeaturesOfLandmarks<Feature> WithLandmarks(const std::vector<Feature>& features,
                                           const std::vector<LandmarkId>& landmarks,
                                           const std::vector<LandmarkId>& without) {
  FeaturesOfLandmarks<Feature> out;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (!landmarks[i].valid()) continue;
    if (std::binary_search(without.begin(), without.end(), landmarks[i])) continue;
    out.features.push_back(features[i]);
    out.places.push_back(i);
  }
  return out;
}

// Returns for each pair true if it is kept: no other pair contradicts it, and it is the first of
// several equal ones.
template <class LandmarkId>
std::vector<bool> Consistent(const std::vector<LandmarkPair<LandmarkId>>& pairs) {
  std::map<LandmarkId, LandmarkId> partner_of_query;
  std::map<LandmarkId, LandmarkId> partner_of_candidate;
  std::vector<LandmarkId> bad_query;
  std::vector<LandmarkId> bad_candidate;
  for (const auto& pair : pairs) {
    const auto [q, new_q] = partner_of_query.emplace(pair.in_query, pair.in_candidate);
    if (q->second != pair.in_candidate) bad_query.push_back(pair.in_query);
    const auto [c, new_c] = partner_of_candidate.emplace(pair.in_candidate, pair.in_query);
    if (c->second != pair.in_query) bad_candidate.push_back(pair.in_candidate);
  }
  std::sort(bad_query.begin(), bad_query.end());
  std::sort(bad_candidate.begin(), bad_candidate.end());
  std::vector<bool> consistent;
  for (const auto& pair : pairs) {
    const bool first = partner_of_query.erase(pair.in_query) > 0;
    consistent.push_back(
        first && !std::binary_search(bad_query.begin(), bad_query.end(), pair.in_query) &&
        !std::binary_search(bad_candidate.begin(), bad_candidate.end(), pair.in_candidate));
  }
  return consistent;
}

template <class T>
void KeepThose(const std::vector<bool>& keep, std::vector<T>& values) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keep[i]) kept.push_back(std::move(values[i]));
  }
  values = std::move(kept);
}

}  // namespace

LoopSearch::LoopSearch(const Map& query_map,
                       KeyFrameId query,
                       const Map& candidate_map,
                       KeyFrameId candidate,
                       const CameraAndPyramid& imaging,
                       int neighbours)
    : query_map_(query_map),
      candidate_map_(candidate_map),
      imaging_(imaging),
      query_(LandmarksAround(query_map, query, neighbours)),
      candidate_(LandmarksAround(candidate_map, candidate, neighbours)) {
  if (&query_map == &candidate_map) DropCommonLandmarks();
}

void LoopSearch::DropCommonLandmarks() {
  common_points_ = TakeOutCommon(query_.points, candidate_.points);
  common_lines_ = TakeOutCommon(query_.lines, candidate_.lines);
}

const CameraPoint& LoopSearch::InQuery(PointId id) {
  const auto known = in_query_.find(id);
  if (known != in_query_.end()) return known->second;
  return in_query_[id] = PointInCamera(imaging_.camera,
                                       query_map_,
                                       *query_map_.Find(id),
                                       query_.keyframe->frame.cam_from_world);
}

const CameraPoint& LoopSearch::InCandidate(PointId id) {
  const auto known = in_candidate_.find(id);
  if (known != in_candidate_.end()) return known->second;
  return in_candidate_[id] = PointInCamera(imaging_.camera,
                                           candidate_map_,
                                           *candidate_map_.Find(id),
                                           candidate_.keyframe->frame.cam_from_world);
}

void LoopSearch::AddPair(PointId in_query, PointId in_candidate, LoopMatches& matches) {
  matches.points.push_back({in_query, in_candidate});
  matches.problem.points.push_back({InQuery(in_query), InCandidate(in_candidate)});
}

void LoopSearch::AddPair(LineId in_query, LineId in_candidate, LoopMatches& matches) {
  matches.lines.push_back({in_query, in_candidate});
  matches.problem.lines.push_back(
      {LineInCamera(*query_map_.Find(in_query), query_.keyframe->frame.cam_from_world),
       LineInCamera(*candidate_map_.Find(in_candidate),
                    candidate_.keyframe->frame.cam_from_world)});
}

LoopMatches LoopSearch::MatchDescriptors(const LoopVerificationOptions& options) {
  const Frame& a = query_.keyframe->frame;
  const Frame& b = candidate_.keyframe->frame;
  LoopMatches matches;
  matches.problem.camera = imaging_.camera;
  matches.problem.free_scale = !KnowsUnitOfLength(imaging_.camera);
  const auto points_a = WithLandmarks(a.features().points, a.points, common_points_);
  const auto points_b = WithLandmarks(b.features().points, b.points, common_points_);
  PointMatchOptions point_options;
  point_options.max_distance = options.max_distance;
  point_options.ratio = options.ratio;
  for (const FeatureMatch& match :
       MatchPoints(points_a.features, points_b.features, point_options)) {
    AddPair(a.points[points_a.places[Index(match.a)]],
            b.points[points_b.places[Index(match.b)]],
            matches);
  }
  const auto lines_a = WithLandmarks(a.features().lines, a.lines, common_lines_);
  const auto lines_b = WithLandmarks(b.features().lines, b.lines, common_lines_);
  LineMatchOptions line_options;
  line_options.max_distance = options.max_distance;
  line_options.ratio = options.ratio;
  line_options.max_angle_deg = 60;
  line_options.max_offset_px = 1e6;
  line_options.max_shift_px = 0;
  for (const FeatureMatch& match : MatchLines(lines_a.features, lines_b.features, line_options)) {
    AddPair(
        a.lines[lines_a.places[Index(match.a)]], b.lines[lines_b.places[Index(match.b)]], matches);
  }
  return matches;
}

void LoopSearch::AddFoundInCandidate(const SearchedImage& found, LoopMatches& matches) {
  const Frame& frame = candidate_.keyframe->frame;
  for (const LandmarkMatch& match : found.points) {
    const PointId in_query = query_.points[Index(match.landmark)]->id;
    const PointId in_candidate = frame.points[Index(match.feature)];
    if (!in_candidate.valid()) {
      matches.problem.sightings.push_back(
          {true, InQuery(in_query), MeasurePoint(frame.features(), Index(match.feature))});
    } else if (!std::binary_search(common_points_.begin(), common_points_.end(), in_candidate)) {
      AddPair(in_query, in_candidate, matches);
    }
  }
  for (const LandmarkMatch& match : found.lines) {
    const LineId in_candidate = frame.lines[Index(match.feature)];
    if (!in_candidate.valid()) continue;
    if (std::binary_search(common_lines_.begin(), common_lines_.end(), in_candidate)) continue;
    AddPair(query_.lines[Index(match.landmark)]->id, in_candidate, matches);
  }
}

void LoopSearch::AddFoundInQuery(const SearchedImage& found, LoopMatches& matches) {
  const Frame& frame = query_.keyframe->frame;
  for (const LandmarkMatch& match : found.points) {
    const PointId in_query = frame.points[Index(match.feature)];
    const PointId in_candidate = candidate_.points[Index(match.landmark)]->id;
    if (!in_query.valid()) {
      matches.problem.sightings.push_back(
          {false, InCandidate(in_candidate), MeasurePoint(frame.features(), Index(match.feature))});
    } else if (!std::binary_search(common_points_.begin(), common_points_.end(), in_query)) {
      AddPair(in_query, in_candidate, matches);
    }
  }
  for (const LandmarkMatch& match : found.lines) {
    const LineId in_query = frame.lines[Index(match.feature)];
    if (!in_query.valid()) continue;
    if (std::binary_search(common_lines_.begin(), common_lines_.end(), in_query)) continue;
    AddPair(in_query, candidate_.lines[Index(match.landmark)]->id, matches);
  }
}

void LoopSearch::DropContradictions(LoopMatches& matches) const {
  const std::vector<bool> points = Consistent(matches.points);
  KeepThose(points, matches.points);
  KeepThose(points, matches.problem.points);
  const std::vector<bool> lines = Consistent(matches.lines);
  KeepThose(lines, matches.lines);
  KeepThose(lines, matches.problem.lines);
}

MutualSearch LoopSearch::SearchBoth(const Similarity3& candidate_from_query, double radius_px) {
  const Frame& query = query_.keyframe->frame;
  const Frame& candidate = candidate_.keyframe->frame;
  const ProjectionSearchOptions options = SearchOptions(radius_px);
  MutualSearch search;
  search.matches.problem.camera = imaging_.camera;
  search.matches.problem.free_scale = !KnowsUnitOfLength(imaging_.camera);
  search.in_candidate = SearchImage(imaging_,
                                    query_,
                                    CameraAmong(query.cam_from_world, candidate_from_query),
                                    *candidate.indexed,
                                    options);
  search.in_query =
      SearchImage(imaging_,
                  candidate_,
                  CameraAmong(candidate.cam_from_world, Inverse(candidate_from_query)),
                  *query.indexed,
                  options);
  AddFoundInCandidate(search.in_candidate, search.matches);
  AddFoundInQuery(search.in_query, search.matches);
  DropContradictions(search.matches);
  return search;
}

SearchedImage LoopSearch::SearchInNeighbourOfQuery(KeyFrameId neighbour,
                                                   const Similarity3& candidate_from_query,
                                                   LoopMatches& matches) {
  const Frame& frame = query_map_.Find(neighbour)->frame;
  const Similarity3 neighbour_from_query =
      ToSimilarity(frame.cam_from_world * Inverse(query_.keyframe->frame.cam_from_world));
  SearchedImage found =
      SearchImage(imaging_,
                  candidate_,
                  CameraAmong(candidate_.keyframe->frame.cam_from_world,
                              neighbour_from_query * Inverse(candidate_from_query)),
                  *frame.indexed,
                  SearchOptions(kNearRadiusPx));
  for (const LandmarkMatch& match : found.points) {
    const PointId in_query = frame.points[Index(match.feature)];
    const PointId in_candidate = candidate_.points[Index(match.landmark)]->id;
    if (in_query.valid() && in_query != in_candidate) AddPair(in_query, in_candidate, matches);
  }
  for (const LandmarkMatch& match : found.lines) {
    const LineId in_query = frame.lines[Index(match.feature)];
    const LineId in_candidate = candidate_.lines[Index(match.landmark)]->id;
    if (in_query.valid() && in_query != in_candidate) AddPair(in_query, in_candidate, matches);
  }
  return found;
}

SearchedImage LoopSearch::SearchInNeighbourOfCandidate(KeyFrameId neighbour,
                                                       const Similarity3& candidate_from_query,
                                                       LoopMatches& matches) {
  const Frame& frame = candidate_map_.Find(neighbour)->frame;
  const Similarity3 neighbour_from_candidate =
      ToSimilarity(frame.cam_from_world * Inverse(candidate_.keyframe->frame.cam_from_world));
  SearchedImage found = SearchImage(imaging_,
                                    query_,
                                    CameraAmong(query_.keyframe->frame.cam_from_world,
                                                neighbour_from_candidate * candidate_from_query),
                                    *frame.indexed,
                                    SearchOptions(kNearRadiusPx));
  for (const LandmarkMatch& match : found.points) {
    const PointId in_query = query_.points[Index(match.landmark)]->id;
    const PointId in_candidate = frame.points[Index(match.feature)];
    if (in_candidate.valid() && in_query != in_candidate) AddPair(in_query, in_candidate, matches);
  }
  for (const LandmarkMatch& match : found.lines) {
    const LineId in_query = query_.lines[Index(match.landmark)]->id;
    const LineId in_candidate = frame.lines[Index(match.feature)];
    if (in_candidate.valid() && in_query != in_candidate) AddPair(in_query, in_candidate, matches);
  }
  return found;
}

}  // namespace plumbline
