// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/mapping/local_mapper.h"

#include "plumbline/io/map_file/map_io.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/true_map.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Feeds a mapper with keyframes along the path, whose poses are off by some centimetres and whose
// matches are those that the truth says the map holds.
class MapperRun {
 public:
  explicit MapperRun(const MappingOptions& options = {})
      : options_(options), mapper_(world_.Imaging(), {}, options) {}

  void Add(int path_frame, double pose_noise) {
    const KeyFrameId id = map_.NextKeyFrameId();
    Rng rng(3, "mapper_run", static_cast<std::uint64_t>(id.value));
    const SyntheticFrame sensed = Sense(world_, PoseOnPath(path_frame), {}, rng);
    Vector6d twist;
    twist << RandomVector<3>(rng, 0.2 * pose_noise), RandomVector<3>(rng, pose_noise);
    if (id == KeyFrameId{0}) twist.setZero();
    given_error_.push_back(twist.tail<3>().norm());
    truth_[id] = PoseOnPath(path_frame);
    KeyFrame keyframe{id,
                      KeyFrameId{id.value - 1},
                      MakeFrame(FrameId{path_frame}, ExpSe3(twist) * truth_[id], sensed)};
    if (displaced_) Displace(keyframe.frame);
    sensed_[id] = sensed;
    Match(keyframe.frame, sensed);
    steps_ = mapper_.Add(map_, keyframe, {});
    map_.CheckInvariants();
  }

  void Save(const std::filesystem::path& file) const {
    AtlasContext context;
    context.camera = world_.camera;
    const LocalMapper::State state = mapper_.state();
    context.stereo_evidence = state.stereo_evidence;
    context.maps[map_.id()].young = state.young.at(map_.id());
    Atlas atlas;
    atlas.Adopt(map_);
    SaveAtlas(file, atlas, context, map_.id());
  }
  // Goes on with what is in the file alone.
  void GoOnFrom(const std::filesystem::path& file) {
    const SavedAtlas saved = LoadAtlas(file);
    map_ = saved.atlas.active();
    mapper_ = LocalMapper(world_.Imaging(), {}, options_);
    mapper_.SetState(
        {{{map_.id(), saved.context.maps.at(map_.id()).young}}, saved.context.stereo_evidence});
  }

  // The right images of keyframes to come are displaced.
  void DisplaceRightImages() { displaced_ = true; }
  StereoCorrection CorrectionOfNewMap() {
    Map map;
    mapper_.StartNewMap(map);
    return map.correction().stereo;
  }

  const Map& map() const { return map_; }
  const AdjustedLines& adjusted_lines() const { return mapper_.adjusted_lines(); }
  const std::vector<MappingStep>& steps() const { return steps_; }
  double WorstPose() const {
    double worst = 0;
    for (const auto& [id, keyframe] : map_.keyframes()) {
      worst = std::max(worst, CentreDistance(keyframe.frame.cam_from_world, truth_.at(id)));
    }
    return worst;
  }
  double MeanGivenError() const {
    double sum = 0;
    for (const double e : given_error_) sum += e;
    return sum / static_cast<double>(given_error_.size());
  }
  // Share of the points with two or more views all of whose views are of one point of the world.
  double Purity() const {
    int pure = 0;
    int all = 0;
    for (const auto& [id, point] : map_.points()) {
      if (point.observations.size() < 2) continue;
      ++all;
      pure += TruthsOf(point).size() == 1;
    }
    return static_cast<double>(pure) / all;
  }

 private:
  void Displace(Frame& frame) const {
    Vector6d k;
    k << 0.2, 0.4, -0.3, -0.8, 0.3, 0.2;
    auto displaced = std::make_shared<FrameFeatures>(*frame.indexed);
    Correct({{world_.camera, k}}, {}, displaced->features);
    frame.indexed = displaced;
  }

