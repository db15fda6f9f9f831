// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/job_runner.h"

#include "tests/io/scratch_folder.h"
#include "tests/lab/experiments/experiment_fixtures.h"
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A program in place of ours: notes each call in the file `calls`, then does what `script` says.
// There PATH is the sequence, OUT the folder of the run; write_result makes a good end.
RunnerOptions FakeProgram(const ScratchFolder& folder, const std::string& script) {
  const std::string text =
      "#!/bin/sh\nPATH_=\"$2\"; OUT=\"$4\"\necho \"$OUT\" >> '" + (folder / "calls").string() +
      "'\nwrite_result() { cat > \"$OUT/summary.json\" <<END\n" + Summary(0.01) +
      "\nEND\necho \"$OUT\" > \"$OUT/trajectory.txt\"; }\n" + script + "\n";
  RunnerOptions options;
  options.program = folder.Write("program", text);
  fs::permissions(options.program, fs::perms::owner_all);
  return options;
}

// On this machine, so many at once.
auto RunJobs(const Plan& plan, const RunnerOptions& options, int jobs = 1) {
  LocalExecutor executor(jobs);
  return plumbline::RunJobs(plan, executor, options);
}

std::size_t Calls(const ScratchFolder& folder) {
  const std::string calls = Contents(folder / "calls");
  return static_cast<std::size_t>(std::count(calls.begin(), calls.end(), '\n'));
}

TEST(JobRunner, RunsEveryJobOnce) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  RunnerOptions options = FakeProgram(folder, "write_result");
  std::vector<RunnerState> states;
  options.progress = [&](const RunnerState& state) { states.push_back(state); };
  const auto results = RunJobs(plan, options);
  ASSERT_TRUE(results.has_value());
  ASSERT_EQ(results->size(), 8U);
  for (const JobResult& result : *results) {
    ASSERT_TRUE(result.figures.has_value()) << result.reason;
    EXPECT_DOUBLE_EQ(result.figures->values.at("ate"), 10);
  }
  EXPECT_EQ(Calls(folder), 8U);
  EXPECT_EQ(states.back().done, 8U);
  EXPECT_EQ(states.back().total, 8U);
  EXPECT_EQ(states.back().failed, 0U);
  EXPECT_EQ(states.back().seconds_left, 0);
  EXPECT_EQ(states.front().current, "euroc/a/one/1");
}

TEST(JobRunner, LetsVariantsTakeTurnsWhereTimesAreMeasured) {
  const ScratchFolder folder;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  experiment.exclusive = true;
  const Plan plan = MakePlan(experiment, RequestIn(folder));
  ASSERT_TRUE(RunJobs(plan, FakeProgram(folder, "write_result")).has_value());
  const std::string runs = (folder / "out/runs/euroc/a").string();
  EXPECT_EQ(Contents(folder / "calls"),
            fmt::format("{0}/one/1\n{0}/two/1\n{0}/one/2\n{0}/two/2\n", runs));
}

TEST(JobRunner, RunsAVariantOfAnEarlierProgramByThatProgram) {
  const ScratchFolder folder;
  const ScratchFolder other;
  WriteSequenceFolder(folder, "data/euroc/a");
  Experiment experiment = TwoVariants();
  experiment.variants[0].by_earlier = true;
  PlanRequest request = RequestIn(folder);
  request.earlier = "the earlier one";
  const Plan plan = MakePlan(experiment, request);
  RunnerOptions options = FakeProgram(folder, "write_result");
  options.earlier = FakeProgram(other, "write_result").program;
  ASSERT_TRUE(RunJobs(plan, options).has_value());
  EXPECT_EQ(Calls(folder), 2U);
  EXPECT_EQ(Calls(other), 2U);
  EXPECT_EQ(Contents(other / "calls").find("/two/"), std::string::npos);
}

TEST(JobRunner, GoesOnWhereItStopped) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  RunnerOptions options = FakeProgram(folder, "write_result");
  options.stop = [&] { return Calls(folder) >= 4; };
  EXPECT_FALSE(RunJobs(plan, options).has_value());
  const std::size_t before = Calls(folder);
  ASSERT_LT(before, 8U);
  options.stop = {};
  EXPECT_TRUE(RunJobs(plan, options).has_value());
  // The last one before the stop may or may not have come to its end; the others have.
  const std::size_t after = Calls(folder) - before;
  EXPECT_GE(after, 8 - before);
  EXPECT_LE(after, 8 - before + 1);
  const std::size_t calls = Calls(folder);
  ASSERT_TRUE(RunJobs(plan, options).has_value());
  EXPECT_EQ(Calls(folder), calls) << "all was done";
  options.force = true;
  RunJobs(plan, options);
  EXPECT_EQ(Calls(folder), calls + 8);
}

