# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Runs on recorded sequences."""
from __future__ import annotations

import functools
import operator
import time

from . import _plumbline
from ._plumbline import Atlas, Dataset, InputError, System, Trajectory


class Run:
    """A finished run.

    system: the System, finished. dataset: what it ran on. results: a FrameResult for each frame, in
    order. out: the folder with the files of the run, or None.
    """

    def __init__(self, system: System, dataset: Dataset, results: list, out: str | None):
        self.system = system
        self.dataset = dataset
        self.results = results
        self.out = out

    @functools.cached_property
    def trajectory(self) -> Trajectory:
        """All frames with a pose, of the left camera as delivered, in the main map."""
        return self.system.trajectory()

    @functools.cached_property
    def maps(self) -> Atlas:
        """The maps at the end."""
        return self.system.maps()

    @functools.cached_property
    def map(self):
        """The Map in which most frames have a pose; None when none has."""
        main = self.system.main_map
        return next((one for one in self.maps if one.id == main), None)

    @functools.cached_property
    def errors(self) -> dict | None:
        """compare_trajectories() with the ground truth of the data, with one camera after Sim(3)
        alignment; None where there is no ground truth or no pose to compare."""
        truth = self.dataset.ground_truth
        if truth is None:
            return None
        try:
            return _plumbline.compare_trajectories(
                truth, self.trajectory,
                alignment="sim3" if self.dataset.sensor == "mono" else "se3",
                max_gap_s=0.25 if self.dataset.format == "kitti" else 0.1)
        except InputError:
            return None

    def __repr__(self) -> str:
        tracked = sum(result.status == "tracked" for result in self.results)
        return f"<Run on {self.dataset.name}: {tracked} of {len(self.results)} frames tracked>"


def _count(name: str, value: object, least: int) -> int:
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise InputError(f"{name}: expected a whole number, found {type(value).__name__}")
    number = operator.index(value)
    if number < least:
        raise InputError(f"{name}: expected a whole number of at least {least}, found {number}")
    return number


def _choose_frames(dataset: Dataset, start, stop, stride) -> list[int]:
    first = _count("start", start, 0)
    end = len(dataset) if stop is None else min(len(dataset), _count("stop", stop, 1))
    if first >= end:
        raise InputError(
            f"start {first}: the sequence has {len(dataset)} frames, and stop is {stop}")
    return list(range(first, end, _count("stride", stride, 1)))


def _wait_until(due: float) -> None:
    while (left := due - time.monotonic()) > 0:
        time.sleep(left)


def _feed(system: System, dataset: Dataset, frames: list[int], on_frame) -> list:
    """Feeds the frames and returns what came of those that are tracked by now."""
    results = []

    def take():
        for result in system.results():
            results.append(result)
            if on_frame is not None:
                on_frame(result)

    live = system.options["slam"]["mode"] == "live"
    stamps = dataset.stamps_ns
    begin = time.monotonic()
    for index in frames:
        try:
            frame = dataset[index]
        except InputError:
            frame = None  # the record of the frame says that it was skipped
        if live:
            _wait_until(begin + 1e-9 * int(stamps[index] - stamps[frames[0]]))
        if frame is None:
            system.skip(int(stamps[index]), "image_unreadable")
        else:
            system.feed(frame)
        take()
    return results


def run(path, *, sensor=None, camera=None, format=None, start=0, stop=None, stride=1, map=None,
        localize=False, out=None, on_frame=None, **options) -> Run:
    """Tracks the camera through a recorded sequence and maps what it sees, as `plumbline run`; the
    trajectory has the same bytes.

    path, sensor, camera, format: as for open(), or path is a Dataset. start, stop, stride: which
    frames. map: a file or an Atlas to go on in; localize: only find the camera in it. out: a folder
    for the files of the run. on_frame: called with the FrameResult of each frame, in order, in this
    thread. options: groups as dictionaries, features={"line_count": 100}, or dotted keys.

    The GIL is released while it computes. Ctrl-C raises KeyboardInterrupt between two frames; with
    `out` the frames so far are finished and written first. Raises InputError.
    """
    if isinstance(path, Dataset):
        if (sensor, camera, format) != (None, None, None):
            raise InputError("sensor, camera, format: expected none beside a Dataset, found some")
        dataset = path
    else:
        dataset = _plumbline.open(path, sensor=sensor, camera=camera, format=format)
    if on_frame is not None and not callable(on_frame):
        raise InputError(f"on_frame: expected a function, found {type(on_frame).__name__}")
    if localize and map is None:
        raise InputError("localize: expected map as well")
    frames = _choose_frames(dataset, start, stop, stride)
    system = System(dataset.calibration, **options)
    system._describe(dataset.name)
    atlas = map if map is None or isinstance(map, Atlas) else _plumbline.load_map(map)
    folder = None
    if out is not None:
        folder = _plumbline._RunFolder(out, dataset, None if atlas is map else map)
        system._keep_views(frames)
    if atlas is not None:
        system.continue_in(atlas, read_only=bool(localize))

    def finish() -> str | None:
        system.finish()
        if folder is None:
            return None
        return _plumbline._write_run(system, folder, dataset, len(frames), [])

    try:
        results = _feed(system, dataset, frames, on_frame)
    except KeyboardInterrupt:
        if folder is not None:
            finish()
        raise
    written = finish()
    for result in system.results():
        results.append(result)
        if on_frame is not None:
            on_frame(result)
    return Run(system, dataset, results, written)
