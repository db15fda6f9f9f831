// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/job_runner.h"
#include "lab/experiments/plan.h"

#include <filesystem>
#include <string>
#include <vector>

namespace plumbline {

// Result of one experiment of a group, with its files in a folder of its name.
struct GroupPart {
  std::string name, help;
  std::string trouble;  // reason if nothing could be run; else empty
  std::size_t runs = 0, failed = 0;
  std::vector<std::string> missing;   // missing sequences
  std::vector<std::string> failures;  // "euroc/MH_01_easy, points, run 2: why"
};

// Returns the part of the report of an experiment whose jobs have results.
GroupPart SummarizePart(const Plan& plan, const std::vector<JobResult>& results);

// Writes results.json and timing.json, the concatenated lists of the parts, table.md, all their
// tables, and table.html, a page with links to theirs and a list of failures. An experiment that
// could not be run is in results.json as a row with a reason. Throws InputError if a file cannot be
// written.
void WriteGroupReport(const std::filesystem::path& out,
                      const std::string& name,
                      const std::string& help,
                      const std::vector<GroupPart>& parts);

}  // namespace plumbline
