// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/camera.h"
#include "plumbline/image/image.h"

namespace plumbline {

// What is in images but no part of a world, drawn over them: it casts no shadow.

// Draws a line of letters into the lower left corner, the same in all images.
void DrawText(GrayImage& image);
// Returns a mask of images of this size: black where DrawText draws, white elsewhere.
GrayImage TextMask(int width, int height);

// A person who walks by, 2.5 m before the camera, from left to right within four seconds of every
// eight: in half of the images.
struct Person {
  double time = 0;      // of the image, seconds
  double shift_px = 0;  // to the left: the disparity of the right camera
};

// Draws the person; nothing while nobody walks by.
void DrawPerson(const Camera& camera, const Person& person, GrayImage& image);
// Returns the mask of DrawPerson: black where it draws, white elsewhere.
GrayImage PersonMask(const Camera& camera, const Person& person);

}  // namespace plumbline
