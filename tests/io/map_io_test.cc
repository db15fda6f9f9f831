// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/map_file/map_io.h"

#include "plumbline/base/byte_stream.h"
#include "plumbline/base/crc32.h"
#include "plumbline/io/atomic_file.h"
#include "plumbline/map/map_builder.h"

#include "tests/io/map_fixture.h"
#include "tests/io/scratch_folder.h"
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

std::filesystem::path Saved(const ScratchFolder& folder, const SavedAtlas& atlas) {
  const auto file = folder / "m.plb";
  SaveAtlas(file, atlas.atlas, atlas.context);
  return file;
}

void ExpectSame(const Features& a, const Features& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].px, b.points[i].px);
    EXPECT_EQ(a.points[i].sigma_px, b.points[i].sigma_px);
    EXPECT_EQ(a.points[i].angle, b.points[i].angle);
    EXPECT_EQ(a.points[i].response, b.points[i].response);
    EXPECT_EQ(a.points[i].octave, b.points[i].octave);
    EXPECT_EQ(a.points[i].descriptor, b.points[i].descriptor);
    ASSERT_EQ(a.point_disparity[i].has_value(), b.point_disparity[i].has_value());
    if (!a.point_disparity[i]) continue;
    EXPECT_EQ(a.point_disparity[i]->px, b.point_disparity[i]->px);
    EXPECT_EQ(a.point_disparity[i]->sigma_px, b.point_disparity[i]->sigma_px);
  }
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].segment.start, b.lines[i].segment.start);
    EXPECT_EQ(a.lines[i].segment.end, b.lines[i].segment.end);
    EXPECT_EQ(a.lines[i].sigma_px, b.lines[i].sigma_px);
    EXPECT_EQ(a.lines[i].response, b.lines[i].response);
    EXPECT_EQ(a.lines[i].octave, b.lines[i].octave);
    EXPECT_EQ(a.lines[i].descriptor, b.lines[i].descriptor);
    ASSERT_EQ(a.line_right[i].has_value(), b.line_right[i].has_value());
    if (!a.line_right[i]) continue;
    EXPECT_EQ(a.line_right[i]->segment.start, b.line_right[i]->segment.start);
    EXPECT_EQ(a.line_right[i]->segment.end, b.line_right[i]->segment.end);
    EXPECT_EQ(a.line_right[i]->sigma_px, b.line_right[i]->sigma_px);
  }
}

void ExpectSame(const KeyFrame& a, const KeyFrame& b) {
  EXPECT_EQ(a.parent, b.parent);
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.scale, b.scale);
  EXPECT_EQ(a.session, b.session);
  EXPECT_EQ(a.frame.id, b.frame.id);
  EXPECT_EQ(a.frame.stamp_ns, b.frame.stamp_ns);
  EXPECT_EQ(a.frame.cam_from_world.rotation.coeffs(), b.frame.cam_from_world.rotation.coeffs());
  EXPECT_EQ(a.frame.cam_from_world.translation, b.frame.cam_from_world.translation);
  EXPECT_EQ(a.frame.points, b.frame.points);
  EXPECT_EQ(a.frame.lines, b.frame.lines);
  EXPECT_EQ(a.frame.indexed->correction, b.frame.indexed->correction);
  ExpectSame(a.frame.features(), b.frame.features());
  std::vector<int> found;
  a.frame.indexed->PointsInWindow(a.frame.features().points[0].px, {0.5, 0.5}, &found);
  EXPECT_EQ(found, std::vector<int>{0});
}

template <class Landmark>
void ExpectSameLooks(const Landmark& a, const Landmark& b) {
  EXPECT_EQ(a.created_by, b.created_by);
  EXPECT_EQ(a.view_direction, b.view_direction);
  EXPECT_EQ(a.descriptor, b.descriptor);
  EXPECT_EQ(a.score.visible, b.score.visible);
  EXPECT_EQ(a.score.found, b.score.found);
  EXPECT_EQ(a.observations, b.observations);
}

