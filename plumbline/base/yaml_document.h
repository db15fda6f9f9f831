// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace YAML {
class Node;
}

namespace plumbline {

// Parses a YAML text of one document. Throws InputError "source:line: expected ..., found ..." if
// it is not YAML, if a group has a key twice (the library would silently take the first), or if it
// has a second document. An empty text is a null node. O(length), times log(keys of a group).
YAML::Node ParseYaml(const std::string& text, const std::string& source);

}  // namespace plumbline
