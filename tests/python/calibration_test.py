# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Calibrations from files, texts and numbers; options."""
import shutil
import subprocess

import numpy as np
import pytest

import plumbline


def test_a_pinhole():
    camera = plumbline.pinhole(640, 480, 500, 501, 320, 240)
    assert (camera.sensor, camera.width, camera.height) == ("mono", 640, 480)
    np.testing.assert_array_equal(camera.K, [[500, 0, 320], [0, 501, 240], [0, 0, 1]])
    assert camera.baseline is None and camera.depth_factor is None
    again = plumbline.Calibration.parse(camera.to_yaml())
    assert again.to_yaml() == camera.to_yaml()


def test_a_pair_and_depth():
    pair = plumbline.pinhole(640, 480, 500, 500, 320, 240, baseline=0.2)
    assert pair.sensor == "stereo" and pair.baseline == pytest.approx(0.2)
    assert pair.rectified_camera().baseline == pytest.approx(0.2)
    depth = plumbline.pinhole(640, 480, np.float32(500), 500, 320, 240, depth_factor=5000,
                              rate_hz=30, distortion="radtan",
                              coefficients=[-0.1, 0.01, 0, 0])
    assert (depth.sensor, depth.depth_factor, depth.rate_hz) == ("rgbd", 5000, 30)


def test_a_file_and_a_built_in_camera(tmp_path):
    (tmp_path / "camera.yaml").write_text(plumbline.pinhole(
        640, 480, 500, 500, 320, 240, baseline=0.2).to_yaml())
    assert plumbline.Calibration.load(str(tmp_path / "camera.yaml")).sensor == "stereo"
    assert plumbline.Calibration.load(str(tmp_path / "camera.yaml"), "mono").sensor == "mono"
    assert "tum_fr1" in plumbline.built_in_cameras()
    assert plumbline.Calibration.load("tum_fr1").width == 640


def test_data_sets_tell_what_they_are(dataset, sequence):
    assert len(dataset) == 12 and len(dataset.stamps_ns) == 12
    assert (dataset.sensor, dataset.format, dataset.name) == ("stereo", "euroc", sequence.name)
    assert dataset.calibration.sensor == "stereo"
    assert plumbline.open(sequence, sensor="mono")[0].right is None
    assert dataset[-1].stamp_ns == dataset.stamps_ns[-1]
    assert len(dataset.ground_truth) > 12
    assert dataset[0].left.dtype == np.uint8 and dataset[0].depth is None


def test_ground_truth_is_optional_and_can_be_replaced(sequence, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(sequence, copy)
    truth = copy / "mav0" / "state_groundtruth_estimate0" / "data.csv"
    rows = truth.read_text()
    truth.write_text("1,2,3\n")
    dataset = plumbline.open(copy)
    assert dataset.ground_truth is None
    assert dataset.ground_truth_fault.startswith(f"{truth}:1: expected at least 8 columns")
    own = tmp_path / "own.csv"
    own.write_text(rows + rows.splitlines()[1] + "\n")
    given = plumbline.open(copy, ground_truth=own)
    assert given.ground_truth_fault is None and len(given.ground_truth) > 12
    assert given.notes == [f"{own}:{len(rows.splitlines()) + 1}: 1 row goes back in time and is "
                           "left out"]
    assert plumbline.open(copy, ground_truth="none").ground_truth_fault is None


def test_images_are_turned_and_reduced_with_their_camera(dataset, sequence):
    width, height = dataset.calibration.width, dataset.calibration.height
    half = plumbline.open(sequence, max_width=width // 2)
    assert half[0].left.shape == half[0].right.shape == (round(height / 2), width // 2)
    assert half.calibration.width == width // 2
    mono = plumbline.open(sequence, sensor="mono", rotate="180")
    stored = plumbline.open(sequence, sensor="mono")
    assert np.array_equal(mono[1].left, np.rot90(stored[1].left, 2))
    assert any("turned by 180 degrees" in note for note in mono.notes)


def test_masks_and_views(dataset, sequence, tmp_path):
    rows, columns = dataset[0].left.shape
    mask = tmp_path / "mask.pgm"
    pixels = np.full((rows, columns), 255, np.uint8)
    pixels[:, : columns // 2] = 0
    mask.write_bytes(b"P5\n%d %d\n255\n" % (columns, rows) + pixels.tobytes())
    masked = plumbline.open(sequence, mask=mask)
    assert dataset[0].mask is None
    np.testing.assert_array_equal(masked[0].mask, pixels)
    assert plumbline.open(sequence, mask=[mask, mask])[1].mask.shape == (rows, columns)
    with pytest.raises(plumbline.InputError, match="mask: expected a path"):
        plumbline.open(sequence, mask=7)

    def features(frame, **more):
        system = plumbline.System(dataset.calibration)
        system.process(frame, **more)
        system.finish()
        return system.maps()[0].points

    frame = dataset[0]
    half = len(features(frame, mask=(pixels, None)))
    assert 0 < half < 0.8 * len(features(frame))
    assert half == len(features(masked[0]))
    with pytest.raises(plumbline.InputError, match="mask: expected an image of"):
        features(frame, mask=pixels[1:])
    narrow = plumbline.open(sequence, view_angle=30).calibration.rectified_camera()
    assert narrow.width < dataset.calibration.rectified_camera().width


def test_options_in_groups_and_with_dots():
    defaults = plumbline.options()
    assert defaults["slam"]["mode"] == "lockstep"
    assert defaults["features"]["line"]["merge"] is True
    changed = plumbline.options(features={"line_count": np.int32(50), "line": {"merge": False}},
                                **{"slam.seed": 7, "slam.mode": "inline",
                                   "mapping.line_map.max_relative_sigma": np.float64(0.01)})
    assert changed["features"]["line_count"] == 50
    assert changed["features"]["line"]["merge"] is False
    assert changed["slam"] == {"mode": "inline", "seed": 7, "lag": defaults["slam"]["lag"]}
    assert changed["mapping"]["line_map"]["max_relative_sigma"] == 0.01
    assert plumbline.options(**changed) == changed
    assert "line_count: 200" in plumbline.describe_options()
    assert "\nlines.residual: observed_ends " in plumbline.describe_options()
    camera = plumbline.pinhole(640, 480, 500, 500, 320, 240)
    assert plumbline.System(camera, **changed).options == changed


def test_messages_are_those_of_the_program(program, sequence):
    for setting, options in (
            ("features.line_count=-1", {"features.line_count": -1}),
            ("slam.mode=fast", {"slam": {"mode": "fast"}}),
            ("featuers.lines=false", {"featuers.lines": False})):
        done = subprocess.run([program, "run", sequence, "--set", setting], text=True,
                              capture_output=True)
        with pytest.raises(plumbline.InputError) as caught:
            plumbline.run(sequence, **options)
        assert done.returncode == 2
        assert done.stderr == f"plumbline: --set {caught.value}\n"
    done = subprocess.run([program, "run", sequence / "nothing"], text=True, capture_output=True)
    with pytest.raises(plumbline.InputError) as caught:
        plumbline.run(sequence / "nothing")
    assert done.stderr == f"plumbline: {caught.value}\n"
