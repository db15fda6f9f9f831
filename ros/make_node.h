// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport.h"
#include <memory>
#include <string>

// For transports in C++17 (transport.h).
namespace plumbline::ros_node {

// Makes the node, which works as long as it is held; the transport must outlive it. Throws
// InputError for wrong parameters, named as `names` says, and a map that cannot be loaded.
std::shared_ptr<void> MakeNode(Transport& transport,
                               const Parameters& parameters,
                               const ParameterNames& names);

}  // namespace plumbline::ros_node
