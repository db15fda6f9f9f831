// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include <cstddef>

namespace plumbline::python {
namespace {

namespace py = pybind11;

// Called by pybind11 for the memory of a value that was never initialized.
void* RefuseMemory(std::size_t /*bytes*/) {
  throw py::type_error("expected an object that __init__ made, found one that __new__ alone made");
}

}  // namespace

void RefuseUninitialized(const py::module_& module) {
  for (const auto& [name, member] : module.attr("__dict__").cast<py::dict>()) {
    if (PyType_Check(member.ptr()) == 0) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(member.ptr());
    // nullptr for classes without a value of C++, such as those of errors.
    py::detail::type_info* const bound = py::detail::get_type_info(type);
    if (bound != nullptr) bound->operator_new = RefuseMemory;
  }
}

}  // namespace plumbline::python
