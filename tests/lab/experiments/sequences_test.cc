// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/sequences.h"

#include "worlds/sequence_cache.h"
#include "worlds/world.h"
#include "worlds/world_catalog.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace sequences_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> NamesOf(const FoundSequences& found) {
  std::vector<std::string> names;
  for (const ExperimentSequence& sequence : found.sequences) names.push_back(sequence.name);
  return names;
}

SequenceSources SourcesIn(const ScratchFolder& folder) {
  return {folder / "data", folder / "cache", WorldSize::kTest};
}

TEST(ExperimentSequences, AreFoundByFolderInOrderOfNames) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/b");
  WriteSequenceFolder(folder, "data/euroc/a");
  WriteSequenceFolder(folder, "data/other/deep/er/c");
  folder.Write("data/euroc/notes/readme.txt", "no sequence");
  const auto found =
      FindSequences({{"other/*"}, {"euroc/*"}, {"euroc/a"}, {"kitti/*"}}, SourcesIn(folder));
  EXPECT_THAT(NamesOf(found), ElementsAre("other/c", "euroc/a", "euroc/b"));
  EXPECT_THAT(found.missing, ElementsAre("kitti/*"));
  EXPECT_EQ(found.sequences[1].path, folder / "data/euroc/a");
  EXPECT_EQ(found.sequences[1].frames, 3U);
  EXPECT_FALSE(found.sequences[1].rendered.has_value());
}

TEST(ExperimentSequences, ThoseWithoutCalibrationTakeTheCameraOfTheirBenchmark) {
  const ScratchFolder folder;
  for (const std::string name : {"icl/office", "tum/desk"}) {
    folder.Write("data/" + name + "/rgb.txt", "1.0 rgb/1.png\n2.0 rgb/2.png\n");
    WriteImage(folder, "data/" + name + "/rgb/1.png");
    WriteImage(folder, "data/" + name + "/rgb/2.png");
  }
  const auto found = FindSequences({{"icl/*"}, {"tum/*"}}, SourcesIn(folder));
  ASSERT_THAT(NamesOf(found), ElementsAre("icl/office", "tum/desk"));
  EXPECT_THAT(found.sequences[0].arguments, ElementsAre("--camera", "icl_nuim"));
  EXPECT_THAT(found.sequences[1].arguments, ElementsAre());
}

TEST(ExperimentSequences, IdentityFollowsWhatIsInTheLists) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  const auto identity = [&] {
    return FindSequences({{"euroc/*"}}, SourcesIn(folder)).sequences[0].identity;
  };
  const std::string before = identity();
  EXPECT_EQ(identity(), before);
  folder.Write("data/euroc/a/mav0/state_groundtruth_estimate0/data.csv",
               "1000000000,0,0,0,1,0,0,0\n");
  EXPECT_NE(identity(), before);
  folder.Write("data/euroc/a/mav0/cam0/data.csv", "not,a,list\n");
  const auto broken = FindSequences({{"euroc/*"}}, SourcesIn(folder)).sequences[0];
  EXPECT_THAT(broken.identity, StartsWith("euroc/a/mav0/cam0/data.csv:1"));
  EXPECT_EQ(broken.frames, 0U);
}

TEST(ExperimentSequences, WorldsAreThoseThatCanBeRendered) {
  const ScratchFolder folder;
  SequenceSources sources = SourcesIn(folder);
  sources.data = std::nullopt;
  const std::string name = Worlds().front().name;
  const auto found = FindSequences(
      {{"worlds/" + name}, {"worlds/" + name, {"frames=7", "seed=3"}, "other"}, {"euroc/*"}},
      sources);
  ASSERT_THAT(NamesOf(found), ElementsAre("worlds/" + name, "worlds/" + name + "@other"));
  EXPECT_THAT(found.missing, ElementsAre("euroc/*"));
  const ExperimentSequence& plain = found.sequences[0];
  const ExperimentSequence& other = found.sequences[1];
  EXPECT_EQ(plain.frames, 150U);
  EXPECT_EQ(plain.rendered->options.scale, 0.5);
  EXPECT_EQ(other.frames, 7U);
  EXPECT_EQ(other.rendered->options.seed, 3U);
  EXPECT_EQ(other.path, folder / "cache" / SequenceKey(name, other.rendered->options));
  EXPECT_NE(plain.identity, other.identity);
  sources.size = WorldSize::kFull;
  EXPECT_EQ(FindSequences({{"worlds/" + name}}, sources).sequences[0].rendered->options.frames,
            SynthOptions().frames);
  EXPECT_EQ(FindSequences({{"worlds/*"}}, sources).sequences.size(), Worlds().size());
}

TEST(ExperimentSequences, OfAPaperAreFoundWholeOrInPartAndTellWhereTheyComeFrom) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/V1_01_easy");
  WriteSequenceFolder(folder, "data/euroc/V1_02_medium_first50");
  WriteSequenceFolder(folder, "data/euroc/V1_03_difficult_other");
  std::vector<SequenceChoice> choices;
  for (const std::string name : {"V1_01_easy", "V1_02_medium", "V1_03_difficult"}) {
    choices.push_back({"euroc/" + name, {}, "blurred", {"--blur", "5"}, name + " b", "somewhere"});
  }
  const auto found = FindSequences(choices, SourcesIn(folder));
  ASSERT_THAT(NamesOf(found),
              ElementsAre("euroc/V1_01_easy@blurred", "euroc/V1_02_medium_first50@blurred"));
  EXPECT_THAT(found.missing,
              ElementsAre("euroc/V1_03_difficult@blurred (V1_03_difficult b; somewhere)"));
  EXPECT_EQ(found.sequences[0].paper, "V1_01_easy b");
  EXPECT_FALSE(found.sequences[0].part);
  EXPECT_TRUE(found.sequences[1].part);
  EXPECT_THAT(found.sequences[1].arguments, ElementsAre("--blur", "5"));
  EXPECT_NEAR(found.sequences[0].megapixels, 2 * 64 * 48 * 1e-6, 1e-12);
}

TEST(ExperimentSequences, BadSourcesAreRefused) {
  const ScratchFolder folder;
  EXPECT_THAT(MessageOf([&] { FindSequences({{"euroc/*"}}, SourcesIn(folder)); }),
              HasSubstr("data: expected the folder of the sequences, found none"));
  WriteSequenceFolder(folder, "data/kitti/one/00");
  WriteSequenceFolder(folder, "data/kitti/two/00");
  EXPECT_THAT(MessageOf([&] { FindSequences({{"kitti/*"}}, SourcesIn(folder)); }),
              HasSubstr("two sequences are called kitti/00: "));
  EXPECT_THAT(MessageOf([&] {
                FindSequences({{"worlds/*", {"farmes=3"}, "x"}}, SourcesIn(folder));
              }),
              HasSubstr("unknown option 'farmes'"));
}

}  // namespace sequences_test
}  // namespace plumbline
