// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/paper_catalog.h"

#include "lab/experiments/rippl_controls.h"

#include <initializer_list>
#include <string>
#include <utility>

namespace plumbline {
namespace {

const std::string kTum = "https://cvg.cit.tum.de/data/datasets/rgbd-dataset/download";
const std::string kEuroc = "https://projects.asl.ethz.ch/datasets/euroc-mav/";
const std::vector<std::string> kRippl = {"--preset", "rippl"};
const std::vector<std::string> kCutting = {"--preset", "good-line-cutting"};

SequenceChoice Tum(const std::string& folder, const std::string& paper) {
  return {"tum/rgbd_dataset_" + folder, {}, "", {}, paper, kTum};
}

// Sequences of the first paper's tables: those of both, those of the second without sitting_static.
std::vector<SequenceChoice> RipplSequences(bool with_static) {
  std::vector<SequenceChoice> choices = {
      Tum("freiburg1_xyz", "fr1_xyz"),
      Tum("freiburg2_xyz", "fr2_xyz"),
      Tum("freiburg1_floor", "fr1_floor"),
      Tum("freiburg2_desk", "fr2_desk"),
      Tum("freiburg3_long_office_household", "fr3_long_office"),
      Tum("freiburg3_nostructure_texture_far", "fr3_nstr_tex_far"),
      Tum("freiburg3_sitting_static", "fr3_sit_static"),
      Tum("freiburg3_structure_texture_far", "fr3_str_tex_far")};
  if (!with_static) choices.erase(choices.begin() + 6);
  return choices;
}

void Append(std::vector<SequenceChoice>& choices, std::initializer_list<const char*> patterns) {
  for (const char* pattern : patterns) choices.push_back({pattern});
}

// The first 100 frames of rendered worlds.
void AppendShort(std::vector<SequenceChoice>& choices, std::initializer_list<const char*> worlds) {
  for (const char* world : worlds) choices.push_back({world, {"frames=100"}, "short"});
}

// One of the first paper's initial maps: by factorization of m frames (rank1_pairwise), or of two
// views (two_view).
std::vector<std::string> StartSettings(const char* method) {
  return {std::string("initialization.method=") + method};
}

std::vector<std::string> With(std::vector<std::string> settings,
                              std::initializer_list<const char*> more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

// Parts common to tables 1 and 2: all data but for the last world, all figures but for the last
// metric; the first variant is the reference.
Experiment RipplTable(std::vector<SequenceChoice> sequences,
                      const char* last_world,
                      std::vector<Variant> variants,
                      const char* last_metric) {
  Experiment e;
  e.sequences = std::move(sequences);
  Append(
      e.sequences,
      {"euroc/*", "icl/*", "kitti/*", "worlds/room", "worlds/office", "worlds/planar", last_world});
  e.reference = variants.front().name;
  e.variants = std::move(variants);
  e.metrics = {
      "ate", "rpe_pairs", "ate_causal", "scale_drift", "start_frames", "lost", "maps", last_metric};
  e.full_runs = 10;
  return e;
}

Experiment RipplTable1() {
  const auto settings = [](const char* method) {
    return With(StartSettings(method), {"features.lines=false", "features.point_count=2000"});
  };
  Experiment e = RipplTable(RipplSequences(true),
                            "worlds/forward",
                            {{"proposed", settings("rank1_pairwise"), kRippl},
                             {"conventional", settings("two_view"), kRippl}},
                            "keyframes");
  e.name = "rippl-table1";
  e.help = "Lee and Hwang 2019, table 1: one camera, 2000 points, by the way the map begins";
  e.plots = {"ate", "rpe_pairs"};
  e.runs = 5;
  return e;
}

// The three systems of table 2, each with all that makes it, so that no difference is one of a
// part: RIPPL begins by factorization and makes lines of n checked views, the others by two views
// and of two; EPL has end points from creation to adjustment, another residual and interval; PPL
// the other turn.
std::vector<Variant> RipplSystems() {
  return {{"RIPPL", {}, kRippl},
          {"EPL",
           With(StartSettings("two_view"),
                {"lines.residual=projected_endpoints", "lines.reconstruction=two_view"}),
           kRippl},
          {"PPL",
           With(StartSettings("two_view"),
                {"lines.residual=plucker_left", "lines.reconstruction=two_view"}),
           kRippl}};
}

// The default system beside those of a paper, with their sensor. It adjusts the whole map at the
// end, which they do not: poses as first reported are from before.
Variant DefaultSystem(std::vector<std::string> arguments) {
  return {"default", {"loop.enabled=false"}, std::move(arguments)};
}

Experiment RipplTable2() {
  std::vector<Variant> systems = RipplSystems();
  systems.push_back(DefaultSystem({"--sensor", "mono"}));
  Experiment e =
      RipplTable(RipplSequences(false), "worlds/lowtexture", std::move(systems), "lines");
  e.ratios = {"ate", "ate_causal"};
  e.name = "rippl-table2";
  e.help = "Lee and Hwang 2019, table 2: one camera, 500 points and 300 lines, by system";
  e.plots = {"ate"};
  e.runs = 5;
  return e;
}

// The systems between RIPPL and PPL of table 2, one step each: another start, then other lines. PPL
// then differs in the turn alone.
Experiment RipplTable2Controls() {
  Experiment e = RipplTable2();
  e.name = "rippl-table2-controls";
  e.help =
      "Lee and Hwang 2019, table 2: the systems between RIPPL and PPL, begun by two views, with "
      "lines of n checked views and of two";
  const std::vector<Variant> systems = RipplSystems();
  const std::vector<std::string> two_view = StartSettings("two_view");
  e.variants = {systems[0],
                {"two_view_start", two_view, kRippl},
                {"two_view_lines", With(two_view, {"lines.reconstruction=two_view"}), kRippl},
                systems[2]};
  e.variants[2].reference = "two_view_start";
  e.variants[3].reference = "two_view_lines";
  return e;
}

Experiment RipplFigure6() {
  Experiment e;
  e.name = "rippl-figure6";
  e.help =
      "Lee and Hwang 2019, figure 6: landmarks of the beginning and those made when the camera is "
      "back, loops open, by the way the map begins";
  // Once round a room, back to the start.
  e.sequences = {Tum("freiburg3_long_office_household", "fr3_long_office"),
                 {"worlds/room", {"rate_hz=15", "frames=150"}, "round"}};
  e.variants = RipplTable1().variants;
  e.metrics = {"ate", "scale_drift", "start_frames", "lost", "maps", "points"};
  e.plots = {"ate", "scale_drift"};
  e.runs = 10;
  e.full_runs = 10;
  e.paper_plot = PaperPlot::kRevisits;
  return e;
}

Experiment RipplFigure7() {
  const auto world = [](const char* pattern) {
    return SequenceChoice{pattern, {"depth=true", "depth_noise=0"}, "depth"};
  };
  Experiment e;
  e.name = "rippl-figure7";
  e.help =
      "Lee and Hwang 2019, figure 7: how soon and how well a map begins on a plane and in slow "
      "forward motion, by the way it begins";
  e.sequences = {Tum("freiburg1_floor", "fr1_floor"),
                 world("worlds/forward"),
                 world("worlds/planar"),
                 {"euroc/*"}};
  const std::string points = "features.point_count=2000";
  e.variants = {{"proposed", {points}, kRippl},
                {"conventional", {points, "initialization.method=two_view"}, kRippl}};
  e.metrics = {"starts",
               "possible",
               "success",
               "wrong",
               "late",
               "waiting",
               "map_frames",
               "map_seconds",
               "rotation_error",
               "direction_error",
               "depth_error",
               "map_points"};
  e.plots = {"success", "map_frames", "direction_error"};
  e.runs = 1;
  e.command = RunCommandKind::kStarts;
  e.reference = "proposed";
  e.ratios = {"rotation_error", "direction_error", "depth_error"};
  e.test_arguments = {"--every", "15"};
  e.pools = {{"plane", {"tum/*", "worlds/planar@*"}},
             {"forward", {"worlds/forward@*"}},
             {"all", {"tum/*", "euroc/*", "worlds/*"}}};
  return e;
}

Experiment RipplFigure8() {
  Experiment e;
  e.name = "rippl-figure8";
  e.help =
      "Lee and Hwang 2019, figure 8: relative error of the first 100 frames, a metre without a "
      "map, "
      "by the frames solved together and by the points in an image";
  e.sequences = RipplSequences(true);
  Append(e.sequences, {"euroc/*", "worlds/office", "worlds/planar"});
  const std::vector<std::string> begin = {"--preset", "rippl", "--to", "100"};
  const auto add = [&](const std::string& name,
                       std::vector<std::string> settings,
                       const std::string& curve,
                       int number) {
    settings.emplace_back("features.lines=false");
    e.variants.push_back({name, std::move(settings), begin, curve, static_cast<double>(number)});
  };
  const std::string method = "initialization.method=";
  for (const int m : {3, 4, 5, 7, 10}) {
    const std::string number = std::to_string(m);
    add("m" + number,
        {"initialization.frames=" + number, "features.point_count=2000"},
        "frames/proposed",
        m);
  }
  add("two_view", {method + "two_view", "features.point_count=2000"}, "frames/conventional", 2);
  for (const int points : {100, 200, 500, 1000, 2000}) {
    const std::string number = std::to_string(points), count = "features.point_count=" + number;
    add("p" + number, {count}, "points/proposed", points);
    add("outliers_p" + number,
        {"initialization.pairwise.reject_outliers=false", count},
        "points/without outlier rejection",
        points);
    add("two_view_p" + number, {method + "two_view", count}, "points/conventional", points);
  }
  e.metrics = {"start_rpe", "start_frames", "lost"};
  e.runs = 2;
  e.full_runs = 5;
  e.abscissa = "frames solved together, or points in an image";
  e.paper_plot = PaperPlot::kConvergence;
  return e;
}

Experiment RipplFigure9() {
  Experiment e;
  e.name = "rippl-figure9";
  e.help = "Lee and Hwang 2019, figure 9: the camera before a plane, by system";
  e.sequences = {Tum("freiburg3_nostructure_texture_far", "fr3_nstr_tex_far"),
                 Tum("freiburg1_floor", "fr1_floor"),
                 {"worlds/planar"}};
  e.variants = RipplSystems();
  e.metrics = {"ate", "start_frames", "lost", "maps", "lines"};
  e.plots = {"ate"};
  e.runs = 10;
  e.full_runs = 10;
  e.paper_plot = PaperPlot::kTrajectories;
  return e;
}

// The systems of table 2 and the default one beside them, also with one camera.
Experiment RipplLines() {
  Experiment e;
  e.variants = RipplSystems();
  e.variants.push_back(DefaultSystem({"--sensor", "mono"}));
  e.runs = 1;
  e.full_runs = 10;
  return e;
}

Experiment RipplFigure10() {
  Experiment e = RipplLines();
  e.name = "rippl-figure10";
  e.help =
      "Lee and Hwang 2019, figure 10: how clean the lines of the map itself are, by system, "
      "from above and from the side";
  e.sequences = {{"worlds/room"},
                 {"worlds/office"},
                 {"worlds/lowtexture"},
                 Tum("freiburg1_floor", "fr1_floor"),
                 {"euroc/MH_01_easy*"}};
  e.metrics = {"map_line_precision",
               "map_line_recall",
               "map_line_error",
               "map_line_angle",
               "line_precision",
               "line_recall",
               "lines",
               "ate"};
  e.plots = {"map_line_precision", "map_line_error"};
  e.paper_plot = PaperPlot::kLineMaps;
  return e;
}

Experiment RipplFigure11() {
  Experiment e = RipplLines();
  e.name = "rippl-figure11";
  e.help =
      "Lee and Hwang 2019, figure 11: the lines of the map that one image shows, from its camera "
      "and from above, by system";
  e.sequences = {{"worlds/room"}, Tum("freiburg1_floor", "fr1_floor"), {"euroc/MH_01_easy*"}};
  e.metrics = {"map_line_error", "map_line_angle", "map_line_precision", "lines", "ate"};
  e.plots = {"map_line_error"};
  e.paper_plot = PaperPlot::kLineArea;
  return e;
}

Experiment RipplTimingSystem() {
  Experiment e;
  e.name = "rippl-timing-system";
  e.help = "Lee and Hwang 2019, section 5: times of tracking and adjustment by system";
  e.sequences = RipplSequences(false);
  Append(e.sequences, {"euroc/*", "worlds/room"});
  e.variants = RipplSystems();
  e.metrics = {"adjust_ms",
               "adjust_p95_ms",
               "track_ms",
               "frame_ms",
               "cpu_ms",
               "adjusted_line_bytes",
               "map_line_bytes",
               "memory_mb"};
  e.plots = {"adjust_ms", "frame_ms"};
  e.runs = 3;
  e.full_runs = 5;
  e.exclusive = true;
  return e;
}

// Systems of the second paper: against the last frame, with the residuals and weights of its
// program. +Cut trims lines to the measured segment and cuts them; _trimmed only trims them.
std::vector<Variant> CuttingSystems() {
  const char *no_points = "features.points=false", *whole = "cutting.method=none",
             *trimmed = "cutting.method=trim";
  return {{"L", {no_points, whole}, kCutting},
          {"L+Cut", {no_points}, kCutting},
          {"PL", {whole}, kCutting},
          {"PL+Cut", {}, kCutting},
          {"P", {"features.lines=false"}, kCutting},
          {"L_trimmed", {no_points, trimmed}, kCutting},
          {"PL_trimmed", {trimmed}, kCutting},
          {"PL_weighted", {whole, "lines.weighting=covariance"}, kCutting},
          DefaultSystem({})};
}

// Parts common to tables 1 to 3: ratios are to the paper's system.
Experiment CuttingTable() {
  Experiment e;
  e.variants = CuttingSystems();
  e.metrics = {"rpe_causal_mean", "roe_causal_mean", "coverage", "lost"};
  e.plots = {"rpe_causal_mean", "roe_causal_mean"};
  e.reference = "PL+Cut";
  e.ratios = {"rpe_causal_mean", "roe_causal_mean"};
  e.full_runs = 10;
  e.tolerated_failures = 2;
  return e;
}

Experiment CuttingTable1() {
  Experiment e = CuttingTable();
  e.name = "cutting-table1";
  e.help = "Zhao and Vela 2018, table 1: line cutting where there is little texture";
  SequenceChoice world = {"worlds/lowtexture"};
  world.paper = "low texture";
  e.sequences = {world};
  e.runs = 10;
  return e;
}

Experiment CuttingTables2And3() {
  Experiment e = CuttingTable();
  e.name = "cutting-table2-3";
  e.help = "Zhao and Vela 2018, tables 2 and 3: line cutting in fast flight, sharp and blurred";
  for (const bool blurred : {false, true}) {
    const std::string label = blurred ? "blurred" : "";
    const std::vector<std::string> blur =
        blurred ? std::vector<std::string>{"--blur", "5"} : std::vector<std::string>{};
    for (const std::string name : {"V1_01_easy",
                                   "V1_02_medium",
                                   "V1_03_difficult",
                                   "V2_01_easy",
                                   "V2_02_medium",
                                   "V2_03_difficult"}) {
      const std::string paper = blurred ? name + " blurred" : name;
      e.sequences.push_back({"euroc/" + name, {}, label, blur, paper, kEuroc});
    }
    for (const char* pattern : {"euroc/MH_*", "worlds/vicon_*"}) {
      e.sequences.push_back({pattern, {}, label, blur});
    }
  }
  e.runs = 5;
  return e;
}

Experiment CuttingFigure5() {
  Experiment e;
  e.name = "cutting-figure5";
  e.help =
      "Zhao and Vela 2018, figure 5: measured lines and the pieces that are left of them, with "
      "little texture, motion blur and changing light";
  e.sequences = {{"euroc/V1_03_difficult", {}, "", {}, "V1_03_difficult", kEuroc},
                 {"worlds/lowtexture"},
                 {"worlds/vicon_difficult"},
                 {"worlds/lights"}};
  // Against the map, so that there are keyframes with lines to draw.
  e.variants = {{"PL+Cut", {"tracking.reference=local_map"}, kCutting}};
  e.metrics = {"rpe_causal_mean", "lost", "lines"};
  e.runs = 1;
  e.paper_plot = PaperPlot::kCutLines;
  return e;
}

Experiment CuttingTimingSystem() {
  Experiment e;
  e.name = "cutting-timing-system";
  e.help = "Zhao and Vela 2018, section 6.2: time of tracking with and without line cutting";
  e.sequences = {{"euroc/V1_01_easy", {}, "", {}, "V1_01_easy", kEuroc},
                 {"euroc/MH_*"},
                 {"worlds/vicon_medium"}};
  const std::vector<Variant> all = CuttingSystems();
  e.variants = {all[2], all[3]};
  e.metrics = {"track_ms", "frame_ms", "frame_p95_ms", "cpu_ms"};
  e.plots = {"track_ms"};
  e.runs = 3;
  e.full_runs = 5;
  e.exclusive = true;
  return e;
}

}  // namespace

std::vector<Experiment> PaperExperiments() {
  return {RipplTable1(),
          RipplTable2(),
          RipplTable2Controls(),
          RipplFigure6(),
          RipplFigure7(),
          RipplFigure8(),
          RipplControls(),
          RipplFigure9(),
          RipplFigure10(),
          RipplFigure11(),
          RipplTimingSystem(),
          CuttingTable1(),
          CuttingTables2And3(),
          CuttingFigure5(),
          CuttingTimingSystem()};
}

Experiment GateExperiment() {
  Experiment e;
  e.name = "gate";
  e.help = "a few minutes over worlds and what recordings there are, with limits to keep";
  AppendShort(e.sequences, {"worlds/room", "worlds/lowtexture", "worlds/planar", "worlds/lateral"});
  Append(e.sequences,
         {"euroc/MH_01_easy_first250",
          "tum/rgbd_dataset_freiburg1_floor_first90",
          "kitti/06_first51"});
  e.variants = {{"both", {}}, {"mono", {}, {"--sensor", "mono"}}};
  e.metrics = {
      "ate", "ate_causal", "rpe_causal_mean", "lost", "maps", "line_recall", "line_precision"};
  e.plots = {"ate"};
  e.runs = 1;
  return e;
}

Experiment LineGateExperiment() {
  Experiment e;
  e.name = "gate_lines";
  e.help = "the lines of a map in three worlds, the mean of some runs, with limits to keep";
  AppendShort(e.sequences, {"worlds/room", "worlds/lowtexture", "worlds/lateral"});
  e.variants = {{"both", {}}};
  e.metrics = {"line_recall", "line_precision", "ate"};
  e.plots = {"line_recall", "line_precision"};
  e.runs = 4;
  return e;
}

std::span<const ExperimentGroup> ExperimentGroups() {
  static const std::vector<ExperimentGroup> kGroups = [] {
    std::vector<ExperimentGroup> groups = {
        {"rippl-timing",
         "Lee and Hwang 2019, section 5: times of the system and of a start",
         {"rippl-timing-system", "rippl-timing-initialization"}},
        {"cutting-timing",
         "Zhao and Vela 2018, section 6.2: times of line cutting, in the system and by itself",
         {"cutting-timing-system", "cutting-timing-optimizers"}}};
    ExperimentGroup all{"all", "every table and figure of both papers", {}};
    const std::string control = "rippl-table2-controls";  // of no table or figure of a paper
    for (const Experiment& experiment : PaperExperiments()) {
      if (experiment.name != control) all.experiments.push_back(experiment.name);
    }
    all.experiments.insert(
        all.experiments.end(),
        {"cutting-figure2-4", "rippl-timing-initialization", "cutting-timing-optimizers"});
    groups.push_back(all);
    groups.push_back({"controls",
                      "our own controls, of which docs/results.md and docs/papers have tables",
                      {"line_controls",
                       "line_controls_mono",
                       "line_matching_mono",
                       "lines_lights",
                       "initialization_parts",
                       "cutting_controls",
                       "cutting_controls_lines",
                       control}});
    return groups;
  }();
  return kGroups;
}

const ExperimentGroup* FindExperimentGroup(std::string_view name) {
  for (const ExperimentGroup& group : ExperimentGroups()) {
    if (group.name == name) return &group;
  }
  return nullptr;
}

}  // namespace plumbline
