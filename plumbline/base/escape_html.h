// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline {

// Returns the text escaped for the body of an HTML page or a quoted attribute.
std::string EscapeHtml(std::string_view text);

}  // namespace plumbline
