# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Visual SLAM with points and lines.

    import plumbline
    run = plumbline.run("MH_01_easy", features={"line_count": 100})
    print(run.trajectory.positions)

`run` does what `plumbline run` does, with the same bytes; `System` takes frames from anywhere, one at
a time; functions such as `detect_lines`, `factorize_rank1`, `cut_lines`, `solve_pose` and
`bundle_adjust` are what it is made of. Poses are 4 x 4 matrices, `world_from_camera` unless the name
says otherwise; lengths are metres (with one camera: the map's unit), angles radians, time stamps
whole nanoseconds; pixel centres lie at integer coordinates.

Arrays that go in are copied. Arrays that come out of Frame, Map and Atlas are read-only, and keep
what they look into alive; all others are new and belong to the caller. All errors are
`plumbline.Error`; bad input is `plumbline.InputError`, which is a ValueError too.
"""
from ._plumbline import (
    Atlas,
    BugError,
    Calibration,
    Dataset,
    Error,
    Frame,
    FrameResult,
    InputError,
    Map,
    RectifiedCamera,
    Synth,
    System,
    Trajectory,
    __version__,
    align_points,
    built_in_cameras,
    bundle_adjust,
    compare_trajectories,
    covariance_from_disparity,
    cut_lines,
    describe_options,
    detect_lines,
    factorize_rank1,
    follow_points,
    interpolate_points,
    load_map,
    match_lines,
    match_stereo_lines,
    merge_maps,
    open,
    options,
    pose_information,
    rank1_matrix,
    render,
    solve_pose,
    worlds,
)
from .camera import pinhole
from .recorded import Run, run

__all__ = [
    "Atlas",
    "BugError",
    "Calibration",
    "Dataset",
    "Error",
    "Frame",
    "FrameResult",
    "InputError",
    "Map",
    "RectifiedCamera",
    "Run",
    "Synth",
    "System",
    "Trajectory",
    "__version__",
    "align_points",
    "built_in_cameras",
    "bundle_adjust",
    "compare_trajectories",
    "covariance_from_disparity",
    "cut_lines",
    "describe_options",
    "detect_lines",
    "factorize_rank1",
    "follow_points",
    "interpolate_points",
    "load_map",
    "match_lines",
    "match_stereo_lines",
    "merge_maps",
    "open",
    "options",
    "pinhole",
    "pose_information",
    "rank1_matrix",
    "render",
    "run",
    "solve_pose",
    "worlds",
]
