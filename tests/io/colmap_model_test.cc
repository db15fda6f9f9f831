// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/export/colmap_model.h"

#include "plumbline/io/export/keyframe_images.h"
#include "plumbline/map/reprojection.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/read_colmap.h"
#include "tests/support/true_map.h"
#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::HasSubstr;

SavedMap NoisyMap() {
  const SyntheticWorld world = MakeSyntheticWorld(120, 10);
  SavedMap saved;
  saved.camera = world.camera;
  saved.map =
      MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10), PoseOnPath(25), PoseOnPath(40)}, {}).map;
  // Ids with gaps, and a feature that shows nothing.
  saved.map.Apply({edit::RemoveKeyFrame{KeyFrameId{1}}, edit::RemovePoint{PointId{3}}});
  return saved;
}

void ExpectEqual(const ColmapModel& a, const ColmapModel& b) {
  EXPECT_EQ(a.camera, b.camera);
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    EXPECT_EQ(a.images[i].id, b.images[i].id);
    EXPECT_EQ(a.images[i].name, b.images[i].name);
    EXPECT_EQ(a.images[i].cam_from_world.rotation.coeffs(),
              b.images[i].cam_from_world.rotation.coeffs());
    EXPECT_EQ(a.images[i].cam_from_world.translation, b.images[i].cam_from_world.translation);
    ASSERT_EQ(a.images[i].keypoints.size(), b.images[i].keypoints.size());
    for (std::size_t k = 0; k < a.images[i].keypoints.size(); ++k) {
      EXPECT_EQ(a.images[i].keypoints[k].px, b.images[i].keypoints[k].px);
      EXPECT_EQ(a.images[i].keypoints[k].point, b.images[i].keypoints[k].point);
    }
  }
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].id, b.points[i].id);
    EXPECT_EQ(a.points[i].position, b.points[i].position);
    EXPECT_TRUE(a.points[i].color == b.points[i].color);
    EXPECT_EQ(a.points[i].error, b.points[i].error);
    EXPECT_EQ(a.points[i].track, b.points[i].track);
  }
}

TEST(ColmapModel, TextAndBinaryGiveItBackToTheLastBit) {
  const ScratchFolder folder;
  const SavedMap saved = NoisyMap();
  const ColmapModel model = MakeColmapModel(saved,
                                            ExportCamera(saved.camera),
                                            KeyFrameImageNames(saved.map),
                                            {{PointId{5}, {17, 18, 219}}});
  WriteColmapText(folder.path(), model);
  WriteColmapBinary(folder.path(), model);
  ExpectEqual(ReadColmapText(folder.path()), model);
  ExpectEqual(ReadColmapBinary(folder.path()), model);
}

TEST(ColmapModel, HasTheReprojectionErrorsOfTheMap) {
  const ScratchFolder folder;
  const SavedMap saved = NoisyMap();
  WriteColmapText(
      folder.path(),
      MakeColmapModel(saved, ExportCamera(saved.camera), KeyFrameImageNames(saved.map)));
  const ColmapModel model = ReadColmapText(folder.path());
  ASSERT_GT(model.points.size(), 60U);
  double largest = 0;
  for (const ColmapModel::Point& point : model.points) {
    const MapPoint* original = saved.map.Find(PointId{point.id - 1});
    ASSERT_NE(original, nullptr);
    const double from_files = ReprojectionErrorOf(model, point);
    EXPECT_NEAR(from_files, point.error, 1e-9);
    EXPECT_NEAR(from_files, *MeanReprojectionError(saved.camera, saved.map, *original), 1e-9);
    largest = std::max(largest, from_files);
  }
  EXPECT_GT(largest, 0.5);  // there is something to compare
  EXPECT_LT(largest, 20);
}