void ExpectSame(const MapPoint& a, const MapPoint& b) {
  ExpectSameLooks(a, b);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.reference_distance, b.reference_distance);
  EXPECT_EQ(a.reference_octave, b.reference_octave);
}

void ExpectSame(const MapLine& a, const MapLine& b) {
  ExpectSameLooks(a, b);
  EXPECT_EQ(a.line.moment, b.line.moment);
  EXPECT_EQ(a.line.direction, b.line.direction);
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.information, b.information);
}

template <class Id, class Entry>
void ExpectSame(const IdTable<Id, Entry>& a, const IdTable<Id, Entry>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [id, entry] : a) {
    ASSERT_TRUE(b.contains(id));
    ExpectSame(entry, b.at(id));
  }
}

void ExpectSame(const Map& a, const Map& b) {
  b.CheckInvariants();
  EXPECT_EQ(a.id(), b.id());
  EXPECT_EQ(a.version(), b.version());
  EXPECT_EQ(a.NextKeyFrameId(), b.NextKeyFrameId());
  EXPECT_EQ(a.NextPointId(), b.NextPointId());
  EXPECT_EQ(a.NextLineId(), b.NextLineId());
  EXPECT_EQ(a.correction(), b.correction());
  ExpectSame(a.keyframes(), b.keyframes());
  ExpectSame(a.points(), b.points());
  ExpectSame(a.lines(), b.lines());
  for (const auto& [id, removed] : a.Record().removed_keyframes) {
    EXPECT_EQ(a.NumberOf(id), b.NumberOf(id));
    EXPECT_EQ(a.ParentOf(id), b.ParentOf(id));
    EXPECT_EQ(a.PlaceOf(id).scale, b.PlaceOf(id).scale);
    EXPECT_EQ(a.PoseOf(id).Matrix(), b.PoseOf(id).Matrix());
  }
  EXPECT_EQ(a.Record().merged_points, b.Record().merged_points);
  EXPECT_EQ(a.Record().merged_lines, b.Record().merged_lines);
  EXPECT_EQ(a.Record().keyframes_taken_in, b.Record().keyframes_taken_in);
}

TEST(LoadAtlas, GivesBackAllMapsToTheLastBit) {
  const ScratchFolder folder;
  const SavedAtlas saved = MakeSavedAtlas();
  const SavedAtlas loaded = LoadAtlas(Saved(folder, saved));
  ASSERT_EQ(loaded.atlas.maps().size(), 2U);
  EXPECT_EQ(loaded.atlas.active_id(), MapId{0});
  ASSERT_NE(saved.atlas.active().correction(), FeatureCorrection());
  ASSERT_EQ(saved.atlas.active().keyframes().size(), 4U);
  ASSERT_EQ(saved.atlas.active().Find(KeyFrameId{4})->scale, 2);
  ASSERT_EQ(saved.atlas.active().Current(PointId{5}), PointId{4});
  for (const auto& [id, map] : saved.atlas.maps()) ExpectSame(map, *loaded.atlas.Find(id));
}

TEST(LoadAtlas, GivesBackTheLensOfAMap) {
  const ScratchFolder folder;
  SavedAtlas saved = MakeSavedAtlas();
  Map& map = saved.atlas.active();
  const FeatureCorrection correction{map.correction().stereo, {kMapCamera, 2.5}};
  map.Apply({edit::CorrectFeatures{correction}});
  const SavedAtlas loaded = LoadAtlas(Saved(folder, saved));
  EXPECT_EQ(loaded.atlas.active().correction(), correction);
  ExpectSame(map, loaded.atlas.active());
}

TEST(LoadAtlas, RefusesALensThatFoldsTheImageOver) {
  const ScratchFolder folder;
  SavedAtlas saved = MakeSavedAtlas();
  saved.atlas.active().Apply({edit::CorrectFeatures{{{}, {kMapCamera, 0.04 * kMapCamera.width}}}});
  const auto file = Saved(folder, saved);
  EXPECT_THROW(LoadAtlas(file), InputError);
}

