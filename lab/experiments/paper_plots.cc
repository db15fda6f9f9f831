// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paper_plots.h"

#include "lab/experiments/curve_plot.h"
#include "lab/experiments/line_map_plots.h"
#include "lab/line_maps/run_trajectory.h"
#include "plumbline/base/error.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/report/trajectory_figure.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Figure::Color kBlack{0, 0, 0}, kGrey{150, 150, 150}, kRed{213, 40, 0}, kBlue{0, 90, 178};
constexpr std::array<Figure::Color, 4> kColors = {
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}}};

// Plots have the names of files.
std::string NameForPlot(std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

// From above: the two axes in which the true path moves most.
struct View {
  std::pair<int, int> axes;
  Vector2d Of(const Vector3d& point) const { return {point[axes.first], point[axes.second]}; }
};

// A drawing in metres with room for a legend.
class TopView {
 public:
  TopView(const std::vector<Vector2d>& shown, const std::string& title) {
    constexpr double kSide = 460;
    Eigen::AlignedBox2d range;
    for (const Vector2d& point : shown) range.extend(point);
    const Vector2d margin = Vector2d::Constant(0.03 * range.diagonal().norm() + 1e-6);
    range.extend(range.min() - margin);
    range.extend(range.max() + margin);
    figure_.width = 640;
    figure_.height = 570;
    panel_ = {64, 50, 540, kSide, EqualScale(range, 540 / kSide), "m", "m", ": " + title};
    DrawPanel(panel_, figure_);
  }

  void Path(const std::vector<Vector2d>& points, Figure::Color color) {
    Figure::Polyline line{{}, color, 1.5};
    for (const Vector2d& point : points) line.points.push_back(panel_.ToPixel(point));
    if (line.points.size() > 1) figure_.lines.push_back(std::move(line));
  }

  void Dot(const Vector2d& point, Figure::Color color) {
    if (!panel_.range.contains(point)) return;
    const Vector2d at = panel_.ToPixel(point), half(1, 0);
    figure_.lines.push_back({{at - half, at + half}, color, 2});
  }

  // Of many every second, third, ...: more are no clearer, and the file would be large.
  void Dots(const std::vector<Vector2d>& points, Figure::Color color) {
    constexpr std::size_t kMost = 900;
    const std::size_t step = points.size() / (kMost + 1) + 1;
    for (std::size_t i = 0; i < points.size(); i += step) Dot(points[i], color);
  }

  void Legend(const std::vector<std::pair<std::string, Figure::Color>>& entries) {
    double x = 64;
    for (const auto& [text, color] : entries) {
      figure_.lines.push_back({{{x, 20}, {x + 22, 20}}, color, 3});
      figure_.texts.push_back({{x + 28, 24}, text, kFigureTextSize, Figure::Anchor::kStart, {}});
      x += 52 + 7.2 * static_cast<double>(text.size());
    }
  }

  Figure Take() { return std::move(figure_); }

 private:
  Figure figure_;
  FigurePanel panel_{};
};

std::vector<Vector2d> PathOf(const TrajectoryError& error, const View& view, bool reference) {
  std::vector<Vector2d> path;
  for (const EvaluatedPose& pose : error.poses) {
    path.push_back(view.Of(reference ? pose.reference.translation : pose.estimate.translation));
  }
  return path;
}

std::optional<TrajectoryError> ErrorOf(const Plan& plan, const Job& job) {
  return CompareRunWithTruth(plan.SequenceOf(job).path, job.folder);
}

double ValueOr(const RunFigures& figures, std::string_view name, double other) {
  const auto value = figures.values.find(name);
  return value == figures.values.end() ? other : value->second;
}

// Means over the runs of a variant that have a result.
struct StartMeans {
  double error_mm = 0, frames = 0;
  int runs = 0;
};

std::vector<StartMeans> MeansOfVariants(const Plan& plan, const std::vector<JobResult>& results) {
  constexpr double kFrames = 100;  // that figure 8 is about
  std::vector<StartMeans> means(plan.experiment.variants.size());
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (!results[i].figures) continue;
    StartMeans& mean = means[plan.jobs[i].variant];
    const auto error = results[i].figures->values.find("start_rpe");
    if (error == results[i].figures->values.end()) continue;
    mean.error_mm += error->second;
    mean.frames += ValueOr(*results[i].figures, "start_frames", kFrames);
    ++mean.runs;
  }
  for (StartMeans& mean : means) {
    if (mean.runs == 0) continue;
    mean.error_mm /= mean.runs;
    mean.frames /= mean.runs;
  }
  return means;
}

