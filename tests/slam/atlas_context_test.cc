// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/atlas_context.h"

#include "plumbline/features/extractor.h"
#include "plumbline/slam/system.h"

#include "tests/support/moving_poster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

RunResult RunPoster(int from, int to, const SlamOptions& options = {}) {
  System system(MovingPoster::MakeCalibration(), options);
  const MovingPoster poster;
  for (int i = from; i < to; ++i) system.Process(poster.Frame(i));
  return system.Finish();
}

TEST(SystemContext, SaysWhatTheMapsWereMadeWith) {
  SlamOptions options;
  options.slam.seed = 5;
  options.features.orb.scale_factor = 1.25;
  const RunResult result = RunPoster(0, 4, options);
  const AtlasContext& context = result.context;
  EXPECT_EQ(context.camera.fx, result.camera.fx);
  EXPECT_EQ(context.octave_scale, 1.25);
  EXPECT_THAT(context.options_yaml, HasSubstr("seed: 5"));
  EXPECT_EQ(context.feature_format, kFeatureFormat);
  ASSERT_EQ(context.sessions.size(), 1U);
  EXPECT_THAT(context.sessions[0].program, MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+.*"));
  EXPECT_EQ(context.sessions[0].data, "");
  EXPECT_EQ(context.sessions[0].first_stamp_ns, MovingPoster::StampNs(0));
  EXPECT_EQ(context.sessions[0].last_stamp_ns, MovingPoster::StampNs(3));
  ASSERT_EQ(context.maps.size(), 1U);
  EXPECT_NE(context.maps.at(MapId{0}).uuid, Uuid());
  EXPECT_FALSE(context.maps.at(MapId{0}).young.points.empty());
}

// A map file that tells of a map that is not there is refused.
TEST(AddMaps, LeavesOutMapsThatBecamePartOfOthers) {
  Atlas atlas;
  for (int i = 0; i < 2; ++i) atlas.Start();
  AtlasContext context;
  context.sessions.emplace_back();
  LocalMapper::State mapper;
  mapper.young[MapId{1}].points = {PointId{3}};
  AddMaps(atlas, mapper, context);
  EXPECT_EQ(context.maps.size(), 2U);
  atlas.Join(MapId{0}, MapId{1}, {});
  AddMaps(atlas, mapper, context);
  ASSERT_EQ(context.maps.size(), 1U);
  EXPECT_TRUE(context.maps.contains(MapId{0}));
}

TEST(SystemContext, NamesASessionByItsInput) {
  const auto uuid = [](int from, const SlamOptions& options = {}) {
    return RunPoster(from, from + 3, options).context.sessions.at(0).uuid;
  };
  const Uuid first = uuid(0);
  EXPECT_EQ(uuid(0), first);
  EXPECT_NE(uuid(1), first);
  SlamOptions options;
  options.slam.mode = RunMode::kInline;
  options.features.parallel = false;
  EXPECT_EQ(uuid(0, options), first);
  options.slam.seed = 1;
  EXPECT_NE(uuid(0, options), first);
}

TEST(SystemContext, IsThereWithoutAnyMap) {
  System system(MovingPoster::MakeCalibration(), {});
  const AtlasContext context = system.Finish().context;
  EXPECT_TRUE(context.maps.empty());
  EXPECT_EQ(context.sessions.size(), 1U);
}

}  // namespace
}  // namespace plumbline
