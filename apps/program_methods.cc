// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/program_methods.h"

#ifdef PLUMBLINE_WITH_LAB
#include "lab/rivals/laboratory_methods.h"
#endif

namespace plumbline {

const SystemMethods& ProgramMethods() {
#ifdef PLUMBLINE_WITH_LAB
  return LaboratoryMethods();
#else
  static const SystemMethods methods;
  return methods;
#endif
}

}  // namespace plumbline
