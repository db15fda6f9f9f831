// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/initialization/geometric_interpolation.h"
#include "plumbline/initialization/klt_tracks.h"
#include "plumbline/initialization/rank1_factorization.h"

#include "arrays.h"
#include "bindings.h"
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace plumbline::python {
namespace {

struct Rank1Input {
  std::vector<Eigen::Vector2d> reference;
  std::vector<Rank1View> views;
};

// A position counts if its sigma is greater than 0, and is ignored otherwise.
Rank1View ReadView(const double* places,
                   const double* sigmas,
                   std::size_t count,
                   py::ssize_t view) {
  Rank1View out;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d place(places + 2 * k);
    const bool seen = sigmas[k] > 0;
    if ((seen && !place.allFinite()) || sigmas[k] < 0) {
      throw InputError(
          fmt::format("views, sigmas: expected a finite place where sigma is greater than 0, found "
                      "({}, {}) and "
                      "{} at [{}, {}]",
                      place.x(),
                      place.y(),
                      sigmas[k],
                      view,
                      k));
    }
    out.points.push_back(seen ? place : Eigen::Vector2d::Zero());
    out.sigmas.push_back(sigmas[k]);
  }
  return out;
}

Rank1Input ReadRank1(py::handle reference,
                     py::handle views,
                     py::handle sigmas,
                     py::handle rotations,
                     py::handle centre_directions) {
  Rank1Input input;
  input.reference = ReadVectors2(reference, "reference");
  const auto count = static_cast<py::ssize_t>(input.reference.size());
  const Doubles places = ReadDoubles(views, "views", {kAny, count, 2}, Numbers::kAnyValue);
  const py::ssize_t size = places.shape(0);
  const Doubles deviations = ReadDoubles(sigmas, "sigmas", {size, count});
  const Doubles turns = ReadDoubles(rotations, "rotations", {size, 3, 3});
  const Doubles centres = ReadDoubles(centre_directions, "centre_directions", {size, 3});
  if (size == 0) throw InputError("views: expected at least one view, found none");
  for (py::ssize_t i = 0; i < size; ++i) {
    Rank1View view =
        ReadView(places.data(i), deviations.data(i), static_cast<std::size_t>(count), i);
    view.reference_from_cam = ReadRotation(turns[py::int_(i)], "rotations");
    const Eigen::Vector3d direction(centres.data(i));
    if (!(direction.norm() > 0)) {
      throw InputError(
          fmt::format("centre_directions: expected vectors of some length, found none at [{}]", i));
    }
    view.centre_direction = direction.normalized();
    input.views.push_back(std::move(view));
  }
  return input;
}

double CheckPositive(const char* name, double value) {
  if (value > 0 && std::isfinite(value)) return value;
  throw InputError(fmt::format("{}: expected a number greater than 0, found {}", name, value));
}

py::object Factorize(py::handle reference,
                     py::handle views,
                     py::handle sigmas,
                     py::handle rotations,
                     py::handle centre_directions,
                     int iterations) {
  const Rank1Input input = ReadRank1(reference, views, sigmas, rotations, centre_directions);
  Rank1Options options;
  if (iterations < 0 || iterations > 1000) {
    throw InputError(fmt::format("iterations: expected 0 to 1000, found {}", iterations));
  }
  options.iterations = iterations;
  std::optional<Rank1Solution> solution;
  {
    const py::gil_scoped_release release;
    solution = FactorizeRank1(input.reference, input.views, options);
  }
  if (!solution) return py::none();
  py::dict dict;
  dict["centres"] = ToArray(solution->centres);
  dict["inverse_distances"] = ToArray(solution->inverse_distances);
  dict["in_front"] = solution->in_front;
  dict["solved"] = solution->solved;
  dict["spread"] = solution->spread;
  return dict;
}

py::tuple MatrixOf(py::handle reference,
                   py::handle views,
                   py::handle sigmas,
                   py::handle rotations,
                   py::handle centre_directions) {
  const Rank1Input input = ReadRank1(reference, views, sigmas, rotations, centre_directions);
  const Rank1Matrix matrix(input.reference, input.views, Rank1Options().min_epipole_angle);
  return py::make_tuple(ToArray(matrix.entries()), ToArray(matrix.weights()));
}

py::dict Interpolate(py::handle reference,
                     py::handle current,
                     py::handle between_from_reference,
                     py::handle current_from_reference,
                     double sigma,
                     const py::object& covariance) {
  const auto first = ReadVectors2(reference, "reference"), last = ReadVectors2(current, "current");
  CheckCount("current", first.size(), last.size());
  CheckPositive("sigma", sigma);
  InterpolationPoses poses{ReadPose(between_from_reference, "between_from_reference"),
                           ReadPose(current_from_reference, "current_from_reference")};
  if (!covariance.is_none()) {
    const Doubles numbers = ReadDoubles(covariance, "covariance", {12, 12});
    poses.covariance = Eigen::Map<const Eigen::Matrix<double, 12, 12>>(numbers.data());
    if (!poses.covariance.isApprox(poses.covariance.transpose(), 1e-9)) {
      throw InputError("covariance: expected a symmetric matrix, found another one");
    }
  }
  const GeometricInterpolation interpolation(poses);
  std::vector<Eigen::Vector2d> points(first.size(), Eigen::Vector2d(kMissing, kMissing));
  std::vector<double> angles(first.size(), kMissing);
  Doubles covariances({static_cast<py::ssize_t>(first.size()), py::ssize_t{2}, py::ssize_t{2}});
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto found = interpolation.Interpolate(first[i], sigma, last[i], sigma);
    Eigen::Map<Eigen::Matrix2d> out(covariances.mutable_data(static_cast<py::ssize_t>(i)));
    out.setConstant(kMissing);
    if (!found) continue;
    points[i] = found->point;
    angles[i] = found->line_angle;
    out = found->covariance;  // symmetric
  }
  py::dict dict;
  dict["points"] = ToArray(points);
  dict["covariances"] = covariances;
  dict["line_angles"] = ToArray(angles);
  return dict;
}

