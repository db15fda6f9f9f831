# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Wrong arguments: an exception that says what was expected and what was found, and no crash."""
import functools
import sys

import numpy as np
import pytest

import plumbline
from plumbline import _plumbline
from building_test import cutting_problem, rank1_arguments, tracks
from stubs_test import arguments_of, functions

CAMERA = plumbline.RectifiedCamera(450, 450, 376, 240, 752, 480, baseline=0.11)
SINGLE = plumbline.RectifiedCamera(450, 450, 376, 240, 752, 480)
MONO = plumbline.pinhole(96, 64, 80, 80, 48, 32)
PAIR = plumbline.pinhole(96, 64, 80, 80, 48, 32, baseline=0.1)
RGBD = plumbline.pinhole(96, 64, 80, 80, 48, 32, depth_factor=1000)
GRAY = np.zeros((64, 96), np.uint8)
LINES = plumbline.detect_lines(np.repeat(np.repeat(
    np.random.default_rng(1).integers(0, 255, (6, 8), np.uint8), 20, axis=0), 20, axis=1))
NAN = float("nan")
EYE = np.eye(4)
TRAJECTORY = plumbline.Trajectory([0, 1], [[0, 0, 0], [1, 0, 0]], [[0, 0, 0, 1]] * 2)
CUT = cutting_problem(np.random.default_rng(2), 3)
RANK1 = rank1_arguments(*tracks(np.random.default_rng(3))[1:], 0.001)[0]


def system(calibration=MONO, frames=0, finish=False):
    made = plumbline.System(calibration)
    for i in range(frames):
        made.process(GRAY, i)
    if finish:
        made.finish()
    return made


def cut(**changes):
    names = ("camera", "segments", "covariances", "measured")
    return plumbline.cut_lines(**(dict(zip(names, CUT)) | changes))


def rank1(**changes):
    return plumbline.factorize_rank1(**(RANK1 | changes))


def changed(array, index, value):
    array = np.array(array, dtype=float)
    array[index] = value
    return array


def lines_with(field, value):
    lines = LINES.copy()
    lines[field][0] = value
    return lines


def trajectory(stamps=(0, 1), positions=((0, 0, 0), (1, 0, 0)), quaternions=((0, 0, 0, 1),) * 2):
    return plumbline.Trajectory(stamps, positions, quaternions)


def pose(**points):
    return plumbline.solve_pose(CAMERA, EYE, points=points)


def adjust(**arguments):
    return plumbline.bundle_adjust(CAMERA, [EYE, EYE], points=[[0, 0, 5.0]], **arguments)


@functools.cache
def room():
    """A system that has a map of a world whose depth is measured."""
    world = plumbline.Synth("room", frames=1, scale=0.3, samples=1)
    made = plumbline.System(world.calibration)
    made.process(world[0])
    return made.maps()


def merged(transform):
    return plumbline.merge_maps(room(), room(), transform)


def empty():
    return system(frames=1).maps()


WORLD = [[0, 0, 5.0], [1, 0, 5]]
PIXELS = [[376, 240], [466, 240]]

