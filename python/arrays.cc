// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include "plumbline/base/error.h"

#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace plumbline::python {
namespace {

std::string ShapeText(const Shape& shape) {
  std::string text;
  for (const py::ssize_t side : shape) {
    text += (text.empty() ? "" : ", ") + (side == kAny ? std::string("N") : std::to_string(side));
  }
  return "(" + text + (shape.size() == 1 ? ",)" : ")");
}

[[noreturn]] void Fail(const char* name, const std::string& expected, py::handle found) {
  throw InputError(fmt::format("{}: expected {}, found {}", name, expected, Describe(found)));
}

// Converts a value to a numpy array; only lists are converted.
py::array AsArray(py::handle value, const char* name, const std::string& expected) {
  if (value.is_none() || py::isinstance<py::str>(value)) Fail(name, expected, value);
  py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
    Fail(name, expected, value);
  }
  return array;
}

bool Fits(const py::array& array, const Shape& shape) {
  if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (shape[i] != kAny && array.shape(static_cast<py::ssize_t>(i)) != shape[i]) return false;
  }
  return true;
}

std::string PlaceText(const py::array& array, py::ssize_t index) {
  std::string text;
  for (py::ssize_t axis = array.ndim() - 1; axis >= 0; --axis) {
    const std::string at = std::to_string(index % array.shape(axis));
    text = text.empty() ? at : at + ", " + text;
    index /= array.shape(axis);
  }
  return "[" + text + "]";
}

void CheckFinite(const Doubles& array, const char* name) {
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    const double value = array.data()[i];
    if (std::isfinite(value)) continue;
    throw InputError(fmt::format(
        "{}: expected finite numbers, found {} at {}", name, value, PlaceText(array, i)));
  }
}

template <class Vector>
std::vector<Vector> ReadVectors(py::handle value, const char* name) {
  constexpr auto kSize = static_cast<py::ssize_t>(Vector::RowsAtCompileTime);
  const Doubles array = ReadDoubles(value, name, {kAny, kSize});
  std::vector<Vector> vectors;
  vectors.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) vectors.push_back(Vector(array.data(i)));
  return vectors;
}

template <int kDim>
std::vector<Segment<kDim>> ReadSegments(py::handle value, const char* name) {
  const Doubles array = ReadDoubles(value, name, {kAny, 2, kDim});
  std::vector<Segment<kDim>> segments(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double* row = array.data(static_cast<py::ssize_t>(i));
    using Vector = typename Segment<kDim>::Vector;
    segments[i] = {Vector(row), Vector(row + kDim)};
    if (segments[i].Length() > 0) continue;
    throw InputError(
        fmt::format("{}: expected segments of some length, found none at [{}]", name, i));
  }
  return segments;
}

template <class Row>
Doubles FromRows(const std::vector<Row>& rows, const Shape& row_shape) {
  Shape shape = {static_cast<py::ssize_t>(rows.size())};
  shape.insert(shape.end(), row_shape.begin(), row_shape.end());
  Doubles array(shape);
  double* out = array.mutable_data();
  for (const Row& row : rows) {
    std::memcpy(out, row.data(), static_cast<std::size_t>(row.size()) * sizeof(double));
    out += row.size();
  }
  return array;
}

Eigen::Quaterniond RotationOf(const Eigen::Matrix3d& matrix, const char* name) {
  constexpr double kTolerance = 1e-6;
  const double off = (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (off > kTolerance || matrix.determinant() < 0) {
    throw InputError(fmt::format(
        "{}: expected a rotation (to {}), found a matrix that is off by {:.3g}, determinant {:.3g}",
        name,
        kTolerance,
        off,
        matrix.determinant()));
  }
  return Eigen::Quaterniond(matrix).normalized();
}

Rigid3 PoseOf(const double* numbers, const char* name) {
  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  const Eigen::Map<const Matrix> matrix(numbers);
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw InputError(fmt::format("{}: expected the last row (0, 0, 0, 1), found ({}, {}, {}, {})",
                                 name,
                                 matrix(3, 0),
                                 matrix(3, 1),
                                 matrix(3, 2),
                                 matrix(3, 3)));
  }
  return {RotationOf(matrix.topLeftCorner<3, 3>(), name), matrix.topRightCorner<3, 1>()};
}

// Returns true for one number: of Python or of numpy, or an array without axes.
bool IsScalar(py::handle value) {
  return py::isinstance<py::float_>(value) || py::isinstance<py::int_>(value) ||
         (py::hasattr(value, "ndim") && value.attr("ndim").cast<int>() == 0);
}

}  // namespace

