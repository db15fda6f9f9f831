// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/group_report.h"

#include "lab/experiments/figure_list.h"
#include "lab/experiments/table_page.h"
#include "plumbline/base/counted.h"
#include "plumbline/base/input_file.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/atomic_file.h"

#include <optional>
#include <utility>

#include <fmt/format.h>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

// The lines of a list of figures without its brackets.
std::string EntriesOf(const std::string& list) {
  const auto first = list.find('{'), last = list.rfind('}');
  return first == std::string::npos ? "" : list.substr(first, last - first + 1);
}

// The lists of all parts as one.
std::string JoinLists(const fs::path& out, const std::vector<GroupPart>& parts, const char* file) {
  std::string joined;
  const bool results = std::string(file) == "results.json";
  for (const GroupPart& part : parts) {
    std::string list;
    if (!part.trouble.empty()) {
      const FigureRow row{"", "", {}, "", {}, "", part.trouble};
      if (results) list = FormatFigureList(part.name, std::vector<FigureRow>{row});
    } else {
      list = ReadFileIfThere(out / part.name / file).value_or("");
    }
    const std::string entries = EntriesOf(list);
    if (entries.empty()) continue;
    joined += (joined.empty() ? "" : ",\n") + entries;
  }
  return "[\n" + joined + "\n]\n";
}

std::string OutcomeOf(const GroupPart& part) {
  if (!part.trouble.empty()) return "not run: " + part.trouble;
  std::string text = Counted(part.runs, "run");
  if (part.failed > 0) text += fmt::format(", {} failed", part.failed);
  return text;
}

std::string Markdown(const fs::path& out,
                     const std::string& name,
                     const std::string& help,
                     const std::vector<GroupPart>& parts) {
  std::string text = fmt::format("# {}\n\n{}.\n\n| experiment | |\n|---|---|\n", name, help);
  for (const GroupPart& part : parts) {
    text += fmt::format("| {} | {} |\n", part.name, OutcomeOf(part));
  }
  for (const GroupPart& part : parts) {
    for (const char* file : {"table.md", "timing.md"}) {
      if (!part.trouble.empty()) continue;
      if (const auto table = ReadFileIfThere(out / part.name / file)) text += "\n" + *table;
    }
  }
  return text;
}

std::string Page(const std::string& name,
                 const std::string& help,
                 const std::vector<GroupPart>& parts) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
      "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n<p>{2}.</p>\n<table>\n<thead><tr>"
      "<th>experiment</th><th></th><th></th></tr></thead>\n<tbody>\n",
      EscapeHtml(name),
      TablePageStyle(),
      EscapeHtml(help));
  std::string gaps;
  for (const GroupPart& part : parts) {
    const std::string title = EscapeHtml(part.name);
    html += fmt::format(
        "<tr><th>{}</th><td>{}</td><td>{}</td></tr>\n",
        part.trouble.empty() ? fmt::format("<a href=\"{0}/table.html\">{0}</a>", title) : title,
        EscapeHtml(OutcomeOf(part)),
        EscapeHtml(part.help));
    for (const std::string& failure : part.failures) {
      gaps += fmt::format("<li>{}: failed: {}</li>\n", title, EscapeHtml(failure));
    }
    for (const std::string& sequence : part.missing) {
      gaps += fmt::format("<li>{}: no sequence {}</li>\n", title, EscapeHtml(sequence));
    }
  }
  html += "</tbody></table>\n";
  if (!gaps.empty()) html += "<h2>What is missing</h2>\n<ul>\n" + gaps + "</ul>\n";
  return html + "</body>\n</html>\n";
}

}  // namespace

GroupPart SummarizePart(const Plan& plan, const std::vector<JobResult>& results) {
  GroupPart part{
      plan.experiment.name, plan.experiment.help, "", results.size(), 0, plan.missing, {}};
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].figures) continue;
    ++part.failed;
    if (plan.jobs[i].computed) {
      part.failures.push_back(results[i].reason);
      part.trouble = results[i].reason;
      continue;
    }
    part.failures.push_back(fmt::format("{}, {}, run {}: {}",
                                        plan.SequenceOf(plan.jobs[i]).name,
                                        plan.VariantOf(plan.jobs[i]).name,
                                        plan.jobs[i].run,
                                        results[i].reason));
  }
  return part;
}

void WriteGroupReport(const fs::path& out,
                      const std::string& name,
                      const std::string& help,
                      const std::vector<GroupPart>& parts) {
  for (const char* file : {"results.json", "timing.json"}) {
    WriteFileAtomically(out / file, JoinLists(out, parts, file));
  }
  WriteFileAtomically(out / "table.md", Markdown(out, name, help, parts));
  WriteFileAtomically(out / "table.html", Page(name, help, parts));
}

}  // namespace plumbline
