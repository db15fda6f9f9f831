// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/poster_sequence.h"
#include "tests/e2e/program.h"
#include "tests/support/data_folder.h"
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace plumbline {
namespace {

// Makes OpenCV and glibc take the code that a processor without vector instructions beyond SSE2 and
// without fused multiply-add would take. Where the processor has none of them, nothing changes.
constexpr const char* kOldProcessor =
    "OPENCV_CPU_DISABLE=AVX512-SKX,AVX2,FMA3,AVX,FP16,SSE4.2,SSE4.1 "
    "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX2,-FMA,-FMA4 ";

// Runs on this processor and as on an old one; compares all files that must have the same bytes.
void ExpectSameBytes(const std::string& arguments) {
  const ScratchFolder folder;
  for (const std::string run : {"this", "old"}) {
    const Outcome outcome =
        RunProgram(folder,
                   "run " + arguments + " --quiet --out " + Quoted(folder / run),
                   run == "old" ? kOldProcessor : "");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  const auto names = FilesOf(folder / "this");
  EXPECT_EQ(names, FilesOf(folder / "old"));
  int compared = 0;
  for (const std::string& name : names) {
    if (!IsRepeatable(name)) continue;
    ++compared;
    EXPECT_TRUE(Contents(folder / "this" / name) == Contents(folder / "old" / name))
        << arguments << ": " << name;
  }
  EXPECT_GE(compared, 6);
  EXPECT_GT(Contents(folder / "this/trajectory.txt").size(), 500U);
}

TEST(OtherProcessor, GivesTheSameBytes) {
  const ScratchFolder folder;
  ExpectSameBytes(Quoted(WritePosterSequence(folder, 22)));
}

TEST(OtherProcessor, GivesTheSameBytesOnRecordedSequences) {
  int found = 0;
  for (const auto& [sequence, options] :
       {std::pair<std::string, std::string>{"euroc/MH_01_easy_first250", " --to 30"},
        {"kitti/06_first51", " --to 25"},
        {"tum/rgbd_dataset_freiburg1_floor_first90", " --to 30"},
        {"tum/rgbd_dataset_freiburg1_floor_first90", " --sensor mono --from 20 --to 60"},
        {"icl/office_kt3_first600", " --from 60 --to 110 --camera icl_nuim"}}) {
    const auto data = FindData(sequence);
    if (!data) continue;
    ++found;
    ExpectSameBytes(Quoted(*data) + options);
  }
  if (found == 0) GTEST_SKIP() << "real data not found; set PLUMBLINE_DATA";
}

}  // namespace
}  // namespace plumbline
