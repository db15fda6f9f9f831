// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/starts/true_depth.h"
#include "plumbline/geometry/se3.h"

#include <memory>
#include <optional>

namespace plumbline {

// Ground truth of a sequence, beside the images given to an initializer.
class StartTruth {
 public:
  virtual ~StartTruth() = default;
  // Pose of the rectified camera; nullopt: unknown.
  virtual std::optional<Rigid3> WorldFromCamera(int frame) const = 0;
  // nullptr: unknown.
  virtual std::shared_ptr<const TrueDepth> DepthAt(int frame) const = 0;
};

}  // namespace plumbline
