// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/version.h"

#include "bindings.h"

PYBIND11_MODULE(_plumbline, module) {
  namespace python = plumbline::python;
  module.doc() = "The compiled part of the package plumbline; use `import plumbline`.";
  module.attr("__version__") = PLUMBLINE_VERSION;
  python::BindErrors(module);
  python::BindOptions(module);
  python::BindCalibration(module);
  python::BindTrajectories(module);
  python::BindDatasets(module);
  python::BindMaps(module);
  python::BindMapMerging(module);
  python::BindSystem(module);
  python::BindInertial(module);
  python::BindLines(module);
  python::BindInitialization(module);
  python::BindCutting(module);
  python::BindAdjustment(module);
  python::BindSynth(module);
  python::RefuseUninitialized(module);
}
