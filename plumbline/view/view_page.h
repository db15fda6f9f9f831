// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace plumbline {

// The page that shows a run, one file with its style and scripts in it: view_page.html, view_*.css,
// view_*.js and what it shares with report.html, made part of the library by CMake.
std::shared_ptr<const std::string> ViewPage();

}  // namespace plumbline
