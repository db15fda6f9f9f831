// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/report_data.h"

#include "plumbline/base/base64.h"
#include "plumbline/base/elementary.h"
#include "plumbline/base/options.h"
#include "plumbline/base/options_io.h"
#include "plumbline/image/rectify.h"
#include "plumbline/report/run_scene.h"
#include "plumbline/report/timing.h"

#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / std::numbers::pi;

// Rounds a number, since few digits keep the page small.
Json Rounded(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = math::Pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

// Collects numbers as little-endian float32 in base64.
class Floats {
 public:
  void Add(double value) {
    static_assert(std::endian::native == std::endian::little);
    const auto bytes = std::bit_cast<std::array<char, 4>>(static_cast<float>(value));
    bytes_.append(bytes.data(), bytes.size());
  }
  template <class Vector>
  void Add(const Eigen::MatrixBase<Vector>& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) Add(v(i));
  }
  std::string Encoded() const { return EncodeBase64(bytes_); }

 private:
  std::string bytes_;
};

Json Options(SlamOptions used) {
  SlamOptions defaults;
  const OptionTable default_table(defaults), used_table(used);
  Json list = Json::array();
  for (const OptionField& field : used_table.fields()) {
    list.push_back({{"key", field.key},
                    {"value", used_table.Value(field.key)},
                    {"default", default_table.Value(field.key)},
                    {"help", field.help}});
  }
  return list;
}

std::string FormatName(DatasetFormat format) {
  return format == DatasetFormat::kStream ? "stream" : NameOf(format);
}

// A word as a shell would read it back.
std::string ShellWord(const std::string& word) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./=:,+-@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

Json Run(const RunResult& result, const Dataset& dataset, const ReportContext& context) {
  const RunDescription& description = context.description;
  std::string command = "plumbline run";
  for (const std::string& word : description.arguments) command += " " + ShellWord(word);
  const auto rate = dataset.calibration().rate_hz;
  const auto gyroscope = DescribeGyroscope(result);
  return {{"name", dataset.info().name},
          {"path", description.data_path},
          {"format", FormatName(dataset.info().format)},
          {"sensor", NameOf(dataset.sensor())},
          {"frames_in_sequence", dataset.size()},
          {"frames_chosen", description.frames_chosen},
          {"interrupted", description.interrupted ? Json(*description.interrupted) : Json(nullptr)},
          {"rate_hz", rate ? Json(*rate) : Json(nullptr)},
          {"version", description.version},
          {"date", context.date},
          {"seed", description.seed},
          {"command", description.arguments.empty() ? Json(nullptr) : Json(command)},
          {"notes", NotesOf(description, dataset)},
          {"gyroscope", gyroscope ? Json(*gyroscope) : Json(nullptr)},
          {"wall_seconds", Rounded(context.resources.wall_seconds, 3)},
          {"cpu_seconds", Rounded(context.resources.cpu_seconds, 3)},
          {"peak_memory_mb", Rounded(context.resources.peak_memory_mb, 1)},
          {"preset", description.preset ? Json(*description.preset) : Json(nullptr)},
          {"options", Options(result.options)}};
}

Json Counts(const RunCounts& c) {
  return {{"frames", c.frames},
          {"tracked", c.tracked},
          {"lost", c.lost},
          {"skipped", c.skipped},
          {"dropped", c.dropped},
          {"initializing", c.initializing},
          {"shed_mapping", c.shed_mapping},
          {"shed_lines", c.shed_lines},
          {"shed_points", c.shed_points},
          {"demoted", c.demoted},
          {"maps", c.maps},
          {"keyframes", c.keyframes},
          {"points", c.points},
          {"lines", c.lines}};
}

