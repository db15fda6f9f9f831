// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace plumbline {

// Returns the page that shows a run, one file with its style and scripts in it. CMake makes it part
// of the library, from view_page.html, view_*.css, view_*.js and what these share with report.html.
std::shared_ptr<const std::string> ViewPage();

}  // namespace plumbline
