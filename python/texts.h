// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <pybind11/pybind11.h>

// Texts and paths between Python, whose texts may contain characters invalid in files (half of a
// surrogate pair), and the library, whose paths may contain bytes invalid in texts (not UTF-8).
namespace plumbline::python {

// Returns a text as UTF-8. Throws InputError "slam.mode: expected a text that is valid Unicode,
// found 'a\ud800'" if that is impossible.
std::string ReadText(pybind11::handle text, std::string_view name);

// Returns a text of any bytes, like os.fsdecode.
pybind11::str ToText(std::string_view bytes);

// Reads the path of a str, bytes or os.PathLike, like os.fsencode. Returns false for anything else;
// throws InputError for a text that cannot be a file name.
bool ReadPath(pybind11::handle value, std::filesystem::path& path);

}  // namespace plumbline::python

// Replaces pybind11/stl/filesystem.h, which reports a text that cannot be a file name as a wrong
// type.
template <>
struct pybind11::detail::type_caster<std::filesystem::path> {
  PYBIND11_TYPE_CASTER(std::filesystem::path, const_name("os.PathLike"));

  bool load(handle source, bool /*convert*/) { return plumbline::python::ReadPath(source, value); }

  static handle cast(const std::filesystem::path& path, return_value_policy /*policy*/, handle) {
    const str text = plumbline::python::ToText(path.string());
    return module_::import("pathlib").attr("Path")(text).release();
  }
};
