// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/essential.h"

#include "plumbline/geometry/symmetric_matrix.h"
#include "plumbline/solvers/polynomial.h"
#include "plumbline/solvers/ray_match.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

namespace plumbline {
namespace {

// The monomials of polynomials in x, y, z of degree one, two and three. The cubic ones are in the
// order of elimination: the first ten are solved for, the others are x, y and 1 times powers of z.
struct Exponents {
  int x, y, z;
  constexpr bool operator==(const Exponents&) const = default;
  constexpr Exponents operator+(const Exponents& o) const { return {x + o.x, y + o.y, z + o.z}; }
};
constexpr std::array<Exponents, 4> kLinear{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
constexpr std::array<Exponents, 10> kQuadratic{{{2, 0, 0},
                                                {0, 2, 0},
                                                {0, 0, 2},
                                                {1, 1, 0},
                                                {1, 0, 1},
                                                {0, 1, 1},
                                                {1, 0, 0},
                                                {0, 1, 0},
                                                {0, 0, 1},
                                                {0, 0, 0}}};
constexpr std::array<Exponents, 20> kCubic{{{3, 0, 0}, {0, 3, 0}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1},
                                            {2, 0, 0}, {0, 2, 1}, {0, 2, 0}, {1, 1, 1}, {1, 1, 0},
                                            {1, 0, 2}, {1, 0, 1}, {1, 0, 0}, {0, 1, 2}, {0, 1, 1},
                                            {0, 1, 0}, {0, 0, 3}, {0, 0, 2}, {0, 0, 1}, {0, 0, 0}}};

// Returns the index of the product of each pair of monomials.
template <std::size_t kA, std::size_t kB, std::size_t kProduct>
constexpr auto ProductTable(const std::array<Exponents, kA>& a,
                            const std::array<Exponents, kB>& b,
                            const std::array<Exponents, kProduct>& product) {
  std::array<std::array<std::size_t, kB>, kA> table{};
  for (std::size_t i = 0; i < kA; ++i) {
    for (std::size_t j = 0; j < kB; ++j) {
      for (std::size_t k = 0; k < kProduct; ++k) {
        if (product[k] == a[i] + b[j]) table[i][j] = k;
      }
    }
  }
  return table;
}
constexpr auto kLinearTimesLinear = ProductTable(kLinear, kLinear, kQuadratic);
constexpr auto kQuadraticTimesLinear = ProductTable(kQuadratic, kLinear, kCubic);

using Linear = std::array<double, 4>;
using Quadratic = std::array<double, 10>;
using Cubic = Eigen::Matrix<double, 1, 20>;

void AddProduct(double factor, const Linear& a, const Linear& b, Quadratic& sum) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) sum[kLinearTimesLinear[i][j]] += factor * a[i] * b[j];
  }
}

void AddProduct(const Quadratic& a, const Linear& b, Cubic& sum) {
  for (std::size_t i = 0; i < 10; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      sum(static_cast<Eigen::Index>(kQuadraticTimesLinear[i][j])) += a[i] * b[j];
    }
  }
}

using LinearMatrix = std::array<std::array<Linear, 3>, 3>;

// Returns det E (eq. 6).
Cubic Determinant(const LinearMatrix& E) {
  Cubic sum = Cubic::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    Quadratic minor{};
    AddProduct(1, E[1][i], E[2][j], minor);
    AddProduct(-1, E[1][j], E[2][i], minor);
    AddProduct(minor, E[0][k], sum);
  }
  return sum;
}

// Returns the ten constraints det E = 0 and E E^T E - 1/2 trace(E E^T) E = 0 (eq. 7), one in each
// row.
Eigen::Matrix<double, 10, 20> Constraints(const LinearMatrix& E) {
  std::array<std::array<Quadratic, 3>, 3> square{};  // E E^T, then without half its trace
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) AddProduct(1, E[i][k], E[j][k], square[i][j]);
      square[j][i] = square[i][j];
    }
  }
  for (std::size_t c = 0; c < 10; ++c) {
    const double half = 0.5 * (square[0][0][c] + square[1][1][c] + square[2][2][c]);
    for (std::size_t i = 0; i < 3; ++i) square[i][i][c] -= half;
  }
  Eigen::Matrix<double, 10, 20> rows;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      Cubic sum = Cubic::Zero();
      for (std::size_t k = 0; k < 3; ++k) AddProduct(square[i][k], E[k][j], sum);
      rows.row(row++) = sum;
    }
  }
  rows.row(row) = Determinant(E);
  return rows;
}

