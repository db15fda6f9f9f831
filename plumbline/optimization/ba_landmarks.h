// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/heap_bytes.h"
#include "plumbline/base/statistics.h"
#include "plumbline/optimization/ba_terms.h"
#include "plumbline/optimization/schur_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace plumbline {

// Observation in the caller's problem, from which a landmark's observation is made.
template <class Term>
struct BaObservation {
  int pose = 0;
  int landmark = 0;
  Term term;
};

// Requires that landmarks of this kind have a direction, so that they may be parallel to an axis.
template <class Kind>
concept HasDirection = requires(const typename Kind::Place& place) {
  place.direction;
};

// Requires that landmarks of this kind complete their equations, since their observations do not
// determine all of their parameters.
template <class Kind>
concept HoldsGauge = requires(const typename Kind::View& view,
                              LandmarkEquations<Kind::kDof>& equations) {
  Kind::HoldGauge(view, equations);
};

// Requires that landmarks of this kind can be carried along with a pose.
template <class Kind>
concept CanBeCarried = requires(const typename Kind::State& state, const BaPose& pose) {
  Kind::Carried(state, pose, pose);
};

// All landmarks of one kind (BaPoint, BaLine) with their observations, stored by landmark and
// within each by pose; landmarks are linearized, eliminated and moved in that order. Internal to
// bundle_adjuster.h.
template <class Kind>
class BaLandmarks {
 public:
  using State = typename Kind::State;
  using Term = typename Kind::Term;

  BaLandmarks(const RectifiedCamera& camera,
              std::vector<State> states,
              std::vector<BaObservation<Term>> observations,
              const std::vector<BaPose>& poses,
              BaParallelLines parallel = {});

  const std::vector<State>& states() const { return states_; }
  // Returns half the loss over the observations and parallels in use, and stores each landmark's
  // part.
  double Cost(const std::vector<BaPose>& poses, const HuberThresholds& huber);
  // Adds the equations of the observations and parallels in use to `solver` and eliminates the
  // landmarks.
  void Eliminate(const std::vector<BaPose>& poses,
                 const HuberThresholds& huber,
                 double lambda,
                 SchurSolver& solver);
  // Moves all landmarks by the solved step to trial states. A landmark whose cost rises by the step
  // is moved on its own instead. With `carry`, one that would be behind a camera, moved or not, is
  // first carried along with a pose that shows it. Returns the cost under the trial poses.
  double Try(const std::vector<BaPose>& poses,
             const std::vector<BaPose>& trial_poses,
             const HuberThresholds& huber,
             bool carry,
             const SchurSolver& solver);
  // Returns the landmarks' share of the decrease of the cost that the linear model predicts.
  double expected_decrease() const { return expected_; }
  // Makes the trial states the current ones.
  void Accept();
  // Puts into use exactly the observations and parallels whose chi2 is within the limit at 95 %.
  // Returns true if that changed any.
  bool Classify(const std::vector<BaPose>& poses);
  // Puts into use all observations and parallels that have a residual.
  void UseAll(const std::vector<BaPose>& poses);
  std::size_t used() const {
    return static_cast<std::size_t>(std::count(used_.begin(), used_.end(), char{1})) +
           parallel_.used();
  }
  // Returns the memory in bytes of the landmarks, their observations and their parts of the
  // equations, including the reserve of vectors.
  std::size_t Bytes() const {
    return HeapBytes(states_) + HeapBytes(trial_) + HeapBytes(begin_) + HeapBytes(coupling_begin_) +
           HeapBytes(observations_) + HeapBytes(original_) + HeapBytes(used_) + HeapBytes(chi2_) +
           HeapBytes(couplings_) + HeapBytes(eliminated_) + HeapBytes(cost_) +
           HeapBytes(trial_cost_) + HeapBytes(own_lambda_) + parallel_.Bytes();
  }
  // Returns chi2 and use of each observation as of the last Classify() or UseAll(), in the order of
  // the caller.
  void Export(std::vector<double>& chi2, std::vector<bool>& inliers) const;

 private:
  static constexpr double kOwnLambda = 1e-3;  // initial damping of a landmark moved on its own
  static constexpr double kNegligible = 1e-6;
  // The largest part of the memory of an adjustment, thus in single precision.
  using KeptCoupling = Coupling<Kind::kDof, float>;
  struct Packed {
    Term term;
    int pose = 0;
    int coupling = -1;  // index in couplings_, -1 for a fixed pose
  };

