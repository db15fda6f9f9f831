# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Runs on recorded sequences."""
from __future__ import annotations

import functools
import operator
import os
import time
import warnings
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, SupportsIndex

from . import _plumbline
from ._plumbline import Atlas, Dataset, Frame, FrameResult, InputError, Map, System, Trajectory

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._plumbline import _TrajectoryErrors  # known to the types alone

Path = str | os.PathLike[str]


class Run:
    """A finished run.

    system: the System, finished. dataset: what it ran on. results: a FrameResult for each frame, in
    order. out: the folder with the files of the run (in that asked for `.part`, where an earlier run
    with more poses was kept), or None.
    """

    def __init__(self, system: System, dataset: Dataset, results: list[FrameResult],
                 out: str | None) -> None:
        self.system = system
        self.dataset = dataset
        self.results = results
        self.out = out

    @functools.cached_property
    def trajectory(self) -> Trajectory:
        """All frames with a pose, of the left camera as delivered, in the main map."""
        return self.system.trajectory()

    @functools.cached_property
    def covariances(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Stamps (N,) and covariances (N, 6, 6) of the poses as first reported, in the main map:
        System.causal_covariances()."""
        return self.system.causal_covariances()

    @functools.cached_property
    def maps(self) -> Atlas:
        """The maps at the end."""
        return self.system.maps()

    @functools.cached_property
    def map(self) -> Map | None:
        """The Map in which most frames have a pose; None when none has."""
        main = self.system.main_map
        return next((one for one in self.maps if one.id == main), None)

    @functools.cached_property
    def errors(self) -> _TrajectoryErrors | None:
        """compare_trajectories() with the ground truth of the data, with one camera after Sim(3)
        alignment; None where there is no ground truth or no pose to compare."""
        truth = self.dataset.ground_truth
        if truth is None:
            return None
        try:
            return _plumbline.compare_trajectories(truth, self.trajectory,
                                                   **self.dataset._error_options())
        except InputError:
            return None

    def __repr__(self) -> str:
        tracked = sum(result.status == "tracked" for result in self.results)
        return f"<Run on {self.dataset.name}: {tracked} of {len(self.results)} frames tracked>"


def _count(name: str, value: object, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, SupportsIndex):
        raise InputError(f"{name}: expected a whole number, found {type(value).__name__}")
    number = operator.index(value)
    if number < least:
        raise InputError(f"{name}: expected a whole number of at least {least}, found {number}")
    return number


def _choose_frames(dataset: Dataset, start: int, stop: int | None, stride: int) -> list[int]:
    first = _count("start", start, 0)
    end = len(dataset) if stop is None else min(len(dataset), _count("stop", stop, 1))
    if first >= end:
        raise InputError(
            f"start {first}: the sequence has {len(dataset)} frames, and stop is {stop}")
    return list(range(first, end, _count("stride", stride, 1)))


def _wait_until(due_ns: int) -> None:
    while (left := due_ns - time.monotonic_ns()) > 0:
        time.sleep(1e-9 * left)


def _read_live(dataset: Dataset, index: int, stamp_ns: int,
               schedule: _plumbline._PlaybackSchedule) -> Frame | str:
    """Reads a frame shortly before it is due, and returns when it is due."""
    _wait_until(schedule.read_at(stamp_ns))
    begin_ns = time.monotonic_ns()
    frame = dataset._read(index)
    _wait_until(schedule.due_once_read(stamp_ns, begin_ns, time.monotonic_ns()))
    return frame


class _Teller:
    """Hands on what came of the frames, and what happened to the maps, as it becomes known."""

    def __init__(self, system: System, on_frame: Callable[[FrameResult], object] | None,
                 on_event: Callable[[dict[str, Any]], object] | None) -> None:
        self.results: list[FrameResult] = []
        self.began = False
        self._system = system
        self._on_frame = on_frame
        self._on_event = on_event

    def tell(self) -> None:
        self.began = True
        for result in self._system.results():
            self.results.append(result)
            if self._on_frame is not None:
                self._on_frame(result)
        if self._on_event is not None:
            for event in self._system.new_events():
                self._on_event(event)


def _feed(system: System, dataset: Dataset, frames: list[int], teller: _Teller,
          inertial: _plumbline._RunInertial | None = None) -> None:
    live = system.options["slam"]["mode"] == "live"
    stamps = dataset.stamps_ns
    schedule = _plumbline._PlaybackSchedule()
    for index in frames:
        stamp_ns = int(stamps[index])
        if live:
            frame = _read_live(dataset, index, stamp_ns, schedule)
        else:
            frame = dataset._read(index)
        if inertial is not None:
            inertial.feed_up_to(system, stamp_ns)
        if isinstance(frame, str):
            system.skip(stamp_ns, frame)
        else:
            system.feed(frame)
        teller.tell()


def _check_callable(name: str, value: object) -> None:
    if value is not None and not callable(value):
        raise InputError(f"{name}: expected a function, found {type(value).__name__}")


def run(path: Path | Dataset, *, preset: str | None = None, sensor: str | None = None,
        camera: str | None = None, format: str | None = None, topics: Sequence[str] = (),
        ground_truth: Path | None = None, rotate: str = "auto", max_width: int | None = None,
        view_angle: float | None = None, mask: Path | Sequence[Path] | None = None, start: int = 0,
        stop: int | None = None, stride: int = 1, map: Path | Atlas | None = None,
        localize: bool = False, out: Path | None = None, seed: int | None = None,
        mode: str | None = None, imu: Path | ArrayLike | None = None,
        on_frame: Callable[[FrameResult], object] | None = None,
        on_event: Callable[[dict[str, Any]], object] | None = None, **options: Any) -> Run:
    """Tracks the camera through a recorded sequence and maps what it sees, as `plumbline run`; the
    trajectory has the same bytes.

    preset: the system of a paper, "rippl" or "good-line-cutting", to which options are added. path,
    sensor, camera, format, topics, ground_truth, rotate, max_width, view_angle, mask: as for
    open(), or path is a Dataset. start, stop, stride: which frames. map: a file or an Atlas to go on in; localize: only
    find the camera in it. out: a folder for the files of the run. seed: of the random numbers; mode:
    "inline", "lockstep" or "live" (slam.seed and slam.mode). imu: "off", "auto" (the gyroscope of the
    data; the default without preset), a file that tells of the sensor, or samples (N, 7), stamp in nanoseconds, rates in rad/s,
    forces in m/s^2, of a sensor that the camera file tells of; what is wrong is a UserWarning. on_frame: called with the FrameResult of each frame, in order;
    on_event: with a dictionary for each loop, join of maps and relocalization, as soon as it is
    known (System.new_events); both in this thread. options: groups as dictionaries,
    features={"line_count": 100}, or dotted keys.

    The GIL is released while it computes. Ctrl-C raises KeyboardInterrupt between two frames; with
    `out` the frames so far are finished and written first, as they are before an exception of
    on_frame or on_event is raised again. Raises InputError.
    """
    needed = None if preset is None else _plumbline._preset_sensor(preset)
    if isinstance(path, Dataset):
        if (sensor, camera, format, tuple(topics), ground_truth, rotate, max_width, view_angle,
                mask) != (None, None, None, (), None, "auto", None, None, None):
            raise InputError("sensor, camera, format, topics, ground_truth, rotate, max_width, "
                             "view_angle, mask: expected none beside a Dataset, found some")
        dataset = path
    else:
        dataset = _plumbline.open(path, sensor=sensor or needed, camera=camera, format=format,
                                  topics=topics, ground_truth=ground_truth, rotate=rotate,
                                  max_width=max_width, view_angle=view_angle, mask=mask)
    _check_callable("on_frame", on_frame)
    _check_callable("on_event", on_event)
    if needed is not None and dataset.sensor != needed:
        raise InputError(f"preset {preset}: expected a dataset opened as {needed}, found {dataset.sensor}")
    if localize and map is None:
        raise InputError("localize: expected map as well")
    frames = _choose_frames(dataset, start, stop, stride)
    imu = "off" if imu is None and preset is not None else imu
    inertial = _plumbline._RunInertial(dataset, imu, camera, tuple(topics), rotate)
    for note in inertial.notes:
        warnings.warn(note, stacklevel=2)
    system = System(dataset.calibration, preset=preset, seed=seed, mode=mode, **options)
    inertial.use(system)
    atlas = map if map is None or isinstance(map, Atlas) else _plumbline.load_map(map)
    folder = None
    if out is not None:
        folder = _plumbline._RunFolder(out, dataset, None if isinstance(map, Atlas) else map)
        system._keep_views(frames)
    if atlas is not None:
        system.continue_in(atlas, read_only=bool(localize))

    def write() -> str | None:
        if folder is None:
            return None
        place, note = _plumbline._write_run(system, folder, dataset, len(frames), inertial, [])
        if note is not None:
            warnings.warn(note, stacklevel=4)
        return os.fspath(place)

    def finish() -> str | None:
        try:
            system.finish()
        except KeyboardInterrupt:  # the maps are whole, and as far adjusted as they got
            write()
            raise
        return write()

    teller = _Teller(system, on_frame, on_event)
    try:
        _feed(system, dataset, frames, teller, inertial)
    except BaseException as failure:
        # Of a system that refused its first frame there is nothing to keep.
        if folder is not None and (teller.began or isinstance(failure, KeyboardInterrupt)):
            finish()
        raise
    written = finish()
    teller.tell()
    for note in inertial.notes_after(system):
        warnings.warn(note, stacklevel=2)
    return Run(system, dataset, teller.results, written)
