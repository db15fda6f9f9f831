// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/report/report_data.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace plumbline {

// Returns JSON in a form that may stand in a <script> element: no "<" is left, which could end the
// element.
std::string EscapeScriptJson(std::string_view json);

// Returns report.html: one page that needs no other file and no network. It holds the data of
// FormatReportData and the scripts that draw it.
std::string FormatHtmlReport(const System& system,
                             const Dataset& dataset,
                             const ReportContext& context);

// Writes report.html into a folder, whole or not at all. The date of the context is replaced by the
// time of the call (UTC). Throws InputError when the file cannot be written.
void WriteHtmlReport(const System& system,
                     const Dataset& dataset,
                     ReportContext context,
                     const std::filesystem::path& folder);

}  // namespace plumbline