Json Frames(const FrameLog& frames, const ShownFrames& shown) {
  using F = FrameRecord;
  const auto column = [&](const auto& value) {
    Json values = Json::array();
    for (const std::size_t number : shown.numbers()) values.push_back(value(frames[number]));
    return values;
  };
  const std::int64_t start = frames.empty() ? 0 : frames.StampOf(0);
  return {
      {"number", shown.numbers()},
      {"seconds", column([&](const F& f) {
         return Rounded(static_cast<double>(f.stamp_ns - start) * 1e-9, 4);
       })},
      {"state", column([](const F& f) { return NameOf(f.status); })},
      {"reason", column([](const F& f) { return f.reason; })},
      {"shed", column([](const F& f) { return NameOf(f.shed); })},
      {"map", column([](const F& f) { return f.map.valid() ? Json(f.map.value) : Json(nullptr); })},
      {"keyframe", column([](const F& f) { return f.keyframe ? 1 : 0; })},
      {"matched_points", column([](const F& f) { return f.counts.matched_points; })},
      {"inlier_points", column([](const F& f) { return f.counts.inlier_points; })},
      {"matched_lines", column([](const F& f) { return f.counts.matched_lines; })},
      {"inlier_lines", column([](const F& f) { return f.counts.inlier_lines; })}};
}

Json Stages(const FrameLog& frames, const ShownFrames& shown) {
  Json stages = Json::array();
  for (const StageStatistics& s : TimingStatistics(frames)) {
    Json column = Json::array();
    for (const std::optional<double>& ms : StageMilliseconds(frames, shown.numbers(), s.stage)) {
      column.push_back(ms ? Rounded(*ms, 3) : Json(nullptr));
    }
    stages.push_back({{"name", s.stage},
                      {"frames", s.count},
                      {"median", Rounded(s.median, 3)},
                      {"p95", Rounded(s.p95, 3)},
                      {"p99", Rounded(s.p99, 3)},
                      {"max", Rounded(s.max, 3)},
                      {"mean", Rounded(s.mean, 3)},
                      {"milliseconds", std::move(column)}});
  }
  return stages;
}

Json Statistics(const std::optional<ErrorStatistics>& s, double factor) {
  if (!s) return nullptr;
  return {{"rmse", s->rmse * factor},
          {"mean", s->mean * factor},
          {"median", s->median * factor},
          {"max", s->max * factor},
          {"count", s->count}};
}

// Returns the row of a frame; null if it is not shown.
Json Row(const ShownFrames& shown, std::size_t frame) {
  const std::optional<std::size_t> row = shown.RowOf(frame);
  return row ? Json(*row) : Json(nullptr);
}

Json Error(const MapScene& map, SensorKind sensor, const ShownFrames& shown) {
  if (!map.error) return nullptr;
  const TrajectoryError& error = *map.error;
  Json frames = Json::array(), position = Json::array(), rotation = Json::array();
  for (const EvaluatedPose& pose : error.poses) {
    const Json row = Row(shown, map.frames[pose.row]);
    if (row.is_null()) continue;
    frames.push_back(row);
    position.push_back(Rounded(pose.position_error, 6));
    rotation.push_back(Rounded(pose.rotation_error * kDegrees, 4));
  }
  Json from = Json::array(), to = Json::array(), rpe = Json::array(), roe = Json::array();
  for (const RelativeError& r : error.relative) {
    const Json row = Row(shown, map.frames[error.poses[r.from].row]);
    if (row.is_null()) continue;
    from.push_back(row);
    to.push_back(map.frames[error.poses[r.to].row]);
    rpe.push_back(Rounded(r.translation, 6));
    roe.push_back(Rounded(r.rotation * kDegrees, 5));
  }
  return {{"alignment", sensor == SensorKind::kMono ? "Sim(3)" : "SE(3)"},
          {"degenerate", error.degenerate.has_value()},
          {"window_seconds", 3},
          {"ate", Statistics(error.ate, 1)},
          {"rpe", Statistics(error.rpe, 1)},
          {"roe", Statistics(error.roe, kDegrees)},
          {"frames", std::move(frames)},
          {"position", std::move(position)},
          {"rotation", std::move(rotation)},
          {"relative_from", std::move(from)},
          {"relative_to", std::move(to)},
          {"relative_position", std::move(rpe)},
          {"relative_rotation", std::move(roe)}};
}