std::string Describe(py::handle value) {
  if (!py::isinstance<py::array>(value)) {
    return py::str(py::type::handle_of(value).attr("__name__")).cast<std::string>();
  }
  const auto array = py::reinterpret_borrow<py::array>(value);
  const Shape shape(array.shape(), array.shape() + array.ndim());
  return fmt::format("an array of {} of shape {}",
                     py::str(static_cast<py::object>(array.dtype())).cast<std::string>(),
                     ShapeText(shape));
}

Doubles ReadDoubles(py::handle value, const char* name, const Shape& shape, Numbers numbers) {
  const std::string expected = "numbers of shape " + ShapeText(shape);
  const py::array array = AsArray(value, name, expected);
  // An empty list has no shape to tell.
  if (array.size() == 0 && array.ndim() == 1 && shape.size() > 1 && shape.front() == kAny) {
    Shape empty = shape;
    for (py::ssize_t& side : empty) side = side == kAny ? 0 : side;
    return Doubles(empty);
  }
  const char kind = array.dtype().kind();
  if (!Fits(array, shape) || (kind != 'f' && kind != 'i' && kind != 'u')) {
    Fail(name, expected, array);
  }
  Doubles doubles = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!doubles) throw py::error_already_set();
  if (numbers == Numbers::kFinite) CheckFinite(doubles, name);
  return doubles;
}

std::vector<int> ReadIndices(py::handle value, const char* name, std::size_t limit) {
  const std::string expected = "whole numbers of shape (N,)";
  const py::array array = AsArray(value, name, expected);
  if (array.size() == 0 && array.ndim() == 1) return {};
  const char kind = array.dtype().kind();
  if (array.ndim() != 1 || (kind != 'i' && kind != 'u')) Fail(name, expected, array);
  const auto integers =
      py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(array);
  std::vector<int> indices;
  indices.reserve(static_cast<std::size_t>(integers.size()));
  for (py::ssize_t i = 0; i < integers.size(); ++i) {
    const std::int64_t index = integers.data()[i];
    if (index < 0 || index >= static_cast<std::int64_t>(limit)) {
      throw InputError(
          fmt::format("{}: expected whole numbers from 0 to below {}, found {} at [{}]",
                      name,
                      limit,
                      index,
                      i));
    }
    indices.push_back(static_cast<int>(index));
  }
  return indices;
}

std::vector<double> ReadSigmas(py::handle value, const char* name, std::size_t count) {
  std::vector<double> sigmas;
  const Doubles array = ReadDoubles(value, name, IsScalar(value) ? Shape{} : Shape{kAny});
  if (array.ndim() == 0) {
    sigmas.assign(count, *array.data());
  } else {
    CheckCount(name, count, static_cast<std::size_t>(array.size()));
    sigmas.assign(array.data(), array.data() + array.size());
  }
  for (const double sigma : sigmas) {
    if (sigma > 0 && std::isfinite(sigma)) continue;
    throw InputError(fmt::format("{}: expected numbers greater than 0, found {}", name, sigma));
  }
  return sigmas;
}

std::vector<Eigen::Vector2d> ReadVectors2(py::handle value, const char* name) {
  return ReadVectors<Eigen::Vector2d>(value, name);
}

std::vector<Eigen::Vector3d> ReadVectors3(py::handle value, const char* name) {
  return ReadVectors<Eigen::Vector3d>(value, name);
}

std::vector<Segment2> ReadSegments2(py::handle value, const char* name) {
  return ReadSegments<2>(value, name);
}

std::vector<Segment3> ReadSegments3(py::handle value, const char* name) {
  return ReadSegments<3>(value, name);
}

std::vector<PluckerLine> ReadPluckerLines(py::handle value, const char* name) {
  const Doubles array = ReadDoubles(value, name, {kAny, 6});
  std::vector<PluckerLine> lines;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const Eigen::Vector3d moment(array.data(i)), direction(array.data(i) + 3);
    const double length = direction.norm();
    const double product = moment.dot(direction);
    if (!(length > 0) || std::abs(product) > 1e-6 * length * (moment.norm() + length)) {
      throw InputError(fmt::format(
          "{}: expected moment and direction at right angles, found {:.3g} long and a product of "
          "{:.3g} at [{}]",
          name,
          length,
          product,
          i));
    }
    lines.push_back({moment / length, direction / length});
  }
  return lines;
}

Eigen::Quaterniond ReadRotation(py::handle value, const char* name) {
  const Doubles array = ReadDoubles(value, name, {3, 3});
  return RotationOf(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(array.data()),
                    name);
}

Rigid3 ReadPose(py::handle value, const char* name) {
  return PoseOf(ReadDoubles(value, name, {4, 4}).data(), name);
}

