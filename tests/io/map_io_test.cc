// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_io.h"

#include "plumbline/io/byte_stream.h"
#include "plumbline/io/crc32.h"

#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

const RectifiedCamera kCamera{450, 451, 375.5, 239.25, 0.11, 752, 480};
const Eigen::Quaterniond kRotation(0.8, 0.6, 0, 0);

KeyFrame MakeKeyFrame(int id, int parent) {
  auto indexed = std::make_shared<IndexedFeatures>();
  Features& f = indexed->features;
  for (int i = 0; i < 3; ++i) {
    PointFeature point;
    point.px = {10.0 / 3 + i, 20.5 * id};
    point.angle = -0.1 * i;
    point.octave = i;
    point.descriptor = {1U, 2U, std::numeric_limits<std::uint64_t>::max(), std::uint64_t(i)};
    f.points.push_back(point);
    f.point_disparity.push_back(i == 1 ? std::nullopt : std::optional(Disparity{3.25, 0.5}));
  }
  for (int i = 0; i < 2; ++i) {
    LineFeature line;
    line.segment = {{1, 2}, {30, 4.125}};
    f.lines.push_back(line);
    f.line_right.push_back(i == 0 ? std::optional(RightLine{{{0, 2}, {29, 4}}, 0.75})
                                  : std::nullopt);
  }
  KeyFrame keyframe{KeyFrameId{id}, KeyFrameId{parent}, {}};
  keyframe.frame.id = FrameId{10 * id};
  keyframe.frame.stamp_ns = 1'403'636'584'763'555'584 + id;
  keyframe.frame.cam_from_world = ExpSe3(Vector6d::Constant(0.1 * id));
  keyframe.frame.indexed = indexed;
  keyframe.frame.points.resize(3);
  keyframe.frame.lines.resize(2);
  return keyframe;
}

// Keyframes 0, 2, 3 (1 was removed, the parent of 2), points 0 and 4, line 1.
Map MakeMap() {
  MapPoint first;
  first.id = PointId{0};
  first.created_by = KeyFrameId{0};
  first.position = {1.0 / 3, -2, 5};
  first.reference_octave = 2;
  first.score = {7, 5};
  first.observations = {{KeyFrameId{0}, 0}, {KeyFrameId{2}, 1}};
  MapPoint second = first;
  second.id = PointId{4};
  second.observations = {{KeyFrameId{0}, 2}, {KeyFrameId{1}, 2}, {KeyFrameId{3}, 0}};
  MapLine line;
  line.id = LineId{1};
  line.line = LineThroughPoints({0, 0, 2}, {1, 1, 3});
  line.start = -1;
  line.end = 1.5;
  line.information = Eigen::Matrix4d::Random();
  line.observations = {{KeyFrameId{2}, 0}, {KeyFrameId{3}, 1}};
  Map map(MapId{3});
  map.Apply({edit::AddKeyFrame{MakeKeyFrame(0, -1)},
             edit::AddKeyFrame{MakeKeyFrame(1, 0)},
             edit::AddKeyFrame{MakeKeyFrame(2, 1)},
             edit::AddKeyFrame{MakeKeyFrame(3, 2)},
             edit::AddPoint{first},
             edit::AddPoint{second},
             edit::AddLine{line},
             edit::RemoveKeyFrame{KeyFrameId{1}}});
  return map;
}

TEST(LoadMap, GivesBackWhatWasSaved) {
  const ScratchFolder folder;
  const Map map = MakeMap();
  SaveMap(folder / "m.plb", kCamera, kRotation, map);
  const SavedMap loaded = LoadMap(folder / "m.plb");
  loaded.map.CheckInvariants();
  EXPECT_EQ(loaded.camera.cx, kCamera.cx);
  EXPECT_EQ(loaded.camera.height, kCamera.height);
  EXPECT_EQ(loaded.rectified_from_left.coeffs(), kRotation.coeffs());
  EXPECT_EQ(loaded.map.id(), map.id());
  ASSERT_EQ(loaded.map.keyframes().size(), 3U);
  for (const auto& [id, keyframe] : map.keyframes()) {
    const Frame& frame = loaded.map.Find(id)->frame;
    EXPECT_EQ(frame.id, keyframe.frame.id);
    EXPECT_EQ(frame.stamp_ns, keyframe.frame.stamp_ns);
    EXPECT_EQ(frame.cam_from_world.Matrix(), keyframe.frame.cam_from_world.Matrix());
    EXPECT_EQ(frame.points, keyframe.frame.points);
    EXPECT_EQ(frame.lines, keyframe.frame.lines);
    EXPECT_EQ(frame.features().points[2].descriptor,
              keyframe.frame.features().points[2].descriptor);
    EXPECT_FALSE(frame.features().point_disparity[1]);
    EXPECT_EQ(frame.features().line_right[0]->segment.end, Eigen::Vector2d(29, 4));
    EXPECT_EQ(frame.indexed->point_grid.InWindow(frame.features().points[0].px, 0.5),
              std::vector<int>{0});
  }
  const MapPoint* point = loaded.map.Find(PointId{4});
  ASSERT_NE(point, nullptr);
  EXPECT_EQ(point->position, Eigen::Vector3d(1.0 / 3, -2, 5));
  EXPECT_EQ(point->score.visible, 7);
  EXPECT_EQ(point->observations, map.Find(PointId{4})->observations);
  const MapLine* line = loaded.map.Find(LineId{1});
  ASSERT_NE(line, nullptr);
  EXPECT_EQ(line->line.moment, map.Find(LineId{1})->line.moment);
  EXPECT_EQ(line->information, map.Find(LineId{1})->information);
  EXPECT_EQ(line->end, 1.5);
}