// Returns true if lengths are metres: a single camera measures none, unless ground truth scales its
// map.
bool IsMetric(const MapScene& map, SensorKind sensor) {
  if (sensor != SensorKind::kMono) return true;
  return map.error && map.error->degenerate.value_or(AlignmentFailure::kCollinear) ==
                          AlignmentFailure::kCollinear;
}

Json MapData(const MapScene& map,
             const Vector3d& origin,
             SensorKind sensor,
             const ShownFrames& shown) {
  Json frames = Json::array();
  Floats positions, points, lines, keyframes;
  for (std::size_t i = 0; i < map.frames.size(); ++i) {
    const Json row = Row(shown, map.frames[i]);
    if (row.is_null()) continue;
    frames.push_back(row);
    positions.Add(map.poses[i].translation - origin);
  }
  for (const Vector3d& point : map.points) points.Add(point - origin);
  for (const Segment3& line : map.lines) {
    lines.Add(line.start - origin);
    lines.Add(line.end - origin);
  }
  for (const Rigid3& pose : map.keyframe_poses) {
    keyframes.Add(pose.translation - origin);
    keyframes.Add(pose.rotation.coeffs());  // in the order x y z w
  }
  return {{"id", map.id.value},
          {"metric", IsMetric(map, sensor)},
          {"keyframe_count", map.keyframe_count},
          {"point_count", map.point_count},
          {"line_count", map.line_count},
          {"pose_count", map.poses.size()},
          {"frames", std::move(frames)},
          {"positions", positions.Encoded()},
          {"keyframe_frames", map.keyframe_frames},
          {"keyframes", keyframes.Encoded()},
          {"points", points.Encoded()},
          {"lines", lines.Encoded()},
          {"error", Error(map, sensor, shown)}};
}

Json Place(const std::optional<Vector3d>& place, const Vector3d& origin) {
  if (!place) return nullptr;
  const Vector3d at = *place - origin;
  return {Rounded(at.x(), 4), Rounded(at.y(), 4), Rounded(at.z(), 4)};
}

Json Event(const RunEvent& event, const Vector3d& origin, const ShownFrames& shown) {
  const Recognition& place = event.place;
  Json json = {{"kind", NameOf(event.kind)},
               {"frame", Row(shown, static_cast<std::size_t>(place.frame.value))},
               {"older_keyframe", place.older.value},
               {"map", event.map ? Json(event.map->value) : Json(nullptr)},
               {"older_at", Place(event.older_at, origin)},
               {"points", place.points},
               {"lines", place.lines}};
  if (event.kind != RunEventKind::kRelocalization) {
    json["keyframe"] = place.keyframe.value;
    json["at"] = Place(event.at, origin);
    json["log10_chance"] = Rounded(place.log10_chance, 1);
    json["moved"] = place.moved;
    json["turned_deg"] = place.turned_deg;
    json["scale"] = place.scale;
  }
  if (event.join) {
    json["kept_map"] = event.join->kept.value;
    json["gone_map"] = event.join->gone.value;
  }
  return json;
}

Json Events(const RunScene& scene, const ShownFrames& shown) {
  Json events = Json::array();
  for (const RunEvent& event : scene.events) events.push_back(Event(event, scene.origin, shown));
  return events;
}

