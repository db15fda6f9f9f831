// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/optimization/schur_solver.h"

#include "drive_shape.h"
#include <array>
#include <chrono>
#include <vector>

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

void Solve(SchurSolver& solver, benchmark::State& state) {
  const auto start = std::chrono::steady_clock::now();
  bool solved = solver.Solve(1e-4);
  const std::chrono::duration<double, std::milli> first = std::chrono::steady_clock::now() - start;
  state.counters["first_ms"] = first.count();  // with the choice of a method
  for (auto _ : state) {
    solved = solved && solver.Solve(1e-4);
  }
  if (!solved) state.SkipWithError("not positive definite");
}

void SolvePath(benchmark::State& state) {
  const int poses = static_cast<int>(state.range(0));
  const int reach = static_cast<int>(state.range(1));
  SchurSolver solver(poses);
  for (int i = 0; i < poses; ++i) {
    solver.pose(i).H = 1e4 * Matrix6d::Identity();
    solver.pose(i).g.setOnes();
    for (int step = 1; step <= reach && i - step >= 0; ++step) Couple(i, i - step, solver);
  }
  Solve(solver, state);
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
    ->Args({3000, 10})
    ->Args({4000, 50});

// Drives with revisits: keyframes at the same place share landmarks with one another and with those
// `reach` places back.
void SolveDrive(benchmark::State& state) {
  const auto shape = static_cast<DriveShape>(state.range(0));
  const int poses = static_cast<int>(state.range(1));
  const int reach = static_cast<int>(state.range(2));
  const std::vector<int> places = DrivePlaces(shape, poses);
  const std::vector<std::vector<int>> visits = DriveVisits(places);
  SchurSolver solver(poses);
  for (int i = 0; i < poses; ++i) {
    solver.pose(i).H = 1e4 * Matrix6d::Identity();
    solver.pose(i).g.setOnes();
    for (int step = 1; step <= reach && i - step >= 0; ++step) Couple(i, i - step, solver);
    const int place = places[static_cast<std::size_t>(i)];
    for (int step = 0; step <= reach && place - step >= 0; ++step) {
      for (const int other : visits[static_cast<std::size_t>(place - step)]) {
        if (other < i) Couple(i, other, solver);
      }
    }
  }
  Solve(solver, state);
}
BENCHMARK(SolveDrive)
    ->Unit(benchmark::kMillisecond)
    ->ArgNames({"shape", "poses", "reach"})
    ->ArgsProduct({{static_cast<int>(DriveShape::kChain),
                    static_cast<int>(DriveShape::kHub),
                    static_cast<int>(DriveShape::kRounds)},
                   {1000, 3000},
                   {10, 20}});

}  // namespace
}  // namespace plumbline
