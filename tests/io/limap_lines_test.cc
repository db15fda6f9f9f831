// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/limap_lines.h"

#include "plumbline/io/keyframe_images.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/true_map.h"
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

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
  WriteLimapLines(folder.path(), map, KeyFrameImageNames(map));
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
}

TEST(WriteLimapLines, OfAMapWithoutAnythingIsThreeZeros) {
  const ScratchFolder folder;
  WriteLimapLines(folder.path(), Map(), {});
  for (const char* name : {"image_list.txt", "detections.txt", "alltracks.txt"}) {
    EXPECT_EQ(Contents(folder / name), "0\n");
  }
}

}  // namespace
}  // namespace plumbline
