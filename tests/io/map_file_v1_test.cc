// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file_v1.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/crc32.h"
#include "plumbline/io/map_io.h"

#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

constexpr std::size_t kHeaderBytes = 24;

// A file that a program of that time wrote: keyframes 0, 2 and 3, points 0 and 4, line 1.
std::string FileOfThen() { return Contents(std::filesystem::path(PLUMBLINE_SEEDS) / "map/file"); }

// The header that makes `body` a map file.
std::string WithHeader(const std::string& body) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(body.data());
  ByteWriter header;
  for (const char c : std::string("PLBMAP\r\n")) header(static_cast<std::uint8_t>(c));
  header(std::uint32_t{1});
  header(Crc32({data, body.size()}));
  header(static_cast<std::uint64_t>(body.size()));
  return header.bytes() + body;
}

TEST(MapFileV1, IsReadAsAnAtlasOfOneMap) {
  const ScratchFolder folder;
  const auto file = folder.Write("m.plb", FileOfThen());
  const SavedAtlas loaded = LoadAtlas(file);
  EXPECT_EQ(loaded.atlas.active_id(), MapId{3});
  EXPECT_EQ(loaded.context.camera.fy, 451);
  EXPECT_EQ(loaded.context.camera.height, 480);
  EXPECT_EQ(loaded.context.rectified_from_left.w(), 0.8);
  const Map& map = loaded.atlas.active();
  map.CheckInvariants();
  ASSERT_EQ(map.keyframes().size(), 3U);
  EXPECT_EQ(map.NumberOf(KeyFrameId{3}), 2);
  EXPECT_EQ(map.NextKeyFrameId(), KeyFrameId{4});
  EXPECT_EQ(map.NextPointId(), PointId{5});
  const KeyFrame& keyframe = *map.Find(KeyFrameId{2});
  EXPECT_EQ(keyframe.parent, KeyFrameId{0});
  EXPECT_EQ(keyframe.unit, 1);
  EXPECT_EQ(keyframe.frame.id, FrameId{20});
  EXPECT_EQ(keyframe.frame.stamp_ns, 1'403'636'584'763'555'586);
  EXPECT_NEAR(keyframe.frame.cam_from_world.translation.x(), 0.2, 1e-15);
  EXPECT_EQ(keyframe.frame.points[1], PointId{0});
  const Features& features = keyframe.frame.features();
  EXPECT_EQ(features.points[0].px.x(), static_cast<double>(static_cast<float>(10.0 / 3)));
  EXPECT_EQ(features.points[2].octave, 2);
  EXPECT_EQ(features.points[2].descriptor[3], 2U);
  EXPECT_EQ(features.point_disparity[0]->px, 3.25);
  EXPECT_FALSE(features.point_disparity[1]);
  EXPECT_EQ(features.line_right[0]->segment.end, Eigen::Vector2d(29, 4));
  const MapPoint* point = map.Find(PointId{4});
  ASSERT_NE(point, nullptr);
  EXPECT_EQ(point->position, Eigen::Vector3d(1.0 / 3, -2, 5));
  EXPECT_EQ(point->score.visible, 7);
  EXPECT_EQ(point->observations, (Observations{{KeyFrameId{0}, 2}, {KeyFrameId{3}, 0}}));
  EXPECT_EQ(map.Find(LineId{1})->end, 1.5);
}

TEST(MapFileV1, IsTheSameMapInVersion2) {
  const ScratchFolder folder;
  const SavedAtlas loaded = LoadAtlas(folder.Write("m.plb", FileOfThen()));
  SaveAtlas(folder / "2.plb", loaded.atlas, loaded.context);
  const SavedAtlas again = LoadAtlas(folder / "2.plb");
  EXPECT_EQ(again.atlas.active().keyframes().size(), 3U);
  SaveAtlas(folder / "3.plb", again.atlas, again.context);
  EXPECT_EQ(Contents(folder / "2.plb"), Contents(folder / "3.plb"));
}

TEST(MapFileV1, RefusesEveryCutAndEveryChangedByte) {
  const ScratchFolder folder;
  const std::string whole = FileOfThen();
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const auto file = folder.Write("cut.plb", whole.substr(0, length));
    EXPECT_NE(MessageOf([&] { LoadAtlas(file); }), "no error") << length;
  }
  for (std::size_t at = 0; at < whole.size(); at += 13) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    const auto file = folder.Write("changed.plb", changed);
    EXPECT_NE(MessageOf([&] { LoadAtlas(file); }), "no error") << at;
  }
}

TEST(MapFileV1, TellsWhatIsWrong) {
  const ScratchFolder folder;
  const std::string whole = FileOfThen();
  const auto message = [&](const std::string& contents) {
    const auto file = folder.Write("x.plb", contents);
    return MessageOf([&] { LoadAtlas(file); });
  };
  EXPECT_THAT(message(whole.substr(0, 15)), HasSubstr("ends early"));
  EXPECT_THAT(message(whole + "x"), HasSubstr("bytes after the header"));
  EXPECT_THAT(message(whole.substr(0, whole.size() - 1)), HasSubstr("bytes after the header"));
  std::string changed = whole;
  changed.back() = static_cast<char>(changed.back() ^ 1);
  EXPECT_THAT(message(changed), HasSubstr("damaged (wrong checksum)"));
}

// A count within the size of the file, of items that would take a hundred times as much memory.
TEST(MapFileV1, CountsDoNotAllocateWhatTheFileDoesNotHold) {
  const ScratchFolder folder;
  std::string body = FileOfThen().substr(kHeaderBytes, 88);  // up to the count of keyframes
  body += std::string("\0\0\x38\0", 4);                      // 3'670'016 keyframes
  body.resize(4'000'000, '\0');
  const auto file = folder.Write("forged.plb", WithHeader(body));
  const auto peak_mb = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
  };
  const auto before = peak_mb();
  EXPECT_THAT(MessageOf([&] { LoadAtlas(file); }), HasSubstr("forged.plb: ends early"));
  EXPECT_LT(peak_mb() - before, 200);
}

// Any body with a right checksum: an error or a map that agrees with itself, never a crash.
TEST(MapFileV1, SurvivesForgedContents) {
  const ScratchFolder folder;
  const std::string body = FileOfThen().substr(kHeaderBytes);
  int refused = 0;
  for (std::size_t at = 0; at < body.size(); at += 7) {
    std::string forged = body;
    forged[at] = static_cast<char>(forged[at] ^ 0x41);
    const auto file = folder.Write("forged.plb", WithHeader(forged));
    refused += MessageOf([&] { LoadMap(file).map.CheckInvariants(); }) == "no error" ? 0 : 1;
  }
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace plumbline