  // Sorts the observations by landmark, then by pose, then by index in the caller's list
  // (original_, begin_).
  void Sort(const std::vector<BaObservation<Term>>& observations);
  double CostOf(std::size_t landmark,
                const State& state,
                const std::vector<BaPose>& poses,
                const HuberThresholds& huber) const;
  // Returns the equations of one landmark; if a solver is given, also adds those of the free poses
  // and the couplings.
  LandmarkEquations<Kind::kDof> Linearize(std::size_t i,
                                          const State& state,
                                          const std::vector<BaPose>& poses,
                                          const HuberThresholds& huber,
                                          SchurSolver* solver);
  // Moves the trial of a landmark (with cost `still`) by a few damped steps under fixed poses. The
  // damping of the landmark is kept from call to call.
  void MoveAlone(std::size_t i,
                 double still,
                 const std::vector<BaPose>& trial_poses,
                 const HuberThresholds& huber);
  // Moves the trial of a landmark with the pose of its first observation that leaves its cost
  // finite. Returns that cost; infinity if there is none.
  double Carry(std::size_t i,
               const std::vector<BaPose>& poses,
               const std::vector<BaPose>& trial_poses,
               const HuberThresholds& huber);
  std::span<KeptCoupling> Couplings(std::size_t landmark) {
    return {couplings_.data() + coupling_begin_[landmark],
            couplings_.data() + coupling_begin_[landmark + 1]};
  }
  void UpdateChi2(const std::vector<BaPose>& poses);

  RectifiedCamera camera_;
  std::vector<State> states_, trial_;
  // First observation of each landmark, then the end.
  std::vector<std::size_t> begin_;
  std::vector<std::size_t> coupling_begin_;  // first coupling of each landmark, then the end
  std::vector<Packed> observations_;
  std::vector<std::size_t> original_;  // index in the caller's observations
  BaParallelLines parallel_;
  std::vector<char> used_;
  std::vector<double> chi2_;
  std::vector<KeptCoupling> couplings_;                 // after the elimination
  std::vector<Coupling<Kind::kDof>> being_eliminated_;  // couplings of one landmark
  std::vector<EliminatedLandmark<Kind::kDof>> eliminated_;
  std::vector<double> cost_, trial_cost_;
  std::vector<double> own_lambda_;  // damping of a landmark moved on its own
  double expected_ = 0;
};

template <class Kind>
BaLandmarks<Kind>::BaLandmarks(const RectifiedCamera& camera,
                               std::vector<State> states,
                               std::vector<BaObservation<Term>> observations,
                               const std::vector<BaPose>& poses,
                               BaParallelLines parallel)
    : camera_(camera), states_(std::move(states)), trial_(states_), parallel_(std::move(parallel)) {
  const std::size_t n = states_.size();
  Sort(observations);
  coupling_begin_.assign(n + 1, 0);
  observations_.reserve(observations.size());
  std::vector<int> coupled;  // pose of each coupling
  for (std::size_t i = 0; i < n; ++i) {
    coupling_begin_[i] = coupled.size();
    int last_pose = -1;
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      const auto& observation = observations[original_[k]];
      const int free_index = poses[static_cast<std::size_t>(observation.pose)].free_index;
      if (free_index >= 0 && observation.pose != last_pose) {
        coupled.push_back(free_index);
      }
      last_pose = observation.pose;
      observations_.push_back({observation.term,
                               observation.pose,
                               free_index < 0 ? -1 : static_cast<int>(coupled.size()) - 1});
    }
  }
  coupling_begin_[n] = coupled.size();
  observations = {};  // freed before the rest is allocated
  couplings_.resize(coupled.size());
  for (std::size_t k = 0; k < coupled.size(); ++k) couplings_[k].pose = coupled[k];
  used_.assign(observations_.size(), 1);
  chi2_.assign(observations_.size(), 0);
  eliminated_.resize(n);
  cost_.assign(n, 0);
  trial_cost_.assign(n, 0);
  own_lambda_.assign(n, 0);
}

