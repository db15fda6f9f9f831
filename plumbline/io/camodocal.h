// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/io/yaml_section.h"

namespace plumbline {

// Reads the camera of a CamOdoCal file, as used by VINS-Mono and VINS-Fusion:
//
//   image_width, image_height
//   model_type: PINHOLE         projection_parameters fx fy cx cy,
//                               distortion_parameters k1 k2 p1 p2
//   model_type: KANNALA_BRANDT  projection_parameters mu mv u0 v0, k2 k3 k4 k5
//                               (equidistant k1 to k4)
//
// rate_hz and depth_factor may be added. Throws InputError naming the key, also for MEI and
// SCARAMUZZA, which have another projection.
Calibration ReadCamodocal(const YamlSection& root);

}  // namespace plumbline
