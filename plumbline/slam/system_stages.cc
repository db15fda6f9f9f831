// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/system_stages.h"

namespace plumbline {
namespace {

// A live run that lost the camera looks for it in its map for at least this long before it starts
// another map, since the next frames may show known surroundings again.
constexpr double kLivePatienceSeconds = 1;

LossPatience PatienceOf(const SlamOptions& options) {
  return {options.slam.mode == RunMode::kLive ? kLivePatienceSeconds : 0,
          options.relocalization.enabled ? options.relocalization.patience : 0};
}

}  // namespace

Rigid3 WorldFromFirstCamera(const Rectifier& rectifier) {
  return {rectifier.rectified_left_from_left().conjugate(), Eigen::Vector3d::Zero()};
}

SystemStages::SystemStages(const Calibration& calibration,
                           const SlamOptions& options,
                           const Execution& execution,
                           const SystemMethods& methods)
    : front_end(calibration, options.features),
      imaging{front_end.rectifier().camera(), options.features.orb.scale_factor},
      mapping(imaging, options, execution, methods),
      tracker(imaging,
              options.tracking,
              methods.MakePoseEstimator(imaging.camera, options),
              WorldFromFirstCamera(front_end.rectifier()),
              PatienceOf(options)),
      relocalizer(imaging, options.tracking, methods.MakePoseEstimator(imaging.camera, options)) {}

}  // namespace plumbline
