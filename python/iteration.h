// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace plumbline::python {

// Returns an iterator over a sequence by index, until it raises IndexError. It keeps the sequence
// alive.
inline pybind11::object IterateByIndex(const pybind11::object& sequence) {
  PyObject* iterator = PySeqIter_New(sequence.ptr());
  if (iterator == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::object>(iterator);
}

}  // namespace plumbline::python
