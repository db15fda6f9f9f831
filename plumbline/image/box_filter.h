// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

namespace plumbline {

// Returns the mean over a size x size window around each pixel; border pixels are repeated. size >=
// 1; 1 changes nothing.
GrayImage BoxFiltered(const GrayImage& image, int size);

}  // namespace plumbline
