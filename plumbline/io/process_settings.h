// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

// Sets up the whole process so that the library runs best. A program without other wishes calls
// this once, before it starts threads; `plumbline` does. Without it everything works, and results
// are the same bytes.
//
// - OpenCV uses one thread: the library shares out the work itself, and OpenCV's threads would get
//   in the way of its stages.
// - The allocator keeps the memory of images for the next ones (glibc only): a tenth of the time.
// - Decoders of images and videos do not write to standard error (DropDecoderMessages).
// - A file that grows beyond the limit of the process fails to be written (an InputError) in place
//   of a signal that ends the program.
void SetUpProcess();

}  // namespace plumbline
