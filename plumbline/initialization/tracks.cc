// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/tracks.h"

#include "plumbline/base/error.h"
#include "plumbline/base/ids.h"
#include "plumbline/base/parallel.h"
#include "plumbline/initialization/patch_alignment.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace plumbline {
namespace {

constexpr std::size_t kMaxFrames = 40;
constexpr double kSeparationPx = 5;  // least distance of points that are used together
// Fewest features of a frame that is taken into the window.
constexpr std::size_t kMinFeatures = 60;
// Fewest matches with a reference: absolutely, and relative to the most that any frame had with it.
// The matches that remain are more and more often wrong.
constexpr int kFewestMatches = 12;
constexpr double kMinShareOfMatches = 0.3;
constexpr std::size_t kPatchesAtOnce = 32;  // patches that a thread aligns before it takes others

// Takes features in order, but none that is nearer than `distance_px` to one that was taken. A
// corner is often found in several octaves, and its errors are the same in all of them.
class Separated {
 public:
  Separated(std::span<const PointFeature> points, double distance_px)
      : points_(points), squared_(distance_px * distance_px) {}

  bool Take(std::size_t feature) {
    const Eigen::Vector2d& px = points_[feature].px;
    const bool free = std::none_of(taken_.begin(), taken_.end(), [&](const Eigen::Vector2d& other) {
      return (other - px).squaredNorm() < squared_;
    });
    if (free) taken_.push_back(px);
    return free;
  }

 private:
  std::span<const PointFeature> points_;
  double squared_;
  std::vector<Eigen::Vector2d> taken_;
};

// Returns true for each feature followed from image to image: the best localized one at each
// position.
std::vector<bool> ChooseFollowed(std::span<const PointFeature> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].sigma_px < points[b].sigma_px;
  });
  std::vector<bool> followed(points.size(), false);
  Separated separated(points, kSeparationPx);
  for (const std::size_t k : order) followed[k] = separated.Take(k);
  return followed;
}

}  // namespace

std::vector<RayMatch> MatchesBetween(const ViewPoints& reference, const ViewPoints& view) {
  std::vector<RayMatch> matches;
  for (std::size_t k = 0; k < reference.points.size(); ++k) {
    if (!view.Has(k)) continue;
    matches.push_back({reference.points[k], view.points[k], reference.sigmas[k], view.sigmas[k]});
  }
  return matches;
}

TrackedPixels InitializationWindow::MatchedFrame::Pixels() const {
  TrackedPixels pixels(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k].sigma_px > 0) pixels[k] = places[k].px;
  }
  return pixels;
}

void InitializationWindow::Reset() {
  reference_.reset();
  frames_.clear();
  most_matches_ = 0;
}

InitializationResult InitializationWindow::Offer(const InitializationFrame& frame, int needed) {
  using enum InitializationStatus;
  if (frame.indexed->features.points.size() < kMinFeatures) return {.wait = kTooFewFeatures};
  const bool is_first = empty();
  const int matches = Add(frame);
  if (is_first) return {.wait = kTooFewFrames};
  InitializationResult result{.matches = matches};
  most_matches_ = std::max(most_matches_, matches);
  if (matches < std::max<double>(kFewestMatches, kMinShareOfMatches * most_matches_)) {
    MoveReference();
    most_matches_ = 0;
    result.wait = kTooFewMatches;
  } else if (size() < needed) {
    result.wait = kTooFewFrames;
  }
  return result;
}

void InitializationWindow::SetReference(const InitializationFrame& frame) {
  reference_ = frame;
  if (matching_ == InitialMatching::kDescriptors) return;
  PLUMBLINE_CHECK(frame.image != nullptr, "points are followed on images");
  const std::vector<PointFeature>& points = frame.indexed->features.points;
  const std::vector<bool> followed = ChooseFollowed(points);
  TrackedPixels pixels(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (followed[k]) pixels[k] = points[k].px;
  }
  flow_ = KltTracks(frame.image, std::move(pixels));
  warps_.assign(points.size(), Eigen::Matrix2d::Identity());
}

int InitializationWindow::Add(const InitializationFrame& frame) {
  if (!reference_) {
    SetReference(frame);
    return 0;
  }
  const ImageMotion guess = frames_.empty() ? ImageMotion{} : frames_.back().matches.motion;
  ReferenceMatches matches =
      MatchToReference(reference_->indexed->features, frame.indexed->features, guess);
  std::vector<Place> places = matching_ == InitialMatching::kImages
                                  ? PlacesOnImage(frame, matches)
                                  : PlacesOfMatches(frame.indexed->features, matches);
  const auto count = std::count_if(
      places.begin(), places.end(), [](const Place& place) { return place.sigma_px > 0; });
  if (frames_.size() >= kMaxFrames) {
    std::vector<MatchedFrame> kept;
    for (std::size_t i = 1; i < frames_.size(); i += 2) kept.push_back(std::move(frames_[i]));
    frames_ = std::move(kept);
  }
  frames_.push_back({frame, std::move(matches), std::move(places)});
  return static_cast<int>(count);
}

