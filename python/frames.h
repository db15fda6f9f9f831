// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <memory>

namespace plumbline::python {

// The images of one instant. Immutable, so that arrays may refer to it.
struct PyFrame {
  SensorFrame images;
};

}  // namespace plumbline::python
