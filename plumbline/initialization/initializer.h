// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/inertial/gyroscope.h"
#include "plumbline/initialization/initial_map.h"
#include "plumbline/initialization/options.h"

#include <array>
#include <optional>
#include <type_traits>
#include <utility>

namespace plumbline {

// Reason why there is no initial map yet.
enum class InitializationStatus {
  kNone,
  kTooFewFeatures,     // this image has too few features
  kTooFewFrames,       // the window is not full
  kTooFewMatches,      // too few matches with the reference frame
  kTooLittleParallax,  // the camera stands still, or only turns
  kAmbiguous,          // two interpretations explain the frames equally well
  kInaccurate,         // the structure is not accurate enough, or does not fit
};
constexpr auto EnumNames(std::type_identity<InitializationStatus>) {
  return std::array{std::pair{InitializationStatus::kNone, ""},
                    std::pair{InitializationStatus::kTooFewFeatures, "too_few_features"},
                    std::pair{InitializationStatus::kTooFewFrames, "too_few_frames"},
                    std::pair{InitializationStatus::kTooFewMatches, "too_few_matches"},
                    std::pair{InitializationStatus::kTooLittleParallax, "too_little_parallax"},
                    std::pair{InitializationStatus::kAmbiguous, "ambiguous"},
                    std::pair{InitializationStatus::kInaccurate, "inaccurate"}};
}

// Counts of the steps of initialization, whichever map resulted.
struct InitializationCounts {
  int aligned_images = 0;    // images in which the reference's points were tracked and aligned
  int model_selections = 0;  // decisions between models over several frames (SelectModel)
  int pairwise_poses = 0;    // poses of single frames (EstimatePairwisePose)
  int pairwise_factorizations = 0;  // factorizations of such poses (FactorizePairwise)
  int interpolated_places = 0;      // positions interpolated for these
  int two_view_solutions = 0;       // decisions between a homography and an essential matrix
};

struct InitializationResult {
  InitializationStatus wait = InitializationStatus::kNone;  // kNone if there is a map
  int matches = 0;  // points matched with the reference frame
  // Median angle between the rays of matches, without the camera's rotation; 0 if unknown.
  double parallax_deg = 0;
  std::optional<InitialMap> map = std::nullopt;
};

// Starts a monocular map from a sequence of frames: offer frames in order until one gives a map.
// While the frames are ambiguous, it waits rather than returns a bad map.
class Initializer {
 public:
  virtual ~Initializer() = default;
  virtual InitializationResult Add(const InitializationFrame& frame) = 0;
  // Discards all frames: after a loss, or after a map was started.
  virtual void Reset() = 0;

  // Lets a gyroscope take part in the decision; it must outlive this object.
  void Use(const Gyroscope& gyroscope) { gyroscope_ = &gyroscope; }

  // Counts of all steps so far.
  const InitializationCounts& counts() const { return counts_; }

 protected:
  InitializationCounts counts_;
  const Gyroscope* gyroscope_ = nullptr;  // null if there is none
};

}  // namespace plumbline
