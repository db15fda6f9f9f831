# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""What errors are called and say, and what goes on behind them."""
import shutil

import numpy as np
import pytest

import plumbline


def test_options_that_hold_themselves_are_refused():
    endless = {}
    endless["a"] = endless
    with pytest.raises(plumbline.InputError, match="expected at most 16 dictionaries"):
        plumbline.options(**endless)
    with pytest.raises(plumbline.InputError, match="expected at most 16 dictionaries"):
        plumbline.Synth("room", **endless)


def test_what_is_saved_is_read(tmp_path):
    made = plumbline.Trajectory([-4 * 10**18, 4 * 10**18], [[0, 1e9, 0], [-1e9, 0, 0]],
                                [[0, 0, 0, 1]] * 2)
    made.save(tmp_path / "t.txt")
    read = plumbline.Trajectory.load(tmp_path / "t.txt")
    assert list(read.stamps_ns) == [-4 * 10**18, 4 * 10**18]
    assert (read.positions == made.positions).all()


def test_names_of_files_that_are_no_text_are_told():
    with pytest.raises(plumbline.InputError, match=r"/none/\\xff\.plb"):
        plumbline.load_map(b"/none/\xff.plb".decode(errors="surrogateescape"))


def test_data_whose_names_are_no_text_are_read(sequence, tmp_path):
    folder = tmp_path / b"\xff".decode(errors="surrogateescape")
    (folder).symlink_to(sequence.resolve())
    dataset = plumbline.open(folder)
    assert dataset.name == folder.name and dataset.path == folder and folder.name in repr(dataset)
    run = plumbline.run(dataset, stop=2, out=tmp_path / (folder.name + "out"))
    assert run.out == str(tmp_path / (folder.name + "out"))


def test_messages_name_arguments(dataset, tmp_path):
    for i in range(2):
        (tmp_path / f"{i}.png").write_bytes(b"")
    with pytest.raises(plumbline.InputError, match="give camera=FILE"):
        plumbline.open(tmp_path)
    (tmp_path / "a--map FILE").mkdir()
    (tmp_path / "a--map FILE" / "trajectory.txt").write_text("mine")
    with pytest.raises(plumbline.InputError, match="a--map FILE/trajectory.txt.* another out"):
        plumbline.run(dataset, stop=1, out=tmp_path / "a--map FILE")
    with pytest.raises(plumbline.InputError, match="^slam.sed=1: "):
        plumbline.options(slam={"sed": 1})


def test_errors_have_a_family():
    assert issubclass(plumbline.InputError, (plumbline.Error,))
    assert issubclass(plumbline.InputError, ValueError)
    assert issubclass(plumbline.BugError, plumbline.Error)
    assert plumbline.InputError.__module__ == "plumbline"


def test_a_refused_frame_does_no_harm():
    gray = np.zeros((64, 96), np.uint8)
    made = plumbline.System(plumbline.pinhole(96, 64, 80, 80, 48, 32))
    made.process(gray, 0)
    for images, stamp in ((gray[:3], 5), (gray, 0), (None, 7), (gray, 1.0)):
        with pytest.raises(plumbline.InputError):
            made.process(images, stamp)
    assert made.process(gray, 2).index == 1
    made.finish()
    assert made.finished


def test_an_image_that_is_gone_is_skipped(sequence, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(sequence, copy)
    images = sorted((copy / "mav0" / "cam0" / "data").iterdir())
    images[3].write_bytes(images[3].read_bytes()[:500])
    dataset = plumbline.open(copy)
    with pytest.raises(plumbline.InputError, match=images[3].name):
        dataset[3]
    run = plumbline.run(dataset, stop=6)
    assert [result.status for result in run.results][3] == "skipped"
    assert run.results[3].reason == "image_unreadable"
    assert run.results[3].world_from_camera is None and run.results[3].map is None


def test_an_image_of_another_size_is_skipped_as_by_the_program(sequence, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(sequence, copy)
    images = sorted((copy / "mav0" / "cam0" / "data").iterdir())
    images[3].write_bytes(b"P5\n4 3\n255\n" + bytes(12))
    with pytest.raises(plumbline.InputError, match="as in the calibration, found 4x3"):
        plumbline.open(copy)[3]
    run = plumbline.run(copy, stop=6, out=tmp_path / "out")
    assert run.results[3].reason == "image_size"
    assert ",skipped,,image_size," in (tmp_path / "out" / "frames.csv").read_text()