std::vector<std::shared_ptr<const GrayImage>> ReadSequence(const py::sequence& images) {
  std::vector<std::shared_ptr<const GrayImage>> sequence;
  for (const py::object image : images) {  // of an array, it lives no longer than this
    sequence.push_back(std::make_shared<const GrayImage>(ReadGray(image, "images")));
    const GrayImage &first = *sequence.front(), &last = *sequence.back();
    if (first.width() == last.width() && first.height() == last.height()) continue;
    throw InputError(fmt::format("images: expected images of one size, ({}, {}), found ({}, {})",
                                 first.height(),
                                 first.width(),
                                 last.height(),
                                 last.width()));
  }
  if (sequence.empty()) throw InputError("images: expected at least one image, found none");
  return sequence;
}

Doubles FollowPoints(const py::sequence& images, py::handle points) {
  const auto sequence = ReadSequence(images);
  const auto start = ReadVectors2(points, "points");
  for (const Eigen::Vector2d& px : start) {
    const int width = sequence.front()->width(), height = sequence.front()->height();
    if (px.minCoeff() >= 0 && px.x() <= width - 1 && px.y() <= height - 1) continue;
    throw InputError(
        fmt::format("points: expected places in the first image, found ({}, {})", px.x(), px.y()));
  }
  Doubles array({static_cast<py::ssize_t>(sequence.size()),
                 static_cast<py::ssize_t>(start.size()),
                 py::ssize_t{2}});
  double* out = array.mutable_data();
  {
    const py::gil_scoped_release release;
    KltTracks tracks(sequence.front(), {start.begin(), start.end()});
    for (std::size_t i = 0; i < sequence.size(); ++i) {
      if (i > 0) tracks.Follow(sequence[i]);
      for (const auto& place : tracks.places()) {
        *out++ = place ? place->x() : kMissing;
        *out++ = place ? place->y() : kMissing;
      }
    }
  }
  return array;
}

}  // namespace

void BindInitialization(py::module_& module) {
  module.def(
      "factorize_rank1",
      &Factorize,
      py::arg("reference"),
      py::arg("views"),
      py::arg("sigmas"),
      py::arg("rotations"),
      py::arg("centre_directions"),
      py::arg("iterations") = 5,
      R"(factorize_rank1(reference, views, sigmas, rotations, centre_directions, iterations=5)

Solves for all camera centres and point distances of M views at once (docs/methods, eq. 5).
reference (N, 2) and views (M, N, 2): ideal image coordinates (x/z, y/z); sigmas (M, N): standard
deviation of each coordinate, 0: not seen; rotations (M, 3, 3): reference_from_camera;
centre_directions (M, 3): of each camera's centre in the reference frame, of either sign.
iterations of reweighting; 0: one plain factorization.

Returns None where fewer than 3 points have an entry or a view has none, else a dictionary:
"centres" (M, 3) in the reference frame, together of unit length; "inverse_distances" (N,) along the
unit rays, 0: not known; "in_front" and "solved", numbers of points; "spread" of the residuals in
standard deviations. New arrays.)");
  module.def("rank1_matrix",
             &MatrixOf,
             py::arg("reference"),
             py::arg("views"),
             py::arg("sigmas"),
             py::arg("rotations"),
             py::arg("centre_directions"),
             R"(rank1_matrix(reference, views, sigmas, rotations, centre_directions)

What factorize_rank1 factorizes: entries (3 M, N), of rank one without noise (eq. 4), and weights
(M, N), 1 / variance, 0: not known. New arrays.)");
  module.def("interpolate_points",
             &Interpolate,
             py::arg("reference"),
             py::arg("current"),
             py::arg("between_from_reference"),
             py::arg("current_from_reference"),
             py::arg("sigma"),
             py::arg("covariance") = py::none(),
             R"(interpolate_points(reference, current, between_from_reference,
                   current_from_reference, sigma, covariance=None) -> dict

Geometric interpolation: where points matched between two frames lie in a frame between, as the
intersection of their epipolar lines. reference, current (N, 2): ideal image coordinates with
standard deviation sigma; poses (4, 4), translations in one unit; covariance (12, 12) of their left
perturbations [rotation, translation], between first (None: exact).

"points" (N, 2), "covariances" (N, 2, 2), "line_angles" (N,) at which the lines meet, radians; NaN
where they do not meet. New arrays.)");
  module.def("follow_points",
             &FollowPoints,
             py::arg("images"),
             py::arg("points"),
             R"(follow_points(images, points) -> numpy.ndarray

Points (N, 2) of the first of M images, uint8 (rows, columns), followed by optical flow (Lucas and
Kanade on pyramids), each step checked by following it back: (M, N, 2) pixels, NaN from where a
point is lost. A new array.)");
}

}  // namespace plumbline::python