template <class Kind>
void BaLandmarks<Kind>::Sort(const std::vector<BaObservation<Term>>& observations) {
  begin_.assign(states_.size() + 1, 0);
  for (const auto& o : observations) ++begin_[static_cast<std::size_t>(o.landmark) + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  original_.resize(observations.size());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t k = 0; k < observations.size(); ++k) {
    original_[next[static_cast<std::size_t>(observations[k].landmark)]++] = k;
  }
  const auto place = [&](std::size_t k) {
    return original_.begin() + static_cast<std::ptrdiff_t>(k);
  };
  for (std::size_t i = 0; i + 1 < begin_.size(); ++i) {
    std::sort(place(begin_[i]), place(begin_[i + 1]), [&](std::size_t a, std::size_t b) {
      const int x = observations[a].pose;
      const int y = observations[b].pose;
      return x != y ? x < y : a < b;
    });
  }
}

template <class Kind>
double BaLandmarks<Kind>::CostOf(std::size_t landmark,
                                 const State& state,
                                 const std::vector<BaPose>& poses,
                                 const HuberThresholds& huber) const {
  const typename Kind::Place place = Kind::MakePlace(state);
  double sum = 0;
  for (std::size_t k = begin_[landmark]; k < begin_[landmark + 1]; ++k) {
    if (!used_[k]) continue;
    const Packed& o = observations_[k];
    const double chi2 = Kind::Chi2(camera_, poses[static_cast<std::size_t>(o.pose)], place, o.term);
    sum += HuberLoss(chi2, Kind::Huber(o.term, huber));
  }
  if constexpr (HasDirection<Kind>) sum += parallel_.Loss(landmark, place.direction, huber.line);
  return 0.5 * sum;
}

template <class Kind>
double BaLandmarks<Kind>::Cost(const std::vector<BaPose>& poses, const HuberThresholds& huber) {
  double sum = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    cost_[i] = CostOf(i, states_[i], poses, huber);
    sum += cost_[i];
  }
  return sum;
}

template <class Kind>
LandmarkEquations<Kind::kDof> BaLandmarks<Kind>::Linearize(std::size_t i,
                                                           const State& state,
                                                           const std::vector<BaPose>& poses,
                                                           const HuberThresholds& huber,
                                                           SchurSolver* solver) {
  const typename Kind::View view = Kind::MakeView(state);
  LandmarkEquations<Kind::kDof> landmark;
  for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
    if (!used_[k]) continue;
    const Packed& o = observations_[k];
    const BaPose& pose = poses[static_cast<std::size_t>(o.pose)];
    typename Kind::Target target{landmark, nullptr, nullptr};
    if (solver != nullptr && o.coupling >= 0) {
      target.pose = &solver->pose(pose.free_index);
      target.W = &being_eliminated_[static_cast<std::size_t>(o.coupling) - coupling_begin_[i]].W;
    }
    Kind::Add(camera_, pose, view, o.term, Kind::Huber(o.term, huber), target);
  }
  if constexpr (HasDirection<Kind>) {
    parallel_.Add(i, view.direction, view.J, huber.line, landmark);
  }
  if constexpr (HoldsGauge<Kind>) Kind::HoldGauge(view, landmark);
  return landmark;
}

template <class Kind>
void BaLandmarks<Kind>::Eliminate(const std::vector<BaPose>& poses,
                                  const HuberThresholds& huber,
                                  double lambda,
                                  SchurSolver& solver) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const std::span<KeptCoupling> kept = Couplings(i);
    being_eliminated_.assign(kept.size(), {});
    for (std::size_t k = 0; k < kept.size(); ++k) being_eliminated_[k].pose = kept[k].pose;
    const LandmarkEquations<Kind::kDof> landmark = Linearize(i, states_[i], poses, huber, &solver);
    eliminated_[i] = solver.Eliminate<Kind::kDof>(
        landmark, lambda + own_lambda_[i], std::span(being_eliminated_));
    for (std::size_t k = 0; k < kept.size(); ++k) {
      kept[k].W = being_eliminated_[k].W.template cast<float>();
    }
  }
}

template <class Kind>
double BaLandmarks<Kind>::Carry(std::size_t i,
                                const std::vector<BaPose>& poses,
                                const std::vector<BaPose>& trial_poses,
                                const HuberThresholds& huber) {
  if constexpr (CanBeCarried<Kind>) {
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      if (!used_[k]) continue;
      const auto pose = static_cast<std::size_t>(observations_[k].pose);
      trial_[i] = Kind::Carried(states_[i], poses[pose], trial_poses[pose]);
      const double cost = CostOf(i, trial_[i], trial_poses, huber);
      if (std::isfinite(cost)) return cost;
    }
  }
  return std::numeric_limits<double>::infinity();
}

