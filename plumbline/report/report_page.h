// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline {

// The page report_page.html with its style and scripts in it, made part of the library by CMake.
// {{TITLE}} and {{DATA}} are still to be filled in.
std::string_view ReportPage();

}  // namespace plumbline
