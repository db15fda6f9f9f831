// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <memory>

namespace plumbline {

// What the machine had too little of, for a sentence, when that is what an exception tells: "out of
// memory", "no further thread can be started"; null for any other.
const char* ShortageOf(const std::exception& error);

// Address space put aside, so that what is left to do can be done when memory has run out. It takes
// no memory until then.
class MemoryReserve {
 public:
  // Throws std::bad_alloc.
  MemoryReserve();
  void Release() { space_.reset(); }

 private:
  std::unique_ptr<char[]> space_;
};

}  // namespace plumbline