  std::set<std::size_t> TruthsOf(const MapPoint& point) const {
    std::set<std::size_t> truths;
    for (const auto& [keyframe, feature] : point.observations) {
      truths.insert(sensed_.at(keyframe).point_truth[static_cast<std::size_t>(feature)]);
    }
    return truths;
  }

  // Landmarks of the map by the world's index, from the newest keyframes.
  void Match(Frame& frame, const SyntheticFrame& sensed) const {
    std::map<std::size_t, PointId> point_of;
    std::map<std::size_t, LineId> line_of;
    for (const auto& [id, keyframe] : map_.keyframes()) {
      const SyntheticFrame& before = sensed_.at(id);
      for (std::size_t i = 0; i < before.point_truth.size(); ++i) {
        if (keyframe.frame.points[i].valid())
          point_of[before.point_truth[i]] = keyframe.frame.points[i];
      }
      for (std::size_t i = 0; i < before.line_truth.size(); ++i) {
        if (keyframe.frame.lines[i].valid())
          line_of[before.line_truth[i]] = keyframe.frame.lines[i];
      }
    }
    for (std::size_t i = 0; i < sensed.point_truth.size(); ++i) {
      const auto it = point_of.find(sensed.point_truth[i]);
      if (it != point_of.end()) frame.points[i] = it->second;
    }
    for (std::size_t i = 0; i < sensed.line_truth.size(); ++i) {
      const auto it = line_of.find(sensed.line_truth[i]);
      if (it != line_of.end()) frame.lines[i] = it->second;
    }
  }

  SyntheticWorld world_ = MakeSyntheticWorld(400, 100);
  MappingOptions options_;
  LocalMapper mapper_;
  Map map_;
  std::map<KeyFrameId, SyntheticFrame> sensed_;
  std::map<KeyFrameId, Rigid3> truth_;
  std::vector<double> given_error_;
  std::vector<MappingStep> steps_;
  bool displaced_ = false;
};

TEST(LocalMapper, KeepsInvariantsAndImprovesPoses) {
  MapperRun run;
  for (int k = 0; k < 12; ++k) run.Add(4 * k, 0.03);
  EXPECT_GT(run.MeanGivenError(), 0.03);
  EXPECT_LT(run.WorstPose(), 0.02);
  EXPECT_GT(run.map().points().size(), 200U);
  EXPECT_GT(run.map().lines().size(), 20U);
  EXPECT_GT(run.Purity(), 0.98);
}

TEST(LocalMapper, BeginsNewMapsWithWhatItLearnedOfTheRightImage) {
  MapperRun run;
  run.DisplaceRightImages();
  EXPECT_EQ(run.CorrectionOfNewMap(), StereoCorrection());
  for (int k = 0; k < 12; ++k) run.Add(8 * k, 0);
  ASSERT_NE(run.map().correction().stereo, StereoCorrection());
  constexpr double kSmallestChangePx = 0.02;
  const StereoCorrection begun = run.CorrectionOfNewMap();
  for (const double x : {0.0, 300.0, 600.0}) {
    const Eigen::Vector2d px(x, 0.5 * x);
    EXPECT_NEAR(begun.At(px), run.map().correction().stereo.At(px), kSmallestChangePx);
  }
}

TEST(LocalMapper, GoesOnFromAFileAsIfItHadNeverStopped) {
  const ScratchFolder folder;
  MapperRun whole, paused;
  for (MapperRun* run : {&whole, &paused}) run->DisplaceRightImages();
  for (int k = 0; k < 14; ++k) {
    whole.Add(6 * k, 0.01);
    paused.Add(6 * k, 0.01);
    if (k % 3 != 2) continue;
    paused.Save(folder / "paused.plb");
    paused.GoOnFrom(folder / "paused.plb");
  }
  ASSERT_NE(whole.map().correction().stereo, StereoCorrection());
  whole.Save(folder / "whole.plb");
  paused.Save(folder / "paused.plb");
  EXPECT_EQ(Contents(folder / "whole.plb"), Contents(folder / "paused.plb"));
}

