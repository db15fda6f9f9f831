// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/dot_plot.h"

#include "plumbline/base/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;

constexpr Figure::Color kInk{40, 40, 40}, kGrid{222, 222, 222}, kFaint{120, 120, 120};
// Told apart by people who confuse red and green as well (Okabe and Ito).
constexpr std::array<Figure::Color, 6> kColors = {
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}}};
constexpr double kTextSize = 13, kLetter = 7.2;  // pixels
constexpr double kTop = 64, kRowHeight = 18, kBandGap = 14, kAxisHeight = 52, kPlotWidth = 560;

Figure::Color ColorOf(std::size_t variant) { return kColors[variant % kColors.size()]; }

// From values to pixels, with its grid lines.
class Axis {
 public:
  Axis(const std::vector<double>& values, double left) : left_(left) {
    constexpr double kLogFrom = 30;
    if (values.empty()) return;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    logarithmic_ = *low > 0 && *high > kLogFrom * *low;
    if (logarithmic_) {
      low_ = math::Log10(*low) - 0.1;
      high_ = math::Log10(*high) + 0.1;
    } else {
      low_ = std::min(0.0, *low);
      high_ = *high > low_ ? low_ + 1.06 * (*high - low_) : low_ + 1;
    }
  }

  double ToPixel(double value) const {
    const double place = logarithmic_ ? math::Log10(value) : value;
    return left_ + kPlotWidth * (place - low_) / (high_ - low_);
  }

  std::vector<double> Ticks() const {
    std::vector<double> ticks;
    if (logarithmic_) {
      for (auto power = static_cast<int>(std::floor(low_)); power <= high_; ++power) {
        for (const double factor : {1.0, 2.0, 5.0}) {
          const double tick = factor * math::Pow(10.0, power);
          if (math::Log10(tick) >= low_ && math::Log10(tick) <= high_) ticks.push_back(tick);
        }
      }
      return ticks;
    }
    const double step = GridStep(high_ - low_, 7);
    const auto last = static_cast<int>(std::floor(high_ / step + 1e-9));
    for (auto i = static_cast<int>(std::ceil(low_ / step - 1e-9)); i <= last; ++i) {
      ticks.push_back(i * step);
    }
    return ticks;
  }

  bool logarithmic() const { return logarithmic_; }

 private:
  double left_;
  bool logarithmic_ = false;
  double low_ = 0, high_ = 1;
};

std::vector<double> ValuesOf(const ResultTable& table, std::size_t column) {
  std::vector<double> values;
  for (const TableRow& row : table.rows) {
    const auto& spread = row.cells[column].spread;
    if (spread) values.insert(values.end(), {spread->min, spread->max});
  }
  return values;
}

double LabelWidth(const Plan& plan) {
  std::size_t longest = 8;
  for (const ExperimentSequence& sequence : plan.sequences) {
    longest = std::max(longest, sequence.name.size());
  }
  return 24 + kLetter * static_cast<double>(longest);
}

void DrawAxis(const Axis& axis, double bottom, Figure& figure) {
  for (const double tick : axis.Ticks()) {
    const double x = axis.ToPixel(tick);
    figure.lines.push_back({{{x, kTop}, {x, bottom}}, kGrid, 1});
    figure.texts.push_back({{x, bottom + kTextSize + 4},
                            fmt::format("{:g}", tick),
                            kTextSize,
                            Figure::Anchor::kMiddle,
                            kInk});
  }
}

