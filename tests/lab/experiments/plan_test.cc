// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/plan.h"

#include "lab/experiments/computed.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> NamesOf(const Plan& plan) {
  std::vector<std::string> names;
  for (const Job& job : plan.jobs) names.push_back(plan.NameOf(job));
  return names;
}

TEST(Plan, HasAJobForEachSequenceVariantAndRun) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  EXPECT_THAT(NamesOf(plan),
              ElementsAre("euroc/a/one/1",
                          "euroc/a/one/2",
                          "euroc/a/two/1",
                          "euroc/a/two/2",
                          "euroc/b/one/1",
                          "euroc/b/one/2",
                          "euroc/b/two/1",
                          "euroc/b/two/2"));
  EXPECT_EQ(plan.jobs[1].folder, folder / "out/runs/euroc/a/one/2");
}

TEST(Plan, AVariantOfAnEarlierProgramDependsOnThatProgram) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  PlanRequest request = RequestIn(folder);
  request.earlier = "the earlier one";
  EXPECT_THAT(MessageOf([&] { MakePlan(experiment, request); }),
              HasSubstr("pair: takes no --earlier"));
  experiment.variants[0].by_earlier = true;
  const Plan plan = MakePlan(experiment, request);
  EXPECT_THAT(plan.jobs.front().key, HasSubstr("program the earlier one\n"));
  EXPECT_THAT(plan.jobs.back().key, HasSubstr("program the program\n"));
  request.earlier.reset();
  EXPECT_THAT(MessageOf([&] { MakePlan(experiment, request); }),
              HasSubstr("pair: expected --earlier PROGRAM, found none"));
}

TEST(Plan, RunKHasSeedKAndBeginsAtFrameKMinusOne) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  experiment.variants[0].arguments = {"--blur", "5"};
  PlanRequest request = RequestIn(folder);
  request.settings = {"slam.mode=inline"};
  const Plan plan = MakePlan(experiment, request);
  EXPECT_THAT(plan.jobs[1].command,
              ElementsAre("run",
                          (folder / "data/euroc/a").string(),
                          "--out",
                          (folder / "out/runs/euroc/a/one/2").string(),
                          "--quiet",
                          "--seed",
                          "2",
                          "--from",
                          "1",
                          "--blur",
                          "5",
                          "--set",
                          "slam.mode=inline",
                          "--set",
                          "features.lines=false",
                          "--imu",
                          "off"));
}

TEST(Plan, AReversedVariantPlaysASequenceThatIsWrittenForIt) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");  // without ground truth
  Experiment experiment = TwoVariants();
  experiment.variants[0].reversed = true;
  const Plan plan = MakePlan(experiment, RequestIn(folder));
  const Job &backwards = plan.jobs[1], &forwards = plan.jobs[3];
  EXPECT_THAT(backwards.reversed.string(), HasSubstr((folder / "cache/reversed/euroc/a").string()));
  EXPECT_EQ(backwards.command.at(1), backwards.reversed.string());
  EXPECT_THAT(backwards.key, HasSubstr("backwards"));
  EXPECT_EQ(backwards.key.find(folder.path().string()), std::string::npos);
  EXPECT_TRUE(forwards.reversed.empty());
  EXPECT_EQ(forwards.command.at(1), (folder / "data/euroc/a").string());
  for (const Job* job : {&backwards, &forwards}) {
    EXPECT_EQ(job->command.at(7) + " " + job->command.at(8), "--from 1") << "run 2 leaves out one";
  }
}

TEST(Plan, KeysFollowAllThatTheResultDependsOn) {
  const ScratchFolder folder;
  const std::string key = PlanOfTwo(folder).jobs[0].key;
  EXPECT_EQ(PlanOfTwo(folder).jobs[0].key, key);
  EXPECT_THAT(key, HasSubstr("features.lines=false"));
  EXPECT_EQ(key.find(folder.path().string()), std::string::npos) << "moving the data is no change";
  PlanRequest other = RequestIn(folder);
  other.program = "another build";
  EXPECT_NE(MakePlan(TwoVariants(), other).jobs[0].key, key);
  other = RequestIn(folder);
  other.settings = {"slam.lag=2"};
  EXPECT_NE(MakePlan(TwoVariants(), other).jobs[0].key, key);
  EXPECT_NE(PlanOfTwo(folder).jobs[1].key, key);
  folder.Write("data/euroc/a/mav0/state_groundtruth_estimate0/data.csv",
               "1000000000,0,0,0,1,0,0,0\n");
  EXPECT_NE(MakePlan(TwoVariants(), RequestIn(folder)).jobs[0].key, key);
}

