#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""What a frame costs more from Python than in C++.

    PYTHONPATH=build/release/python /usr/bin/python3 lab/bench/python_frame_cost.py SEQUENCE [FRAMES]

Frames are arrays of numpy's, given to System.process with slam.mode inline. The time of each call less
the time that the library measured for the frame, from its arrival to its end, is what lies outside:
checks, copies of the images, the result, and what the library does after it has stopped the clock. So
it is an upper bound. The clock of the wall counts who else uses the processor; the median does not mind.
"""
import sys
import time

import numpy as np

import plumbline


def main() -> None:
    dataset = plumbline.open(sys.argv[1])
    count = min(len(dataset), int(sys.argv[2]) if len(sys.argv) > 2 else 60)
    system = plumbline.System(dataset.calibration, slam={"mode": "inline"})
    outside, total = [], []
    for i in range(count):
        try:
            frame = dataset[i]
        except plumbline.InputError:
            continue
        second = frame.right if frame.right is not None else frame.depth
        images = np.array(frame.left) if second is None else (np.array(frame.left), np.array(second))
        begin = time.perf_counter()
        result = system.process(images, frame.stamp_ns)
        milliseconds = 1e3 * (time.perf_counter() - begin)
        times = result.times_ms
        inside = times["total"] + sum(ms for name, ms in times.items() if name.startswith("after_"))
        outside.append(milliseconds - inside)
        total.append(inside)
    print(f"{len(outside)} frames of {dataset.calibration.width} x {dataset.calibration.height}, "
          f"{dataset.sensor}: outside the library median {np.median(outside):.3f} ms, quartiles "
          f"{np.percentile(outside, 25):.3f} to {np.percentile(outside, 75):.3f} ms; "
          f"inside median {np.median(total):.1f} ms")


if __name__ == "__main__":
    main()
