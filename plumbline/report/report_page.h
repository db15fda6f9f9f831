// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline {

// Returns the page report_page.html with its style and scripts, built into the library by CMake.
// The caller replaces {{TITLE}} and {{DATA}}.
std::string_view ReportPage();

}  // namespace plumbline
