// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/image/image.h"
#include "plumbline/initialization/options.h"
#include "plumbline/map/frame.h"
#include "plumbline/map/state_stream.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Why there is no initial map yet.
enum class InitializationWait {
  kNone,
  kTooFewFeatures,     // in this image
  kTooFewFrames,       // the window is not full
  kTooFewMatches,      // with the reference frame
  kTooLittleParallax,  // still, or turning only
  kAmbiguous,          // two interpretations explain the frames equally well
  kInaccurate,         // the structure is not known well enough, or does not fit
};
constexpr auto EnumNames(std::type_identity<InitializationWait>) {
  return std::array{std::pair{InitializationWait::kNone, ""},
                    std::pair{InitializationWait::kTooFewFeatures, "too_few_features"},
                    std::pair{InitializationWait::kTooFewFrames, "too_few_frames"},
                    std::pair{InitializationWait::kTooFewMatches, "too_few_matches"},
                    std::pair{InitializationWait::kTooLittleParallax, "too_little_parallax"},
                    std::pair{InitializationWait::kAmbiguous, "ambiguous"},
                    std::pair{InitializationWait::kInaccurate, "inaccurate"}};
}

// A frame offered for the start of a map. The image is needed by rank1_klt, by two_view_images and
// by rank1 unless it matches by descriptor.
struct InitializationFrame {
  FrameId id;
  std::int64_t stamp_ns = 0;
  std::shared_ptr<const IndexedFeatures> indexed;
  std::shared_ptr<const GrayImage> image;
};

// The feature of a view (an index into InitialMap::views) that shows a landmark.
struct InitialObservation {
  int view = 0;
  int feature = 0;
  // Where the view shows a point when that is known better than its feature says, pixels.
  std::optional<Eigen::Vector2d> px = std::nullopt;
};
struct InitialPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world
  std::vector<InitialObservation> observations;        // at least two, by view
};
struct InitialLine {
  PluckerLine line;                              // world; directed as its features
  Segment3 segment;                              // the part that was seen
  std::vector<InitialObservation> observations;  // at least two, by view
};
struct InitialView {
  InitializationFrame frame;
  Rigid3 cam_from_world;
};

// The start of a monocular map. The world is the first view's camera; its scale is such that the
// median depth of the points there is 1.
struct InitialMap {
  std::vector<InitialView> views;  // by time; the first is the reference, the last the newest frame
  std::vector<InitialPoint> points;
  std::vector<InitialLine> lines;
};

struct InitializationResult {
  InitializationWait wait = InitializationWait::kNone;  // kNone: there is a map
  int matches = 0;                                      // points matched with the reference frame
  double parallax_deg = 0;                              // median, after rotation; 0 where unknown
  std::optional<InitialMap> map;

  // No map yet, and why.
  static InitializationResult Wait(InitializationWait reason) {
    return {.wait = reason, .map = std::nullopt};
  }
};

// Starts a monocular map from a sequence of frames: offer frames in order until one gives a map.
// Never a bad map: while the frames do not decide, the answer is to wait.
class Initializer {
 public:
  virtual ~Initializer() = default;
  virtual InitializationResult Add(const InitializationFrame& frame) = 0;
  // Forgets all frames: after a loss, or when a map was taken.
  virtual void Reset() = 0;

  // Writes down all frames and what is known of them, and takes the place of an initializer of the
  // same options that did. Load throws InputError for bytes that no initializer wrote.
  virtual void Save(StateWriter& archive) const = 0;
  virtual void Load(StateReader& archive) = 0;
};

}  // namespace plumbline
