// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/envelope_cholesky.h"

#include "tests/optimization/random_scene.h"
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

struct PanelShape {
  Eigen::Index rows, first;
};

// A random positive definite matrix that is zero outside the envelope: B B^T with B in it, and
// panels whose entries above the diagonal are not to be used.
struct System {
  Eigen::MatrixXd matrix;
  std::vector<EnvelopePanel> panels;
};

System RandomSystem(const std::vector<PanelShape>& shapes) {
  testing::Random random(3);
  const auto uniform = [&random]() { return random.Uniform(-1, 1); };
  Eigen::Index size = 0;
  for (const PanelShape& shape : shapes) size += shape.rows;
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(size, size);
  System system;
  Eigen::Index begin = 0;
  for (const PanelShape& shape : shapes) {
    const Eigen::Index width = begin + shape.rows - shape.first;
    B.block(begin, shape.first, shape.rows, width) =
        Eigen::MatrixXd::NullaryExpr(shape.rows, width, uniform);
    system.panels.push_back({begin, shape.first, {}});
    begin += shape.rows;
  }
  B = B.triangularView<Eigen::Lower>();
  B.diagonal().array() += 3;
  system.matrix = B * B.transpose();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    EnvelopePanel& panel = system.panels[i];
    const Eigen::Index width = panel.begin + shapes[i].rows - panel.first;
    panel.rows = system.matrix.block(panel.begin, panel.first, shapes[i].rows, width);
    panel.rows.rightCols(shapes[i].rows).triangularView<Eigen::StrictlyUpper>().setConstant(99);
  }
  return system;
}

const std::vector<std::vector<PanelShape>> kShapes = {
    {{7, 0}},                                          // dense
    {{6, 0}, {6, 0}, {6, 6}, {6, 12}, {5, 18}},        // a band
    {{6, 0}, {6, 6}, {6, 12}},                         // nothing but the diagonal
    {{3, 0}, {6, 3}, {6, 3}, {6, 9}, {6, 0}, {2, 21}}  // a row that reaches far back
};

TEST(EnvelopeCholesky, SolvesAsADenseFactorizationDoes) {
  for (const std::vector<PanelShape>& shapes : kShapes) {
    System system = RandomSystem(shapes);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(system.matrix.rows(), -1, 2);
    const Eigen::VectorXd expected = system.matrix.llt().solve(b);
    ASSERT_TRUE(FactorEnvelope(system.panels));
    Eigen::VectorXd x = b;
    SolveEnvelope(system.panels, x);
    EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm()) << shapes.size();
  }
}

TEST(EnvelopeCholesky, LeavesTheRowsOfL) {
  System system = RandomSystem(kShapes[3]);
  const Eigen::MatrixXd L = system.matrix.llt().matrixL();
  ASSERT_TRUE(FactorEnvelope(system.panels));
  for (EnvelopePanel& panel : system.panels) {
    const Eigen::Index rows = panel.rows.rows();
    panel.rows.rightCols(rows).triangularView<Eigen::StrictlyUpper>().setZero();
    const auto expected = L.block(panel.begin, panel.first, rows, panel.rows.cols());
    EXPECT_LT((panel.rows - expected).norm(), 1e-10);
  }
}

TEST(EnvelopeCholesky, RefusesWhatIsNotPositiveDefinite) {
  for (const std::vector<PanelShape>& shapes : kShapes) {
    System system = RandomSystem(shapes);
    EnvelopePanel& last = system.panels.back();
    last.rows(last.rows.rows() - 1, last.rows.cols() - 1) = -1;
    EXPECT_FALSE(FactorEnvelope(system.panels));
  }
}

TEST(EnvelopeCholesky, EndsWhenItIsTold) {
  System system = RandomSystem(kShapes[3]);
  int asked = 0;
  EXPECT_FALSE(FactorEnvelope(system.panels, [&] { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
  system = RandomSystem(kShapes[3]);
  EXPECT_TRUE(FactorEnvelope(system.panels, [] { return false; }));
}

TEST(EnvelopeSize, IsThatOfTheFullMatrixWithAsManyMultiplications) {
  EXPECT_NEAR(EnvelopeSize(std::vector<int>(100, 0)), 100, 0.01);
  std::vector<int> band(1000);
  for (int i = 0; i < 1000; ++i) band[static_cast<std::size_t>(i)] = std::max(0, i - 20);
  // Of 20 entries of a row the k-th takes k multiplications.
  EXPECT_NEAR(EnvelopeSize(band), std::cbrt(6 * 1000 * 20 * 21 / 2), 1);
  // The last rows meet the first: each of their entries is one of a band again, but the last few.
  for (std::size_t i = 990; i < 1000; ++i) band[i] = 0;
  EXPECT_NEAR(EnvelopeSize(band), std::cbrt(6 * (1000 * 210 + 10 * 1000 * 20 + 1000 * 45)), 2);
  EXPECT_EQ(EnvelopeSize({}), 0);
}

TEST(EnvelopeCholesky, HasNothingToDoWithoutPanels) {
  std::vector<EnvelopePanel> panels;
  Eigen::VectorXd x(0);
  EXPECT_TRUE(FactorEnvelope(panels));
  SolveEnvelope(panels, x);
}

}  // namespace
}  // namespace plumbline