TEST(LocalMapper, ReportsItsStepsInOrder) {
  MapperRun run;
  run.Add(0, 0);
  std::vector<std::string> names;
  for (const MappingStep& step : run.steps()) {
    names.push_back(step.name);
    EXPECT_GE(step.milliseconds, 0);
  }
  EXPECT_EQ(
      names,
      (std::vector<std::string>{"take_in", "create", "fuse", "adjust", "calibrate", "clean_up"}));
}

TEST(LocalMapper, CountsTheLinesThatItAdjusts) {
  MapperRun run;
  EXPECT_EQ(run.adjusted_lines().count, 0U);
  for (int k = 0; k < 3; ++k) run.Add(4 * k, 0.01);
  const AdjustedLines before = run.adjusted_lines();
  EXPECT_GT(before.bytes, before.count * 2 * sizeof(OrthonormalLine));
  run.Add(12, 0.01);
  EXPECT_GT(run.adjusted_lines().count, before.count);
}

TEST(LocalMapper, TheFirstKeyFrameNeverMoves) {
  MapperRun run;
  for (int k = 0; k < 6; ++k) run.Add(4 * k, 0.02);
  EXPECT_EQ(LogSe3(run.map().Find(KeyFrameId{0})->frame.cam_from_world).norm(), 0);
}

TEST(LocalMapper, RemovesRedundantKeyFramesWhenAllowed) {
  MappingOptions keep_all;
  keep_all.cleanup.redundant_share = 1;
  MapperRun all(keep_all);
  MappingOptions thin;
  thin.cleanup.redundant_share = 0.7;
  MapperRun few(thin);
  for (int k = 0; k < 10; ++k) {
    all.Add(k, 0.005);
    few.Add(k, 0.005);
  }
  EXPECT_EQ(all.map().keyframes().size(), 10U);
  EXPECT_LT(few.map().keyframes().size(), 10U);
  for (std::int64_t k = 0; k < 10; ++k) {
    // Removed or not, each keyframe has a place.
    EXPECT_LT(CentreDistance(few.map().PoseOf(KeyFrameId{k}), PoseOnPath(static_cast<int>(k))),
              0.02);
  }
}

TEST(LocalMapper, GivesTheSameMapEveryTime) {
  MapperRun first;
  MapperRun second;
  for (int k = 0; k < 6; ++k) {
    first.Add(4 * k, 0.02);
    second.Add(4 * k, 0.02);
  }
  ASSERT_EQ(first.map().points().size(), second.map().points().size());
  auto other = second.map().points().begin();
  for (const auto& [id, point] : first.map().points()) {
    EXPECT_EQ(id, other->first);
    EXPECT_EQ(point.position, other->second.position);
    EXPECT_EQ(point.descriptor, other->second.descriptor);
    ++other;
  }
}

// Young landmarks of a map that is left are judged when the camera is back in it, under whatever
// name the map then has.
TEST(LocalMapper, RemembersTheYoungLandmarksOfMapsThatAreLeftAndJoined) {
  Atlas atlas;
  for (int i = 0; i < 3; ++i) atlas.Start();
  LocalMapper mapper(SyntheticWorld().Imaging(), {}, {});
  mapper.SetState({{{MapId{0}, {{PointId{1}}, {}}},
                    {MapId{1}, {{PointId{2}}, {LineId{3}}}},
                    {MapId{2}, {{PointId{4}}, {}}}},
                   {}});
  mapper.GoOnInAnotherMap();
  atlas.Join(MapId{0}, MapId{1}, {});
  mapper.FollowJoins(atlas);
  const auto young = mapper.state().young;
  ASSERT_EQ(young.size(), 2U);
  EXPECT_EQ(young.at(MapId{0}).points, (std::vector{PointId{1}, PointId{2}}));
  EXPECT_EQ(young.at(MapId{0}).lines, std::vector{LineId{3}});
  EXPECT_EQ(young.at(MapId{2}).points, std::vector{PointId{4}});
}

}  // namespace
}  // namespace plumbline
