// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/opencv_modules.h"

#include "plumbline/base/error.h"

#include <algorithm>
#include <array>
#include <new>
#include <string>
#include <string_view>

#include <dlfcn.h>

namespace plumbline {
namespace {

constexpr const char* kLibrary = "libplumbline_opencv.so";
constexpr const char* kFunction = "PlumblineOpenCvModules";

// Returns true if a library could not be loaded for lack of memory, judged by the message of glibc.
bool IsOutOfMemory(std::string_view reason) {
  constexpr std::array kReasons{"failed to map segment", "annot allocate", "cannot map zero-fill"};
  return std::any_of(kReasons.begin(), kReasons.end(), [&](const char* text) {
    return reason.find(text) != std::string_view::npos;
  });
}

const OpenCvModules& Load() {
  // The folder is in the search path of every binary that links this module (CMakeLists.txt). The
  // library stays loaded until the process ends, since threads of its libraries may run until then.
  void* library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* reason = dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread, in glibc
    if (IsOutOfMemory(reason)) throw std::bad_alloc();
    throw InputError(std::string("expected the library ") + kLibrary +
                     ", which decodes videos and rare kinds of images, found: " + reason);
  }
  using Function = const OpenCvModules* (*)();
  const auto function = reinterpret_cast<Function>(dlsym(library, kFunction));
  PLUMBLINE_CHECK(function != nullptr, "the library for OpenCV's modules is not ours");
  return *function();
}

}  // namespace

const OpenCvModules& LoadOpenCvModules() {
  static const OpenCvModules& modules = Load();
  return modules;
}

}  // namespace plumbline
