// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

// Sets up the whole process for the library. Programs without other requirements call this once,
// before they start threads; `plumbline` does. Without it everything works, and results are the
// same bytes.
//
// - OpenCV uses one thread: the library distributes the work itself, and OpenCV's threads would
//   interfere with its stages.
// - The allocator keeps the memory of images for the next ones (glibc only): a tenth of the time.
// - A write beyond the file size limit of the process fails (an InputError) instead of raising a
//   signal that ends the program.
void SetUpProcess();

}  // namespace plumbline
