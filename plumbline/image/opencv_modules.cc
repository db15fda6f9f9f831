// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/image/opencv_modules.h"

#include "plumbline/base/error.h"

#include <dlfcn.h>

namespace plumbline {
namespace {

constexpr const char* kLibrary = "libplumbline_opencv.so";
constexpr const char* kFunction = "PlumblineOpenCvModules";

const OpenCvModules& Load() {
  // The folder is in the search path of whoever links this module (CMakeLists.txt). The library
  // stays until the process ends, since threads of its libraries may.
  void* library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* reason = dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread, in glibc
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