# What is called, and what the message must say.
CASES = {
    # Images and stamps.
    "image of floats": (lambda: system().process(GRAY.astype(float), 0),
                        r"images: expected an image of uint8 of shape \(rows, columns\), found an "
                        r"array of float64 of shape \(64, 96\)"),
    "image of 16 bits": (lambda: system().process(GRAY.astype(np.uint16), 0),
                         "found an array of uint16"),
    "image with colours": (lambda: system().process(np.zeros((64, 96, 3), np.uint8), 0),
                           r"found an array of uint8 of shape \(64, 96, 3\)"),
    "image of another size": (lambda: system().process(GRAY.T, 0),
                              "left: expected an image of 64 rows and 96 columns, as calibrated, "
                              "found 96 and 64"),
    "empty image": (lambda: system().process(np.zeros((0, 0), np.uint8), 0), "found an array"),
    "no image": (lambda: system().process(None, 0), "images: expected an image .* found NoneType"),
    "a text for an image": (lambda: system().process("left.png", 0), "found str"),
    "an object for an image": (lambda: system().process(object(), 0), "found object"),
    "one image for a pair": (lambda: system(PAIR).process(GRAY, 0),
                             "images: expected a left and a right image, as calibrated, found one"),
    "three images": (lambda: system(PAIR).process((GRAY,) * 3, 0),
                     "images: expected 2 for stereo, found 3"),
    "a pair for one camera": (lambda: system().process((GRAY, GRAY), 0),
                              "images: expected 1 for mono, found 2"),
    "wrong right image": (lambda: system(PAIR).process((GRAY, GRAY[:10]), 0),
                          "right: expected an image of 64 rows"),
    "no depth": (lambda: system(RGBD).process(GRAY, 0), "expected an image and a depth image"),
    "depth of whole numbers": (lambda: system(RGBD).process((GRAY, GRAY.astype(np.int32)), 0),
                               "depth: expected a depth image of float32"),
    "depth of another size": (lambda: system(RGBD).process((GRAY, np.ones((4, 4))), 0),
                              "depth: expected an image of 64 rows"),
    "samples of six columns": (lambda: system().process(GRAY, 0, imu=np.zeros((3, 6))),
                               "imu: expected numbers of shape .N, 7."),
    "samples that are no numbers": (lambda: system().process(GRAY, 0, imu=np.full((3, 7), np.nan)),
                                    "imu: expected"),
    "samples that no sensor measures": (
        lambda: system().process(GRAY, 0, imu=[[1, 0, 0, 0, 0, 0, 9.8], [2, 0, 1e300, 0, 0, 0, 9.8]]),
        r"imu: row 1: expected rates in rad/s and forces in m/s\^2, found 1e\+300"),
    "samples before all time": (lambda: system().process(GRAY, 0, imu=[[-1, 0, 0, 0, 0, 0, 9.8]]),
                                "imu: row 0: expected a stamp in nanoseconds, found -1"),
    "samples without a sensor": (lambda: system().feed(GRAY, 0, imu=np.zeros((3, 7))),
                                 "imu: expected System.* with the calibration of the sensor"),
    "a sensor of no file": (lambda: plumbline.System(MONO, imu="none.yaml"), "none.yaml: no such file"),
    "no stamp": (lambda: system().process(GRAY), "stamp_ns: expected a whole number of "
                                                 "nanoseconds, found NoneType"),
    "stamp in seconds": (lambda: system().process(GRAY, 1.5), "found float"),
    "stamp True": (lambda: system().process(GRAY, True), "found bool"),
    "stamp too large": (lambda: system().process(GRAY, 2**64), "expected nanoseconds of 64 bits"),
    "stamp that does not grow": (lambda: system(frames=2).process(GRAY, 1),
                                 "stamp_ns: expected a frame after 1 ns, found one of 1 ns"),
    "stamp to feed": (lambda: system().feed(GRAY, "now"), "found str"),
    "image to feed": (lambda: system().feed([1, 2], 0), "images: expected 1 for mono, found 2"),
    "stamp beyond what is read": (lambda: system().process(GRAY, 4 * 10**18 + 1),
                                  "stamp_ns: expected a stamp within 4000000000000000000 ns of 0"),
    "no reason to skip": (lambda: system(frames=1).skip(10**18, ""), "reason: expected why"),
    "stamp to skip": (lambda: system(frames=1).skip(0, "x"), "expected a frame after 0 ns"),
    # Order of calls.
    "process after the end": (lambda: system(finish=True).process(GRAY, 0),
                              "process: expected a system that runs, found one that is finished"),
    "feed after the end": (lambda: system(finish=True).feed(GRAY, 0), "feed: expected a system"),
    "skip after the end": (lambda: system(finish=True).skip(0, "x"), "skip: expected a system"),
    "the end twice": (lambda: system(finish=True).finish(), "finish: expected a system that runs"),
    "trajectory too early": (lambda: system(frames=1).trajectory(),
                             r"trajectory: expected a system that is finished \(finish\(\)\)"),
    "causal trajectory too early": (lambda: system().causal_trajectory(), "found one that runs"),
    "covariances too early": (lambda: system().causal_covariances(),
                              r"causal_covariances: expected a system that is finished"),
    "keyframes too early": (lambda: system().keyframe_trajectory(), "found one that runs"),
    "main map too early": (lambda: system().main_map, "main_map: expected a system that is fin"),
    "trajectory of no map": (lambda: system(frames=1, finish=True).trajectory(7),
                             "map: expected the id of a map, found 7"),
    "maps before the first frame": (lambda: system().maps(), "maps: expected a system with a frame"),
    # Options.
    "option of another type": (lambda: plumbline.System(MONO, features={"line_count": "many"}),
                               "features.line_count: expected a whole number, 0 to 5000, "
                               "found 'many'"),
    "option of a broken number": (lambda: plumbline.System(MONO, features={"line_count": 1.5}),
                                  "found '1.5'"),
    "option out of range": (lambda: plumbline.System(MONO, slam={"lag": 101}), "0 to 100"),
    "option that is a list": (lambda: plumbline.System(MONO, slam={"mode": ["live"]}),
                              "slam.mode: expected a number, True, False, a text or a "
                              "dictionary, found list"),
    "option that is None": (lambda: plumbline.options(slam={"seed": None}), "found NoneType"),
    "option that is NaN": (lambda: plumbline.options(**{"features.line.min_length": NAN}),
                           "expected a number"),
    "option that is a constant now": (lambda: plumbline.options(**{"tracking.max_pose_sigma": 0.01}),
                                      r"tracking.max_pose_sigma is no option any more: it is fixed at 0.02 "
                                      r"\(TrackingOptions::max_pose_sigma\)"),
    "constant of lines": (lambda: plumbline.detect_lines(GRAY, merge_gap=1),
                          r"merge_gap is no option any more: it is fixed at 0.15"),
    "option that is an array": (lambda: plumbline.options(slam={"seed": np.zeros(2)}),
                                "found an array of float64"),
    "option without a name": (lambda: plumbline.options(slam={1: 2}), "expected names of options"),
    "unknown option": (lambda: plumbline.options(slam={"sed": 1}), "did you mean 'slam.seed'"),
    "seed twice": (lambda: plumbline.System(MONO, seed=1, slam={"seed": 1}),
                   "seed: expected it once, found slam.seed as well"),
    "mode twice": (lambda: plumbline.options(mode="live", **{"slam.mode": "live"}),
                   "mode: expected it once, found slam.mode as well"),
    "mode of another name": (lambda: plumbline.System(MONO, mode="fast"), "slam.mode: expected"),
    "seed of text": (lambda: plumbline.options(seed="one"), "slam.seed: expected"),
    # Half of a surrogate pair.
    "option of no text": (lambda: plumbline.options(mode="a\ud800"),
                          r"^slam.mode: expected a text that is valid Unicode, found 'a\\ud800'"),
    "option of no name": (lambda: plumbline.System(MONO, slam={"a\ud800": 1}),
                          r"^slam.: expected a text that is valid Unicode, found 'a\\ud800'"),
    "observations of no name": (lambda: pose(**{"a\ud800": 1}), "points: expected"),
    "data of no name": (lambda: plumbline.open("a\ud800"),
                        r"path: expected a text that can be the name of a file, found 'a\\ud800'"),
    "run of no name": (lambda: plumbline.run("a\ud800"), r"found 'a\\ud800'"),
    "map of no name": (lambda: plumbline.load_map("a\0b"), r"found 'a\\x00b'"),
    "file of no name": (lambda: TRAJECTORY.save("a\ud800"), r"found 'a\\ud800'"),
    "contradicting options": (lambda: plumbline.System(MONO, features={"points": False,
                                                                       "lines": False}),
                              "points"),
    # Data sets, runs, calibrations.
    "no data": (lambda: plumbline.open("/nothing/here"), "/nothing/here"),
    "unknown sensor": (lambda: plumbline.open(".", sensor="radar"),
                       "sensor: expected mono, stereo or rgbd, found radar"),
    "unknown rotation": (lambda: plumbline.open(".", rotate="45"),
                         "rotate: expected auto, none, 90, 180 or 270, found 45"),
    "unknown format": (lambda: plumbline.open(".", format="rosbag"), "format: expected euroc"),
    "unknown camera": (lambda: plumbline.Calibration.load("no_such_camera"), "no_such_camera"),
    "broken camera": (lambda: plumbline.Calibration.parse("model: [pinhole"), "calibration:1"),
    "sensor that is not there": (lambda: plumbline.Calibration.parse(MONO.to_yaml(), "rgbd"),
                                 "expected a calibration with a depth_factor for rgbd"),
    "pair that is not there": (lambda: plumbline.Calibration.parse(MONO.to_yaml(), "stereo"),
                               "two cameras for stereo, found one"),
    "camera without a focal length": (lambda: plumbline.pinhole(96, 64, 0, 80, 48, 32), "fx"),
    "camera of text": (lambda: plumbline.pinhole("96", 64, 80, 80, 48, 32),
                       "width: expected a number, found str"),
    "coefficients of nothing": (lambda: plumbline.pinhole(96, 64, 80, 80, 48, 32,
                                                          coefficients=[1]), "expected none"),
    "negative focal length": (lambda: plumbline.RectifiedCamera(-1, 1, 0, 0, 4, 4),
                              "fx: expected a number greater than 0, found -1"),
    "principal point NaN": (lambda: plumbline.RectifiedCamera(1, 1, NAN, 0, 4, 4), "cx: expected"),
    "no pixels": (lambda: plumbline.RectifiedCamera(1, 1, 0, 0, 0, 4), "expected at least 1"),
    "negative baseline": (lambda: plumbline.RectifiedCamera(1, 1, 0, 0, 4, 4, -1), "baseline"),
    "frames without images": (lambda: room().active.export("/none/a", "colmap", frames="all"),
                              "^frames: expected images=PATH, the data that"),
    "frames of no kind": (lambda: room().active.export("/none/a", "colmap", frames="some"),
                          "^frames: expected keyframes, all or every:N, found some"),
    "nerfstudio without images": (lambda: room().active.export("/none/a", "nerfstudio"),
                                  "^format nerfstudio: expected images=PATH"),
    "images of lines": (lambda: room().active.export("/none/a", "obj", images="/none"),
                        "^images: goes with format ply, colmap and nerfstudio only"),
    "trajectory of keyframes": (
        lambda: room().active.export("/none/a", "colmap", images="/nowhere", trajectory=TRAJECTORY),
        "trajectory: goes with frames="),
    "poses of no file": (
        lambda: room().active.export("/none/a", "colmap", images="/nowhere", frames="all"),
        "frames: expected trajectory as well"),
    "no map file": (lambda: plumbline.load_map("/nothing.plb"), "/nothing.plb"),
    "merging with a mirror": (lambda: merged(np.diag([1, -1, 1, 1])), "transform: expected a rotation"),
    "merging with a stretch": (lambda: merged(np.diag([1, 2, 1, 1])), "transform: expected a rotation"),
    "merging with 3 x 3": (lambda: merged(np.eye(3)), r"transform: expected numbers of shape \(4, 4\)"),
    "merging with another scale": (lambda: merged(np.diag([2, 2, 2, 1])),
                                   "transform: expected a motion of the scale 1, found the scale 2"),
    "merging without a map": (lambda: plumbline.merge_maps(empty(), empty()),
                              "first: expected a map, found none"),
    # Trajectories.
    "stamps of floats": (lambda: trajectory(stamps=[0.5, 1.5]),
                         "stamps_ns: expected whole numbers"),
    "stamps beyond what is read": (lambda: trajectory(stamps=[0, 4 * 10**18 + 1]),
                                   r"stamps_ns: expected stamps within 4000000000000000000 ns of "
                                   r"0, found 4000000000000000001 at \[1\]"),
    "stamps before what is read": (lambda: trajectory(stamps=[-2**63, 0]), "stamps_ns: expected"),
    "positions out of reach": (lambda: trajectory(positions=[[0, 0, 0], [0, -1e200, 0]]),
                               r"positions: expected coordinates within 1e\+09 of 0, found "
                               r"-1e\+200 at \[1, 1\]"),
    "source out of reach": (lambda: plumbline.align_points(1e200 * np.eye(3), np.eye(3)),
                            "source: expected coordinates within"),
    "target out of reach": (lambda: plumbline.align_points(np.eye(3), 1e200 * np.eye(3)),
                            "target: expected coordinates within"),
    "stamps that descend": (lambda: trajectory(stamps=[1, 0]), "found 0 after 1"),
    "positions of two": (lambda: trajectory(positions=[[0, 0], [1, 1]]),
                         r"positions: expected numbers of shape \(N, 3\), found an array of int64 "
                         r"of shape \(2, 2\)"),
    "too few positions": (lambda: trajectory(positions=[[0, 0, 0]]),
                          "positions: expected 2 of them, found 1"),
    "positions with NaN": (lambda: trajectory(positions=[[0, 0, 0], [0, NAN, 0]]),
                           r"positions: expected finite numbers, found nan at \[1, 1\]"),
    "long quaternions": (lambda: trajectory(quaternions=[[0, 0, 0, 2]] * 2), "norm of 1, found 2"),
    "ragged list": (lambda: trajectory(positions=[[0, 0, 0], [1]]), "positions: expected numbers"),
    "complex positions": (lambda: trajectory(positions=np.zeros((2, 3), complex)), "complex128"),
    "positions of text": (lambda: trajectory(positions=[["a", "b", "c"]] * 2), "positions: expec"),
    "unknown alignment": (lambda: plumbline.compare_trajectories(TRAJECTORY, TRAJECTORY, "affine"),
                          "alignment: expected none, se3 or sim3, found affine"),
    "window of no length": (lambda: plumbline.compare_trajectories(TRAJECTORY, TRAJECTORY,
                                                                   window_s=0), "window_s"),
    "window below a nanosecond": (lambda: plumbline.compare_trajectories(
        TRAJECTORY, TRAJECTORY, window_s=1e-10), "window_s: expected seconds from 1e-06 to"),
    "gap below a nanosecond": (lambda: plumbline.compare_trajectories(
        TRAJECTORY, TRAJECTORY, max_gap_s=1e-10), "max_gap_s: expected seconds from 1e-06"),
    "trajectories of other times": (lambda: plumbline.compare_trajectories(
        TRAJECTORY, trajectory(stamps=[10**15, 2 * 10**15])), "within the time of the reference"),
    "points on a line": (lambda: plumbline.align_points(np.outer(range(4), [1, 0, 0]),
                                                        np.outer(range(4), [0, 1, 0])),
                         "all on one line"),
    "points of other numbers": (lambda: plumbline.align_points(np.zeros((3, 3)), np.zeros((4, 3))),
                                "target: expected 3 of them, found 4"),
    # Lines.
    "lines of colours": (lambda: plumbline.detect_lines(np.zeros((64, 96, 3), np.uint8)), "image:"),
    "lines of a tiny image": (lambda: plumbline.detect_lines(GRAY[:4]), "at least 16 rows"),
    "lines of no detector": (lambda: plumbline.detect_lines(GRAY, detector="hough"),
                             "detector: expected drawing, .*, found hough"),
    "fewer lines than none": (lambda: plumbline.detect_lines(GRAY, count=-1), "at least 0"),
    "mask of another size": (lambda: plumbline.detect_lines(GRAY, mask=GRAY[:32]), "mask: expect"),
    "mask of booleans": (lambda: plumbline.detect_lines(GRAY, mask=GRAY > 0), "mask: .* bool"),
    "lines with an unknown option": (lambda: plumbline.detect_lines(GRAY, min_lenght=1),
                                     "did you mean 'min_length'"),
    "lines that are pixels": (lambda: plumbline.match_lines(np.zeros((3, 4)), LINES),
                              r"a: expected lines of shape \(N,\), as detect_lines gives them"),
    "a table of lines": (lambda: plumbline.match_lines(LINES, LINES.reshape(1, -1)), "b: expected"),
    "line with NaN": (lambda: plumbline.match_lines(lines_with("start", NAN), LINES),
                      r"found nan and .* at \[0\]"),
    "line without sigma": (lambda: plumbline.match_lines(LINES, lines_with("sigma_px", 0)),
                           "sigma_px, greater than 0"),
    "unknown option of matching": (lambda: plumbline.match_lines(LINES, LINES, radius=3),
                                   "expected the options mutual, max_distance"),
    "matching out of range": (lambda: plumbline.match_lines(LINES, LINES, ratio=3), "0.1 to 1"),
    "matching of text": (lambda: plumbline.match_lines(LINES, LINES, mutual="yes"), "found str"),
    "a pair without a baseline": (lambda: plumbline.match_stereo_lines(SINGLE, LINES, LINES),
                                  "camera: expected a baseline greater than 0, found 0"),
    # Rank-1 and interpolation.
    "reference of three": (lambda: rank1(reference=np.zeros((60, 3))), r"reference: .* \(N, 2\)"),
    "views of others": (lambda: rank1(views=np.zeros((4, 59, 2))), r"views: .* \(N, 60, 2\)"),
    "no views": (lambda: rank1(views=np.zeros((0, 60, 2)), sigmas=np.zeros((0, 60)),
                               rotations=np.zeros((0, 3, 3)), centre_directions=np.zeros((0, 3))),
                 "views: expected at least one view"),
    "views with NaN": (lambda: rank1(views=changed(RANK1["views"], (1, 2, 0), NAN)),
                       r"expected a finite place where sigma is greater than 0, .* at \[1, 2\]"),
    "negative sigmas": (lambda: rank1(sigmas=-RANK1["sigmas"]), "greater than 0"),
    "rotations that are none": (lambda: rank1(rotations=2 * RANK1["rotations"]),
                                "rotations: expected a rotation"),
    "centres nowhere": (lambda: rank1(centre_directions=np.zeros((4, 3))), "of some length"),
    "iterations without end": (lambda: rank1(iterations=10**6), "expected 0 to 1000"),
    "matrix of nothing": (lambda: plumbline.rank1_matrix(**(RANK1 | {"reference": None})),
                          "reference: expected numbers .* found NoneType"),
    "poses of 3 x 4": (lambda: plumbline.interpolate_points(PIXELS, PIXELS, EYE[:3], EYE, 1),
                       r"between_from_reference: expected numbers of shape \(4, 4\)"),
    "sigma of nothing": (lambda: plumbline.interpolate_points(PIXELS, PIXELS, EYE, EYE, 0),
                         "sigma: expected a number greater than 0, found 0"),
    "covariance that is none": (lambda: plumbline.interpolate_points(
        PIXELS, PIXELS, EYE, EYE, 1, np.triu(np.ones((12, 12)))), "symmetric"),
    "points outside": (lambda: plumbline.follow_points([GRAY, GRAY], [[100, 5]]),
                       "points: expected places in the first image"),
    "images of other sizes": (lambda: plumbline.follow_points([GRAY, GRAY[:60]], [[5, 5]]),
                              "images: expected images of one size"),
    "no images": (lambda: plumbline.follow_points([], [[5, 5]]), "at least one image"),
    # Cutting.
    "segments behind the camera": (lambda: cut(segments=-CUT[1]), "before the camera"),
    "segments of no length": (lambda: cut(segments=np.ones((3, 2, 3))), "of some length"),
    "covariances of others": (lambda: cut(covariances=CUT[2][:2]), r"covariances: .* \(3, 2, 3, 3\)"),
    "covariances that are none": (lambda: cut(covariances=-CUT[2]), "positive semidefinite"),
    "too few measured": (lambda: cut(measured=CUT[3][:2]), "measured: expected 3 of them, found 2"),
    "sigma negative": (lambda: cut(sigma_px=-1.0), "sigma_px: expected numbers greater than 0"),
    "sigma of others": (lambda: cut(sigma_px=[1.0, 2.0]), "sigma_px: expected 3 of them, found 2"),
    "information that is none": (lambda: cut(other_information=np.triu(np.ones((6, 6)))),
                                 "other_information: expected a symmetric matrix"),
    "unknown information": (lambda: cut(information="best"), "information: expected independent, printed"),
    "ratios that descend": (lambda: plumbline.pose_information(*CUT, ratios=[[0.6, 0.5]] * 3),
                            r"ratios: expected 0 <= first <= second <= 1, found 0.6 and 0.5 at \[0\]"),
    "ratios of others": (lambda: plumbline.pose_information(*CUT, ratios=[[0, 1]]),
                         r"ratios: expected numbers of shape \(3, 2\)"),
    "unknown information": (lambda: plumbline.pose_information(*CUT, information="all"),
                            "information: expected independent, printed or correlated, found all"),
    "points behind the camera": (lambda: plumbline.covariance_from_disparity(
        CAMERA, [[0, 0, -1]], 1, 1), "before the camera"),
    "depth without a baseline": (lambda: plumbline.covariance_from_disparity(
        SINGLE, [[0, 0, 1]], 1, 1), "baseline"),
    "sigma infinite": (lambda: plumbline.covariance_from_disparity(
        CAMERA, [[0, 0, 1]], float("inf"), 1), "sigma_px: expected a number greater than 0"),
    # Poses and bundle adjustment.
    "pose that is no motion": (lambda: plumbline.solve_pose(CAMERA, 2 * EYE), "last row"),
    "pose that mirrors": (lambda: plumbline.solve_pose(CAMERA, np.diag([1, 1, -1, 1])),
                          "determinant -1"),
    "points that are no dictionary": (lambda: plumbline.solve_pose(CAMERA, EYE, points=WORLD),
                                      "points: expected a dictionary, found list"),
    "a column too many": (lambda: pose(world=WORLD, pixels=PIXELS, colour=1),
                          "points: expected world, pixels, sigma_px, .* found colour"),
    "a column too few": (lambda: pose(world=WORLD), "points: expected pixels, found none"),
    "pixels of others": (lambda: pose(world=WORLD, pixels=PIXELS[:1]), "expected 2 of them"),
    "sigma of 0": (lambda: pose(world=WORLD, pixels=PIXELS, sigma_px=0.0),
                   "points.sigma_px: expected numbers greater than 0, found 0"),
    "disparities without a pair": (lambda: plumbline.solve_pose(SINGLE, EYE, points=dict(
        world=WORLD, pixels=PIXELS, disparities=[1.0, 1.0])), "camera: expected a baseline"),
    "lines that are none": (lambda: plumbline.solve_pose(CAMERA, EYE, lines=dict(
        world=[[1, 0, 0, 1, 0, 0]], segments=[PIXELS])), "at right angles"),
    "unknown option of poses": (lambda: plumbline.solve_pose(CAMERA, EYE, round=3), "'rounds'"),
    "fixed pose that is not there": (lambda: adjust(fixed=[2]),
                                     r"fixed: expected whole numbers from 0 to below 2, found 2"),
    "fixed pose of floats": (lambda: adjust(fixed=[0.0]), "fixed: expected whole numbers of shape"),
    "point that is not there": (lambda: adjust(point_observations=dict(
        pose=[0], point=[1], pixels=PIXELS[:1])), "point_observations.point: expected"),
    "pose that is not there": (lambda: adjust(point_observations=dict(
        pose=[-1], point=[0], pixels=PIXELS[:1])), "found -1"),
    "line that is not there": (lambda: adjust(line_observations=dict(
        pose=[0], line=[0], segments=[PIXELS])), "line_observations.line: expected"),
    "indices of others": (lambda: adjust(point_observations=dict(
        pose=[0, 1], point=[0], pixels=PIXELS[:1])), "point_observations.pose: expected 1"),
    "iterations of text": (lambda: adjust(max_iterations="all"), "max_iterations: expected"),
    # Worlds.
    "unknown world": (lambda: plumbline.Synth("moon"), "moon"),
    "frames of text": (lambda: plumbline.Synth("room", frames="all"), "frames: expected a whole"),
    "unknown form of a world": (lambda: plumbline.render("room", "/tmp/none", "kitti"),
                                "format: expected euroc or tum, found kitti"),
}


