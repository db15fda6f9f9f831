// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/line_map_plots.h"

#include "lab/line_maps/line_map_error.h"
#include "lab/line_maps/line_map_figure.h"
#include "lab/line_maps/run_line_map.h"
#include "lab/line_maps/run_trajectory.h"
#include "plumbline/base/base64.h"
#include "plumbline/base/error.h"
#include "plumbline/io/datasets/open_dataset.h"
#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/io/export/png.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/report/trajectory_figure.h"
#include "worlds/true_world.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Figure::Color kTrueLine{185, 185, 185}, kRightLine{20, 140, 50}, kWrongLine{215, 30, 30},
    kUnjudgedLine{30, 30, 30}, kTruePath{0, 90, 178};
constexpr double kPanelWidth = 300, kMostPanelHeight = 320, kColumn = 366, kMarginLeft = 62,
                 kMarginTop = 62, kRowGap = 62;

// A run, and lines of its map in the world of the ground truth.
struct RunLines {
  const Job* job = nullptr;
  std::string variant;
  TrajectoryError trajectory;
  std::vector<Segment3> lines;
};

// View common to all columns: the coordinates right, ahead and up of a point of the world, their
// names, and their ranges.
struct LineScene {
  std::function<Vector3d(const Vector3d&)> to_view;
  std::array<std::string, 3> axes;
  std::vector<TrueLine> truth;
  bool truth_known = false;
  std::vector<Vector3d> path;
  Eigen::AlignedBox3d range;  // of the view's coordinates
};

// One row of panels: right, and ahead or up.
struct LineRow {
  int vertical = 0;  // 1: ahead, seen from above; 2: up
  std::string name;
};

// The first run of each variant that has one, with all lines of its map.
std::vector<RunLines> FirstRunsOn(const Plan& plan,
                                  const std::vector<JobResult>& results,
                                  std::size_t sequence) {
  std::vector<RunLines> runs;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const Job& job = plan.jobs[i];
    if (job.sequence != sequence || job.run != 1 || !results[i].figures) continue;
    try {
      auto trajectory = CompareRunWithTruth(plan.SequenceOf(job).path, job.folder);
      if (!trajectory || trajectory->poses.size() < 2) continue;
      auto lines = ReadLinesInTrueWorld(job.folder / "map.plb", *trajectory);
      runs.push_back({&job, plan.VariantOf(job).name, *std::move(trajectory), std::move(lines)});
    } catch (const InputError&) {
      continue;  // the table reports the failure
    }
  }
  return runs;
}

void ReadTruth(const std::filesystem::path& sequence, LineScene& scene) {
  scene.truth_known = std::filesystem::exists(sequence / "lines.csv");
  if (scene.truth_known) scene.truth = ReadTrueLines(sequence / "lines.csv");
}

// Nine of ten ends of the lines of all runs, on each axis, and the path.
Eigen::AlignedBox3d RangeOfLines(const std::vector<RunLines>& runs, const LineScene& scene) {
  constexpr double kLeftOut = 0.05;  // at either side
  std::array<std::vector<double>, 3> values;
  for (const RunLines& run : runs) {
    for (const Segment3& line : run.lines) {
      for (const Vector3d& end : {scene.to_view(line.start), scene.to_view(line.end)}) {
        for (int axis = 0; axis < 3; ++axis)
          values[static_cast<std::size_t>(axis)].push_back(end(axis));
      }
    }
  }
  Eigen::AlignedBox3d range;
  for (const Vector3d& place : scene.path) range.extend(place);
  if (values[0].empty()) return range;
  Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& of_axis = values[static_cast<std::size_t>(axis)];
    std::sort(of_axis.begin(), of_axis.end());
    const auto left_out = static_cast<std::size_t>(kLeftOut * static_cast<double>(of_axis.size()));
    low(axis) = of_axis[left_out];
    high(axis) = of_axis[of_axis.size() - 1 - left_out];
  }
  return range.extend(low).extend(high);
}

