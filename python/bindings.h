// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

// Parts of the module: one function, one file for each subject.
namespace plumbline::python {

void BindErrors(pybind11::module_& module);
void BindOptions(pybind11::module_& module);
void BindCalibration(pybind11::module_& module);
void BindTrajectories(pybind11::module_& module);
void BindDatasets(pybind11::module_& module);
void BindMaps(pybind11::module_& module);
void BindMapMerging(pybind11::module_& module);
void BindSystem(pybind11::module_& module);
void BindInertial(pybind11::module_& module);
void BindLines(pybind11::module_& module);
void BindInitialization(pybind11::module_& module);
void BindCutting(pybind11::module_& module);
void BindAdjustment(pybind11::module_& module);
void BindSynth(pybind11::module_& module);

// To be called last: makes the use of an object made by __new__ without __init__ raise TypeError.
// pybind11 would pass uninitialized memory to functions.
void RefuseUninitialized(const pybind11::module_& module);

}  // namespace plumbline::python
