// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/starts/start_truth.h"
#include "plumbline/image/rectify.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/slam/front_end.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace plumbline {

// Ground truth of a recorded or rendered sequence that is also read as monocular.
//
// Poses are those of the ground truth, or others if given, interpolated over gaps as wide as
// ErrorOptionsFor allows for the data. Depth comes from the best source: exact depth images of a
// rendered world (mav0/depth0), those of an RGB-D sensor, or the points of the sequence's own
// stereo pairs, measured in each frame by itself with a deviation of 0.2 px at best.
class SequenceTruth : public StartTruth {
 public:
  //   mono       the sequence as monocular, which defines the frame numbers; must outlive this
  //   rectifier  of its images
  //   camera     as DatasetOptions::camera
  //   poses      of the camera as delivered, replacing the ground truth; nullopt: the ground truth
  // Throws InputError if the sequence cannot be opened.
  SequenceTruth(const Dataset& mono,
                const Rectifier& rectifier,
                const std::optional<std::string>& camera,
                const std::optional<Trajectory>& poses = std::nullopt);

  std::optional<Rigid3> WorldFromCamera(int frame) const override;
  // Decodes and, of a stereo pair, measures: up to some 100 ms.
  std::shared_ptr<const TrueDepth> DepthAt(int frame) const override;

  bool has_poses() const { return !poses_.empty(); }
  bool has_depth() const { return depth_factor_ || metric_; }

 private:
  void OpenDepthImages(const std::filesystem::path& folder);
  std::shared_ptr<const TrueDepth> DepthFromImage(DepthImage depth) const;
  std::shared_ptr<const TrueDepth> DepthFromStereo(SensorFrame frame) const;

  const Dataset& mono_;
  RectifiedCamera camera_;
  Eigen::Quaterniond rectified_from_raw_;
  Trajectory poses_;  // of the camera as delivered
  std::int64_t max_gap_ns_;
  std::map<std::int64_t, std::filesystem::path> depth_images_;
  std::optional<double> depth_factor_;  // of depth_images_
  std::unique_ptr<Dataset> metric_;     // the sequence as RGB-D or stereo; null: neither
  std::map<std::int64_t, std::size_t> metric_frames_;
  std::unique_ptr<FrontEnd> stereo_;  // of metric_ as stereo
};

}  // namespace plumbline
