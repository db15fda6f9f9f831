// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/command_inputs.h"

#include "tests/io/scratch_folder.h"
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace command_inputs_test {

// Without images, with a ground truth of this file.
class TrueDataset : public Dataset {
 public:
  explicit TrueDataset(const std::filesystem::path& truth) : Dataset(Info(truth)) {}
  Expected<SensorFrame, ImageFailure> Read(std::size_t) const override {
    return ImageFailure{"none.png", "no such file"};
  }

 private:
  static DatasetInfo Info(const std::filesystem::path& truth) {
    DatasetInfo info;
    info.ground_truth.emplace();
    info.ground_truth->path = truth;
    return info;
  }
};

std::vector<std::filesystem::path> PathsOf(const std::vector<std::string>& arguments,
                                           const Dataset& dataset) {
  const CommandSyntax syntax = {
      "x",
      "",
      {"PATH"},
      {{"--camera", "FILE", ""}, {"--poses", "FILE", ""}, {"--config", "FILE", "may be repeated"}}};
  std::vector<std::filesystem::path> paths;
  for (const RunInput& input : CommandInputs(CommandLine(syntax, arguments), dataset)) {
    EXPECT_FALSE(input.may_lie_in_out);
    paths.push_back(input.path);
  }
  return paths;
}

TEST(CommandInputs, AreTheDataThoseOfOptionsAndTheGroundTruth) {
  const ScratchFolder folder;
  const std::filesystem::path truth = folder.Write("truth.csv", "");
  const TrueDataset dataset(truth);
  const std::string a = folder.Write("a.yaml", "").string(),
                    b = folder.Write("b.yaml", "").string(),
                    poses = folder.Write("poses.txt", "").string();
  EXPECT_THAT(PathsOf({"data"}, dataset), testing::ElementsAre("data", truth));
  EXPECT_THAT(PathsOf({"data", "--config", a, "--poses", poses, "--config", b}, dataset),
              testing::ElementsAre("data", poses, a, b, truth));
  // A built-in camera, what is no file and a live source have no place.
  EXPECT_THAT(PathsOf({"data", "--camera", "tum_fr1", "--config", "/dev/null"}, dataset),
              testing::ElementsAre("data", truth));
  EXPECT_THAT(PathsOf({"camera:0"}, dataset), testing::ElementsAre(truth));
}

}  // namespace command_inputs_test
}  // namespace plumbline
