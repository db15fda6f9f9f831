// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport.h"
#include <memory>
#include <string>

// For transports in C++17 (transport.h).
namespace plumbline::ros_node {

// Makes the node, which works as long as it is held; the transport must outlive it. Throws
// InputError for wrong parameters, whose names get `prefix` in messages, and a map that cannot be
// loaded.
std::shared_ptr<void> MakeNode(Transport& transport,
                               const Parameters& parameters,
                               const std::string& prefix);

}  // namespace plumbline::ros_node
