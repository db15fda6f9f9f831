// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace YAML {
class Node;
}

namespace plumbline {

// Reads a YAML text of one document. Throws InputError "source:line: expected ..., found ..." when
// it is no YAML, when a group has a key twice (the library would silently take the first), and when
// there is a second document. An empty text is a null node. O(length), times log(keys of a group).
YAML::Node ParseYaml(const std::string& text, const std::string& source);

}  // namespace plumbline
