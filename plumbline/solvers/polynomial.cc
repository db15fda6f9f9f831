// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/polynomial.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace plumbline {
namespace {

constexpr std::size_t kMaxDegree = 15;

// Points of [-1, 1], ascending. There are never more than a degree and the two ends.
struct Points {
  std::array<double, kMaxDegree + 2> x{};
  std::size_t count = 0;

  void Add(double value) { x[count++] = value; }
};

struct Polynomial {
  std::array<double, kMaxDegree + 1> c{};
  std::size_t degree = 0;

  double At(double x) const {
    double value = c[degree];
    for (std::size_t i = degree; i-- > 0;) value = value * x + c[i];
    return value;
  }
  double SlopeAt(double x) const {
    double value = 0;
    for (std::size_t i = degree; i > 0; --i) value = value * x + static_cast<double>(i) * c[i];
    return value;
  }
  Polynomial Derivative() const {
    Polynomial d;
    d.degree = degree - 1;
    for (std::size_t i = 0; i < degree; ++i) d.c[i] = static_cast<double>(i + 1) * c[i + 1];
    return d;
  }
};

// Returns the only root between low and high, where the polynomial has opposite signs.
double RootBetween(const Polynomial& p, double low, double high, double at_low) {
  double x = 0.5 * (low + high);
  for (int i = 0; i < 100; ++i) {
    const double value = p.At(x);
    if (value == 0) return x;
    ((value > 0) == (at_low > 0) ? low : high) = x;
    double next = x - value / p.SlopeAt(x);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 1e-15) return next;
    x = next;
  }
  return x;
}

// Returns the roots in [-1, 1].
Points RootsInside(const Polynomial& p) {
  Points roots;
  if (p.degree == 0) return roots;
  Points turning;
  turning.Add(-1);
  if (p.degree > 1) {
    const Points extrema = RootsInside(p.Derivative());
    for (std::size_t i = 0; i < extrema.count; ++i) turning.Add(extrema.x[i]);
  }
  turning.Add(1);
  double before = p.At(turning.x[0]);
  for (std::size_t i = 1; i < turning.count; ++i) {
    const double after = p.At(turning.x[i]);
    if ((before > 0) != (after > 0)) {
      roots.Add(RootBetween(p, turning.x[i - 1], turning.x[i], before));
    }
    before = after;
  }
  return roots;
}

}  // namespace

std::vector<double> RealRoots(std::span<const double> coefficients) {
  PLUMBLINE_CHECK(coefficients.size() <= kMaxDegree + 1, "a polynomial of too high a degree");
  std::vector<double> roots;
  while (!coefficients.empty() && coefficients.back() == 0) {
    coefficients = coefficients.first(coefficients.size() - 1);
  }
  if (coefficients.size() < 2) return roots;
  Polynomial p;
  p.degree = coefficients.size() - 1;
  std::copy(coefficients.begin(), coefficients.end(), p.c.begin());
  Polynomial reversed;
  reversed.degree = p.degree;
  std::reverse_copy(coefficients.begin(), coefficients.end(), reversed.c.begin());
  const Points inside = RootsInside(p);
  roots.assign(inside.x.begin(), inside.x.begin() + static_cast<std::ptrdiff_t>(inside.count));
  const Points outside = RootsInside(reversed);
  for (std::size_t i = 0; i < outside.count; ++i) {
    const double inverse = outside.x[i];
    // Roots at exactly +-1 are among those inside.
    if (inverse != 0 && std::abs(inverse) < 1) roots.push_back(1 / inverse);
  }
  std::sort(roots.begin(), roots.end());
  return roots;
}

}  // namespace plumbline
