// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline {

// Returns the bytes in base64 (RFC 4648, with padding). O(n).
std::string EncodeBase64(std::string_view bytes);

}  // namespace plumbline