TEST(LoadAtlas, GivesBackWhatTheMapsWereMadeWith) {
  const ScratchFolder folder;
  const AtlasContext saved = MakeSavedAtlas().context;
  const AtlasContext loaded = LoadAtlas(Saved(folder, MakeSavedAtlas())).context;
  EXPECT_EQ(loaded.camera.cx, saved.camera.cx);
  EXPECT_EQ(loaded.camera.height, saved.camera.height);
  EXPECT_EQ(loaded.rectified_from_left.coeffs(), saved.rectified_from_left.coeffs());
  EXPECT_EQ(loaded.octave_scale, saved.octave_scale);
  EXPECT_EQ(loaded.stereo_evidence.information, saved.stereo_evidence.information);
  EXPECT_EQ(loaded.stereo_evidence.weighted, saved.stereo_evidence.weighted);
  EXPECT_EQ(loaded.stereo_evidence.moments, saved.stereo_evidence.moments);
  EXPECT_EQ(loaded.feature_format, saved.feature_format);
  EXPECT_EQ(loaded.options_yaml, saved.options_yaml);
  ASSERT_EQ(loaded.sessions.size(), 1U);
  EXPECT_EQ(loaded.sessions[0].uuid, saved.sessions[0].uuid);
  EXPECT_EQ(loaded.sessions[0].program, "0.1");
  EXPECT_EQ(loaded.sessions[0].data, "MH_01");
  EXPECT_EQ(loaded.sessions[0].first_stamp_ns, 5);
  EXPECT_EQ(loaded.sessions[0].last_stamp_ns, 7);
  ASSERT_EQ(loaded.maps.size(), 2U);
  EXPECT_EQ(loaded.maps.at(MapId{1}).uuid, UuidOf("map 1"));
  EXPECT_EQ(loaded.maps.at(MapId{0}).young.points, (std::vector{PointId{0}, PointId{99}}));
  EXPECT_EQ(loaded.maps.at(MapId{0}).young.lines, std::vector{LineId{1}});
}

TEST(LoadAtlas, DoesNotLetDisparitiesBeCorrectedTwice) {
  const ScratchFolder folder;
  SavedAtlas never_saved = MakeSavedAtlas();
  SavedAtlas loaded = LoadAtlas(Saved(folder, never_saved));
  const FeatureCorrection next{{kMapCamera, Vector6d::Constant(0.25)}};
  for (SavedAtlas* one : {&never_saved, &loaded}) {
    one->atlas.active().Apply({edit::CorrectFeatures{next}});
  }
  ExpectSame(never_saved.atlas.active(), loaded.atlas.active());
  Features once = ThreePointsAndTwoLines(3);
  Correct({}, next, once);
  ExpectSame(loaded.atlas.active().Find(KeyFrameId{3})->frame.features(), once);
}

TEST(SaveAtlas, WritesTheSameBytesAgain) {
  const ScratchFolder folder;
  const auto first = Saved(folder, MakeSavedAtlas());
  const SavedAtlas loaded = LoadAtlas(first);
  SaveAtlas(folder / "again.plb", loaded.atlas, loaded.context);
  EXPECT_EQ(Contents(first), Contents(folder / "again.plb"));
  // Also where another map than the one that grew last is to go on.
  SaveAtlas(folder / "other.plb", loaded.atlas, loaded.context, MapId{1});
  const SavedAtlas other = LoadAtlas(folder / "other.plb");
  EXPECT_EQ(other.atlas.active_id(), MapId{1});
  EXPECT_EQ(other.atlas.active().NextPointId(), loaded.atlas.active().NextPointId());
  SaveAtlas(folder / "other_again.plb", other.atlas, other.context);
  EXPECT_EQ(Contents(folder / "other.plb"), Contents(folder / "other_again.plb"));
}