TEST(ColmapModel, KeypointsAndTracksNameEachOther) {
  const SavedMap saved = NoisyMap();
  const ColmapModel model =
      MakeColmapModel(saved, ExportCamera(saved.camera), KeyFrameImageNames(saved.map));
  std::map<std::uint32_t, const ColmapModel::Image*> images;
  std::size_t matched = 0, unmatched = 0, in_tracks = 0;
  for (const ColmapModel::Image& image : model.images) {
    EXPECT_TRUE(images.emplace(image.id, &image).second);
    for (const ColmapModel::Keypoint& keypoint : image.keypoints) {
      (keypoint.point == ColmapModel::kNoPoint ? unmatched : matched) += 1;
    }
  }
  for (const ColmapModel::Point& point : model.points) {
    EXPECT_TRUE((point.color == Color{128, 128, 128}));
    for (const ColmapModel::View& view : point.track) {
      EXPECT_EQ(images.at(view.image)->keypoints.at(view.keypoint).point, point.id);
      ++in_tracks;
    }
  }
  EXPECT_EQ(matched, in_tracks);
  EXPECT_GT(unmatched, 0U);
  EXPECT_FALSE(images.contains(ColmapImageId(KeyFrameId{1})));
}

TEST(ColmapModel, HasFramesBehindTheKeyframes) {
  const SavedMap saved = NoisyMap();
  const PosedImage frame{7, "7.png", {{0, 1, 0, 0}, {1, 2, 3}}};
  const std::vector<PosedImage> others = {frame, {8, "8.png", {}}};
  const ColmapModel keyframes =
      MakeColmapModel(saved, ExportCamera(saved.camera), KeyFrameImageNames(saved.map));
  const ColmapModel model =
      MakeColmapModel(saved, ExportCamera(saved.camera), KeyFrameImageNames(saved.map), {}, others);
  ASSERT_EQ(model.images.size(), keyframes.images.size() + 2);
  const ColmapModel::Image& first = model.images[keyframes.images.size()];
  EXPECT_EQ(first.id, keyframes.images.back().id + 1);
  EXPECT_EQ(model.images.back().id, first.id + 1);
  EXPECT_EQ(first.name, "7.png");
  EXPECT_EQ(first.cam_from_world.translation, frame.cam_from_world.translation);
  EXPECT_TRUE(first.keypoints.empty());
  EXPECT_EQ(model.points.size(), keyframes.points.size());
  const ScratchFolder folder;
  WriteColmapText(folder.path(), model);
  WriteColmapBinary(folder.path(), model);
  ExpectEqual(ReadColmapText(folder.path()), model);
  ExpectEqual(ReadColmapBinary(folder.path()), model);
}

struct KnownLens {
  const char* name;  // in COLMAP
  DistortionModel model;
  double focal;
  std::array<double, kMostCoefficients> distortion;
};

const std::vector<KnownLens>& LensesThatColmapKnows() {
  using enum DistortionModel;
  static const std::vector<KnownLens> lenses = {
      {"PINHOLE", kNone, 500, {}},
      {"PINHOLE", kRadTan, 500, {}},
      {"OPENCV", kRadTan, 460, {-0.28, 0.07, 0.0002, 0.00002}},
      {"FULL_OPENCV", kRadTan, 517, {0.26, -0.95, -0.005, 0.003, 1.16}},
      {"FULL_OPENCV", kRational, 300, {8.5, 4.2, 0.0002, -0.0001, 0.21, 8.85, 7.06, 1.1}},
      {"FOV", kFov, 350, {0.93}},
      {"OPENCV_FISHEYE", kEquidistant, 190, {0.0035, 0.0007, -0.002, 0.0002}}};
  return lenses;
}

// The camera of this lens, of which the rectified one is turned by some degrees.
ExportCamera DeliveredBy(const RectifiedCamera& rectified, const KnownLens& lens) {
  CameraIntrinsics in;
  in.fx = lens.focal;
  in.fy = 1.01 * lens.focal;
  in.cx = 371.3;
  in.cy = 235.7;
  in.width = 752;
  in.height = 480;
  in.model = lens.model;
  in.distortion = lens.distortion;
  const Eigen::AngleAxisd turn(0.05, Eigen::Vector3d(1, 2, -1).normalized());
  return {rectified, Eigen::Quaterniond(turn), Camera(in)};
}

