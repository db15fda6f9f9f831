// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace plumbline {

// Returns the page of the viewer, one file with its style and scripts. CMake builds it into the
// library, from view_page.html, view_*.css, view_*.js and the files shared with report.html.
std::shared_ptr<const std::string> ViewPage();

}  // namespace plumbline