TEST(SaveAtlas, KeepsNumbersThatNeedDoublePrecision) {
  const ScratchFolder folder;
  SavedAtlas saved = MakeSavedAtlas();
  KeyFrame keyframe = MakeKeyFrame(saved.atlas.NextKeyFrameId().value, 4);
  Features features = keyframe.frame.features();
  features.points[1].px.x() = 1.0 / 3;
  features.lines[1].response = 0.1;
  keyframe.frame.indexed = IndexFeatures(kMapCamera, features);
  saved.atlas.active().Apply({edit::AddKeyFrame{keyframe}});
  const SavedAtlas loaded = LoadAtlas(Saved(folder, saved));
  ExpectSame(saved.atlas.active(), loaded.atlas.active());
}

// Numbers that do not vary take next to no bytes.
TEST(SaveAtlas, KeepsLandmarksThatAreAlike) {
  const ScratchFolder folder;
  constexpr int kPoints = 500;
  SavedAtlas saved;
  saved.context.camera = kMapCamera;
  Map& map = saved.atlas.Start();
  MapEdit edits;
  for (std::int64_t k = 0; k < 2; ++k) {
    KeyFrame keyframe = MakeKeyFrame(k, k - 1);
    Features features = keyframe.frame.features();
    features.points.resize(kPoints, features.points[0]);
    features.point_disparity.resize(kPoints);
    keyframe.frame.indexed = IndexFeatures(kMapCamera, features);
    keyframe.frame.points.resize(kPoints);
    edits.push_back(edit::AddKeyFrame{keyframe});
  }
  for (int i = 0; i < kPoints; ++i) {
    MapPoint point;
    point.id = PointId{i};
    point.created_by = KeyFrameId{0};
    point.position = {0, 0, 5};
    point.view_direction = Eigen::Vector3d::UnitZ();
    point.observations = {{KeyFrameId{0}, i}, {KeyFrameId{1}, i}};
    edits.push_back(edit::AddPoint{point});
  }
  map.Apply(edits);
  const auto file = Saved(folder, saved);
  EXPECT_LT(std::filesystem::file_size(file), 40 * kPoints);
  ExpectSame(LoadAtlas(file).atlas.active().points(), map.points());
}

TEST(LoadMap, GivesTheActiveMap) {
  const ScratchFolder folder;
  const SavedAtlas saved = MakeSavedAtlas();
  const auto file = folder / "m.plb";
  SaveAtlas(file, saved.atlas, saved.context, MapId{1});
  const SavedMap loaded = LoadMap(file);
  EXPECT_EQ(loaded.map.id(), MapId{1});
  EXPECT_EQ(loaded.camera.fx, kMapCamera.fx);
  EXPECT_EQ(loaded.rectified_from_left.coeffs(), kMapRotation.coeffs());
  SaveMap(file, kMapCamera, kMapRotation, saved.atlas.active());
  ExpectSame(LoadMap(file).map, saved.atlas.active());
}

TEST(LoadMap, GivesAnEmptyMapWhereThereIsNone) {
  const ScratchFolder folder;
  AtlasContext context;
  context.camera = kMapCamera;
  SaveAtlas(folder / "m.plb", Atlas(), context);
  EXPECT_TRUE(LoadAtlas(folder / "m.plb").atlas.empty());
  EXPECT_TRUE(LoadMap(folder / "m.plb").map.keyframes().empty());
}

TEST(LoadAtlas, RefusesCutsAndChangedBytesAnywhere) {
  const ScratchFolder folder;
  const std::string whole = Contents(Saved(folder, MakeSavedAtlas()));
  for (std::size_t length = 0; length < whole.size(); length += 11) {
    const auto file = folder.Write("cut.plb", whole.substr(0, length));
    EXPECT_THAT(MessageOf([&] { LoadAtlas(file); }),
                AnyOf(HasSubstr("cut.plb: ends early"), HasSubstr("found another file")))
        << length;
  }
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ (at % 2 == 0 ? 0x10 : 0x01));
    const auto file = folder.Write("changed.plb", changed);
    EXPECT_NE(MessageOf([&] { LoadAtlas(file); }), "no error") << at;
  }
}

