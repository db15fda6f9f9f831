// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/colmap_folder.h"

#include "plumbline/io/keyframe_images.h"

#include "tests/io/scratch_folder.h"
#include "tests/support/true_map.h"
#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace plumbline {
namespace colmap_folder_test {

TEST(WriteColmapFolder, HasTheModelInTheFilesAskedForAndTheLines) {
  const SyntheticWorld world = MakeSyntheticWorld(120, 10);
  SavedMap saved;
  saved.camera = world.camera;
  saved.map = MakeTrueMap(world, {PoseOnPath(0), PoseOnPath(10)}, {}).map;
  const std::map<KeyFrameId, std::string> names = KeyFrameImageNames(saved.map);
  const ColmapModel model = MakeColmapModel(saved, names);
  for (const ColmapFiles files : {ColmapFiles::kText, ColmapFiles::kBinary, ColmapFiles::kBoth}) {
    const ScratchFolder folder;
    WriteColmapFolder(folder.path(), saved.map, model, names, files);
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