template <class Kind>
double BaLandmarks<Kind>::Try(const std::vector<BaPose>& poses,
                              const std::vector<BaPose>& trial_poses,
                              const HuberThresholds& huber,
                              bool carry,
                              const SchurSolver& solver) {
  double sum = 0;
  expected_ = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const auto& eliminated = eliminated_[i];
    trial_[i] = states_[i];
    if (eliminated.regular) {
      const auto step = solver.LandmarkStep<Kind::kDof, float>(eliminated, Couplings(i));
      expected_ -=
          0.5 *
          eliminated.y.dot(eliminated.L.template triangularView<Eigen::Lower>().transpose() * step);
      trial_[i] = Kind::Retract(states_[i], step);
    }
    trial_cost_[i] = CostOf(i, trial_[i], trial_poses, huber);
    if (eliminated.regular && !(trial_cost_[i] <= cost_[i])) {
      const double still = CostOf(i, states_[i], trial_poses, huber);
      if (carry && !std::isfinite(trial_cost_[i]) && !std::isfinite(still)) {
        const double carried = Carry(i, poses, trial_poses, huber);
        MoveAlone(i, carried, trial_poses, huber);
        sum += trial_cost_[i];
        continue;
      }
      if (!(trial_cost_[i] <= still)) {
        trial_[i] = states_[i];
        MoveAlone(i, still, trial_poses, huber);
        sum += trial_cost_[i];
        continue;
      }
    }
    own_lambda_[i] = own_lambda_[i] < kNegligible ? 0 : 0.1 * own_lambda_[i];
    sum += trial_cost_[i];
  }
  return sum;
}

template <class Kind>
void BaLandmarks<Kind>::MoveAlone(std::size_t i,
                                  double still,
                                  const std::vector<BaPose>& trial_poses,
                                  const HuberThresholds& huber) {
  constexpr int kSteps = 5;
  trial_cost_[i] = still;
  if (!std::isfinite(still)) return;
  double& lambda = own_lambda_[i];
  lambda = std::max(lambda, kOwnLambda);
  for (int step = 0; step < kSteps; ++step) {
    const auto equations = Linearize(i, trial_[i], trial_poses, huber, nullptr);
    EliminatedLandmark<Kind::kDof> factor;
    if (!factor.Factor(equations, lambda)) return;
    const State next = Kind::Retract(trial_[i], factor.Step());
    const double cost = CostOf(i, next, trial_poses, huber);
    if (cost < trial_cost_[i]) {
      trial_[i] = next;
      trial_cost_[i] = cost;
      lambda = std::max(kOwnLambda, 0.1 * lambda);
    } else {
      lambda = std::min(1e6, 10 * lambda);
    }
  }
}

template <class Kind>
void BaLandmarks<Kind>::Accept() {
  std::swap(states_, trial_);
  std::swap(cost_, trial_cost_);
}

template <class Kind>
void BaLandmarks<Kind>::UpdateChi2(const std::vector<BaPose>& poses) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const typename Kind::Place place = Kind::MakePlace(states_[i]);
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      const Packed& o = observations_[k];
      chi2_[k] = Kind::Chi2(camera_, poses[static_cast<std::size_t>(o.pose)], place, o.term);
    }
    if constexpr (HasDirection<Kind>) parallel_.UpdateChi2(i, place.direction);
  }
}

template <class Kind>
bool BaLandmarks<Kind>::Classify(const std::vector<BaPose>& poses) {
  UpdateChi2(poses);
  bool changed = parallel_.Classify();
  for (std::size_t k = 0; k < chi2_.size(); ++k) {
    const char used = chi2_[k] <= Chi2Limit95(Kind::Dof(observations_[k].term)) ? 1 : 0;
    changed |= used != used_[k];
    used_[k] = used;
  }
  return changed;
}

template <class Kind>
void BaLandmarks<Kind>::UseAll(const std::vector<BaPose>& poses) {
  UpdateChi2(poses);
  parallel_.UseAll();
  for (std::size_t k = 0; k < chi2_.size(); ++k) used_[k] = std::isfinite(chi2_[k]) ? 1 : 0;
}

template <class Kind>
void BaLandmarks<Kind>::Export(std::vector<double>& chi2, std::vector<bool>& inliers) const {
  chi2.assign(chi2_.size(), 0);
  inliers.assign(chi2_.size(), false);
  for (std::size_t k = 0; k < chi2_.size(); ++k) {
    chi2[original_[k]] = chi2_[k];
    inliers[original_[k]] = used_[k] != 0;
  }
}

}  // namespace plumbline
