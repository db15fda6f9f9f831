// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include <benchmark/benchmark.h>

// One solution of the equations of a whole path. Arguments: poses, and how many poses back a pose
// shares landmarks: all of them is what a dense factorization takes.

namespace plumbline {
namespace {

// A landmark that couples the two poses weakly.
void Couple(int pose, int other, SchurSolver& solver) {
  LandmarkEquations<3> landmark;
  landmark.V.setIdentity();
  std::vector<Coupling<3>> couplings(2);
  couplings[0] = {other, 0.1 * Eigen::Matrix<double, 6, 3>::Ones()};
  couplings[1] = {pose, 0.1 * Eigen::Matrix<double, 6, 3>::Identity()};
  benchmark::DoNotOptimize(solver.Eliminate<3>(landmark, 0, couplings));
}

void SolvePath(benchmark::State& state) {
  const int poses = static_cast<int>(state.range(0));
  const int reach = static_cast<int>(state.range(1));
  SchurSolver solver(poses);
  for (int i = 0; i < poses; ++i) {
    solver.pose(i).H = 1e4 * Matrix6d::Identity();
    solver.pose(i).g.setOnes();
    for (const int step : {1, reach / 2, reach}) {
      if (step > 0 && i - step >= 0) Couple(i, i - step, solver);
    }
    if (reach >= i && i > 0) Couple(i, 0, solver);
  }
  for (auto _ : state) {
    if (solver.Solve(1e-4)) continue;
    state.SkipWithError("not positive definite");
    break;
  }
}
BENCHMARK(SolvePath)
    ->Unit(benchmark::kMillisecond)
    ->ArgNames({"poses", "reach"})
    ->Args({200, 200})
    ->Args({400, 400})
    ->Args({400, 50})
    ->Args({1000, 1000})
    ->Args({1000, 200})
    ->Args({1000, 50})
    ->Args({4000, 50});

}  // namespace
}  // namespace plumbline