// The lines of a run with their colours, wrong ones at the back.
std::vector<std::pair<Segment3, Figure::Color>> Colored(const RunLines& run,
                                                        const LineScene& scene) {
  std::vector<std::pair<Segment3, Figure::Color>> colored;
  if (!scene.truth_known) {
    for (const Segment3& line : run.lines) colored.emplace_back(line, kUnjudgedLine);
    return colored;
  }
  LineMapErrorOptions options;
  options.tolerances = {0.05};
  const LineMapError error = CompareLineMaps(scene.truth, run.lines, {}, options);
  for (const bool right : {false, true}) {
    for (std::size_t i = 0; i < run.lines.size(); ++i) {
      if (error.counterparts[i].has_value() != right) continue;
      colored.emplace_back(run.lines[i], right ? kRightLine : kWrongLine);
    }
  }
  return colored;
}

class LineColumns {
 public:
  LineColumns(const LineScene& scene, std::array<LineRow, 2> rows, double left)
      : scene_(scene), rows_(std::move(rows)), left_(left) {
    const Vector3d size = 1.06 * scene.range.sizes().cwiseMax(Vector3d::Constant(1e-3));
    const double scale = std::min(
        {kPanelWidth / size.x(), kMostPanelHeight / size.y(), kMostPanelHeight / size.z()});
    const double half_width = 0.5 * kPanelWidth / scale;
    double top = kMarginTop;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const int axis = rows_[r].vertical;
      const double height = std::max(40.0, scale * size(axis));
      const Vector2d centre(scene.range.center().x(), scene.range.center()(axis));
      const Vector2d half(half_width, 0.5 * height / scale);
      panels_[r] = {left, top, kPanelWidth, height, {centre - half, centre + half}, {}, {}, {}};
      panels_[r].label_x = scene.axes[0] + " [m]";
      panels_[r].label_y = scene.axes[static_cast<std::size_t>(axis)] + " [m]";
      top += height + kRowGap;
    }
    figure_.height = static_cast<int>(top);
    figure_.width = static_cast<int>(left);
  }

  void Add(const RunLines& run) {
    const auto colored = Colored(run, scene_);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      FigurePanel panel = panels_[r];
      panel.left = left_;
      panel.title = ", " + rows_[r].name;
      DrawPanel(panel, figure_);
      for (const TrueLine& line : scene_.truth) Draw(line.segment, kTrueLine, 2, r, panel);
      for (const auto& [line, color] : colored) Draw(line, color, 0.9, r, panel);
      for (std::size_t i = 1; i < scene_.path.size(); ++i) {
        DrawInView({scene_.path[i - 1], scene_.path[i]}, kTruePath, 1.5, r, panel);
      }
    }
    figure_.texts.push_back({{left_ + 0.5 * kPanelWidth, 22},
                             fmt::format("{} ({} lines)", run.variant, run.lines.size()),
                             15,
                             Figure::Anchor::kMiddle,
                             {0, 0, 0}});
    left_ += kColumn;
    figure_.width = static_cast<int>(left_ - kMarginLeft + 16);
  }

  // Below all columns.
  void Legend() {
    std::vector<std::pair<std::string, Figure::Color>> entries;
    if (!scene_.path.empty()) entries.emplace_back("true path", kTruePath);
    if (scene_.truth_known) {
      entries.insert(entries.begin(),
                     {{"within 5 cm of a true line", kRightLine},
                      {"not", kWrongLine},
                      {"true line", kTrueLine}});
    }
    double x = panels_[0].left;
    const double y = figure_.height - 6.0;
    for (const auto& [text, color] : entries) {
      figure_.lines.push_back({{{x, y}, {x + 22, y}}, color, 3});
      figure_.texts.push_back({{x + 28, y + 4}, text, kFigureTextSize, Figure::Anchor::kStart, {}});
      x += 52 + 7.2 * static_cast<double>(text.size());
    }
    figure_.height += 12;
  }

  Figure& figure() { return figure_; }

 private:
  void Draw(const Segment3& line,
            Figure::Color color,
            double width,
            std::size_t row,
            const FigurePanel& panel) {
    DrawInView({scene_.to_view(line.start), scene_.to_view(line.end)}, color, width, row, panel);
  }

  void DrawInView(const Segment3& line,
                  Figure::Color color,
                  double width,
                  std::size_t row,
                  const FigurePanel& panel) {
    const int axis = rows_[row].vertical;
    const auto part =
        Clipped({{line.start.x(), line.start(axis)}, {line.end.x(), line.end(axis)}}, panel.range);
    if (!part) return;
    figure_.lines.push_back({{panel.ToPixel(part->start), panel.ToPixel(part->end)}, color, width});
  }

  const LineScene& scene_;
  std::array<LineRow, 2> rows_;
  std::array<FigurePanel, 2> panels_{};  // of the first column
  double left_ = 0;                      // of the next column
  Figure figure_;
};