// The points are projected by COLMAP's own formulas.
TEST(ColmapModel, OfImagesAsDeliveredHasTheLensAndTheSamePoints) {
  const SyntheticWorld world = MakeSyntheticWorld(120, 10);
  SavedMap saved;
  saved.camera = world.camera;
  saved.map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(25), PoseOnPath(40)}, {.noise = 0}).map;
  const std::vector<PosedImage> others = {{7, "7.png", PoseOnPath(30)}};
  const auto names = KeyFrameImageNames(saved.map);
  const ColmapModel undistorted =
      MakeColmapModel(saved, ExportCamera(saved.camera), names, {}, others);
  for (const KnownLens& lens : LensesThatColmapKnows()) {
    const ScratchFolder folder;
    const ExportCamera camera = DeliveredBy(saved.camera, lens);
    const ColmapModel model = MakeColmapModel(saved, camera, names, {}, others);
    EXPECT_EQ(model.camera.model, lens.name);
    WriteColmapText(folder.path(), model);
    WriteColmapBinary(folder.path(), model);
    ExpectEqual(ReadColmapBinary(folder.path()), model);
    const ColmapModel read = ReadColmapText(folder.path());
    ExpectEqual(read, model);
    ASSERT_EQ(read.points.size(), undistorted.points.size());
    for (std::size_t i = 0; i < read.points.size(); ++i) {
      EXPECT_EQ(read.points[i].track, undistorted.points[i].track);
      EXPECT_LT(ReprojectionErrorOf(read, read.points[i]), 1e-6) << lens.name;
      EXPECT_LT(read.points[i].error, 1e-6);
    }
    const Eigen::Vector3d point = read.points.front().position;
    EXPECT_LT((read.images.back().cam_from_world * point -
               camera.PoseOf(others[0].cam_from_world) * point)
                  .norm(),
              1e-12);
  }
}

TEST(ColmapCameraOf, KnowsNoLensThatColmapHasNot) {
  using enum DistortionModel;
  const RectifiedCamera rectified = MakeSyntheticWorld(0, 0).camera;
  for (const KnownLens& lens : {KnownLens{"", kDoubleSphere, 220, {-0.18, 0.59}},
                                {"", kEucm, 230, {0.63, 1.04}},
                                {"", kOmni, 420, {0.9, -0.2, 0.05, 0.001, -0.0005}}}) {
    EXPECT_FALSE(ColmapCameraOf(DeliveredBy(rectified, lens).intrinsics()));
  }
  const auto known =
      ColmapCameraOf(DeliveredBy(rectified, LensesThatColmapKnows()[2]).intrinsics());
  ASSERT_TRUE(known);
  EXPECT_EQ(known->parameters,
            (std::vector<double>{
                460, 1.01 * 460, 371.3 + 0.5, 235.7 + 0.5, -0.28, 0.07, 0.0002, 0.00002}));
}

// Each image has two lines, one without features as well.
TEST(WriteColmapText, WritesTheForm) {
  const ScratchFolder folder;
  ColmapModel model;
  model.camera = {"PINHOLE", 752, 480, {435, 420.25, 367.5, 252.5}};
  model.images.push_back({1, {{1, 0, 0, 0}, {0, -0.5, 2}}, "a.png", {{{1.5, 2.5}, 9}, {{3, 4}}}});
  model.images.push_back({3, {{0, 1, 0, 0}, {0, 0, 0}}, "b.png", {}});
  model.points.push_back({9, {1, 2, 0.1}, {77, 0, 255}, 0.25, {{1, 0}}});
  WriteColmapText(folder.path(), model);
  const auto rows = [&](const std::string& name) {
    std::string text, line;
    std::istringstream file(Contents(folder / name));
    while (std::getline(file, line)) {
      if (!line.starts_with('#')) text += line + "|";
    }
    return text;
  };
  EXPECT_EQ(rows("cameras.txt"), "1 PINHOLE 752 480 435 420.25 367.5 252.5|");
  EXPECT_EQ(rows("images.txt"),
            "1 1 0 0 0 0 -0.5 2 1 a.png|1.5 2.5 9 3 4 -1|3 0 1 0 0 0 0 0 1 b.png||");
  EXPECT_EQ(rows("points3D.txt"), "9 1 2 0.1 77 0 255 0.25 1 0|");
  WriteColmapBinary(folder.path(), model);
  ExpectEqual(ReadColmapText(folder.path()), model);
  ExpectEqual(ReadColmapBinary(folder.path()), model);
}

