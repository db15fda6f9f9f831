// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/line_map.h"

#include "plumbline/mapping/line_observation_search.h"
#include "plumbline/matching/measurements.h"
#include "plumbline/optimization/residuals.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace plumbline {
namespace {

// Least share of the supporting keyframes with a point of a line in their image that must show it.
// With a smaller share, the line was prolonged over another structure that happens to be collinear.
constexpr double kMinShownShare = 0.4;

// A keyframe is searched if it is not more than so many times as far from the line as the furthest
// of those that the map knows to show it.
constexpr double kReach = 3;

double MiddleDistance(const Frame& frame, const Segment3& segment) {
  return (frame.cam_from_world * (0.5 * (segment.start + segment.end))).norm();
}

// Returns a landmark as a hypothesis.
LineHypothesis Hypothesis(const Map& map, const MapLine& landmark) {
  LineHypothesis line;
  line.line = landmark.line;
  line.interval = {landmark.start, landmark.end};
  line.information = landmark.information;
  const Segment3 segment = SegmentOf(line.line, line.interval);
  line.reach = 0;
  for (const auto& [keyframe, feature] : landmark.observations) {
    line.reach = std::max(line.reach, kReach * MiddleDistance(map.Find(keyframe)->frame, segment));
  }
  return line;
}

struct SupportedLine {
  LineHypothesis hypothesis;
  std::vector<LineSupport> supports;
  std::vector<LineInterval> parts;  // the parts of the line that enough keyframes show
};

// Finds the supports of a hypothesis and the line through them, three times in turn. Ends earlier
// if the supports stay the same, since further rounds would change nothing. Returns nullopt if
// there are too few supports.
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
    line.hypothesis.reach = hypothesis.reach;
    line.parts = ShownParts(camera, through->line, line.supports, min_keyframes, kMinShownShare);
    if (line.parts.empty()) return std::nullopt;
    line.hypothesis.interval = {line.parts.front().start, line.parts.back().end};
    std::vector<LineSupport> supports = search.Find(line.hypothesis);
    if (supports == line.supports) return line;
    line.supports = std::move(supports);
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

// Finds the longest part of an interval whose points have a small enough uncertainty, in steps of a
// twentieth of its length; nullopt if there is none.
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

// The keyframes and segments that show a part of a line.
struct Sightings {
  std::set<KeyFrameId> keyframes;
  double furthest = 0;        // largest distance of a keyframe from the middle of the part
  double mean_chi2 = 0;       // mean over the segments in the left images, by their own deviations
  double mean_length_px = 0;  // mean over the segments in the left images
};

// Returns the squared distances of a support's ends from the line, over their variances; infinity
// if the line has no projection.
double Chi2(const RectifiedCamera& camera,
            const OrthonormalLine& line,
            const LineSupport& support) {
  const Frame& frame = support.keyframe->frame;
  const auto residual =
      EvaluateLine(camera,
                   frame.cam_from_world,
                   line,
                   MeasureLeftLine(frame.features(), support.feature, LineWeighting::kCovariance));
  return residual ? residual->r.squaredNorm() : std::numeric_limits<double>::infinity();
}

Sightings FindSightings(const RectifiedCamera& camera,
                        const SupportedLine& line,
                        const LineInterval& part) {
  constexpr double kMinOverlap = 0.25;
  const Segment3 segment = SegmentOf(line.hypothesis.line, part);
  const OrthonormalLine orthonormal = ToOrthonormal(line.hypothesis.line);
  Sightings found;
  int segments = 0;
  for (const LineSupport& support : line.supports) {
    const Frame& frame = support.keyframe->frame;
    const Segment2& seen = frame.features().lines[support.feature].segment;
    const auto interval = TrimToSegment(camera, frame.cam_from_world, line.hypothesis.line, seen);
    if (!interval || OverlapRatio(*interval, part) <= kMinOverlap) continue;
    found.keyframes.insert(support.keyframe->id);
    found.furthest = std::max(found.furthest, MiddleDistance(frame, segment));
    found.mean_chi2 += Chi2(camera, orthonormal, support);
    found.mean_length_px += seen.Length();
    ++segments;
  }
  if (segments > 0) {
    found.mean_chi2 /= segments;
    found.mean_length_px /= segments;
  }
  return found;
}

// Returns which share of the keyframes that have a part of a line in their image show it. Keyframes
// further away than the furthest that shows it do not count: they are likely to stand behind a
// wall.
double FoundRatio(const FrustumTree& views,
                  const RectifiedCamera& camera,
                  const Segment3& segment,
                  const Sightings& sightings) {
  constexpr double kMinLengthPx = 30;
  std::size_t expected = sightings.keyframes.size();
  for (const int index : views.MayShow(segment, kMinLengthPx, sightings.furthest)) {
    const KeyFrame& keyframe = views.keyframe(index);
    if (sightings.keyframes.contains(keyframe.id)) continue;
    if (MiddleDistance(keyframe.frame, segment) > sightings.furthest) continue;
    const Rigid3& pose = keyframe.frame.cam_from_world;
    const auto projected = ProjectSegment(camera, {pose * segment.start, pose * segment.end});
    expected += projected && projected->Length() >= kMinLengthPx;
  }
  return expected > 0
             ? static_cast<double>(sightings.keyframes.size()) / static_cast<double>(expected)
             : 0;
}

// Returns the pieces of a line that are good enough to be given out.
std::vector<MappedLine> GoodPieces(const FrustumTree& views,
                                   const RectifiedCamera& camera,
                                   const SupportedLine& line,
                                   const LineMapOptions& options) {
  std::vector<MappedLine> pieces;
  for (const LineInterval& shown : line.parts) {
    const auto part = KnownPart(line, shown, options.max_relative_sigma);
    if (!part) continue;
    const Segment3 segment = SegmentOf(line.hypothesis.line, *part);
    const Sightings seen = FindSightings(camera, line, *part);
    const int count = static_cast<int>(seen.keyframes.size());
    if (count < options.min_keyframes || seen.mean_chi2 > options.max_mean_chi2 ||
        seen.mean_length_px < options.min_mean_length_px ||
        FoundRatio(views, camera, segment, seen) < options.min_found_ratio) {
      continue;
    }
    const auto sigma = [&](double t) {
      return SigmaAt(line.hypothesis.line, line.hypothesis.information, t);
    };
    pieces.push_back({segment, std::max(sigma(part->start), sigma(part->end)), count});
  }
  return pieces;
}

// Orders the lines by their number of observations, most first, and then by id.
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
                                            const CameraAndPyramid& imaging,
                                            const LineMapOptions& options,
                                            const StopCheck& stop) {
  LineSupportSearch search(map, imaging);
  std::vector<WellSeenLine> lines;
  for (const MapLine* landmark : ByObservations(map)) {
    if (IsToStop(stop)) break;
    auto line = Support(search, imaging.camera, Hypothesis(map, *landmark), options.min_keyframes);
    if (!line) continue;
    std::vector<MappedLine> pieces = GoodPieces(search.views(), imaging.camera, *line, options);
    if (pieces.empty()) continue;
    search.Claim(line->supports);
    lines.push_back({line->hypothesis.line, std::move(line->supports), std::move(pieces)});
  }
  return lines;
}

std::vector<Segment3> SegmentsOf(const std::vector<MappedLine>& lines) {
  std::vector<Segment3> segments;
  for (const MappedLine& line : lines) segments.push_back(line.segment);
  return segments;
}

std::vector<MappedLine> MakeLineMap(const Map& map,
                                    const CameraAndPyramid& imaging,
                                    const LineMapOptions& options,
                                    const StopCheck& stop) {
  std::vector<MappedLine> lines;
  for (const WellSeenLine& line : FindWellSeenLines(map, imaging, options, stop)) {
    lines.insert(lines.end(), line.pieces.begin(), line.pieces.end());
  }
  return lines;
}

}  // namespace plumbline
