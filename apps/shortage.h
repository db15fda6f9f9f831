// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <memory>

namespace plumbline {

// Returns the resource that an exception reports as exhausted, for a sentence: "out of memory", "no
// further thread can be started"; null for any other.
const char* ShortageOf(const std::exception& error);

// Reserved address space, so that remaining work can be done when memory is exhausted. It takes no
// memory until then.
class MemoryReserve {
 public:
  // Throws std::bad_alloc.
  MemoryReserve();
  void Release() { space_.reset(); }

 private:
  std::unique_ptr<char[]> space_;
};

}  // namespace plumbline
