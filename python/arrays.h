// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/plucker.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/geometry/segment.h"
#include "plumbline/image/image.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

// Conversion between numpy arrays and values of the library. Input is checked and copied, and may
// be freed by the caller at once; output is a new array, or a view that keeps its owner alive.
namespace plumbline::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style>;
using Integers = py::array_t<std::int64_t, py::array::c_style>;

// Any length of a dimension in a shape.
inline constexpr py::ssize_t kAny = -1;
using Shape = std::vector<py::ssize_t>;

// Value of missing numbers in arrays.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

enum class Numbers { kFinite, kAnyValue };

// Returns a description for messages: "array of float32 of shape (3, 4)", "list".
std::string Describe(py::handle value);

// Returns a copy, row by row, of an array (or list) of real numbers of any byte order and memory
// order. Throws InputError "points: expected numbers of shape (N, 3), found ..." for another shape,
// for anything but numbers, and for NaN and infinity if only finite numbers are valid.
Doubles ReadDoubles(py::handle value,
                    const char* name,
                    const Shape& shape,
                    Numbers numbers = Numbers::kFinite);
// The same for whole numbers from 0 to below `limit`.
std::vector<int> ReadIndices(py::handle value, const char* name, std::size_t limit);

// Returns `count` numbers, each greater than 0: from one for all, or from `count` of them.
std::vector<double> ReadSigmas(py::handle value, const char* name, std::size_t count);

std::vector<Eigen::Vector2d> ReadVectors2(py::handle value, const char* name);
std::vector<Eigen::Vector3d> ReadVectors3(py::handle value, const char* name);
std::vector<Segment2> ReadSegments2(py::handle value, const char* name);  // (N, 2, 2)
std::vector<Segment3> ReadSegments3(py::handle value, const char* name);  // (N, 2, 3)
// (N, 6), moment and direction; scaled to |direction| = 1, which must not be 0 and at right angles
// to the moment.
std::vector<PluckerLine> ReadPluckerLines(py::handle value, const char* name);
Eigen::Quaterniond ReadRotation(py::handle value, const char* name);  // (3, 3)
Rigid3 ReadPose(py::handle value, const char* name);                  // (4, 4)
std::vector<Rigid3> ReadPoses(py::handle value, const char* name);    // (N, 4, 4)
void CheckCount(const char* name, std::size_t expected, std::size_t found);

// 8 bits, (rows, columns), not empty.
GrayImage ReadGray(py::handle value, const char* name);
// Floating point numbers in metres, or 16-bit whole numbers divided by `factor`; 0, NaN, infinity
// and negative numbers mean no measurement.
DepthImage ReadDepth(py::handle value, const char* name, std::optional<double> factor);

// New arrays.
Doubles ToArray(const Eigen::Ref<const Eigen::MatrixXd>& matrix);  // two-dimensional
Doubles ToArray(const std::vector<double>& values);
Doubles ToArray(const std::vector<Eigen::Vector2d>& rows);
Doubles ToArray(const std::vector<Eigen::Vector3d>& rows);
Doubles ToArray(const std::vector<Segment3>& segments);  // (N, 2, 3)
Doubles ToArray(const std::vector<PluckerLine>& lines);  // (N, 6)
Doubles ToArray(const std::vector<Rigid3>& poses);       // (N, 4, 4)
Doubles ToArray(const Rigid3& pose);                     // (4, 4)
Integers ToArray(const std::vector<std::int64_t>& values);
py::array_t<bool> ToArray(const std::vector<bool>& values);

// The same array, not writable.
py::array ReadOnly(py::array array);

// The pixels themselves, not writable; `owner` is kept alive as long as the array.
template <class T>
py::array View(const Image<T>& image, py::handle owner) {
  return ReadOnly(py::array_t<T>({image.height(), image.width()}, image.data(), owner));
}

}  // namespace plumbline::python
