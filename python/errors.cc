// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"

#include "bindings.h"
#include <cstring>
#include <exception>
#include <map>
#include <regex>
#include <string>

namespace plumbline::python {
namespace {

namespace py = pybind11;

// A new exception class of the package; the module keeps it, and so does this process.
PyObject* MakeError(py::module_& module,
                    const char* name,
                    const char* doc,
                    const py::tuple& bases) {
  const std::string full_name = std::string("plumbline.") + name;
  PyObject* error = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, bases.ptr(), nullptr);
  if (error == nullptr) throw py::error_already_set();
  module.add_object(name, error);
  return error;
}

// Returns a message of the program in the words of Python: options are the arguments that they
// become, "give --camera FILE" is "give camera=FILE". Those that Python has none for stay.
std::string WithArguments(const std::string& message) {
  static const std::map<std::string, std::string> arguments = {{"camera", "camera"},
                                                               {"format", "format"},
                                                               {"frames", "frames"},
                                                               {"images", "images"},
                                                               {"map", "map"},
                                                               {"mask", "mask"},
                                                               {"out", "out"},
                                                               {"sensor", "sensor"},
                                                               {"to", "format"},
                                                               {"topic", "topics"},
                                                               {"trajectory", "trajectory"},
                                                               {"undistort", "undistort"},
                                                               {"view-angle", "view_angle"}};
  static const std::regex option(R"((^|[ (])--(set |[a-z]+(?:-[a-z]+)*)(?: ([A-Z]+)\b)?)");
  std::string text;
  auto rest = message.cbegin();
  for (std::sregex_iterator it(message.begin(), message.end(), option), end; it != end; ++it) {
    const std::smatch& found = *it;
    text.append(rest, found[0].first);
    rest = found[0].second;
    const auto argument = arguments.find(found[2].str());
    if (found[2] == "set ") {  // an option of a run, which has its name behind it
      text += found[1].str() + found[3].str();
    } else if (argument == arguments.end()) {
      text += found[0].str();
    } else {
      text += found[1].str() + argument->second + (found[3].matched ? "=" + found[3].str() : "");
    }
  }
  return text.append(rest, message.cend());
}

// Raises it with a message that may hold any bytes, such as those of a file's name.
void Raise(PyObject* error, const char* message) {
  const auto bytes = static_cast<py::ssize_t>(std::strlen(message));
  const auto text =
      py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(message, bytes, "backslashreplace"));
  if (text) PyErr_SetObject(error, text.ptr());
}

}  // namespace

void BindErrors(py::module_& module) {
  PyObject* base = MakeError(module,
                             "Error",
                             "What all errors of this package are.",
                             py::make_tuple(py::handle(PyExc_Exception)));
  static PyObject* const input_error =
      MakeError(module,
                "InputError",
                "Bad input: what was expected and what was found, in the words of the program.",
                py::make_tuple(py::handle(base), py::handle(PyExc_ValueError)));
  static PyObject* const bug_error = MakeError(module,
                                               "BugError",
                                               "A broken invariant of the library itself.",
                                               py::make_tuple(py::handle(base)));
  py::register_exception_translator([](std::exception_ptr failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const InputError& error) {
      Raise(input_error, WithArguments(error.what()).c_str());
    } catch (const BugError& error) {
      Raise(bug_error, error.what());
    }
  });
}

}  // namespace plumbline::python
