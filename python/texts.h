// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <pybind11/pybind11.h>

// Texts and paths between Python, whose texts may hold what no file can (half of a surrogate pair),
// and the library, whose paths may hold what no text can (bytes that are not UTF-8).
namespace plumbline::python {

// Throws InputError "slam.mode: expected a text that is valid Unicode, found 'a\ud800'" for a text
// that UTF-8 cannot hold.
std::string ReadText(pybind11::handle text, std::string_view name);

// A text of any bytes, as os.fsdecode gives it.
pybind11::str ToText(std::string_view bytes);

// The path of a str, bytes or os.PathLike, as os.fsencode gives it. Returns false for anything
// else; throws InputError for a text that cannot be the name of a file.
bool ReadPath(pybind11::handle value, std::filesystem::path& path);

}  // namespace plumbline::python

// In place of pybind11/stl/filesystem.h, for which a text that cannot be a name is of a wrong type.
template <>
struct pybind11::detail::type_caster<std::filesystem::path> {
  PYBIND11_TYPE_CASTER(std::filesystem::path, const_name("os.PathLike"));

  bool load(handle source, bool /*convert*/) { return plumbline::python::ReadPath(source, value); }

  static handle cast(const std::filesystem::path& path, return_value_policy /*policy*/, handle) {
    const str text = plumbline::python::ToText(path.string());
    return module_::import("pathlib").attr("Path")(text).release();
  }
};