@pytest.mark.parametrize("name", CASES)
def test_bad_input_is_told(name):
    call, message = CASES[name]
    with pytest.raises(plumbline.InputError, match=message):
        call()


# What pybind11 refuses by itself: other kinds of objects.
TYPES = {
    "calibration": lambda: plumbline.System("tum_fr1"),
    "camera": lambda: plumbline.solve_pose(MONO, EYE),
    "trajectory": lambda: plumbline.compare_trajectories(np.eye(4), TRAJECTORY),
    "atlas": lambda: system().continue_in("map.plb"),
    "path": lambda: plumbline.load_map(3),
    "count": lambda: plumbline.detect_lines(GRAY, count=1.5),
    "unknown argument": lambda: plumbline.load_map(file="a"),
    "frame by name": lambda: plumbline.Synth("room", frames=1, scale=0.1)["first"],
}


@pytest.mark.parametrize("name", TYPES)
def test_other_kinds_of_objects_are_refused(name):
    with pytest.raises(TypeError, match="incompatible|supported"):
        TYPES[name]()


BOUND = sorted((member for member in vars(_plumbline).values()
                if isinstance(member, type) and not issubclass(member, Exception)),
               key=lambda member: member.__name__)


def test_all_classes_are_looked_at():
    names = {bound.__name__ for bound in BOUND}
    assert {"Dataset", "Frame", "System", "Trajectory", "Map", "Calibration"} <= names


