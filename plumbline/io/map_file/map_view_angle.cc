// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file/map_view_angle.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/units.h"
#include "plumbline/image/rectify.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plumbline {
namespace {

bool GivesCamera(const Calibration& calibration, RectifiedCamera of_map) {
  const RectifiedCamera camera = Rectifier(calibration).camera();
  of_map.baseline = camera.baseline;
  return !CameraDifference({camera}, {of_map});
}

}  // namespace

std::optional<double> ViewAngleOfMap(const RectifiedCamera& of_map,
                                     const Calibration& calibration) {
  if (GivesCamera(calibration, of_map)) return std::nullopt;
  // The side that the lens does not limit reaches to half of the angle, but for a pixel.
  const double farthest = std::max(std::max(of_map.cx, of_map.width - 1 - of_map.cx) / of_map.fx,
                                   std::max(of_map.cy, of_map.height - 1 - of_map.cy) / of_map.fy);
  const double angle = std::round(2 * math::Atan(farthest) / kDegree);
  Calibration cut = calibration;
  for (const double degrees : {angle, angle + 1}) {
    cut.view_angle_deg = degrees;
    if (!CalibrationFault(cut) && GivesCamera(cut, of_map)) return degrees;
  }
  return std::nullopt;
}

std::optional<std::string> ViewAngleDifference(const RectifiedCamera& of_map,
                                               Calibration calibration) {
  if (!calibration.view_angle_deg || GivesCamera(calibration, of_map)) return std::nullopt;
  const double angle = *calibration.view_angle_deg;
  calibration.view_angle_deg.reset();
  if (GivesCamera(calibration, of_map)) {
    return fmt::format("images cut out as by default and with a view angle of {:g} degrees", angle);
  }
  const std::optional<double> of_run = ViewAngleOfMap(of_map, calibration);
  if (!of_run) return std::nullopt;
  return fmt::format("view angles of {:g} and {:g} degrees", *of_run, angle);
}

}  // namespace plumbline
