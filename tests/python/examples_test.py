# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""The scripts of examples/python, as users run them. On recorded sequences with PLUMBLINE_LONG set."""
import os
import pathlib
import re
import subprocess
import sys

import pytest

pytest.importorskip("matplotlib")

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"
DATA = pathlib.Path(os.environ.get("PLUMBLINE_DATA")
                    or pathlib.Path(__file__).parents[3] / "shared" / "data")
recorded = pytest.mark.skipif(not os.environ.get("PLUMBLINE_LONG") or not DATA.is_dir(),
                              reason="PLUMBLINE_LONG is not set, or there are no recordings")
MH_01 = DATA / "euroc" / "MH_01_easy_first250"


def ran(script: str, *arguments: object, picture: pathlib.Path, seconds: int = 250) -> str:
    """What the script says; the picture must be there, and something must be drawn on it."""
    done = subprocess.run([sys.executable, EXAMPLES / script, *map(str, arguments)], text=True,
                          capture_output=True, timeout=seconds)
    assert done.returncode == 0, done.stderr
    from matplotlib.image import imread
    pixels = imread(picture)[..., :3]
    assert pixels.shape[0] > 400 and len({tuple(p) for p in pixels[::7, ::7].reshape(-1, 3)}) > 20
    return done.stdout


def number(text: str, pattern: str) -> float:
    return float(re.search(pattern, text).group(1))


def test_first_run(sequence, tmp_path):
    said = ran("first_run.py", sequence, "--out", tmp_path, picture=tmp_path / "first_run.png")
    assert "12 of 12 frames tracked" in said
    assert number(said, r"ATE ([0-9.]+) mm") < 10
    assert (tmp_path / "report.html").is_file()


@pytest.mark.parametrize("detector", ["drawing", "edlines"])
def test_line_front_end(sequence, tmp_path, detector):
    images = sorted((sequence / "mav0" / "cam0" / "data").iterdir())[:2]
    said = ran("line_front_end.py", *images, "--detector", detector, "--out", tmp_path,
               picture=tmp_path / "lines.png")
    assert number(said, r"; (\d+) pairs") > 15


def test_rank1_explained(sequence, tmp_path):
    said = ran("rank1_explained.py", sequence, "--views", 2, "--out", tmp_path,
               picture=tmp_path / "rank1.png")
    assert number(said, r"second singular value is ([0-9.e+-]+) of") < 0.1
    assert number(said, r"all tracks: centres off by ([0-9.]+) %") < 5
    assert number(said, r"interpolated: centres off by ([0-9.]+) %") < 10


def test_cutting_explained(tmp_path):
    said = ran("cutting_explained.py", "--scenes", 8, "--steps", 12, "--out", tmp_path,
               picture=tmp_path / "cutting.png")
    assert number(said, r"15 lines: log det grows by ([0-9.]+)") > 0.5


def test_compare_runs(sequence, tmp_path):
    said = ran("compare_runs.py", sequence, "--runs", 2, "--out", tmp_path,
               picture=tmp_path / "comparison.png")
    assert said.count("95 % interval") == 2


@recorded
def test_first_run_on_a_recording(tmp_path):
    said = ran("first_run.py", MH_01, "--out", tmp_path, picture=tmp_path / "first_run.png")
    assert "249 of 250 frames tracked" in said
    assert number(said, r"ATE ([0-9.]+) mm") < 6


@recorded
def test_rank1_explained_on_a_recording(tmp_path):
    said = ran("rank1_explained.py", MH_01, "--out", tmp_path, picture=tmp_path / "rank1.png")
    assert number(said, r"all tracks: centres off by ([0-9.]+) %") < 5


@recorded
def test_compare_runs_on_a_recording(tmp_path):
    said = ran("compare_runs.py", MH_01, "--runs", 3, "--out", tmp_path,
               picture=tmp_path / "comparison.png", seconds=900)
    assert said.count("95 % interval") == 2


@recorded
def test_without_a_path_rooms_are_rendered(tmp_path):
    ran("first_run.py", "--out", tmp_path / "a", picture=tmp_path / "a" / "first_run.png")
    ran("line_front_end.py", "--out", tmp_path, picture=tmp_path / "lines.png")
    ran("rank1_explained.py", "--out", tmp_path, picture=tmp_path / "rank1.png")
    ran("compare_runs.py", "--out", tmp_path, picture=tmp_path / "comparison.png")
