// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "texts.h"

#include "plumbline/base/error.h"

#include <fmt/format.h>

namespace plumbline::python {

namespace py = pybind11;
namespace {

// As repr() with ASCII alone, which any message can hold.
std::string Escaped(py::handle value) {
  const auto text = py::reinterpret_steal<py::object>(PyObject_ASCII(value.ptr()));
  if (!text) throw py::error_already_set();
  return text.cast<std::string>();
}

}  // namespace

std::string ReadText(py::handle text, std::string_view name) {
  py::ssize_t size = 0;
  const char* bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
  if (bytes != nullptr) return {bytes, static_cast<std::size_t>(size)};
  PyErr_Clear();
  throw InputError(
      fmt::format("{}: expected a text that is valid Unicode, found {}", name, Escaped(text)));
}

py::str ToText(std::string_view bytes) {
  PyObject* text =
      PyUnicode_DecodeFSDefaultAndSize(bytes.data(), static_cast<py::ssize_t>(bytes.size()));
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

bool ReadPath(py::handle value, std::filesystem::path& path) {
  const auto name = py::reinterpret_steal<py::object>(PyOS_FSPath(value.ptr()));
  if (!name) {
    PyErr_Clear();
    return false;
  }
  PyObject* encoded = nullptr;
  if (PyUnicode_FSConverter(name.ptr(), &encoded) == 0) {
    PyErr_Clear();
    throw InputError("path: expected a text that can be the name of a file, found " +
                     Escaped(name));
  }
  path = std::string(py::reinterpret_steal<py::bytes>(encoded));
  return true;
}

}  // namespace plumbline::python