TEST(LoadMap, GivesRemovedParentsALivingOne) {
  const ScratchFolder folder;
  SaveMap(folder / "m.plb", kCamera, kRotation, MakeMap());
  const SavedMap loaded = LoadMap(folder / "m.plb");
  EXPECT_FALSE(loaded.map.Find(KeyFrameId{0})->parent.valid());
  EXPECT_EQ(loaded.map.Find(KeyFrameId{2})->parent, KeyFrameId{0});
  EXPECT_EQ(loaded.map.Find(KeyFrameId{3})->parent, KeyFrameId{2});
}

TEST(SaveMap, WritesTheSameBytesAgain) {
  const ScratchFolder folder;
  SaveMap(folder / "a.plb", kCamera, kRotation, MakeMap());
  const SavedMap loaded = LoadMap(folder / "a.plb");
  SaveMap(folder / "b.plb", loaded.camera, loaded.rectified_from_left, loaded.map);
  EXPECT_EQ(Contents(folder / "a.plb"), Contents(folder / "b.plb"));
}

TEST(LoadMap, RefusesEveryCutAndEveryChangedByte) {
  const ScratchFolder folder;
  SaveMap(folder / "m.plb", kCamera, kRotation, MakeMap());
  const std::string whole = Contents(folder / "m.plb");
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const auto file = folder.Write("cut.plb", whole.substr(0, length));
    EXPECT_NE(MessageOf([&] { LoadMap(file); }), "no error") << length;
  }
  for (std::size_t at = 0; at < whole.size(); at += 13) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    const auto file = folder.Write("changed.plb", changed);
    EXPECT_NE(MessageOf([&] { LoadMap(file); }), "no error") << at;
  }
}

TEST(LoadMap, TellsWhatIsWrong) {
  const ScratchFolder folder;
  SaveMap(folder / "m.plb", kCamera, kRotation, MakeMap());
  const std::string whole = Contents(folder / "m.plb");
  const auto message = [&](const std::string& contents) {
    const auto file = folder.Write("x.plb", contents);
    return MessageOf([&] { LoadMap(file); });
  };
  std::string version = whole;
  version[8] = 2;
  EXPECT_THAT(message(version), HasSubstr("expected a map of version 1, found version 2"));
  EXPECT_THAT(message(""), HasSubstr("x.plb: expected a Plumbline map, found another file"));
  EXPECT_THAT(message("ply\nformat"), HasSubstr("expected a Plumbline map"));
  EXPECT_THAT(message(whole.substr(0, 15)), HasSubstr("ends early"));
  EXPECT_THAT(message(whole + "x"), HasSubstr("bytes after the header"));
  EXPECT_THAT(message(whole.substr(0, whole.size() - 1)), HasSubstr("bytes after the header"));
  std::string changed = whole;
  changed.back() = static_cast<char>(changed.back() ^ 1);
  EXPECT_THAT(message(changed), HasSubstr("damaged (wrong checksum)"));
  EXPECT_THAT(MessageOf([&] { LoadMap(folder / "none.plb"); }), HasSubstr("no such file"));
}

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

// A count within the size of the file, of items that would take a hundred times as much memory.
TEST(LoadMap, CountsDoNotAllocateWhatTheFileDoesNotHold) {
  const ScratchFolder folder;
  SaveMap(folder / "m.plb", kCamera, kRotation, Map(MapId{0}));
  std::string body = Contents(folder / "m.plb").substr(24);
  const std::size_t counts = body.size() - 12;  // of keyframes, points and lines
  body.resize(4'000'000, '\0');
  body.replace(counts, 4, std::string("\0\0\x38\0", 4));  // 3'670'016 keyframes
  const auto file = folder.Write("forged.plb", WithHeader(body));
  const auto peak_mb = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
  };
  const auto before = peak_mb();
  EXPECT_THAT(MessageOf([&] { LoadMap(file); }), HasSubstr("forged.plb: ends early"));
  EXPECT_LT(peak_mb() - before, 200);
}

TEST(LoadMap, RefusesNumbersThatAreNotFinite) {
  const ScratchFolder folder;
  SaveMap(folder / "m.plb", kCamera, kRotation, MakeMap());
  const std::string body = Contents(folder / "m.plb").substr(24);
  const std::string infinity("\0\0\0\0\0\0\xF0\x7F", 8);
  // The focal length; the x of the first point, 1 / 3, found by its bytes.
  const std::string third("\x55\x55\x55\x55\x55\x55\xD5\x3F", 8);
  for (const std::size_t at : {std::size_t{0}, body.find(third)}) {
    ASSERT_NE(at, std::string::npos);
    std::string forged = body;
    forged.replace(at, 8, infinity);
    const auto file = folder.Write("forged.plb", WithHeader(forged));
    EXPECT_THAT(MessageOf([&] { LoadMap(file); }),
                HasSubstr("forged.plb: expected finite numbers, found another"))
        << at;
  }
}

// Any body with a right checksum: an error or a map that agrees with itself, never a crash.
TEST(LoadMap, SurvivesForgedContents) {
  const ScratchFolder folder;
  SaveMap(folder / "m.plb", kCamera, kRotation, MakeMap());
  const std::string body = Contents(folder / "m.plb").substr(24);
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