// The curves whose name begins with `group`, in the order of their first variant; each point from a
// variant.
template <class Point>
std::vector<Curve> CurvesOf(const Plan& plan,
                            const std::vector<StartMeans>& means,
                            const std::string& group,
                            const Point& point) {
  std::vector<Curve> curves;
  for (std::size_t v = 0; v < means.size(); ++v) {
    const Variant& variant = plan.experiment.variants[v];
    if (means[v].runs == 0 || !variant.curve.starts_with(group)) continue;
    const std::string name = variant.curve.substr(group.size());
    auto curve =
        std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.name == name; });
    if (curve == curves.end()) curve = curves.insert(curves.end(), {name, {}});
    curve->points.push_back(point(variant, means[v]));
  }
  return curves;
}

// Path and landmarks of the beginning and of the end, in the world of the truth.
struct Revisit {
  std::vector<Vector2d> truth, path, begin, end;
};

std::optional<Revisit> ReadRevisit(const Plan& plan, const Job& job) {
  constexpr double kShare = 0.15;
  const auto error = ErrorOf(plan, job);
  if (!error || error->poses.size() < 2) return std::nullopt;
  const View view{AxesOfMostMotion(error->poses)};
  Revisit out{PathOf(*error, view, true), PathOf(*error, view, false), {}, {}};
  const SavedMap saved = LoadMap(job.folder / "map.plb");
  std::map<KeyFrameId, std::int64_t> stamps;
  for (const auto& [id, keyframe] : saved.map.keyframes()) stamps[id] = keyframe.frame.stamp_ns;
  if (stamps.empty()) return out;
  const std::int64_t first = stamps.begin()->second, last = stamps.rbegin()->second;
  const auto part = static_cast<std::int64_t>(kShare * static_cast<double>(last - first));
  for (const auto& [id, point] : saved.map.points()) {
    const auto seen = stamps.find(point.observations.begin()->first);
    if (seen == stamps.end()) continue;
    const Vector2d place = view.Of(error->reference_from_estimate * point.position);
    if (seen->second <= first + part) out.begin.push_back(place);
    if (seen->second >= last - part) out.end.push_back(place);
  }
  return out;
}

// The jobs of run 1, by sequence, then variant.
std::vector<std::size_t> FirstRuns(const Plan& plan, const std::vector<JobResult>& results) {
  std::vector<std::size_t> jobs;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (plan.jobs[i].run == 1 && results[i].figures) jobs.push_back(i);
  }
  return jobs;
}

std::string DescribeJob(const Plan& plan, const Job& job) {
  return plan.SequenceOf(job).name + ", " + plan.VariantOf(job).name;
}

void AddPerJob(const Plan& plan,
               const std::vector<JobResult>& results,
               std::vector<PagePlot>& out) {
  const bool revisits = plan.experiment.paper_plot == PaperPlot::kRevisits;
  for (const std::size_t i : FirstRuns(plan, results)) {
    const Job& job = plan.jobs[i];
    const std::string name =
        NameForPlot(plan.SequenceOf(job).name + "_" + plan.VariantOf(job).name);
    try {
      out.push_back({(revisits ? "revisits_" : "cut_lines_") + name,
                     revisits ? ToSvg(RevisitPlot(plan, job)) : CutLinePlot(plan, job)});
    } catch (const InputError&) {
      continue;  // the table reports the failure
    }
  }
}

// The pictures of lines of each sequence that has runs.
void AddLinePlots(const Plan& plan,
                  const std::vector<JobResult>& results,
                  std::vector<PagePlot>& out) {
  const bool area = plan.experiment.paper_plot == PaperPlot::kLineArea;
  for (std::size_t s = 0; s < plan.sequences.size(); ++s) {
    try {
      const std::string svg =
          area ? LineAreaPlot(plan, results, s) : LineMapsPlot(plan, results, s);
      if (svg.empty()) continue;
      out.push_back(
          {(area ? "line_area_" : "line_maps_") + NameForPlot(plan.sequences[s].name), svg});
    } catch (const InputError&) {
      continue;  // the table reports the failure
    }
  }
}

}  // namespace