@pytest.mark.parametrize("bound", BOUND, ids=lambda bound: bound.__name__)
def test_objects_that_were_never_made_are_refused(bound):
    for made_by in (bound, type("Derived", (bound,), {})):
        empty = made_by.__new__(made_by)
        for name, member in vars(bound).items():
            if type(member) is property:
                with pytest.raises((TypeError, RuntimeError)):
                    getattr(empty, name)
        for name, use in (("__len__", len), ("__iter__", list), ("__repr__", repr)):
            if name in vars(bound):
                with pytest.raises((TypeError, RuntimeError)):
                    use(empty)
    if hasattr(bound, "__len__"):
        with pytest.raises(TypeError, match="expected an object that __init__ made"):
            len(bound.__new__(bound))


def continued(atlas, system_before):
    system_before.continue_in(atlas)


def started(dataset):
    made = plumbline.System(dataset.calibration)
    made.process(dataset[0])
    return made


# The same of what needs a sequence, a run on it (finished) and a folder.
RUNS = {
    "start behind the end": (lambda d, f, t: plumbline.run(d, start=12),
                             "start 12: the sequence has 12 frames, and stop is None"),
    "start before the start": (lambda d, f, t: plumbline.run(d, start=-1),
                               "start: expected a whole number of at least 0, found -1"),
    "stop between frames": (lambda d, f, t: plumbline.run(d, stop=1.5),
                            "stop: expected a whole number, found float"),
    "stride of nothing": (lambda d, f, t: plumbline.run(d, stride=0),
                          "stride: expected a whole number of at least 1, found 0"),
    "localizing nowhere": (lambda d, f, t: plumbline.run(d, localize=True),
                           "localize: expected map as well"),
    "frames told to a number": (lambda d, f, t: plumbline.run(d, on_frame=3),
                                "on_frame: expected a function, found int"),
    "events told to a text": (lambda d, f, t: plumbline.run(d, on_event="print"),
                              "on_event: expected a function, found str"),
    "sensor of a Dataset": (lambda d, f, t: plumbline.run(d, sensor="mono"),
                            "sensor, camera, format, topics, ground_truth, rotate, max_width, view_angle, mask: expected "),
    "ground truth that is not there": (
        lambda d, f, t: plumbline.open(d.path, ground_truth=t / "none.txt"), "none.txt: no such file"),
    "topics of a folder": (lambda d, f, t: plumbline.open(d.path, topics=["/cam0"]),
                           "expected a bag or an MCAP file to choose topics of"),
    "width of nothing": (lambda d, f, t: plumbline.open(d.path, max_width=0),
                         "expected a greatest width of 1 or more, found 0"),
    "pair that is turned": (lambda d, f, t: plumbline.run(d.path, rotate="90"),
                            "found a stereo pair"),
    "map that is not there": (lambda d, f, t: plumbline.run(d, map=t / "none.plb"), "none.plb"),
    "results into the data": (lambda d, f, t: plumbline.run(d, out=d.path), "."),
    "frame behind the last": (lambda d, f, t: d[12], "frame: expected -12 to 11, found 12"),
    "rendered frame behind the last": (
        lambda d, f, t: plumbline.Synth("room", frames=1, scale=0.1)[1], "expected -1 to 0"),
    "map behind the last": (lambda d, f, t: f.maps[3], "map: expected -1 to 0, found 3"),
    "map of another camera": (lambda d, f, t: continued(f.maps, plumbline.System(MONO)), "."),
    "map after the first frame": (lambda d, f, t: continued(f.maps, started(d)),
                                  "expected a system before its first frame"),
    "stamp of a Frame": (lambda d, f, t: started(d).process(d[1], 3),
                         "stamp_ns: expected none beside a Frame, which has its own, found int"),
    "keyframes of no map": (lambda d, f, t: f.system.keyframe_trajectory(9),
                            "map: expected the id of a map, found 9"),
    "first poses of no map": (lambda d, f, t: f.system.causal_trajectory(9),
                              "map: expected the id of a map, found 9"),
    "unknown form of a map": (lambda d, f, t: f.map.export(t / "a", "xml"),
                              "format: expected ply, obj, dxf, tum, colmap or nerfstudio, found xml"),
    "map into no folder": (lambda d, f, t: f.maps.save(t / "none" / "map.plb"), "map.plb"),
    "trajectory into no folder": (lambda d, f, t: f.trajectory.save(t / "none" / "a.txt"), "a.txt"),
    "trajectory that is none": (lambda d, f, t: plumbline.Trajectory.load(d.path), "."),
}


