// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/report_data.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace plumbline {

// Returns JSON escaped for a <script> element: without "<", which could end the element.
std::string EscapeScriptJson(std::string_view json);

// Returns report.html: one self-contained page that needs no network, with the data of
// FormatReportData and the scripts that draw it.
std::string FormatHtmlReport(const RunResult& result,
                             const Dataset& dataset,
                             const ReportContext& context);

// Writes report.html into a folder, atomically. The date of the context is replaced by the time of
// the call (UTC). Throws InputError if the file cannot be written.
void WriteHtmlReport(const RunResult& result,
                     const Dataset& dataset,
                     ReportContext context,
                     const std::filesystem::path& folder);

// Returns the page report_page.html with its style and scripts, built into the library by CMake.
// The caller replaces {{TITLE}} and {{DATA}}.
std::string_view ReportPage();

}  // namespace plumbline