std::vector<InitializationWindow::Place> InitializationWindow::PlacesOfMatches(
    const Features& features, const ReferenceMatches& matches) const {
  std::vector<Place> places(reference_->indexed->features.points.size());
  for (const FeatureMatch& match : matches.points) {
    const PointFeature& seen = features.points[Index(match.b)];
    places[Index(match.a)] = {seen.px, seen.sigma_px};
  }
  return places;
}

// Returns the positions of the reference's points in the image. Points are followed from the last
// image; lost points are matched by descriptor. Each is then aligned to its appearance in the
// reference, and followed from there in the next image.
std::vector<InitializationWindow::Place> InitializationWindow::PlacesOnImage(
    const InitializationFrame& frame, const ReferenceMatches& matches) {
  PLUMBLINE_CHECK(frame.image != nullptr, "points are followed on images");
  const std::vector<PointFeature>& reference = reference_->indexed->features.points;
  flow_.Follow(frame.image, helper_);
  TrackedPixels guesses = flow_.places();
  for (const FeatureMatch& match : matches.points) {
    auto& guess = guesses[Index(match.a)];
    if (!guess) guess = frame.indexed->features.points[Index(match.b)].px;
  }
  const TrackedPixels aligned = AlignWithReference(*frame.image, guesses, matches.motion.linear());
  std::vector<Place> places(reference.size());
  for (std::size_t k = 0; k < aligned.size(); ++k) {
    if (!aligned[k]) continue;
    flow_.Correct(k, *aligned[k]);
    places[k] = {*aligned[k], reference[k].sigma_px};
  }
  return places;
}