TEST(LoadAtlas, ReadsFilesOfVersion020) {
  const SavedAtlas loaded = LoadAtlas(PLUMBLINE_SEEDS "/map/file_v2");
  EXPECT_EQ(loaded.file_version, 2U);
  EXPECT_EQ(loaded.context.feature_format, kFeatureFormat);
  ASSERT_FALSE(loaded.context.sessions.empty());
  ASSERT_FALSE(loaded.atlas.empty());
  for (const auto& [id, map] : loaded.atlas.maps()) map.CheckInvariants();
  EXPECT_FALSE(loaded.atlas.active().points().empty());
  // Saved again, it is what is read.
  const ScratchFolder folder;
  const auto again = Saved(folder, loaded);
  EXPECT_EQ(LoadAtlas(again).atlas.active().points().size(), loaded.atlas.active().points().size());
}

TEST(LoadAtlas, TellsWhatIsWrong) {
  const ScratchFolder folder;
  const std::string whole = Contents(Saved(folder, MakeSavedAtlas()));
  const auto message = [&](const std::string& contents) {
    const auto file = folder.Write("x.plb", contents);
    return MessageOf([&] { LoadAtlas(file); });
  };
  std::string version = whole;
  version[8] = 3;
  EXPECT_THAT(message(version),
              HasSubstr("expected a map of version 2, found version 3, which a later"));
  version[8] = 1;
  EXPECT_THAT(message(version),
              HasSubstr("expected a map of version 2, found version 1, which plumbline 0.2.0"));
  EXPECT_THAT(message(""), HasSubstr("x.plb: expected a Plumbline map, found another file"));
  EXPECT_THAT(message("ply\nformat"), HasSubstr("expected a Plumbline map"));
  EXPECT_THAT(message(whole.substr(0, 10)), HasSubstr("ends early"));
  EXPECT_THAT(message(whole + "x"), HasSubstr("expected the end, found more bytes"));
  std::string changed = whole;
  changed[100] = static_cast<char>(changed[100] ^ 1);
  EXPECT_THAT(message(changed), HasSubstr("damaged (wrong checksum)"));
  EXPECT_THAT(MessageOf([&] { LoadAtlas(folder / "none.plb"); }), HasSubstr("no such file"));
  EXPECT_THAT(MessageOf([&] { LoadAtlas(folder.path()); }), HasSubstr("expected a file"));
}

TEST(SaveAtlas, LeavesTheOldFileWhereThereIsNoRoom) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const ScratchFolder folder;
  const SavedAtlas saved = MakeSavedAtlas();
  const std::string before = Contents(Saved(folder, saved));
  // The temporary name leads to a device that is always full.
  const AtomicFile probe(folder / "m.plb");
  std::filesystem::create_symlink("/dev/full", probe.temporary_path());
  EXPECT_THAT(MessageOf([&] { SaveAtlas(folder / "m.plb", Atlas(), saved.context); }),
              HasSubstr("m.plb: No space left on device"));
  EXPECT_EQ(Contents(folder / "m.plb"), before);
  EXPECT_THAT(MessageOf([&] { SaveAtlas(folder / "none/m.plb", saved.atlas, saved.context); }),
              HasSubstr("none/m.plb: No such file or directory"));
}

TEST(SaveAtlas, KeepsTheOldFileOfAMapThatCouldNotBeReadAgain) {
  const ScratchFolder folder;
  SavedAtlas saved = MakeSavedAtlas();
  const std::string before = Contents(Saved(folder, saved));
  saved.atlas.active().ReserveIds(PointId{kMaxBuiltId}, LineId{0});
  Saved(folder, saved);
  EXPECT_NO_THROW(LoadAtlas(folder / "m.plb"));
  WriteFileAtomically(folder / "m.plb", before);
  saved.atlas.active().ReserveIds(PointId{kMaxBuiltId + 1}, LineId{0});
  EXPECT_THAT(MessageOf([&] { Saved(folder, saved); }),
              HasSubstr("m.plb: expected a map that gave at most 536870912 ids to points, found"));
  EXPECT_EQ(Contents(folder / "m.plb"), before);
}

