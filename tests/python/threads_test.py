# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Threads, and memory."""
import os
import pathlib
import signal
import threading
import time

import numpy as np
import pytest

import plumbline


def test_two_systems_in_two_threads(dataset, finished):
    runs = [None, None]

    def work(place):
        runs[place] = plumbline.run(dataset)

    threads = [threading.Thread(target=work, args=(place,)) for place in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for run in runs:
        assert run.trajectory.to_tum() == finished.trajectory.to_tum()


def test_python_goes_on_meanwhile(dataset):
    """The GIL is released while a frame is processed: another thread runs in the middle of a call."""
    system = plumbline.System(dataset.calibration, slam={"mode": "inline"})
    stamps, done = [], threading.Event()

    def watch():
        while not done.is_set():
            stamps.append(time.monotonic())
            time.sleep(0.0005)

    watcher = threading.Thread(target=watch)
    watcher.start()
    spans = []
    for frame in dataset:
        begin = time.monotonic()
        system.process(frame)
        spans.append((begin, time.monotonic()))
    done.set()
    watcher.join()
    assert any(begin < stamp < end for begin, end in spans for stamp in stamps)


def test_one_thread_at_a_time_in_a_system(dataset):
    system = plumbline.System(dataset.calibration, slam={"mode": "inline"})
    frames = list(dataset)
    begin, results, refusals = threading.Barrier(2), [], []

    def work(own):
        begin.wait()
        for frame in own:
            try:
                results.append(system.process(frame))
            except plumbline.InputError as error:
                refusals.append(str(error))

    threads = [threading.Thread(target=work, args=(frames[place::2],)) for place in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    # Frames that came too late or while the other one was in the system were refused, no more.
    assert len(results) + len(refusals) == 12
    assert len({result.index for result in results}) == len(results)
    for message in refusals:
        assert "one thread at a time" in message or "expected a frame after" in message


def resident() -> int:
    fields = pathlib.Path("/proc/self/statm").read_text().split()
    return int(fields[1]) * 4096


def test_systems_leave_nothing_behind(dataset):
    """200 systems made, used and dropped after 20: memory stays within 5 %."""
    camera = plumbline.pinhole(96, 64, 80, 80, 48, 32)
    rng = np.random.default_rng(1)
    image = rng.integers(0, 255, (64, 96), np.uint8)

    def use(count):
        for _ in range(count):
            system = plumbline.System(camera)
            system.process(image, 0)
            system.maps()
            try:
                system.process(image, 0)
            except plumbline.InputError:
                pass
            system.finish()

    use(20)
    before = resident()
    use(200)
    assert resident() < 1.05 * before


def test_arrays_leave_nothing_behind(finished, dataset):
    def use(count):
        for _ in range(count):
            for name in ("points", "lines", "point_tracks", "line_information"):
                getattr(finished.map, name)
            dataset[0].left
            plumbline.detect_lines(dataset[0].left, count=10)

    use(10)
    before = resident()
    use(60)
    assert resident() < 1.05 * before


def test_a_forked_child_makes_systems_of_its_own(dataset):
    parent = plumbline.System(dataset.calibration)
    parent.process(dataset[0])
    frames = [dataset[0], dataset[1]]
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        own = plumbline.System(dataset.calibration)
        own.process(frames[0])
        tracked = own.process(frames[1]).status == "tracked"
        os._exit(0 if tracked else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert parent.process(frames[1]).status == "tracked"
    # With the mode inline there are no threads that a child could lack.
    inline = plumbline.System(dataset.calibration, mode="inline")
    inline.process(frames[0])
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        os._exit(0 if inline.process(frames[1]).status == "tracked" else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