using Quartic = std::array<double, 5>;  // in z, lowest power first
using PolynomialMatrix = std::array<std::array<Quartic, 3>, 3>;

// Returns the rows `upper` minus z times `lower` of the eliminated system: the factors of x, y and
// 1 (Nistér's B).
PolynomialMatrix EliminateToZ(const Eigen::Matrix<double, 10, 10>& right) {
  PolynomialMatrix B{};
  for (std::size_t row = 0; row < 3; ++row) {
    const auto upper = right.row(static_cast<Eigen::Index>(4 + 2 * row));
    const auto lower = right.row(static_cast<Eigen::Index>(5 + 2 * row));
    constexpr std::array<Eigen::Index, 3> kFirst{0, 3, 6};
    constexpr std::array<Eigen::Index, 3> kDegree{2, 2, 3};
    for (std::size_t column = 0; column < 3; ++column) {
      for (Eigen::Index power = 0; power <= kDegree[column]; ++power) {
        const Eigen::Index source = kFirst[column] + kDegree[column] - power;
        B[row][column][static_cast<std::size_t>(power)] += upper(source);
        B[row][column][static_cast<std::size_t>(power + 1)] -= lower(source);
      }
    }
  }
  return B;
}

template <std::size_t kA, std::size_t kB>
std::array<double, kA + kB - 1> Product(const std::array<double, kA>& a,
                                        const std::array<double, kB>& b) {
  std::array<double, kA + kB - 1> product{};
  for (std::size_t i = 0; i < kA; ++i) {
    for (std::size_t j = 0; j < kB; ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

std::array<double, 11> Determinant(const PolynomialMatrix& B) {
  std::array<double, 11> sum{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    const auto plus = Product(B[1][i], B[2][j]);
    const auto minus = Product(B[1][j], B[2][i]);
    std::array<double, 9> minor;
    for (std::size_t c = 0; c < minor.size(); ++c) minor[c] = plus[c] - minus[c];
    const auto term = Product(minor, B[0][k]);
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += term[c];  // above 10 they are zero
  }
  return sum;
}

// Returns (x, y) with B(z) (x, y, 1) = 0.
std::optional<Eigen::Vector2d> SolveForXY(const PolynomialMatrix& B, double z) {
  Eigen::Matrix3d at;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double value = 0;
      for (std::size_t c = 5; c-- > 0;) value = value * z + B[i][j][c];
      at(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = value;
    }
    const auto row = at.row(static_cast<Eigen::Index>(i));
    at.row(static_cast<Eigen::Index>(i)) /= std::max(row.norm(), 1e-300);
  }
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d normal = at.row(i).transpose().cross(at.row((i + 1) % 3).transpose());
    if (normal.squaredNorm() > best.squaredNorm()) best = normal;
  }
  if (!(std::abs(best.z()) > 1e-12)) return std::nullopt;
  return best.head<2>() / best.z();
}

using NullSpace = Eigen::Matrix<double, 9, 4>;

std::optional<NullSpace> NullSpaceOf(std::span<const RayMatch, 5> matches) {
  Eigen::Matrix<double, 9, 5> equations;  // E row by row
  for (std::size_t k = 0; k < 5; ++k) {
    const Eigen::Vector3d a = matches[k].a.homogeneous();
    const Eigen::Vector3d b = matches[k].b.homogeneous();
    for (int i = 0; i < 3; ++i) {
      equations.block<3, 1>(3 * i, static_cast<Eigen::Index>(k)) = b(i) * a;
    }
  }
  const Eigen::HouseholderQR<Eigen::Matrix<double, 9, 5>> qr(equations);
  const auto diagonal = qr.matrixQR().diagonal().cwiseAbs();
  if (!(diagonal.minCoeff() > 1e-10 * diagonal.maxCoeff())) return std::nullopt;
  NullSpace basis = NullSpace::Zero();
  basis.bottomRows<4>().setIdentity();
  return NullSpace(qr.householderQ() * basis);
}

Eigen::Matrix3d MatrixByRows(const Eigen::Matrix<double, 9, 1>& e) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(e.data());
}

}  // namespace