std::vector<Rigid3> ReadPoses(py::handle value, const char* name) {
  const Doubles array = ReadDoubles(value, name, {kAny, 4, 4});
  std::vector<Rigid3> poses;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) poses.push_back(PoseOf(array.data(i), name));
  return poses;
}

void CheckCount(const char* name, std::size_t expected, std::size_t found) {
  if (expected == found) return;
  throw InputError(fmt::format("{}: expected {} of them, found {}", name, expected, found));
}

GrayImage ReadGray(py::handle value, const char* name) {
  const char* expected = "an image of uint8 of shape (rows, columns)";
  if (!py::isinstance<py::array>(value)) Fail(name, expected, value);
  const auto array = py::reinterpret_borrow<py::array>(value);
  if (array.ndim() != 2 || array.size() == 0 || !py::isinstance<py::array_t<std::uint8_t>>(array)) {
    Fail(name, expected, value);
  }
  const auto rows = py::array_t<std::uint8_t, py::array::c_style>::ensure(array);
  GrayImage image(static_cast<int>(rows.shape(1)), static_cast<int>(rows.shape(0)));
  std::memcpy(image.data(), rows.data(), static_cast<std::size_t>(rows.size()));
  return image;
}

DepthImage ReadDepth(py::handle value, const char* name, std::optional<double> factor) {
  const char* expected =
      "a depth image of float32 or float64 (metres) or uint16 of shape (rows, columns)";
  if (!py::isinstance<py::array>(value)) Fail(name, expected, value);
  const auto array = py::reinterpret_borrow<py::array>(value);
  const bool whole = array.dtype().kind() == 'u' && array.itemsize() == 2;
  if (array.ndim() != 2 || array.size() == 0 || (!whole && array.dtype().kind() != 'f')) {
    Fail(name, expected, value);
  }
  if (whole && !factor) {
    throw InputError(std::string(name) +
                     ": expected metres, as the calibration has no depth_factor, found " +
                     Describe(value));
  }
  const auto rows = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  DepthImage depth(static_cast<int>(rows.shape(1)), static_cast<int>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.size(); ++i) {
    const double metres = rows.data()[i] / (whole ? *factor : 1.0);
    depth.data()[i] = std::isfinite(metres) && metres > 0 ? static_cast<float>(metres) : 0.0F;
  }
  return depth;
}

Doubles ToArray(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  Doubles array({matrix.rows(), matrix.cols()});
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<RowMajor>(array.mutable_data(), matrix.rows(), matrix.cols()) = matrix;
  return array;
}

Doubles ToArray(const std::vector<double>& values) {
  return Doubles(static_cast<py::ssize_t>(values.size()), values.data());
}

Doubles ToArray(const std::vector<Eigen::Vector2d>& rows) { return FromRows(rows, {2}); }

Doubles ToArray(const std::vector<Eigen::Vector3d>& rows) { return FromRows(rows, {3}); }

Doubles ToArray(const std::vector<Segment3>& segments) {
  Doubles array({static_cast<py::ssize_t>(segments.size()), py::ssize_t{2}, py::ssize_t{3}});
  double* out = array.mutable_data();
  for (const Segment3& segment : segments) {
    for (const Eigen::Vector3d& end : {segment.start, segment.end}) {
      for (int i = 0; i < 3; ++i) *out++ = end[i];
    }
  }
  return array;
}

Doubles ToArray(const std::vector<PluckerLine>& lines) {
  std::vector<Vector6d> rows;
  rows.reserve(lines.size());
  for (const PluckerLine& line : lines) {
    rows.push_back((Vector6d() << line.moment, line.direction).finished());
  }
  return FromRows(rows, {6});
}

Doubles ToArray(const std::vector<Rigid3>& poses) {
  std::vector<Eigen::Matrix4d> columns;  // one after the other: the transpose by rows
  columns.reserve(poses.size());
  for (const Rigid3& pose : poses) columns.push_back(pose.Matrix().transpose());
  return FromRows(columns, {4, 4});
}

Doubles ToArray(const Rigid3& pose) { return ToArray(pose.Matrix()); }

Integers ToArray(const std::vector<std::int64_t>& values) {
  return Integers(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<bool> ToArray(const std::vector<bool>& values) {
  py::array_t<bool> array(static_cast<py::ssize_t>(values.size()));
  bool* out = array.mutable_data();
  for (const bool value : values) *out++ = value;
  return array;
}

py::array ReadOnly(py::array array) {
  array.attr("flags").attr("writeable") = false;
  return array;
}

}  // namespace plumbline::python