const KeyFrame& NearestInTime(const Map& map, std::int64_t stamp_ns) {
  const KeyFrame* nearest = nullptr;
  const auto distance = [stamp_ns](const KeyFrame& keyframe) {
    return std::abs(keyframe.frame.stamp_ns - stamp_ns);
  };
  for (const auto& [id, keyframe] : map.keyframes()) {
    if (nearest == nullptr || distance(keyframe) < distance(*nearest)) nearest = &keyframe;
  }
  if (nearest == nullptr) throw InputError("there is no keyframe");
  return *nearest;
}

// The lines that a keyframe sees, in the world of the ground truth.
std::vector<Segment3> LinesSeenBy(const KeyFrame& keyframe,
                                  const Map& map,
                                  const TrajectoryError& trajectory) {
  const Similarity3 true_from_run = TrueWorldFromRun(trajectory);
  std::vector<Segment3> lines;
  for (const LineId id : keyframe.frame.lines) {
    const MapLine* line = map.Find(id);
    if (line == nullptr) continue;
    const Segment3 ends = line->Interval();
    lines.push_back({true_from_run * ends.start, true_from_run * ends.end});
  }
  return lines;
}

// Leaves the true lines that a frame sees.
void KeepVisible(int frame, std::vector<TrueLine>& truth) {
  std::erase_if(truth, [frame](const TrueLine& line) {
    return line.visible &&
           std::none_of(line.visible->begin(), line.visible->end(), [frame](const FrameRange& r) {
             return r.first <= frame && frame <= r.last;
           });
  });
}

// The pose of the true camera at a time of the run.
Rigid3 TruePoseAt(const TrajectoryError& trajectory, std::int64_t stamp_ns) {
  const auto nearest =
      std::min_element(trajectory.poses.begin(),
                       trajectory.poses.end(),
                       [stamp_ns](const EvaluatedPose& a, const EvaluatedPose& b) {
                         return std::abs(a.stamp_ns - stamp_ns) < std::abs(b.stamp_ns - stamp_ns);
                       });
  return nearest->reference;
}

// The image of a keyframe with the measured segments of lines of the map.
struct AreaImage {
  std::string png;
  int width = 0, height = 0;
};

AreaImage DrawAreaImage(const KeyFrameImages& images, const KeyFrame& keyframe) {
  const GrayImage image = ToGray(images.Read(keyframe));
  Overlay overlay;
  for (std::size_t i = 0; i < keyframe.frame.lines.size(); ++i) {
    if (!keyframe.frame.lines[i].valid()) continue;
    overlay.segments.push_back({keyframe.frame.features().lines[i].segment, {0, 200, 0}});
  }
  return {EncodeOverlayPng(image, overlay), image.width(), image.height()};
}

// Puts the image into the first column of a drawing.
std::string WithImage(std::string svg, const AreaImage& image) {
  const double height = kPanelWidth * image.height / image.width;
  const std::string element = fmt::format(
      "<image x=\"16\" y=\"{}\" width=\"{}\" height=\"{:.2f}\" "
      "href=\"data:image/png;base64,{}\"/>\n",
      kMarginTop,
      kPanelWidth,
      height,
      EncodeBase64(image.png));
  return svg.insert(svg.rfind("</svg>"), element);
}

}  // namespace