TEST(ColmapModel, LeavesOutPointsThatFewerThanTwoImagesShow) {
  SavedMap saved = NoisyMap();
  const auto seen_twice = [](const auto& entry) { return entry.second.observations.size() >= 2; };
  const auto& points = saved.map.points();
  const auto expected = std::count_if(points.begin(), points.end(), seen_twice);
  EXPECT_LT(expected, std::ssize(points));
  const auto count = [&] {
    return std::ssize(
        MakeColmapModel(saved, ExportCamera(saved.camera), KeyFrameImageNames(saved.map)).points);
  };
  EXPECT_EQ(count(), expected);
  const PointId id = std::find_if(points.begin(), points.end(), seen_twice)->first;
  saved.map.Apply({edit::MovePoint{id, {0, 0, -50}}});  // behind all cameras
  EXPECT_EQ(count(), expected - 1);
  for (const ColmapModel::Image& image :
       MakeColmapModel(saved, ExportCamera(saved.camera), KeyFrameImageNames(saved.map)).images) {
    for (const ColmapModel::Keypoint& keypoint : image.keypoints) {
      EXPECT_NE(keypoint.point, id.value + 1);
    }
  }
}

TEST(WriteColmapText, NamesTheFileThatCannotBeWritten) {
  const ScratchFolder folder;
  EXPECT_THAT(MessageOf([&] { WriteColmapText(folder / "none", {}); }),
              HasSubstr("none/cameras.txt: No such file or directory"));
  EXPECT_THAT(MessageOf([&] { WriteColmapBinary(folder / "none", {}); }),
              HasSubstr("none/cameras.bin: No such file or directory"));
}

// The words of a line, which single blanks part: readers of this form split at each blank.
std::vector<std::string> NextWords(std::istringstream& file) {
  std::string line, word;
  EXPECT_TRUE(std::getline(file, line));
  std::istringstream words(line);
  std::vector<std::string> result;
  while (std::getline(words, word, ' ')) {
    EXPECT_FALSE(word.empty()) << line;
    result.push_back(word);
  }
  return result;
}

std::vector<double> NextNumbers(std::istringstream& file) {
  std::vector<double> numbers;
  for (const std::string& word : NextWords(file)) numbers.push_back(std::stod(word));
  return numbers;
}

struct LimapFiles {
  std::map<int, std::string> images;
  std::map<int, std::vector<std::vector<double>>> detections;  // x1 y1 x2 y2
  struct Track {
    std::vector<double> start, end, images, segments;
  };
  std::vector<Track> tracks;
};

LimapFiles ReadLimap(const ScratchFolder& folder) {
  LimapFiles files;
  std::istringstream list(Contents(folder / "image_list.txt"));
  for (auto n = NextNumbers(list).at(0); n > 0; --n) {
    const auto words = NextWords(list);
    EXPECT_EQ(words.size(), 2U);
    files.images[std::stoi(words.at(0))] = words.at(1);
  }
  std::istringstream detections(Contents(folder / "detections.txt"));
  for (auto n = NextNumbers(detections).at(0); n > 0; --n) {
    const auto head = NextNumbers(detections);
    auto& segments = files.detections[static_cast<int>(head.at(0))];
    for (auto k = head.at(1); k > 0; --k) segments.push_back(NextNumbers(detections));
  }
  std::istringstream tracks(Contents(folder / "alltracks.txt"));
  const auto count = NextNumbers(tracks).at(0);
  for (int i = 0; i < count; ++i) {
    const auto head = NextNumbers(tracks);
    EXPECT_EQ(head.at(0), i);
    LimapFiles::Track track{
        NextNumbers(tracks), NextNumbers(tracks), NextNumbers(tracks), NextNumbers(tracks)};
    EXPECT_EQ(head.at(1), static_cast<double>(track.images.size()));
    EXPECT_EQ(head.at(2), static_cast<double>(track.images.size()));
    EXPECT_EQ(track.images.size(), track.segments.size());
    files.tracks.push_back(track);
  }
  return files;
}