@pytest.mark.parametrize("name", RUNS)
def test_runs_and_maps_refuse_what_they_cannot_do(name, dataset, finished, tmp_path):
    call, message = RUNS[name]
    with pytest.raises((plumbline.InputError, IndexError), match=message):
        call(dataset, finished, tmp_path)


def refused_by(call, *arguments) -> set[str]:
    """Names of the functions of the package that raised when `call` was called."""
    names, classes = set(), set()

    def watch(frame, event, argument):
        if event == "c_exception":
            names.add(argument.__name__)

    sys.setprofile(watch)
    try:
        call(*arguments)
    except Exception as error:
        sys.setprofile(None)
        if isinstance(error, IndexError):  # brackets are no call that a profile sees
            names.add("__getitem__")
        trace = error.__traceback__
        while trace is not None:  # functions written in Python
            if trace.tb_frame.f_globals["__name__"].startswith("plumbline"):
                names.add(trace.tb_frame.f_code.co_name)
            # Constructors leave no other trace.
            classes |= {name for name in trace.tb_frame.f_code.co_names
                        if isinstance(getattr(plumbline, name, None), type)}
            trace = trace.tb_next
    finally:
        sys.setprofile(None)
    return names or {f"{name}.__init__" for name in classes}


def test_every_public_function_is_in_the_tables(dataset, finished, tmp_path):
    refusing = set()
    for call, _ in CASES.values():
        refusing |= refused_by(call)
    for call in TYPES.values():
        refusing |= refused_by(call)
    for call, _ in RUNS.values():
        refusing |= refused_by(call, dataset, finished, tmp_path)
    takes_arguments = {
        name if name.endswith("__init__") else name.rpartition(".")[2]
        for name, member, node in functions()
        if not name.startswith("_") and "._" not in name.replace("__", "") and arguments_of(node)}
    takes_arguments |= {"run", "pinhole"}
    assert len(takes_arguments) > 30 and len(CASES) + len(RUNS) > 60
    assert takes_arguments - refusing == set()