TEST(Plan, OnlyKeepsWhatItNames) {
  const ScratchFolder folder;
  PlanOfTwo(folder);
  PlanRequest request = RequestIn(folder);
  request.runs = 1;
  const auto chosen = [&](const std::vector<std::string>& only) {
    request.only = only;
    return NamesOf(MakePlan(TwoVariants(), request));
  };
  EXPECT_THAT(chosen({"euroc/b"}), ElementsAre("euroc/b/one/1", "euroc/b/two/1"));
  EXPECT_THAT(chosen({"*/two"}), ElementsAre("euroc/a/two/1", "euroc/b/two/1"));
  EXPECT_THAT(chosen({"a/one", "euroc/b/t*"}), ElementsAre("euroc/a/one/1", "euroc/b/two/1"));
  EXPECT_THAT(chosen({"euroc/?/one"}), ElementsAre("euroc/a/one/1", "euroc/b/one/1"));
  request.only = {"a/three"};
  EXPECT_THAT(MessageOf([&] { MakePlan(TwoVariants(), request); }),
              HasSubstr("--only a/three: expected part of one of euroc/a, euroc/b, with / and one "
                        "of one, two"));
}

TEST(Plan, AtTestSizeThereAreFewerRunsAndFurtherArguments) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  experiment.full_runs = 4;
  experiment.test_arguments = {"--stride", "2"};
  PlanRequest request = RequestIn(folder);
  const Plan test = MakePlan(experiment, request);
  EXPECT_EQ(test.jobs.size(), 2U * 2U);
  EXPECT_THAT(test.jobs[0].key, HasSubstr("--stride 2"));
  request.full = true;
  const Plan full = MakePlan(experiment, request);
  EXPECT_EQ(full.jobs.size(), 2U * 4U);
  EXPECT_EQ(full.jobs[0].key.find("--stride"), std::string::npos);
  EXPECT_LT(EstimatedSeconds(test, test.jobs[0]), EstimatedSeconds(full, full.jobs[0]));
}

TEST(Plan, FewerStartsAreEstimatedToTakeLess) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  experiment.command = RunCommandKind::kStarts;
  const Plan all = MakePlan(experiment, RequestIn(folder));
  experiment.test_arguments = {"--every", "10"};
  const Plan half = MakePlan(experiment, RequestIn(folder));
  const double start = 0.5;  // of the program
  EXPECT_NEAR(EstimatedSeconds(half, half.jobs[0]) - start,
              0.5 * (EstimatedSeconds(all, all.jobs[0]) - start),
              1e-9);
}

TEST(Plan, WhatComputesByItselfIsOneJobDoneWhileItsResultIsThere) {
  const ScratchFolder folder;
  const ComputedExperiment& experiment = *FindComputedExperiment("cutting-testbed");
  const Plan plan = MakePlan(experiment, folder / "out", 3, "program 1");
  ASSERT_EQ(plan.jobs.size(), 1U);
  EXPECT_THAT(plan.jobs[0].command,
              ElementsAre("experiment",
                          "cutting-testbed",
                          "--runs",
                          "3",
                          "--out",
                          (folder / "out").string(),
                          "--quiet"));
  EXPECT_GT(EstimatedSeconds(plan, plan.jobs[0]), 0);
  folder.Write("out/results.json", "[]");
  EXPECT_FALSE(IsDone(plan.jobs[0]));
  MarkDone(plan.jobs[0]);
  EXPECT_TRUE(IsDone(plan.jobs[0]));
  EXPECT_FALSE(IsDone(MakePlan(experiment, folder / "out", 4, "program 1").jobs[0]));
  EXPECT_FALSE(IsDone(MakePlan(experiment, folder / "out", 3, "program 2").jobs[0]));
}

TEST(Plan, RefusesWhatCannotBeRunBeforeAnyRun) {
  const ScratchFolder folder;
  PlanOfTwo(folder);
  PlanRequest request = RequestIn(folder);
  request.settings = {"features.lnies=true"};
  EXPECT_THAT(MessageOf([&] { MakePlan(TwoVariants(), request); }),
              HasSubstr("did you mean 'features.lines'?"));
  Experiment experiment = TwoVariants();
  experiment.sequences = {{"kitti/*"}, {"tum/*"}};
  EXPECT_THAT(MessageOf([&] { MakePlan(experiment, RequestIn(folder)); }),
              HasSubstr("pair: no sequence found for kitti/*, tum/* in "));
  request = RequestIn(folder);
  request.sources.data = std::nullopt;
  EXPECT_THAT(MessageOf([&] { MakePlan(TwoVariants(), request); }), HasSubstr("without --data"));
}