Figure ConvergencePlot(const Plan& plan, const std::vector<JobResult>& results) {
  const auto means = MeansOfVariants(plan, results);
  const auto by_number = [](const Variant& variant, const StartMeans& mean) {
    return Vector2d(variant.abscissa, mean.error_mm);
  };
  const auto by_frames = [](const Variant&, const StartMeans& mean) {
    return Vector2d(mean.frames, mean.error_mm);
  };
  const std::string error = "error of relative positions, mean [mm]";
  std::vector<CurvePanel> panels;
  panels.push_back({"(a), 2000 points",
                    "frames until there is a map, mean",
                    error,
                    CurvesOf(plan, means, "frames/", by_frames),
                    true});
  panels.push_back({"2000 points",
                    "frames solved together",
                    error,
                    CurvesOf(plan, means, "frames/", by_number),
                    true});
  panels.push_back({"(b), m = 3",
                    "points in an image",
                    error,
                    CurvesOf(plan, means, "points/", by_number),
                    true});
  return CurvePlot(panels);
}

Figure PathPlot(const Plan& plan, const std::vector<JobResult>& results, std::size_t sequence) {
  std::vector<Vector2d> shown, truth;
  std::vector<std::pair<std::string, std::vector<Vector2d>>> paths;
  std::optional<View> view;
  for (const std::size_t i : FirstRuns(plan, results)) {
    const Job& job = plan.jobs[i];
    if (job.sequence != sequence) continue;
    const auto error = ErrorOf(plan, job);
    if (!error || error->poses.size() < 2) continue;
    if (!view) view = View{AxesOfMostMotion(error->poses)};
    if (error->poses.size() > truth.size()) truth = PathOf(*error, *view, true);
    paths.emplace_back(plan.VariantOf(job).name, PathOf(*error, *view, false));
    shown.insert(shown.end(), paths.back().second.begin(), paths.back().second.end());
  }
  shown.insert(shown.end(), truth.begin(), truth.end());
  if (shown.empty()) return {};
  TopView drawing(shown, plan.sequences[sequence].name);
  std::vector<std::pair<std::string, Figure::Color>> legend = {{"truth", kGrey}};
  drawing.Path(truth, kGrey);
  for (std::size_t p = 0; p < paths.size(); ++p) {
    drawing.Path(paths[p].second, kColors[p % kColors.size()]);
    legend.emplace_back(paths[p].first, kColors[p % kColors.size()]);
  }
  drawing.Legend(legend);
  return drawing.Take();
}

Figure RevisitPlot(const Plan& plan, const Job& job) {
  const auto revisit = ReadRevisit(plan, job);
  if (!revisit) return {};
  // Single landmarks far away would make all else small.
  std::vector<Vector2d> shown = revisit->truth;
  Eigen::AlignedBox2d range;
  for (const Vector2d& point : shown) range.extend(point);
  const double reach = 2 * range.diagonal().norm();
  for (const auto* places : {&revisit->begin, &revisit->end}) {
    for (const Vector2d& place : *places) {
      if (range.exteriorDistance(place) < reach) shown.push_back(place);
    }
  }
  TopView drawing(shown, DescribeJob(plan, job));
  drawing.Dots(revisit->begin, kBlack);
  drawing.Dots(revisit->end, kRed);
  drawing.Path(revisit->truth, kGrey);
  drawing.Path(revisit->path, kBlue);
  drawing.Legend({{"made at the beginning", kBlack},
                  {"made at the end", kRed},
                  {"path", kBlue},
                  {"truth", kGrey}});
  return drawing.Take();
}

std::vector<PagePlot> PaperPlots(const Plan& plan, const std::vector<JobResult>& results) {
  std::vector<PagePlot> plots;
  switch (plan.experiment.paper_plot) {
    case PaperPlot::kNone:
      break;
    case PaperPlot::kConvergence:
      plots.push_back({"convergence", ToSvg(ConvergencePlot(plan, results))});
      break;
    case PaperPlot::kTrajectories:
      for (std::size_t s = 0; s < plan.sequences.size(); ++s) {
        const Figure figure = PathPlot(plan, results, s);
        if (figure.width > 0) {
          plots.push_back({"paths_" + NameForPlot(plan.sequences[s].name), ToSvg(figure)});
        }
      }
      break;
    case PaperPlot::kLineMaps:
    case PaperPlot::kLineArea:
      AddLinePlots(plan, results, plots);
      break;
    case PaperPlot::kRevisits:
    case PaperPlot::kCutLines:
      AddPerJob(plan, results, plots);
      break;
  }
  return plots;
}

}  // namespace plumbline