TEST(WriteLimapLines, GivesLinesWithTheSegmentsThatShowThem) {
  const ScratchFolder folder;
  const SyntheticWorld world = MakeSyntheticWorld(0, 40);
  Map map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10), PoseOnPath(25)}, {}).map;
  map.Apply({edit::RemoveLine{map.lines().begin()->first}});
  WriteLimapLines(folder.path(), map, ExportCamera(world.camera), KeyFrameImageNames(map));
  const LimapFiles files = ReadLimap(folder);
  EXPECT_EQ(files.images.at(2), "50000000.png");
  ASSERT_EQ(files.images.size(), 3U);
  ASSERT_EQ(files.detections.size(), 3U);
  ASSERT_EQ(files.tracks.size(), map.lines().size());
  std::size_t views = 0;
  for (const LimapFiles::Track& track : files.tracks) {
    const Eigen::Map<const Eigen::Vector3d> start(track.start.data()), end(track.end.data());
    for (std::size_t k = 0; k < track.images.size(); ++k) {
      const auto image = static_cast<int>(track.images[k]);
      const auto& segment =
          files.detections.at(image).at(static_cast<std::size_t>(track.segments[k]));
      // Both ends of the segment lie on the projected line, within their noise.
      const Rigid3& pose = map.Find(KeyFrameId{image - 1})->frame.cam_from_world;
      const Eigen::Vector2d half(0.5, 0.5);
      const Eigen::Vector3d line =
          LineThrough({world.camera.Project(pose * Eigen::Vector3d(start)) + half,
                       world.camera.Project(pose * Eigen::Vector3d(end)) + half});
      EXPECT_LT(std::abs(LineDistance(line, {segment.at(0), segment.at(1)})), 2.5);
      EXPECT_LT(std::abs(LineDistance(line, {segment.at(2), segment.at(3)})), 2.5);
      ++views;
    }
  }
  EXPECT_GT(views, 30U);
  const Segment2& first = map.Find(KeyFrameId{0})->frame.features().lines.front().segment;
  EXPECT_EQ(files.detections.at(1).front().front(), first.start.x() + 0.5);
  EXPECT_EQ(files.detections.at(1).front().back(), first.end.y() + 0.5);
  const ExportCamera bent = DeliveredBy(world.camera, LensesThatColmapKnows().back());
  WriteLimapLines(folder.path(), map, bent, KeyFrameImageNames(map));
  EXPECT_EQ(ReadLimap(folder).detections.at(1).front().front(),
            bent.PixelOf(first.start)->x() + 0.5);
}

TEST(WriteLimapLines, OfAMapWithoutAnythingIsThreeZeros) {
  const ScratchFolder folder;
  WriteLimapLines(folder.path(), Map(), ExportCamera(RectifiedCamera()), {});
  for (const char* name : {"image_list.txt", "detections.txt", "alltracks.txt"}) {
    EXPECT_EQ(Contents(folder / name), "0\n");
  }
}

}  // namespace

namespace colmap_folder_test {

TEST(WriteColmapFolder, HasTheModelInTheFilesAskedForAndTheLines) {
  const SyntheticWorld world = MakeSyntheticWorld(120, 10);
  SavedMap saved;
  saved.camera = world.camera;
  saved.map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10)}, {}).map;
  const std::map<KeyFrameId, std::string> names = KeyFrameImageNames(saved.map);
  const ColmapModel model = MakeColmapModel(saved, ExportCamera(saved.camera), names);
  for (const ColmapFiles files : {ColmapFiles::kText, ColmapFiles::kBinary, ColmapFiles::kBoth}) {
    const ScratchFolder folder;
    WriteColmapFolder(folder.path(), saved.map, ExportCamera(saved.camera), model, names, files);
    for (const std::string name : {"cameras", "images", "points3D"}) {
      const std::filesystem::path file = folder / "sparse/0" / name;
      EXPECT_EQ(std::filesystem::exists(file.string() + ".txt"), files != ColmapFiles::kBinary);
      EXPECT_EQ(std::filesystem::exists(file.string() + ".bin"), files != ColmapFiles::kText);
    }
    for (const char* name : {"image_list.txt", "detections.txt", "alltracks.txt"}) {
      EXPECT_TRUE(std::filesystem::exists(folder / "lines" / name)) << name;
    }
  }
}

}  // namespace colmap_folder_test

}  // namespace plumbline