std::vector<Eigen::Matrix3d> EssentialFromFivePoints(std::span<const RayMatch, 5> matches) {
  std::vector<Eigen::Matrix3d> solutions;
  const auto basis = NullSpaceOf(matches);
  if (!basis) return solutions;
  LinearMatrix E;
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      E[i / 3][i % 3][k] = (*basis)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    }
  }
  const Eigen::Matrix<double, 10, 20> rows = Constraints(E);
  const Eigen::PartialPivLU<Eigen::Matrix<double, 10, 10>> lu(rows.leftCols<10>());
  const Eigen::Matrix<double, 10, 10> right = lu.solve(rows.rightCols<10>());
  if (!right.allFinite()) return solutions;
  const PolynomialMatrix B = EliminateToZ(right);
  for (const double z : RealRoots(Determinant(B))) {
    const auto xy = SolveForXY(B, z);
    if (!xy) continue;
    const Eigen::Vector4d c(xy->x(), xy->y(), z, 1);
    solutions.push_back(MatrixByRows((*basis * c).normalized()));
  }
  return solutions;
}

namespace {

// The solution of the linear equations on normalized points: its rank is 3.
struct LinearEpipolar {
  Eigen::Matrix3d F;
  Eigen::Matrix3d in_a, in_b;  // the normalizations

  Eigen::Matrix3d Denormalized(const Eigen::Matrix3d& normalized) const {
    return in_b.transpose() * normalized * in_a;
  }
};

std::optional<LinearEpipolar> SolveEightPoints(std::span<const RayMatch> matches) {
  if (matches.size() < 8) return std::nullopt;
  const Normalization in_a = NormalizationOf(matches, &RayMatch::a);
  const Normalization in_b = NormalizationOf(matches, &RayMatch::b);
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const RayMatch& m : matches) {
    const Eigen::Vector3d a = in_a.Apply(m.a).homogeneous();
    const Eigen::Vector3d b = in_b.Apply(m.b).homogeneous();
    Eigen::Matrix<double, 9, 1> row;
    row << b.x() * a, b.y() * a, b.z() * a;
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  const Eigenpairs<9> eigen = EigenpairsOf<9>(normal);
  if (!(eigen.values(1) > 1e-12 * eigen.values(8))) return std::nullopt;
  return LinearEpipolar{MatrixByRows(eigen.vectors.col(0)), in_a.Matrix(), in_b.Matrix()};
}

}  // namespace

std::optional<Eigen::Matrix3d> FundamentalFromEightPoints(std::span<const RayMatch> matches) {
  const auto linear = SolveEightPoints(matches);
  if (!linear) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear->F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d singular = svd.singularValues();
  singular(2) = 0;
  return linear->Denormalized(svd.matrixU() * singular.asDiagonal() * svd.matrixV().transpose())
      .normalized();
}

std::optional<Eigen::Matrix3d> EssentialFromEightPoints(std::span<const RayMatch> matches) {
  const auto linear = SolveEightPoints(matches);
  if (!linear) return std::nullopt;
  const Eigen::Matrix3d F = linear->Denormalized(linear->F);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d singular = Eigen::Vector3d(1, 1, 0) / std::sqrt(2);
  return svd.matrixU() * singular.asDiagonal() * svd.matrixV().transpose();
}

std::array<Rigid3, 4> PosesFromEssential(const Eigen::Matrix3d& essential) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(essential, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  Eigen::Matrix3d V = svd.matrixV();
  if (U.determinant() < 0) U.col(2) = -U.col(2);
  if (V.determinant() < 0) V.col(2) = -V.col(2);
  Eigen::Matrix3d quarter_turn;
  quarter_turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Eigen::Quaterniond first(Eigen::Matrix3d(U * quarter_turn * V.transpose()));
  const Eigen::Quaterniond second(Eigen::Matrix3d(U * quarter_turn.transpose() * V.transpose()));
  const Eigen::Vector3d t = U.col(2);
  return {Rigid3{first.normalized(), t},
          Rigid3{first.normalized(), -t},
          Rigid3{second.normalized(), t},
          Rigid3{second.normalized(), -t}};
}

}  // namespace plumbline