const KeyFrame& KeyFrameWithMostLines(const Map& map) {
  const auto count = [](const KeyFrame& keyframe) {
    return std::count_if(keyframe.frame.lines.begin(), keyframe.frame.lines.end(), [](LineId id) {
      return id.valid();
    });
  };
  const KeyFrame* best = nullptr;
  std::size_t at = 0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const bool middle = 4 * at >= map.keyframes().size() && 4 * at <= 3 * map.keyframes().size();
    if (middle && (best == nullptr || count(keyframe) > count(*best))) best = &keyframe;
    ++at;
  }
  if (best == nullptr || count(*best) == 0) throw InputError("there is no keyframe with lines");
  return *best;
}

std::string LineMapsPlot(const Plan& plan,
                         const std::vector<JobResult>& results,
                         std::size_t sequence) {
  std::vector<RunLines> runs = FirstRunsOn(plan, results, sequence);
  if (runs.empty()) return {};
  const auto& poses = runs.front().trajectory.poses;
  const std::pair<int, int> level = AxesOfMostMotion(poses);
  const int up = 3 - level.first - level.second;
  constexpr std::array kNames = {"x", "y", "z"};
  LineScene scene;
  scene.to_view = [level, up](const Vector3d& p) {
    return Vector3d(p(level.first), p(level.second), p(up));
  };
  for (std::size_t i = 0; const int axis : {level.first, level.second, up}) {
    scene.axes[i++] = kNames[static_cast<std::size_t>(axis)];
  }
  ReadTruth(plan.sequences[sequence].path, scene);
  for (const EvaluatedPose& pose : poses) {
    scene.path.push_back(scene.to_view(pose.reference.translation));
  }
  for (const TrueLine& line : scene.truth) {
    scene.range.extend(scene.to_view(line.segment.start));
    scene.range.extend(scene.to_view(line.segment.end));
  }
  if (scene.truth.empty()) scene.range = RangeOfLines(runs, scene);
  LineColumns columns(scene, {LineRow{1, "from above"}, LineRow{2, "from the side"}}, kMarginLeft);
  for (const RunLines& run : runs) columns.Add(run);
  columns.Legend();
  return ToSvg(columns.figure());
}

std::string LineAreaPlot(const Plan& plan,
                         const std::vector<JobResult>& results,
                         std::size_t sequence) {
  std::vector<RunLines> runs = FirstRunsOn(plan, results, sequence);
  if (runs.empty()) return {};
  const std::filesystem::path& path = plan.sequences[sequence].path;
  const SavedMap first = LoadMap(runs.front().job->folder / "map.plb");
  const KeyFrame& shown = KeyFrameWithMostLines(first.map);
  const std::int64_t stamp_ns = shown.frame.stamp_ns;
  for (RunLines& run : runs) {
    const SavedMap saved = LoadMap(run.job->folder / "map.plb");
    run.lines = LinesSeenBy(NearestInTime(saved.map, stamp_ns), saved.map, run.trajectory);
  }
  const Rigid3 cam_from_world = Inverse(TruePoseAt(runs.front().trajectory, stamp_ns));
  LineScene scene;
  scene.to_view = [cam_from_world](const Vector3d& p) {
    const Vector3d in_camera = cam_from_world * p;  // x right, y down, z ahead
    return Vector3d(in_camera.x(), in_camera.z(), -in_camera.y());
  };
  scene.axes = {"right", "ahead", "up"};
  ReadTruth(path, scene);
  const auto dataset = OpenDataset(path);
  const auto& stamps = dataset->info().stamps_ns;
  KeepVisible(
      static_cast<int>(std::lower_bound(stamps.begin(), stamps.end(), stamp_ns) - stamps.begin()),
      scene.truth);
  scene.range = RangeOfLines(runs, scene);
  LineColumns columns(
      scene, {LineRow{2, "from the camera"}, LineRow{1, "from above"}}, kColumn + 16);
  for (const RunLines& run : runs) columns.Add(run);
  columns.Legend();
  return WithImage(ToSvg(columns.figure()), DrawAreaImage(KeyFrameImages(path, {}, first), shown));
}

}  // namespace plumbline
