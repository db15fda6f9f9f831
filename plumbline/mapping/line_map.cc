// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/line_map.h"

#include "plumbline/association/line_information.h"
#include "plumbline/mapping/line_support.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace plumbline {
namespace {

// Of the supporting keyframes that have a point of the line in their image, how many must show it:
// where fewer do, the line was prolonged over something that happens to lie in line with it.
constexpr double kMinShownShare = 0.4;

struct SupportedLine {
  LineHypothesis hypothesis;
  std::vector<LineSupport> supports;
  std::vector<LineInterval> parts;  // that are shown
};

// The line that the supports of a hypothesis give, after three rounds; nullopt where there are too
// few.
std::optional<SupportedLine> Support(const LineSupportSearch& search,
                                     const RectifiedCamera& camera,
                                     const LineHypothesis& hypothesis,
                                     int min_keyframes) {
  constexpr int kRounds = 3;
  SupportedLine line{hypothesis, search.Find(hypothesis), {}};
  for (int round = 0; round < kRounds; ++round) {
    if (CountKeyFrames(line.supports) < min_keyframes) return std::nullopt;
    const auto through = LineThroughSupports(camera, line.supports);
    if (!through) return std::nullopt;
    line.hypothesis = *through;
    line.parts = ShownParts(camera, through->line, line.supports, min_keyframes, kMinShownShare);
    if (line.parts.empty()) return std::nullopt;
    line.hypothesis.interval = {line.parts.front().start, line.parts.back().end};
    line.supports = search.Find(line.hypothesis);
  }
  line.parts =
      ShownParts(camera, line.hypothesis.line, line.supports, min_keyframes, kMinShownShare);
  return line;
}

double DistanceFromNearest(std::span<const LineSupport> supports, const Eigen::Vector3d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const LineSupport& support : supports) {
    nearest = std::min(nearest, (support.keyframe->frame.cam_from_world * point).norm());
  }
  return nearest;
}

// The longest stretch of an interval whose points are known well enough, to a twentieth of its
// length; nullopt where there is none.
std::optional<LineInterval> KnownPart(const SupportedLine& line,
                                      const LineInterval& part,
                                      double max_relative_sigma) {
  constexpr int kSteps = 20;
  const LineHypothesis& h = line.hypothesis;
  std::optional<LineInterval> best, current;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = part.start + (part.end - part.start) * i / kSteps;
    const double distance = DistanceFromNearest(line.supports, h.line.PointAt(t));
    if (!(SigmaAt(h.line, h.information, t) <= max_relative_sigma * distance)) {
      current.reset();
      continue;
    }
    current = LineInterval{current ? current->start : t, t};
    if (!best || current->end - current->start > best->end - best->start) best = current;
  }
  if (!best || !(best->end > best->start)) return std::nullopt;
  return best;
}

// How many keyframes show a part of a line, and how many more have it in their image from no
// further than the furthest of them: those beyond are likely to stand behind a wall.
struct Sightings {
  int shown = 0, expected = 0;
};

Sightings CountSightings(const Map& map,
                         const RectifiedCamera& camera,
                         const SupportedLine& line,
                         const LineInterval& part) {
  constexpr double kMinOverlap = 0.25, kMinLengthPx = 30;
  const Eigen::Vector3d middle = line.hypothesis.line.PointAt(0.5 * (part.start + part.end));
  const auto distance = [&](const Frame& frame) { return (frame.cam_from_world * middle).norm(); };
  std::set<KeyFrameId> shown;
  double furthest = 0;
  for (const LineSupport& support : line.supports) {
    const Frame& frame = support.keyframe->frame;
    const auto interval = TrimToSegment(camera,
                                        frame.cam_from_world,
                                        line.hypothesis.line,
                                        frame.features().lines[support.feature].segment);
    if (!interval || OverlapRatio(*interval, part) <= kMinOverlap) continue;
    shown.insert(support.keyframe->id);
    furthest = std::max(furthest, distance(frame));
  }
  const Segment3 segment = SegmentOf(line.hypothesis.line, part);
  Sightings count{static_cast<int>(shown.size()), 0};
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (distance(keyframe.frame) > furthest) continue;
    const Rigid3& pose = keyframe.frame.cam_from_world;
    const auto projected = ProjectSegment(camera, {pose * segment.start, pose * segment.end});
    count.expected += shown.contains(id) || (projected && projected->Length() >= kMinLengthPx);
  }
  return count;
}

// The pieces of a line that are good enough for the map.
std::vector<MappedLine> GoodPieces(const Map& map,
                                   const RectifiedCamera& camera,
                                   const SupportedLine& line,
                                   const LineMapOptions& options) {
  std::vector<MappedLine> pieces;
  for (const LineInterval& shown : line.parts) {
    const auto part = KnownPart(line, shown, options.max_relative_sigma);
    if (!part) continue;
    const Sightings count = CountSightings(map, camera, line, *part);
    if (count.shown < options.min_keyframes ||
        count.shown < options.min_found_ratio * count.expected) {
      continue;
    }
    const auto sigma = [&](double t) {
      return SigmaAt(line.hypothesis.line, line.hypothesis.information, t);
    };
    pieces.push_back({SegmentOf(line.hypothesis.line, *part),
                      std::max(sigma(part->start), sigma(part->end)),
                      count.shown});
  }
  return pieces;
}

// The best observed first; ties by id.
std::vector<const MapLine*> ByObservations(const Map& map) {
  std::vector<const MapLine*> landmarks;
  for (const auto& [id, line] : map.lines()) {
    if (line.end > line.start) landmarks.push_back(&line);
  }
  std::stable_sort(landmarks.begin(), landmarks.end(), [](const MapLine* a, const MapLine* b) {
    return a->observations.size() > b->observations.size();
  });
  return landmarks;
}

}  // namespace

std::vector<WellSeenLine> FindWellSeenLines(const Map& map,
                                            const ImagingModel& imaging,
                                            const LineMapOptions& options) {
  LineSupportSearch search(map, imaging);
  std::vector<WellSeenLine> lines;
  for (const MapLine* landmark : ByObservations(map)) {
    auto line = Support(search,
                        imaging.camera,
                        {landmark->line, {landmark->start, landmark->end}, landmark->information},
                        options.min_keyframes);
    if (!line) continue;
    std::vector<MappedLine> pieces = GoodPieces(map, imaging.camera, *line, options);
    if (pieces.empty()) continue;
    search.Claim(line->supports);
    lines.push_back({line->hypothesis.line, std::move(line->supports), std::move(pieces)});
  }
  return lines;
}

std::vector<MappedLine> MakeLineMap(const Map& map,
                                    const ImagingModel& imaging,
                                    const LineMapOptions& options) {
  std::vector<MappedLine> lines;
  for (const WellSeenLine& line : FindWellSeenLines(map, imaging, options)) {
    lines.insert(lines.end(), line.pieces.begin(), line.pieces.end());
  }
  return lines;
}

}  // namespace plumbline
