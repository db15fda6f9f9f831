// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/se3.h"

#include <string>

namespace plumbline {

// How a stored image is turned before it is used: rows and columns are exchanged where `transpose`
// is set, and the result is mirrored left to right (`flip_x`) and top to bottom (`flip_y`). These
// are the eight orientations of EXIF.
struct Orientation {
  bool transpose = false, flip_x = false, flip_y = false;

  // Whether images stay as they are.
  bool IsIdentity() const { return !transpose && !flip_x && !flip_y; }
  // Whether it is no rotation: left and right are exchanged.
  bool Mirrors() const { return transpose != (flip_x != flip_y); }

  friend bool operator==(const Orientation&, const Orientation&) = default;
};

// Returns the orientation of a number of EXIF, 1 to 8; other numbers count as 1, as stored.
Orientation OrientationOfExif(int number);
// Returns the orientation that turns images clockwise, by a multiple of 90 degrees.
Orientation ClockwiseTurn(int degrees);
// Returns the orientation that undoes another one.
Orientation Inverse(const Orientation& orientation);
// Returns "turned by 90 degrees clockwise", "mirrored" or both; "as stored" for the identity.
std::string Describe(const Orientation& orientation);

// Returns the rotation about the optical axis from the camera of the stored image to that of the
// turned one. The orientation must not mirror (BugError).
Rigid3 TurnedFromStored(const Orientation& orientation);

// Returns the camera whose images are those of another one, turned: what it projects to a pixel is
// what the other one projects to the pixel that is turned there. Lens distortion turns, too.
Camera Turned(const Camera& camera, const Orientation& orientation);
// Returns the calibration of one camera, or of one with depth, whose images are turned. The camera
// frame turns with the image, so that body_from_left changes; of an image that is mirrored, it
// stays. A pair of cameras must not be turned (BugError): its cameras would not lie side by side.
Calibration Turned(Calibration calibration, const Orientation& orientation);

}  // namespace plumbline