TEST(Plan, NotesWhatIsMissingInOneLine) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  EXPECT_EQ(MakePlan(experiment, RequestIn(folder)).missing_note, "");
  experiment.sequences = {{"euroc/*"}, {"kitti/*"}, {"tum/*"}};
  const std::string data = (folder / "data").string();
  const Plan some = MakePlan(experiment, RequestIn(folder));
  EXPECT_EQ(some.missing_note,
            "pair: no sequence found for kitti/*, tum/* in " + data + "; left out");
  EXPECT_TRUE(some.found_recorded);
  experiment.sequences = {{"kitti/*"}, {"worlds/room"}};
  const Plan none = MakePlan(experiment, RequestIn(folder));
  EXPECT_EQ(none.missing_note,
            "pair: no sequence found for kitti/* in " + data + "; only rendered ones are run");
  EXPECT_FALSE(none.found_recorded);
}

TEST(Plan, TellsOfSettingsThatVariantsReplace) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  PlanRequest request = RequestIn(folder);
  request.settings = {"features.points=true", "features.lines=true"};
  EXPECT_THAT(MakePlan(TwoVariants(), request).setting_notes,
              ElementsAre("pair: --set features.lines=true has no effect on one, which sets "
                          "features.lines itself"));
  request.only = {"a/two"};
  EXPECT_TRUE(MakePlan(TwoVariants(), request).setting_notes.empty());
  request.only = {"a/one"};
  EXPECT_EQ(MessageOf([&] { MakePlan(TwoVariants(), request); }),
            "pair: --set features.lines=true has no effect on one, which sets features.lines "
            "itself; no other variant is run");
  request = RequestIn(folder);
  request.settings = {"slam.seed=7"};  // each run has a seed of its own
  EXPECT_EQ(MessageOf([&] { MakePlan(TwoVariants(), request); }),
            "pair: --set slam.seed=7 has no effect on one, two, which set slam.seed themselves; no "
            "other variant is run");
  Experiment live = TwoVariants();
  live.variants[1].arguments = {"--mode", "live"};
  request.settings = {"slam.mode=inline"};
  EXPECT_THAT(MakePlan(live, request).setting_notes,
              ElementsAre("pair: --set slam.mode=inline has no effect on two, which sets slam.mode "
                          "itself"));
}

TEST(Plan, AJobIsDoneWhileItsFolderHoldsTheResultOfTheSameKey) {
  const ScratchFolder folder;
  Job job = PlanOfTwo(folder).jobs[0];
  EXPECT_FALSE(IsDone(job));
  folder.Write("out/runs/euroc/a/one/1/summary.json", Summary(0.01));
  EXPECT_FALSE(IsDone(job)) << "a run that nobody saw the end of";
  MarkDone(job);
  EXPECT_TRUE(IsDone(job));
  const std::string key = job.key;
  job.key += "changed";
  EXPECT_FALSE(IsDone(job));
  job.key = key;
  folder.Write("out/runs/euroc/a/one/1/summary.json", Summary(0.01).substr(0, 30));
  EXPECT_FALSE(IsDone(job)) << "half a file";
  folder.Write("out/runs/euroc/a/one/1/summary.json", Summary(0.01));
  MarkUndone(job);
  EXPECT_FALSE(IsDone(job));
}

TEST(ProgramId, IsThatOfTheBytes) {
  const ScratchFolder folder;
  const std::string id = ProgramId(folder.Write("a", "program"));
  EXPECT_EQ(ProgramId(folder.Write("b", "program")), id);
  EXPECT_NE(ProgramId(folder.Write("c", "Program")), id);
  EXPECT_THAT(MessageOf([&] { ProgramId(folder / "none"); }), HasSubstr("cannot read the program"));
}

TEST(Plan, StartsAreACommandOfTheirOwnWithTheirOwnOptions) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  experiment.command = RunCommandKind::kStarts;
  experiment.sequences[0].arguments = {"--least-parallax", "0.5"};
  experiment.variants = {{"few", {"initialization.frames=4"}}};
  const Plan plan = MakePlan(experiment, RequestIn(folder));
  EXPECT_THAT(plan.jobs[0].command,
              ElementsAre("starts",
                          (folder / "data/euroc/a").string(),
                          "--out",
                          (folder / "out/runs/euroc/a/few/1").string(),
                          "--quiet",
                          "--seed",
                          "1",
                          "--from",
                          "0",
                          "--least-parallax",
                          "0.5",
                          "--set",
                          "initialization.frames=4"));
  experiment.variants = {{"few", {"tracking.reference=last_frame"}}};
  EXPECT_THAT(MessageOf([&] { MakePlan(experiment, RequestIn(folder)); }),
              HasSubstr("unknown option 'tracking.reference'"));
}

}  // namespace
}  // namespace plumbline