TEST(JobRunner, WhatIsStoppedInTheMiddleIsRunAgain) {
  const ScratchFolder folder;
  PlanRequest request = RequestIn(folder);
  PlanOfTwo(folder);
  request.only = {"a/one"};
  request.runs = 1;
  const Plan plan = MakePlan(TwoVariants(), request);
  RunnerOptions options = FakeProgram(folder, "write_result; sleep 20");
  options.stop = [&] { return fs::exists(plan.jobs[0].folder / "trajectory.txt"); };
  EXPECT_FALSE(RunJobs(plan, options).has_value());
  EXPECT_TRUE(fs::exists(plan.jobs[0].folder / "summary.json"));
  EXPECT_FALSE(IsDone(plan.jobs[0]));
  EXPECT_TRUE(RunJobs(plan, FakeProgram(folder, "write_result")).has_value());
  EXPECT_EQ(Calls(folder), 2U);
}

TEST(JobRunner, ChangedSettingsAreRunAgain) {
  const ScratchFolder folder;
  PlanOfTwo(folder);
  const RunnerOptions options = FakeProgram(folder, "write_result");
  Experiment experiment = TwoVariants();
  RunJobs(MakePlan(experiment, RequestIn(folder)), options);
  EXPECT_EQ(Calls(folder), 8U);
  experiment.variants[1].settings = {"slam.lag=2"};
  RunJobs(MakePlan(experiment, RequestIn(folder)), options);
  EXPECT_EQ(Calls(folder), 12U);
}

TEST(JobRunner, AFailureIsAResultWithAReasonAndTriedAgain) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  const auto results = RunJobs(plan, FakeProgram(folder, R"(case "$OUT" in
*/a/one/1) echo "frame 3 skipped" >&2; echo "plumbline: $PATH_: no such file" >&2; exit 2;;
*/a/one/2) kill -SEGV $$;;
*/a/two/1) write_result; exit 1;;
*/a/two/2) exit 0;;
*) write_result;;
esac)"));
  ASSERT_TRUE(results.has_value());
  EXPECT_EQ((*results)[0].reason, "euroc/a: no such file");
  EXPECT_EQ((*results)[1].reason, "ended by signal 11 (Segmentation fault)");
  EXPECT_EQ((*results)[2].reason, "exit code 1");
  EXPECT_EQ((*results)[3].reason, "no summary.json");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE((*results)[i].figures.has_value()) << i;
  for (std::size_t i = 4; i < 8; ++i) EXPECT_TRUE((*results)[i].figures.has_value()) << i;
  const auto again = RunJobs(plan, FakeProgram(folder, "write_result"));
  EXPECT_EQ(Calls(folder), 8U + 4U);
  for (const JobResult& result : *again) EXPECT_TRUE(result.figures.has_value());
}

TEST(JobRunner, TriesAgainWhatCrashesButNotBadInput) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  RunnerOptions options = FakeProgram(folder, R"(case "$OUT" in
*/a/one/1) [ -f "$OUT/tried" ] && write_result || { touch "$OUT/tried"; kill -SEGV $$; };;
*/a/one/2) echo "plumbline: bad" >&2; exit 2;;
*/a/two/1) kill -ABRT $$;;
*) write_result;;
esac)");
  options.retries = 1;
  const auto results = RunJobs(plan, options);
  ASSERT_TRUE(results.has_value());
  EXPECT_TRUE((*results)[0].figures.has_value());
  EXPECT_EQ((*results)[0].earlier,
            std::vector<std::string>{"ended by signal 11 (Segmentation fault)"});
  EXPECT_EQ((*results)[1].reason, "bad");
  EXPECT_TRUE((*results)[1].earlier.empty());
  EXPECT_EQ((*results)[2].reason, "ended by signal 6 (Aborted)");
  EXPECT_EQ((*results)[2].earlier.size(), 1U);
  EXPECT_EQ(Calls(folder), 8U + 2U);
}

TEST(JobRunner, WhatRunsOutOfMemorySaysSoAndTheOthersGoOn) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  RunnerOptions options = FakeProgram(folder, R"(case "$OUT" in
*/a/one/1) ulimit -v > "$OUT/limit"; echo "plumbline: out of memory" >&2; exit 2;;
*/a/one/2) echo "x: error while loading shared libraries: y: failed to map segment" >&2; exit 127;;
*) write_result;;
esac)");
  options.memory_mb = 500;
  options.retries = 1;
  const auto results = RunJobs(plan, options);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*results)[i].reason, "out of memory (limit 500 MB)");
    EXPECT_TRUE((*results)[i].earlier.empty()) << "it would be the same again";
  }
  EXPECT_EQ(Contents(plan.jobs[0].folder / "limit"), "512000\n");
  for (std::size_t i = 2; i < 8; ++i) EXPECT_TRUE((*results)[i].figures.has_value()) << i;
}

