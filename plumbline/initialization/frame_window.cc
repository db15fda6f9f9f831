// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/initialization/frame_window.h"

#include "plumbline/base/error.h"
#include "plumbline/initialization/match_refinement.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace plumbline {
namespace {

constexpr std::size_t kMaxFrames = 40;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

// Tracks of all features of the reference that any of the frames matched.
template <class MatchesOf>
std::vector<FeatureTrack> CollectTracks(std::size_t features,
                                        std::size_t frames,
                                        const MatchesOf& matches_of) {
  std::vector<FeatureTrack> by_feature(features);
  for (std::size_t i = 0; i < frames; ++i) {
    for (const auto& match : matches_of(i)) {
      FeatureTrack& track = by_feature[Index(match.a)];
      if (track.empty()) track.push_back({0, match.a});
      track.push_back({static_cast<int>(i) + 1, match.b});
    }
  }
  std::erase_if(by_feature, [](const FeatureTrack& track) { return track.empty(); });
  return by_feature;
}

// At most `count` of the tracks: round after round the best that is left in each cell of the image,
// those that the newest frame shows first, then by the number of frames, then by the noise.
std::vector<FeatureTrack> SpreadTracks(const RectifiedCamera& camera,
                                       std::vector<FeatureTrack> tracks,
                                       const std::vector<PointFeature>& reference,
                                       int newest,
                                       int count) {
  if (static_cast<int>(tracks.size()) <= count) return tracks;
  constexpr int kColumns = 8;
  constexpr int kRows = 6;
  std::array<std::vector<std::size_t>, kColumns * kRows> cells;
  const auto feature = [&](std::size_t k) -> const PointFeature& {
    return reference[Index(tracks[k].front().feature)];
  };
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const Eigen::Vector2d& px = feature(k).px;
    const int column =
        std::clamp(static_cast<int>(px.x() / camera.width * kColumns), 0, kColumns - 1);
    const int row = std::clamp(static_cast<int>(px.y() / camera.height * kRows), 0, kRows - 1);
    cells[Index(row * kColumns + column)].push_back(k);
  }
  for (auto& cell : cells) {
    std::stable_sort(cell.begin(), cell.end(), [&](std::size_t a, std::size_t b) {
      const bool a_newest = tracks[a].back().view == newest;
      const bool b_newest = tracks[b].back().view == newest;
      if (a_newest != b_newest) return a_newest;
      if (tracks[a].size() != tracks[b].size()) return tracks[a].size() > tracks[b].size();
      return feature(a).sigma_px < feature(b).sigma_px;
    });
  }
  std::vector<std::size_t> chosen;
  for (std::size_t round = 0; chosen.size() < Index(count); ++round) {
    for (const auto& cell : cells) {
      if (round < cell.size() && chosen.size() < Index(count)) chosen.push_back(cell[round]);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<FeatureTrack> result;
  for (const std::size_t k : chosen) result.push_back(std::move(tracks[k]));
  return result;
}

// The places of a frame's points: those that are matched, refined. Matches that cannot be are left
// out.
void Refine(const InitializationFrame& reference,
            const InitializationFrame& frame,
            ReferenceMatches& matches,
            std::vector<Eigen::Vector2d>& places) {
  PLUMBLINE_CHECK(reference.image && frame.image, "refinement works on images");
  const Features& features = frame.indexed->features;
  const auto refined = RefineMatches(*reference.image,
                                     reference.indexed->features,
                                     *frame.image,
                                     features,
                                     matches.points,
                                     matches.motion.linear());
  std::vector<PointMatch> kept;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (!refined[i]) continue;
    kept.push_back(matches.points[i]);
    places[Index(matches.points[i].b)] = *refined[i];
  }
  matches.points = std::move(kept);
}

}  // namespace

void FrameWindow::Reset() {
  reference_.reset();
  frames_.clear();
}

int FrameWindow::Add(const InitializationFrame& frame) {
  if (!reference_) {
    reference_ = frame;
    return 0;
  }
  const ImageMotion guess = frames_.empty() ? ImageMotion{} : frames_.back().matches.motion;
  ReferenceMatches matches =
      MatchToReference(reference_->indexed->features, frame.indexed->features, guess);
  std::vector<Eigen::Vector2d> places;
  for (const PointFeature& point : frame.indexed->features.points) places.push_back(point.px);
  if (refine_) Refine(*reference_, frame, matches, places);
  const int count = static_cast<int>(matches.points.size());
  if (frames_.size() >= kMaxFrames) {
    std::vector<Matched> kept;
    for (std::size_t i = 1; i < frames_.size(); i += 2) kept.push_back(std::move(frames_[i]));
    frames_ = std::move(kept);
  }
  frames_.push_back({frame, std::move(matches), std::move(places)});
  return count;
}

void FrameWindow::MoveReference() {
  PLUMBLINE_CHECK(!frames_.empty(), "no frame to move to");
  std::vector<Matched> old = std::exchange(frames_, {});
  const std::size_t middle = (old.size() - 1) / 2;
  reference_ = old[middle].frame;
  for (std::size_t i = middle + 1; i < old.size(); ++i) Add(old[i].frame);
}

std::vector<int> FrameWindow::Spread(int count) const {
  const int chosen = std::min(count, size());
  std::vector<int> frames;
  for (int j = 1; j <= chosen; ++j) frames.push_back((j * size() + chosen / 2) / chosen - 1);
  return frames;
}

WindowTracks FrameWindow::TracksOf(const std::vector<int>& frames, int max_points) const {
  const std::vector<PointFeature>& reference = reference_->indexed->features.points;
  const std::vector<FeatureTrack> features = SpreadTracks(
      camera_, PointTracks(frames), reference, static_cast<int>(frames.size()), max_points);
  const double focal = 0.5 * (camera_.fx + camera_.fy);
  const auto set =
      [&](const Eigen::Vector2d& px, double sigma_px, TrackedPoints& points, std::size_t k) {
        points.points[k] = camera_.Unproject(px).hnormalized();
        points.sigmas[k] = sigma_px / focal;
      };
  const TrackedPoints empty{std::vector<Eigen::Vector2d>(features.size(), Eigen::Vector2d::Zero()),
                            std::vector<double>(features.size(), 0)};
  WindowTracks tracks{empty, std::vector<TrackedPoints>(frames.size(), empty), {}};
  for (std::size_t k = 0; k < features.size(); ++k) {
    tracks.features.push_back(features[k].front().feature);
    const PointFeature& in_reference = reference[Index(tracks.features.back())];
    set(in_reference.px, in_reference.sigma_px, tracks.reference, k);
    for (const InitialObservation& o : std::span(features[k]).subspan(1)) {
      const std::size_t view = Index(o.view - 1);
      const Matched& seen = frames_[Index(frames[view])];
      const std::size_t feature = Index(o.feature);
      const double sigma = seen.frame.indexed->features.points[feature].sigma_px;
      set(seen.places[feature], sigma, tracks.views[view], k);
    }
  }
  return tracks;
}

std::vector<FeatureTrack> FrameWindow::PointTracks(const std::vector<int>& frames) const {
  return CollectTracks(
      reference_->indexed->features.points.size(),
      frames.size(),
      [&](std::size_t i) -> const auto& { return frames_[Index(frames[i])].matches.points; });
}

std::vector<FeatureTrack> FrameWindow::LineTracks(const std::vector<int>& frames) const {
  return CollectTracks(
      reference_->indexed->features.lines.size(), frames.size(), [&](std::size_t i) -> const auto& {
        return frames_[Index(frames[i])].matches.lines;
      });
}

}  // namespace plumbline