// Aligns the reference's points to their appearance in the reference (AlignPatches).
TrackedPixels InitializationWindow::AlignWithReference(const GrayImage& image,
                                                       const TrackedPixels& guesses,
                                                       const Eigen::Matrix2d& linear) {
  const std::span reference(reference_->indexed->features.points);
  TrackedPixels aligned(reference.size());
  const auto align = [&](std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    const TrackedPixels some = AlignPatches(*reference_->image,
                                            reference.subspan(begin, count),
                                            image,
                                            std::span(guesses).subspan(begin, count),
                                            linear,
                                            std::span(warps_).subspan(begin, count),
                                            {.octave_scale = octave_scale_});
    std::copy(some.begin(), some.end(), aligned.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  ParallelForRanges(reference.size(), kPatchesAtOnce, helper_, align);
  return aligned;
}

void InitializationWindow::MoveReference() {
  PLUMBLINE_CHECK(!frames_.empty(), "no frame to move to");
  std::vector<MatchedFrame> old = std::exchange(frames_, {});
  const std::size_t middle = (old.size() - 1) / 2;
  SetReference(old[middle].frame);
  for (std::size_t i = middle + 1; i < old.size(); ++i) Add(old[i].frame);
}

std::vector<int> InitializationWindow::SelectFrames(int count) const {
  const int chosen = std::min(count, size());
  std::vector<int> frames;
  for (int j = 1; j <= chosen; ++j) frames.push_back((j * size() + chosen / 2) / chosen - 1);
  return frames;
}

std::vector<int> InitializationWindow::NewestFrames(int count) const {
  std::vector<int> frames;
  for (int i = std::max(0, size() - count); i < size(); ++i) frames.push_back(i);
  return frames;
}

// Returns at most `count` of the reference's features. In each round every cell of the image gives
// its best remaining feature. Features that the newest frame shows come first, then those that most
// frames show, then those with the least noise.
std::vector<std::size_t> InitializationWindow::SelectFeatures(const std::vector<int>& frames,
                                                              int count) const {
  constexpr int kColumns = 8;
  constexpr int kRows = 6;
  const std::vector<PointFeature>& points = reference_->indexed->features.points;
  const auto seen = [&](std::size_t k, int frame) {
    return frames_[Index(frame)].places[k].sigma_px > 0;
  };
  const auto rank = [&](std::size_t k) {
    const auto views =
        std::count_if(frames.begin(), frames.end(), [&](int frame) { return seen(k, frame); });
    return std::tuple(!seen(k, frames.back()), -views, points[k].sigma_px);
  };
  std::array<std::vector<std::size_t>, kColumns * kRows> cells;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::get<1>(rank(k)) == 0) continue;
    const Eigen::Vector2d& px = points[k].px;
    const int column =
        std::clamp(static_cast<int>(px.x() / camera_.width * kColumns), 0, kColumns - 1);
    const int row = std::clamp(static_cast<int>(px.y() / camera_.height * kRows), 0, kRows - 1);
    cells[Index(row * kColumns + column)].push_back(k);
  }
  std::size_t rounds = 0;
  for (auto& cell : cells) {
    std::stable_sort(
        cell.begin(), cell.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    rounds = std::max(rounds, cell.size());
  }
  std::vector<std::size_t> chosen;
  Separated separated(points, kSeparationPx);
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const auto& cell : cells) {
      if (round >= cell.size() || chosen.size() >= Index(count)) continue;
      if (separated.Take(cell[round])) chosen.push_back(cell[round]);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

FeatureTracks InitializationWindow::CollectTracks(const std::vector<int>& frames,
                                                  int max_points) const {
  const std::vector<PointFeature>& reference = reference_->indexed->features.points;
  const double focal = 0.5 * (camera_.fx + camera_.fy);
  FeatureTracks tracks;
  tracks.views.resize(frames.size());
  const auto add = [&](const Place& place, ViewPoints& points) {
    const bool seen = place.sigma_px > 0;
    points.points.push_back(seen ? Eigen::Vector2d(camera_.Unproject(place.px).hnormalized())
                                 : Eigen::Vector2d::Zero());
    points.sigmas.push_back(place.sigma_px / focal);
  };
  for (const std::size_t k : SelectFeatures(frames, max_points)) {
    tracks.features.push_back(static_cast<int>(k));
    add({reference[k].px, reference[k].sigma_px}, tracks.reference);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      add(frames_[Index(frames[i])].places[k], tracks.views[i]);
    }
  }
  tracks.lines = CollectLineTracks(frames);
  return tracks;
}

LineTracks InitializationWindow::CollectLineTracks(const std::vector<int>& frames) const {
  const std::vector<LineFeature>& reference = reference_->indexed->features.lines;
  const double focal = 0.5 * (camera_.fx + camera_.fy);
  const auto ideal = [&](const Segment2& segment) {
    return Segment2{camera_.Unproject(segment.start).head<2>(),
                    camera_.Unproject(segment.end).head<2>()};
  };
  LineTracks lines;
  lines.views.resize(frames.size());
  for (const FeatureTrack& track : LineObservations(frames)) {
    if (track.size() < 3) continue;
    const LineFeature& line = reference[Index(track.front().feature)];
    lines.reference.segments.push_back(ideal(line.segment));
    lines.reference.sigmas.push_back(line.sigma_px / focal);
    for (ViewLines& view : lines.views) {
      view.segments.emplace_back();
      view.sigmas.push_back(0);
    }
    for (const InitialObservation& o : std::span(track).subspan(1)) {
      const std::size_t i = Index(o.view - 1);
      const LineFeature& seen =
          frames_[Index(frames[i])].frame.indexed->features.lines[Index(o.feature)];
      lines.views[i].segments.back() = ideal(seen.segment);
      lines.views[i].sigmas.back() = seen.sigma_px / focal;
    }
  }
  return lines;
}

std::vector<FeatureTrack> InitializationWindow::PointObservations(
    const std::vector<int>& frames) const {
  const std::size_t size = reference_->indexed->features.points.size();
  std::vector<FeatureTrack> tracks(size);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const MatchedFrame& seen = frames_[Index(frames[i])];
    const std::vector<int> nearest =
        NearestFeatures(*seen.frame.indexed, seen.Pixels(), kAttachRadiusPx);
    for (std::size_t k = 0; k < size; ++k) {
      if (nearest[k] < 0) continue;
      if (tracks[k].empty()) tracks[k].push_back({0, static_cast<int>(k)});
      tracks[k].push_back({static_cast<int>(i) + 1, nearest[k], seen.places[k].px});
    }
  }
  std::erase_if(tracks, [](const FeatureTrack& track) { return track.empty(); });
  return tracks;
}

std::vector<FeatureTrack> InitializationWindow::LineObservations(
    const std::vector<int>& frames) const {
  std::vector<FeatureTrack> tracks(reference_->indexed->features.lines.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const FeatureMatch& match : frames_[Index(frames[i])].matches.lines) {
      FeatureTrack& track = tracks[Index(match.a)];
      if (track.empty()) track.push_back({0, match.a});
      track.push_back({static_cast<int>(i) + 1, match.b});
    }
  }
  std::erase_if(tracks, [](const FeatureTrack& track) { return track.empty(); });
  return tracks;
}

}  // namespace plumbline