TEST(LoadAtlas, RefusesWhatContradictsItself) {
  const ScratchFolder folder;
  const auto message = [&](const std::function<void(SavedAtlas&)>& change) {
    SavedAtlas saved = MakeSavedAtlas();
    change(saved);
    const auto file = Saved(folder, saved);
    return MessageOf([&] { LoadAtlas(file); });
  };
  EXPECT_EQ(message([](SavedAtlas&) {}), "no error");
  EXPECT_THAT(message([](SavedAtlas& s) { s.context.camera.fx = 0; }), HasSubstr("valid camera"));
  EXPECT_THAT(message([](SavedAtlas& s) { s.context.camera.width = 1 << 30; }),
              HasSubstr("valid camera"));
  EXPECT_THAT(message([](SavedAtlas& s) { s.context.rectified_from_left.coeffs() *= 2; }),
              HasSubstr("valid camera"));
  EXPECT_THAT(message([](SavedAtlas& s) { s.context.octave_scale = 0; }),
              HasSubstr("valid camera"));
  EXPECT_THAT(message([](SavedAtlas& s) {
                s.context.stereo_evidence.weighted(0) = std::numeric_limits<double>::infinity();
              }),
              HasSubstr("evidence about the stereo pair"));
  EXPECT_THAT(message([](SavedAtlas& s) { s.context.maps[MapId{7}]; }),
              HasSubstr("a map that is not there"));
  EXPECT_THAT(message([](SavedAtlas& s) {
                KeyFrame keyframe = MakeKeyFrame(17, 4);
                keyframe.session = SessionId{1};
                s.atlas.active().Apply({edit::AddKeyFrame{keyframe}});
              }),
              HasSubstr("a session that is not there"));
  EXPECT_THAT(message([](SavedAtlas& s) {
                s.atlas.Find(MapId{1})->Apply({edit::AddKeyFrame{MakeKeyFrame(3, -1)}});
              }),
              HasSubstr("an id that two maps have"));
}

// The sections of a file, packed and with checksums that fit, so that what is in them is read.
std::string Forged(const std::string& file, std::size_t at, char with) {
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(file.data()),
                                            file.size());
  constexpr std::size_t kHeader = 32;
  std::string forged = file.substr(0, 12);
  for (std::size_t begin = 12; begin < file.size();) {
    ByteReader header(bytes.subspan(begin), "x");
    std::uint32_t kind = 0, method = 0;
    std::uint64_t stored = 0, size = 0;
    header(kind);
    header(method);
    header(stored);
    header(size);
    std::string contents = file.substr(begin + kHeader, stored);
    if (at >= begin + kHeader && at < begin + kHeader + stored) {
      char& c = contents[at - begin - kHeader];
      c = static_cast<char>(c ^ with);
    }
    const auto crc = [](const std::string& text) {
      return Crc32({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    ByteWriter new_header;
    new_header(kind);
    new_header(method);
    new_header(stored);
    new_header(size);
    new_header(crc(contents));
    new_header(crc(new_header.bytes()));
    forged += new_header.bytes() + contents;
    begin += kHeader + stored;
  }
  return forged;
}

// Any contents with right checksums: an error or maps that agree with themselves, never a crash.
TEST(LoadAtlas, SurvivesForgedContents) {
  const ScratchFolder folder;
  const std::string whole = Contents(Saved(folder, MakeSavedAtlas()));
  EXPECT_EQ(Forged(whole, 0, 0), whole);
  int refused = 0;
  for (std::size_t at = 12; at < whole.size(); at += 9) {
    for (const char with : {'\x41', '\x80'}) {
      const auto file = folder.Write("forged.plb", Forged(whole, at, with));
      refused += MessageOf([&] {
                   const SavedAtlas loaded = LoadAtlas(file);
                   for (const auto& [id, map] : loaded.atlas.maps()) map.CheckInvariants();
                 }) == "no error"
                     ? 0
                     : 1;
    }
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace plumbline