TEST(JobRunner, PlansTogetherEndEachAsSoonAsItsJobsHaveAndTimesComeLastAndAlone) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  PlanRequest request = RequestIn(folder);
  request.out = folder / "out/timed";
  request.runs = 1;
  Experiment timed = TwoVariants();
  timed.name = "timed";
  timed.exclusive = true;
  const Plan exclusive = MakePlan(timed, request);
  // The programs of the timed plan look whether others run.
  const RunnerOptions options = FakeProgram(folder, R"(touch "$OUT/running"
case "$OUT" in
*/timed/*) [ $(find "$OUT/../../../../.." -name running | wc -l) -eq 1 ] && write_result;;
*) write_result;;
esac
rm "$OUT/running")");
  LocalExecutor executor(3);
  std::vector<std::size_t> finished;
  const auto results =
      RunPlans({&exclusive, &plan},
               folder / "out",
               executor,
               options,
               [&](std::size_t p, const std::vector<JobResult>& of_plan) {
                 EXPECT_EQ(of_plan.size(), p == 0 ? exclusive.jobs.size() : plan.jobs.size());
                 finished.push_back(p);
               });
  ASSERT_TRUE(results.has_value());
  EXPECT_EQ(finished, (std::vector<std::size_t>{1, 0}));
  for (const auto& of_plan : *results) {
    for (const JobResult& result : of_plan) EXPECT_TRUE(result.figures.has_value());
  }
}

TEST(JobRunner, AJobThatHangsIsKilled) {
  const ScratchFolder folder;
  PlanRequest request = RequestIn(folder);
  PlanOfTwo(folder);
  request.only = {"a/one"};
  RunnerOptions options =
      FakeProgram(folder, "case \"$OUT\" in */1) sleep 20;; *) write_result;; esac");
  options.time_limit_s = 1;
  const auto results = RunJobs(MakePlan(TwoVariants(), request), options);
  ASSERT_TRUE(results.has_value());
  EXPECT_EQ((*results)[0].reason, "no end after 1 s");
  EXPECT_TRUE((*results)[1].figures.has_value());
}

TEST(JobRunner, RunsSoManyAtOnce) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  // Each waits, at most 5 s, until another one runs.
  RunnerOptions options = FakeProgram(folder, R"(touch "$OUT/running"
for i in $(seq 500); do
  [ $(ls -d "$OUT"/../../../*/*/*/running | wc -l) -gt 1 ] && break
  sleep 0.01
done
[ $i -lt 500 ] && write_result)");
  const auto results = RunJobs(plan, options, 2);
  for (const JobResult& result : *results) EXPECT_TRUE(result.figures.has_value());
}

TEST(JobRunner, TwoInOneFolderAreRefused) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);
  RunnerOptions options = FakeProgram(folder, "write_result");
  std::string message;
  options.progress = [&](const RunnerState&) {
    if (message.empty()) message = MessageOf([&] { RunJobs(plan, FakeProgram(folder, "")); });
  };
  options.stop = [&] { return !message.empty(); };
  RunJobs(plan, options);
  EXPECT_THAT(message, HasSubstr("out: another experiment is running in this folder"));
}

TEST(JobRunner, RendersTheWorldsThatAreNeeded) {
  const ScratchFolder folder;
  Experiment experiment = TwoVariants();
  experiment.sequences = {{"worlds/room", {"frames=2", "texel=20", "scale=0.2"}, "tiny"}};
  PlanRequest request = RequestIn(folder);
  request.sources.data = std::nullopt;
  request.only = {"room@tiny/one"};
  request.runs = 1;
  const Plan plan = MakePlan(experiment, request);
  RunnerOptions options = FakeProgram(folder, "[ -f \"$PATH_/world.yaml\" ] && write_result");
  std::vector<std::string> said;
  options.progress = [&](const RunnerState& state) { said.push_back(state.current); };
  const auto results = RunJobs(plan, options);
  ASSERT_TRUE((*results)[0].figures.has_value()) << (*results)[0].reason;
  EXPECT_THAT(said[0], HasSubstr("rendering worlds/"));
  fs::remove_all(folder / "cache");
  RunJobs(plan, options);
  EXPECT_FALSE(fs::exists(folder / "cache")) << "nothing is to be run";
}

TEST(JobRunner, TimeLeftComesFromRunsOfTheSameKind) {
  const ScratchFolder folder;
  const Plan plan = PlanOfTwo(folder);  // a/one 1 2, a/two 1 2, b/one 1 2, b/two 1 2
  std::vector<std::optional<double>> seconds(8);
  const double each = EstimatedSeconds(plan, plan.jobs[0]);
  EXPECT_GT(each, 0);
  EXPECT_NEAR(SecondsLeft(plan, seconds), 8 * each, 0.1) << "run 2 reads a frame less";
  seconds[0] = 10;
  EXPECT_NEAR(SecondsLeft(plan, seconds), 7 * 10, 1);
  seconds[2] = 4;  // a/two; the sequence b: 7 each
  EXPECT_NEAR(SecondsLeft(plan, seconds), 10 + 4 + 4 * 7, 1);
  seconds = {1, 1, 2, 2, 3, 3, 4, 4};
  EXPECT_EQ(SecondsLeft(plan, seconds), 0);
}

}  // namespace
}  // namespace plumbline
