// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

// What the module is made of: one function, one file for each subject.
namespace plumbline::python {

void BindErrors(pybind11::module_& module);
void BindOptions(pybind11::module_& module);
void BindCalibration(pybind11::module_& module);
void BindTrajectories(pybind11::module_& module);
void BindDatasets(pybind11::module_& module);
void BindMaps(pybind11::module_& module);
void BindMapMerging(pybind11::module_& module);
void BindSystem(pybind11::module_& module);
void BindLines(pybind11::module_& module);
void BindInitialization(pybind11::module_& module);
void BindCutting(pybind11::module_& module);
void BindAdjustment(pybind11::module_& module);
void BindSynth(pybind11::module_& module);

// After all of these: an object that was made by __new__ without __init__ raises TypeError where it
// is used. pybind11 would hand functions memory that nobody wrote.
void RefuseUninitialized(const pybind11::module_& module);

}  // namespace plumbline::python
