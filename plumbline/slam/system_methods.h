// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"
#include "plumbline/initialization/make_initializer.h"
#include "plumbline/line_cutting/cut_lines.h"
#include "plumbline/matching/line_method.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/pose_estimation.h"
#include "plumbline/tracking/projected_matches.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace plumbline {

// The functions behind the options that name a method. By default they are the product's. A program
// that has more methods gives System its own functions, which call the product's for the product's
// methods, and the names that they add (docs/adr/0031-one-method-of-lines.md):
//
//   OptionTable table(options, methods.added);
//   ...
//   System system(calibration, options, {}, methods);
//
// The functions have no state and are called in any thread.
struct SystemMethods {
  std::vector<AddedMethod> added = {};
  // Makes the initializer of a run with one camera (initialization.method).
  decltype(&MakeInitializer) make_initializer = MakeInitializer;
  // Returns the functions for lines.residual and lines.reconstruction.
  decltype(&ProductLineMethod) line_method = ProductLineMethod;
  // Chooses the features that decide about a pose (cutting.method other than none).
  decltype(&ChooseAll) choose_features = ChooseAll;

  LineSettings Lines(const LineOptions& options) const { return {options, line_method(options)}; }
  PoseEstimator MakePoseEstimator(const RectifiedCamera& camera, const SlamOptions& options) const {
    return {camera, Lines(options.lines), {options.cutting, choose_features}};
  }
};

// CheckOptions of options that may name these methods.
void CheckOptions(const SlamOptions& options, const SystemMethods& methods);

}  // namespace plumbline
