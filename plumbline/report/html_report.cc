// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/html_report.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/atomic_file.h"

#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace plumbline {
namespace {

// Puts `value` in the place of a mark, which the page has once.
void Fill(std::string& page, std::string_view mark, std::string_view value) {
  const std::size_t place = page.find(mark);
  PLUMBLINE_CHECK(place != std::string::npos, "a mark is missing in the page");
  page.replace(place, mark.size(), value);
}

}  // namespace

std::string EscapeScriptJson(std::string_view json) {
  // In JSON "<" occurs only within strings, where the escape means the same.
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string FormatHtmlReport(const RunResult& result,
                             const Dataset& dataset,
                             const ReportContext& context) {
  std::string page(ReportPage());
  // The order matters, since either text may contain a mark: the mark of the title stands before
  // the data.
  Fill(page, "{{DATA}}", EscapeScriptJson(FormatReportData(result, dataset, context)));
  Fill(page, "{{TITLE}}", EscapeHtml(dataset.info().name));
  return page;
}

void WriteHtmlReport(const RunResult& result,
                     const Dataset& dataset,
                     ReportContext context,
                     const std::filesystem::path& folder) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  context.date = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now));
  WriteFileAtomically(folder / "report.html", FormatHtmlReport(result, dataset, context));
}

}  // namespace plumbline
