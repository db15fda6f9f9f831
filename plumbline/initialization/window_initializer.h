// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/initialization/frame_window.h"
#include "plumbline/initialization/initializer.h"

namespace plumbline {

// A start from a reference frame and the frames since that are matched with it.
//
// The first frame with enough features is the reference. Each later one is matched with it and
// kept; from so many of them on as are needed, each makes an attempt. The reference moves forward
// only when matches with it die out.
class WindowInitializer : public Initializer {
 public:
  InitializationResult Add(const InitializationFrame& frame) final;
  void Reset() final;

 protected:
  // needed: frames after the reference from which on there are attempts
  WindowInitializer(const RectifiedCamera& camera, InitialMatching matching, int needed)
      : window_(camera, matching), needed_(needed) {}

  // From the frames of the window; matches are not asked for.
  virtual InitializationResult Attempt() = 0;
  // The reference is another one from now on.
  virtual void ForgetReference() {}

  FrameWindow window_;
  int most_matches_ = 0;  // with the present reference

 private:
  int needed_;
};

}  // namespace plumbline
