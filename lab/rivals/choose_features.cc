// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/rivals/choose_features.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/error.h"
#include "plumbline/line_cutting/pose_information.h"
#include "plumbline/line_cutting/single_line.h"

#include <cmath>
#include <queue>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace plumbline {
namespace {

// Returns log det(R + J^T W J) - log det R.
template <class Rows, class Weight>
double GainOf(const Eigen::LLT<Matrix6d>& rest, const Rows& rows, const Weight& weight) {
  using Square = Eigen::Matrix<double,
                               Rows::RowsAtCompileTime,
                               Rows::RowsAtCompileTime,
                               0,
                               Rows::MaxRowsAtCompileTime,
                               Rows::MaxRowsAtCompileTime>;
  const Square one = Square::Identity(rows.rows(), rows.rows());
  const Square spread = rows * rest.solve(rows.transpose());
  return math::Log((one + weight * spread).determinant());
}

bool CutsLines(CuttingMethod method) {
  return method != CuttingMethod::kNone && method != CuttingMethod::kDrop;
}

// A point, or a line with its best cut, as of the last time it was looked at.
struct Candidate {
  double gain = 0;
  std::size_t index = 0;   // index of points first, then of lines
  std::size_t looked = 0;  // number of chosen features at that time
  LineCut cut;

  bool operator<(const Candidate& other) const {
    return gain != other.gain ? gain < other.gain : index > other.index;
  }
};

class GreedyChoice {
 public:
  GreedyChoice(const CuttingProblem& problem,
               std::span<const PointRows> points,
               const CuttingRecipe& recipe)
      : problem_(problem), points_(points), information_(recipe.information) {
    if (information_ == CuttingInformation::kPrinted) {
      information_ = CuttingInformation::kIndependent;
    }
    cuts_ = CutsLines(recipe.method);
  }

  // Fills `choice`. On entry it says which lines may be chosen.
  void Run(std::size_t budget, ChosenFeatures& choice) {
    Refresh();
    std::priority_queue<Candidate> queue;
    for (std::size_t i = 0; i < points_.size(); ++i) queue.push(Look(i));
    for (std::size_t i = 0; i < choice.lines.size(); ++i) {
      if (choice.lines[i].used) queue.push(Look(points_.size() + i));
      choice.lines[i].used = false;
    }
    while (chosen_ < budget && !queue.empty()) {
      const Candidate best = queue.top();
      queue.pop();
      if (best.looked == chosen_) {
        Take(best, choice);
      } else {
        queue.push(Look(best.index));
      }
    }
  }

 private:
  void Refresh() {
    rest_.compute(PoseInformation(sums_, problem_.other_information, information_));
  }

  Candidate Look(std::size_t index) const {
    if (index < points_.size()) {
      const PointRows& rows = points_[index];
      return {GainOf(rest_, rows, 1.0), index, chosen_, {}};
    }
    const std::size_t line = index - points_.size();
    const LineCut cut =
        cuts_ ? CutSingleLine(problem_, line, sums_, {}, information_).cut : LineCut{};
    const CutResiduals residuals =
        EvaluateCut(problem_.camera, problem_.lines[line], cut, information_);
    return {GainOf(rest_, residuals.rows, residuals.weight), index, chosen_, cut};
  }

  void Take(const Candidate& best, ChosenFeatures& choice) {
    if (best.index < points_.size()) {
      choice.points[best.index] = true;
      sums_.weighted.noalias() += points_[best.index].transpose() * points_[best.index];
    } else {
      const std::size_t line = best.index - points_.size();
      choice.lines[line] = best.cut;
      sums_.Add(EvaluateCut(problem_.camera, problem_.lines[line], best.cut, information_));
    }
    ++chosen_;
    Refresh();
  }

  const CuttingProblem& problem_;
  std::span<const PointRows> points_;
  CuttingInformation information_;
  bool cuts_ = false;
  InformationSums sums_;  // sums over the chosen features
  std::size_t chosen_ = 0;
  Eigen::LLT<Matrix6d> rest_;
};

}  // namespace

void CutChosen(const CuttingProblem& problem,
               std::span<const PointRows> points,
               const CuttingRecipe& recipe,
               ChosenFeatures& choice) {
  CuttingProblem chosen{problem.camera, {}, problem.other_information};
  chosen.other_information += SumPoints(points, choice.points);
  for (std::size_t i = 0; i < choice.lines.size(); ++i) {
    if (choice.lines[i].used) chosen.lines.push_back(problem.lines[i]);
  }
  const std::vector<LineCut> cuts = CutLinesBy(recipe, chosen);
  auto cut = cuts.begin();
  for (LineCut& line : choice.lines) {
    if (line.used) line = *cut++;
  }
}

ChosenFeatures ChooseFeatures(const CuttingProblem& problem,
                              std::span<const PointRows> points,
                              std::size_t budget,
                              const CuttingRecipe& recipe) {
  if (budget >= points.size() + problem.lines.size()) {
    CuttingProblem all = problem;
    all.other_information += SumPoints(points);
    return {std::vector<bool>(points.size(), true), CutLinesBy(recipe, all)};
  }
  ChosenFeatures choice{
      std::vector<bool>(points.size(), false), std::vector<LineCut>(problem.lines.size()), false};
  if (recipe.method == CuttingMethod::kDrop) choice.lines = CutLinesBy(recipe, problem);
  GreedyChoice(problem, points, recipe).Run(budget, choice);
  const bool cut_already =
      recipe.method == CuttingMethod::kGreedy && recipe.information != CuttingInformation::kPrinted;
  if (CutsLines(recipe.method) && !cut_already) CutChosen(problem, points, recipe, choice);
  return choice;
}

}  // namespace plumbline
