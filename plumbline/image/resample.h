// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/image/image.h"

#include <cstddef>
#include <string>

namespace plumbline {

// Orientation of a stored image: rows and columns are exchanged if `transpose` is set, then the
// result is mirrored left to right (`flip_x`) and top to bottom (`flip_y`). These are the eight
// orientations of EXIF.
struct Orientation {
  bool transpose = false, flip_x = false, flip_y = false;

  // Returns true if images stay unchanged.
  bool IsIdentity() const { return !transpose && !flip_x && !flip_y; }
  // Returns true for a reflection: it exchanges left and right.
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

// Returns the camera of the turned images: a point projects to the turned pixel of its projection
// in `camera`. The lens distortion turns, too.
Camera Turned(const Camera& camera, const Orientation& orientation);
// Returns the calibration of one camera, or of one with depth, whose images are turned. The camera
// frame turns with the image, so that body_from_left changes; for a mirrored image it stays. Throws
// BugError for a pair of cameras: they would not stand side by side.
Calibration Turned(Calibration calibration, const Orientation& orientation);

// Returns an image turned.
template <class T>
Image<T> Turned(const Image<T>& image, const Orientation& orientation) {
  const bool transpose = orientation.transpose;
  Image<T> turned(transpose ? image.height() : image.width(),
                  transpose ? image.width() : image.height());
  const std::ptrdiff_t step_x = transpose ? image.width() : 1;
  const std::ptrdiff_t step_y = transpose ? 1 : image.width();
  for (int y = 0; y < turned.height(); ++y) {
    const int from_y = orientation.flip_y ? turned.height() - 1 - y : y;
    const T* from = image.data() + from_y * step_y;
    T* to = turned.row(y);
    for (int x = 0; x < turned.width(); ++x) {
      to[x] = from[step_x * (orientation.flip_x ? turned.width() - 1 - x : x)];
    }
  }
  return turned;
}

// Returns an image reduced to another size, at most that of `image`, by area averaging: each pixel
// is the mean over its area in `image`, rounded to the nearest level; the same bytes on every
// processor. O(pixels).
GrayImage AreaAveraged(const GrayImage& image, int width, int height);

// Returns an image resized by nearest neighbours: values on both sides of an edge are not mixed.
DepthImage NearestPixels(const DepthImage& image, int width, int height);

}  // namespace plumbline
