// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace plumbline {

// Bad input from outside: a missing file, a malformed line, an unknown option. The message names
// the file (and line), what was expected and what was found. The command line prints it and exits
// with 2.
class InputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A broken invariant of the program itself.
class BugError : public std::logic_error {
  using std::logic_error::logic_error;
};

// Throws BugError that names file and line of the caller. These come from the compilers' built-ins,
// which give what std::source_location would; clang 14 cannot read that header of GCC 12.
[[noreturn]] inline void FailCheck(std::string_view expression,
                                   std::string_view why,
                                   const char* file = __builtin_FILE(),
                                   int line = __builtin_LINE()) {
  throw BugError(std::string(file) + ":" + std::to_string(line) + ": check failed: " +
                 std::string(expression) + (why.empty() ? "" : ": ") + std::string(why));
}

#define PLUMBLINE_CHECK(expression, why)          \
  do {                                            \
    if (!(expression)) [[unlikely]]               \
      ::plumbline::FailCheck(#expression, (why)); \
  } while (false)

// Value of an algorithm that may fail in foreseen ways, or the reason (an enum) of its failure.
template <typename T, typename E>
class [[nodiscard]] Expected {
 public:
  Expected(T value) : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT
  Expected(E error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT
  // True if it has a value.
  explicit operator bool() const { return state_.index() == 0; }
  // The value; throws BugError if it has none.
  const T& operator*() const& {
    PLUMBLINE_CHECK(state_.index() == 0, "value of a failed Expected");
    return std::get<0>(state_);
  }
  // The value, to be changed or moved from; throws BugError if it has none.
  T& operator*() & {
    PLUMBLINE_CHECK(state_.index() == 0, "value of a failed Expected");
    return std::get<0>(state_);
  }
  // A member of the value; throws BugError if it has none.
  const T* operator->() const { return &**this; }
  // A member of the value, to be changed or moved from; throws BugError if it has none.
  T* operator->() { return &**this; }
  // The reason of the failure; throws BugError if it has a value.
  const E& error() const {
    PLUMBLINE_CHECK(state_.index() == 1, "error of a successful Expected");
    return std::get<1>(state_);
  }

 private:
  std::variant<T, E> state_;
};

}  // namespace plumbline