void DrawRow(const TableRow& row,
             const TableCell& cell,
             const Axis& axis,
             Vector2d begin,
             bool with_coverage,
             Figure& figure) {
  constexpr double kRadius = 2.4, kAllCovered = 98.95;
  constexpr int kCorners = 16;
  const Figure::Color color = ColorOf(row.variant);
  if (!cell.spread) {
    figure.texts.push_back({begin + Vector2d(6, 0.35 * kTextSize),
                            row.failed > 0 ? fmt::format("{} failed", row.failed) : "no value",
                            kTextSize - 1,
                            Figure::Anchor::kStart,
                            color});
    return;
  }
  const double y = begin.y(), min = axis.ToPixel(cell.spread->min),
               max = axis.ToPixel(cell.spread->max), centre = axis.ToPixel(cell.spread->centre);
  figure.lines.push_back({{{min, y}, {max, y}}, color, 2});
  Figure::Polyline dot{{}, color, 2 * kRadius};  // as wide as its radius: full
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    dot.points.emplace_back(centre + kRadius * math::Cos(angle), y + kRadius * math::Sin(angle));
  }
  figure.lines.push_back(std::move(dot));
  if (!with_coverage || row.coverage >= kAllCovered) return;
  const bool at_end = max > begin.x() + 0.8 * kPlotWidth;
  figure.texts.push_back({{at_end ? min - 8 : max + 8, y + 0.35 * kTextSize},
                          fmt::format("of {:.0f} % of the frames", row.coverage),
                          kTextSize - 2,
                          at_end ? Figure::Anchor::kEnd : Figure::Anchor::kStart,
                          color});
}

void DrawLegend(const Plan& plan, const ResultTable& table, double left, Figure& figure) {
  double x = left;
  for (std::size_t v = 0; v < plan.experiment.variants.size(); ++v) {
    const bool used = std::any_of(table.rows.begin(), table.rows.end(), [v](const TableRow& row) {
      return row.variant == v;
    });
    if (!used) continue;
    const std::string& name = plan.experiment.variants[v].name;
    const double y = kTop - 18;
    figure.lines.push_back({{{x, y}, {x + 14, y}}, ColorOf(v), 4});
    figure.texts.push_back(
        {{x + 19, y + 0.35 * kTextSize}, name, kTextSize, Figure::Anchor::kStart, kInk});
    x += 42 + kLetter * static_cast<double>(name.size());
  }
}

}  // namespace

Figure DotPlot(const Plan& plan, const ResultTable& table, std::size_t column) {
  const Metric& metric = *table.columns[column];
  const double left = LabelWidth(plan);
  const Axis axis(ValuesOf(table, column), left);
  double bottom = kTop;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    bottom += kRowHeight;
    if (r == 0 || table.rows[r].sequence != table.rows[r - 1].sequence) bottom += kBandGap;
  }
  Figure figure;
  figure.width = static_cast<int>(left + kPlotWidth + 30);
  figure.height = static_cast<int>(bottom + kAxisHeight);
  DrawAxis(axis, bottom, figure);
  double y = kTop;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const TableRow& row = table.rows[r];
    if (r == 0 || row.sequence != table.rows[r - 1].sequence) {
      if (r > 0) {
        figure.lines.push_back(
            {{{left, y + 0.5 * kBandGap}, {left + kPlotWidth, y + 0.5 * kBandGap}}, kGrid, 1});
      }
      y += kBandGap;
      figure.texts.push_back({{left - 10, y + 0.5 * kRowHeight + 0.35 * kTextSize},
                              plan.sequences[row.sequence].name,
                              kTextSize,
                              Figure::Anchor::kEnd,
                              kInk});
    }
    DrawRow(row,
            row.cells[column],
            axis,
            {left, y + 0.5 * kRowHeight},
            metric.name.starts_with("ate"),
            figure);
    y += kRowHeight;
  }
  const Vector2d a(left, kTop), b(left + kPlotWidth, kTop), c(left + kPlotWidth, bottom),
      d(left, bottom);
  figure.lines.push_back({{a, b, c, d, a}, kInk, 1});
  figure.texts.push_back({{left + 0.5 * kPlotWidth, bottom + 2.6 * kTextSize + 6},
                          ColumnTitle(metric) + (axis.logarithmic() ? ", logarithmic" : ""),
                          kTextSize,
                          Figure::Anchor::kMiddle,
                          kInk});
  figure.texts.push_back(
      {{left, 20}, std::string(metric.help), kTextSize + 1, Figure::Anchor::kStart, kInk});
  figure.texts.push_back({{left + kPlotWidth, kTop - 14},
                          "median and range of the runs",
                          kTextSize - 2,
                          Figure::Anchor::kEnd,
                          kFaint});
  DrawLegend(plan, table, left, figure);
  return figure;
}

}  // namespace plumbline
