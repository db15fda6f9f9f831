// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline {

// Returns the page report_page.html with its style and scripts in it, which CMake makes part of the
// library. {{TITLE}} and {{DATA}} are still to be replaced.
std::string_view ReportPage();

}  // namespace plumbline