Json Scene(const RunResult& result,
           const Dataset& dataset,
           const RunScene& scene,
           const ShownFrames& shown) {
  Json maps = Json::array();
  for (const MapScene& map : scene.maps) {
    maps.push_back(MapData(map, scene.origin, dataset.sensor(), shown));
  }
  const std::int64_t start = result.frames.empty() ? 0 : result.frames.StampOf(0);
  Floats reference, reference_seconds;
  for (const StampedPose& pose : scene.reference) {
    reference.Add(pose.world_from_camera.translation - scene.origin);
    reference_seconds.Add(static_cast<double>(pose.stamp_ns - start) * 1e-9);
  }
  const RectifiedCamera& camera = result.camera;
  return {{"origin", {scene.origin.x(), scene.origin.y(), scene.origin.z()}},
          {"up", {scene.up.x(), scene.up.y(), scene.up.z()}},
          {"has_ground_truth", dataset.info().ground_truth.has_value()},
          {"ground_truth_fault",
           dataset.info().ground_truth_fault ? Json(*dataset.info().ground_truth_fault)
                                             : Json(nullptr)},
          {"reference", reference.Encoded()},
          {"reference_seconds", reference_seconds.Encoded()},
          {"main", scene.main ? Json(*scene.main) : Json(nullptr)},
          {"maps", std::move(maps)},
          {"events", Events(scene, shown)},
          // The borders of the image plane at unit depth: left, top, right, bottom.
          {"frustum",
           {-camera.cx / camera.fx,
            -camera.cy / camera.fy,
            (camera.width - camera.cx) / camera.fx,
            (camera.height - camera.cy) / camera.fy}}};
}

std::string Pixels(const std::vector<Eigen::Vector2d>& points) {
  Floats floats;
  for (const Eigen::Vector2d& point : points) floats.Add(point);
  return floats.Encoded();
}

std::string Pixels(const std::vector<Segment2>& segments) {
  Floats floats;
  for (const Segment2& segment : segments) {
    floats.Add(segment.start);
    floats.Add(segment.end);
  }
  return floats.Encoded();
}

Json Samples(const std::vector<SampleImage>& samples, const ShownFrames& shown) {
  Json list = Json::array();
  for (const SampleImage& sample : samples) {
    list.push_back({{"frame", Row(shown, static_cast<std::size_t>(sample.frame.value))},
                    {"file", sample.file},
                    {"width", sample.width},
                    {"height", sample.height},
                    {"image", "data:image/jpeg;base64," + EncodeBase64(sample.jpeg)},
                    {"matched_points", Pixels(sample.matched_points)},
                    {"other_points", Pixels(sample.other_points)},
                    {"matched_lines", Pixels(sample.matched_lines)},
                    {"other_lines", Pixels(sample.other_lines)}});
  }
  return list;
}

// What is used of the lens, with the outline in the image as delivered; null if all of it is.
Json Lens(const Dataset& dataset) {
  if (!dataset.info().has_calibration) return nullptr;
  const Rectifier rectifier(dataset.calibration());
  if (rectifier.PassesUnchanged()) return nullptr;
  Json outline = Json::array();
  for (const Eigen::Vector2d& px : rectifier.LeftCoverage().outline) {
    outline.push_back({std::lround(px.x()), std::lround(px.y())});
  }
  return {{"width", dataset.calibration().left.width()},
          {"height", dataset.calibration().left.height()},
          {"text", ViewText(rectifier)},
          {"outline", std::move(outline)}};
}

// Returns the frames that are shown whatever their number: those of events and images.
std::vector<std::size_t> FramesSpokenOf(const RunScene& scene,
                                        const std::vector<SampleImage>& samples) {
  std::vector<std::size_t> frames;
  for (const RunEvent& event : scene.events) {
    frames.push_back(static_cast<std::size_t>(event.place.frame.value));
  }
  for (const SampleImage& sample : samples) {
    frames.push_back(static_cast<std::size_t>(sample.frame.value));
  }
  return frames;
}

}  // namespace

std::string FormatReportData(const RunResult& result,
                             const Dataset& dataset,
                             const ReportContext& context) {
  const RunScene scene = MakeRunScene(result, dataset);
  const ShownFrames shown(
      result.frames, FramesSpokenOf(scene, context.samples), context.most_frames);
  Json json;
  json["run"] = Run(result, dataset, context);
  json["counts"] = Counts(CountRun(result));
  json["shown_every"] = shown.step();
  json["frames"] = Frames(result.frames, shown);
  json["stages"] = Stages(result.frames, shown);
  json["scene"] = Scene(result, dataset, scene, shown);
  json["samples"] = Samples(context.samples, shown);
  json["lens"] = Lens(dataset);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace plumbline
