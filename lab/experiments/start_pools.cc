// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/start_pools.h"

#include "lab/starts/start_figures.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

bool IsIn(const SequencePool& pool, const std::string& sequence) {
  return std::any_of(pool.patterns.begin(), pool.patterns.end(), [&](const std::string& pattern) {
    return MatchesPattern(sequence, pattern);
  });
}

// The jobs of a pool, grouped by variant and run.
using JobsOfRuns = std::map<std::pair<std::size_t, int>, std::vector<std::size_t>>;

JobsOfRuns JobsOf(const Plan& plan, const SequencePool& pool) {
  JobsOfRuns jobs;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const Job& job = plan.jobs[i];
    if (IsIn(pool, plan.SequenceOf(job).name)) jobs[{job.variant, job.run}].push_back(i);
  }
  return jobs;
}

JobResult PooledResult(const std::vector<std::size_t>& jobs,
                       const std::vector<JobResult>& results,
                       const StartsByJob& starts) {
  std::vector<StartRecord> records;
  RunFigures figures;
  for (const std::size_t job : jobs) {
    if (!results[job].figures) return {std::nullopt, "a sequence of the pool failed"};
    records.insert(records.end(), starts[job].begin(), starts[job].end());
    figures.trajectory += results[job].figures->trajectory;
  }
  figures.values = FiguresOf(records);
  return {std::move(figures), ""};
}

}  // namespace

StartsByJob ReadStartsByJob(const Plan& plan, const std::vector<JobResult>& results) {
  StartsByJob starts(plan.jobs.size());
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (results[i].figures) starts[i] = ReadStarts(plan.jobs[i].folder / "starts.csv");
  }
  return starts;
}

std::vector<std::pair<const StartRecord*, const StartRecord*>> CommonStarts(
    const std::vector<StartRecord>& a, const std::vector<StartRecord>& b) {
  std::map<int, const StartRecord*> of_b;
  for (const StartRecord& start : b) of_b.emplace(start.frame, &start);
  std::vector<std::pair<const StartRecord*, const StartRecord*>> common;
  for (const StartRecord& start : a) {
    const auto other = of_b.find(start.frame);
    if (other != of_b.end()) common.emplace_back(&start, other->second);
  }
  return common;
}

std::vector<StartRecord> StartsOfPool(const Plan& plan,
                                      const StartsByJob& starts,
                                      const SequencePool& pool,
                                      std::size_t variant) {
  std::vector<StartRecord> records;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const Job& job = plan.jobs[i];
    if (job.variant != variant || !IsIn(pool, plan.SequenceOf(job).name)) continue;
    records.insert(records.end(), starts[i].begin(), starts[i].end());
  }
  return records;
}

PooledResults WithPools(const Plan& plan,
                        const std::vector<JobResult>& results,
                        const StartsByJob& starts) {
  PooledResults pooled{plan, results};
  for (const SequencePool& pool : plan.experiment.pools) {
    const JobsOfRuns runs = JobsOf(plan, pool);
    if (runs.empty()) continue;
    ExperimentSequence sequence;
    sequence.name = pool.name;
    for (const auto& [key, jobs] : runs) {
      Job job;
      job.sequence = pooled.plan.sequences.size();
      job.variant = key.first;
      job.run = key.second;
      pooled.plan.jobs.push_back(std::move(job));
      pooled.results.push_back(PooledResult(jobs, results, starts));
    }
    pooled.plan.sequences.push_back(std::move(sequence));
  }
  return pooled;
}

std::string FormatStartsByJob(const Plan& plan, const StartsByJob& starts) {
  std::string text;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const Job& job = plan.jobs[i];
    std::istringstream rows(FormatStarts(starts[i]));
    std::string row;
    std::getline(rows, row);
    if (i == 0) text += "sequence,variant,seed," + row + "\n";
    while (std::getline(rows, row)) {
      text += fmt::format(
          "{},{},{},{}\n", plan.SequenceOf(job).name, plan.VariantOf(job).name, job.run, row);
    }
  }
  return text;
}

}  // namespace plumbline
