// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/line_method.h"

#ifdef PLUMBLINE_WITH_LAB
#include "lab/line_rivals/rival_method.h"
#endif

namespace plumbline {

void ChooseLineMethod([[maybe_unused]] SlamOptions& options) {
#ifdef PLUMBLINE_WITH_LAB
  options.lines.method = MethodFor(options.lines);
#endif
}

}  // namespace plumbline
