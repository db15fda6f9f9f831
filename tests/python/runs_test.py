# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Runs: what the program does, frame by frame or in one call."""
import json
import shutil
import signal
import subprocess
import sys
import textwrap
import types
import warnings

import numpy as np
import pytest

import plumbline
from plumbline import recorded

# Files of a run that have nothing to do with the clock.
SAME = ["trajectory.txt", "trajectory_causal.txt", "trajectory_covariance.txt", "keyframes.txt", "frames.csv", "map.plb",
        "options.yaml", "lines.obj", "lines.dxf", "map.ply"]


def test_a_run_writes_the_bytes_of_the_program(program, sequence, tmp_path):
    subprocess.run([program, "run", sequence, "--quiet", "--out", tmp_path / "program", "--set",
                    "features.line_count=100"], check=True)
    run = plumbline.run(sequence, out=tmp_path / "python", features={"line_count": 100})
    for name in SAME:
        written = [(tmp_path / who / name).read_bytes() for who in ("python", "program")]
        if name == "options.yaml":  # its comments name the methods of the laboratory where that is built
            written = [[line.partition(b"#")[0].rstrip() for line in text.splitlines()] for text in written]
        assert written[0] == written[1], name
    assert run.out == str(tmp_path / "python")
    text = (tmp_path / "program" / "trajectory.txt").read_text()
    assert run.trajectory.to_tum() == text
    assert len(text.splitlines()) == 12
    # An ordinary folder of results: the program reads it, and another run may replace it.
    subprocess.run([program, "map", "info", tmp_path / "python" / "map.plb"], check=True,
                   stdout=subprocess.DEVNULL)
    plumbline.run(sequence, out=tmp_path / "python", stop=4)


def test_what_keeps_an_earlier_run_is_told(sequence, tmp_path):
    black = tmp_path / "black"
    black.mkdir()
    (black / "camera.yaml").write_text("size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n")
    for i in range(3):
        (black / f"{i}.pgm").write_bytes(b"P5\n8 6\n255\n" + bytes(48))
    out = tmp_path / "out"
    plumbline.run(sequence, out=out)
    earlier = (out / "trajectory.txt").read_bytes()
    with pytest.warns(UserWarning, match="out keeps the results of an earlier run") as told:
        run = plumbline.run(black, out=out)
    assert [warning.filename for warning in told] == [__file__]
    assert run.out == str(out / ".part")
    assert json.loads((out / ".part" / "summary.json").read_text())["data"] == str(black)
    assert (out / "trajectory.txt").read_bytes() == earlier

    def stop_at(result):
        if result.index == 4:
            raise ZeroDivisionError

    with pytest.warns(UserWarning, match="which has more poses"), pytest.raises(ZeroDivisionError):
        plumbline.run(sequence, out=out, on_frame=stop_at)
    assert (out / "trajectory.txt").read_bytes() == earlier


def samples_of(sequence) -> np.ndarray:
    return np.loadtxt(sequence / "mav0" / "imu0" / "data.csv", delimiter=",", comments="#")


@pytest.fixture
def imu_file(tmp_path, sequence):
    """A camera file's section of the sensor: the places of EuRoC's files as one."""
    def place(name: str) -> np.ndarray:
        text = (sequence / "mav0" / name / "sensor.yaml").read_text()
        numbers = text[text.index("data: [") + 7:]
        return np.array([float(x) for x in numbers[:numbers.index("]")].split(",")]).reshape(4, 4)

    rows = (np.linalg.inv(place("imu0")) @ place("cam0")).ravel()
    densities = [line for line in (sequence / "mav0" / "imu0" / "sensor.yaml").read_text().splitlines()
                 if line.startswith(("gyroscope_", "accelerometer_"))]
    file = tmp_path / "imu.yaml"
    file.write_text("\n  ".join(
        ["imu:", f"imu_from_left: [{', '.join(repr(float(x)) for x in rows)}]", *densities]) + "\n")
    return file


def test_the_gyroscope_of_the_data_gives_the_bytes_of_the_program(program, sequence, tmp_path):
    subprocess.run([program, "run", sequence, "--quiet", "--imu", "auto", "--out",
                    tmp_path / "program"], check=True)
    plumbline.run(sequence, out=tmp_path / "python", imu="auto")
    for name in ("trajectory.txt", "trajectory_causal.txt", "lines.obj"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes()
    summary = json.loads((tmp_path / "python" / "summary.json").read_text())
    assert summary["inertial"]["turns"] >= 8


def test_the_summary_has_the_notes_of_the_sensor_that_the_program_writes(program, sequence, tmp_path):
    # A gap is known before the run, and after it that two frames are too few for the sensor.
    data = tmp_path / "data"
    shutil.copytree(sequence, data)
    file = data / "mav0" / "imu0" / "data.csv"
    rows = file.read_text().splitlines()
    file.write_text("\n".join(rows[:50] + rows[70:]) + "\n")
    subprocess.run([program, "run", data, "--quiet", "--to", "2", "--out", tmp_path / "program"], check=True)
    with pytest.warns(UserWarning) as told:
        plumbline.run(data, out=tmp_path / "python", stop=2)
    notes = [json.loads((tmp_path / who / "summary.json").read_text())["notes"] for who in ("program", "python")]
    assert notes[1] == notes[0]
    warned = [str(warning.message) for warning in told]
    assert len(warned) == 2 and set(warned) <= set(notes[1])
    assert "1 gap above" in warned[0] and "too few frames" in warned[1]


def test_samples_are_taken_as_an_array_at_once_or_with_the_frames(sequence, dataset, imu_file):
    samples = samples_of(sequence)
    system = plumbline.System(dataset.calibration, imu=imu_file)
    assert len(samples) > 100
    before = -np.inf
    for frame in dataset:
        until = frame.stamp_ns + 20e6
        fresh = samples[(samples[:, 0] > before) & (samples[:, 0] <= until)]
        assert system.process(frame, imu=fresh).status == "tracked"
        before = until
    system.finish()
    with_file = plumbline.run(sequence, imu=imu_file)
    # But for stamps in float64, which are rounded by up to 0.2 us.
    assert np.allclose(system.trajectory().positions, with_file.trajectory.positions, atol=1e-6)
    without = plumbline.run(sequence, imu="off")
    assert not np.array_equal(without.trajectory.positions, with_file.trajectory.positions)
    # Without a file the calibration with the data counts, as for the program.
    with_data = plumbline.run(dataset, imu=samples)
    assert np.allclose(with_data.trajectory.positions, with_file.trajectory.positions, atol=1e-6)


def test_what_is_wrong_with_samples_is_told(sequence, tmp_path):
    (tmp_path / "camera.yaml").write_text(
        "size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\nimu:\n"
        "  imu_from_left: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n")
    for i in range(3):
        (tmp_path / f"{i}.pgm").write_bytes(b"P5\n8 6\n255\n" + bytes(48))
    samples = np.zeros((300, 7))
    samples[:, 0] = np.arange(300) * 5e6
    samples[:, 6] = 9.81
    samples[100:, 0] += 1e8
    samples[150, 0] += 1e18
    with pytest.warns(UserWarning, match="1 sample left out, with a stamp far ahead"):
        plumbline.run(tmp_path, imu=samples)
    samples[150, 0] -= 1e18
    with pytest.warns(UserWarning, match="1 gap above 1.5 intervals, the longest 0.105 s"):
        plumbline.run(tmp_path, imu=samples)
    (tmp_path / "camera.yaml").write_text("size: [8, 6]\nintrinsics: [5, 5, 4, 3]\nrate_hz: 3\n")
    with pytest.raises(plumbline.InputError, match="imu: expected the place of the sensor"):
        plumbline.run(tmp_path, imu=samples)  # nothing tells where the sensor is


def test_a_preset_is_named_in_the_summary(sequence, tmp_path):
    for preset in ("good-line-cutting", None):
        plumbline.run(sequence, preset=preset, stop=3, out=tmp_path / "out")
        assert json.loads((tmp_path / "out" / "summary.json").read_text())["preset"] == preset


def test_options_without_effect_are_told():
    with pytest.warns(UserWarning, match="cutting.method: no effect with features.lines=false"):
        plumbline.options(features={"lines": False}, cutting={"method": "greedy"})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plumbline.options(features={"lines": False}, preset="good-line-cutting")
        plumbline.options(**plumbline.options(features={"lines": False}))


def test_frames_from_anywhere_give_the_same_poses(dataset):
    system = plumbline.System(dataset.calibration)
    for frame in dataset:
        images = (np.array(frame.left), np.asfortranarray(frame.right))
        result = system.process(images, np.int64(frame.stamp_ns))
        for image in images:
            image[:] = 0  # they were copied
        assert result.stamp_ns == frame.stamp_ns
        assert result.status == "tracked"
    system.finish()
    assert system.trajectory().to_tum() == plumbline.run(dataset, imu="off").trajectory.to_tum()
    assert system.results() == []


def test_covariances_are_those_of_the_frames_and_of_the_file(dataset, tmp_path):
    run = plumbline.run(dataset, out=tmp_path / "out")
    stamps, covariances = run.covariances
    assert stamps.dtype == np.int64 and covariances.shape == (len(stamps), 6, 6)
    # The first frame starts the map: its pose is chosen.
    assert run.results[0].covariance is None
    known = [result for result in run.results if result.covariance is not None]
    assert len(known) == len(run.results) - 1
    np.testing.assert_array_equal(stamps, [result.stamp_ns for result in known])
    np.testing.assert_array_equal(covariances, [result.covariance for result in known])
    for covariance in covariances:
        np.testing.assert_array_equal(covariance, covariance.T)
        assert np.linalg.eigvalsh(covariance)[0] > 0
    rows = np.loadtxt(tmp_path / "out" / "trajectory_covariance.txt")
    np.testing.assert_allclose(rows[:, 1:].reshape(-1, 6, 6), covariances, rtol=1e-11)
    with pytest.raises(plumbline.InputError, match="map: expected the id of a map, found 7"):
        run.system.causal_covariances(7)


def test_each_result_is_told_once(dataset):
    system = plumbline.System(dataset.calibration)
    system.feed(dataset[0])
    assert system.process(dataset[1]).index == 1
    system.skip(int(dataset.stamps_ns[2]), "left out")
    system.feed(dataset[3])
    assert system.process(dataset[4]).index == 4
    assert [result.index for result in system.results()] == [0, 2, 3]
    assert system.results() == []


def test_modes_that_promise_it_give_the_same_bytes(dataset, finished):
    inline = plumbline.run(dataset, slam={"mode": "inline"})
    assert inline.trajectory.to_tum() == finished.trajectory.to_tum()


def test_a_map_has_the_same_bytes_whatever_the_data_are_called(sequence, finished, tmp_path):
    finished.maps.save(tmp_path / "map.plb")
    (tmp_path / "other name").symlink_to(sequence.resolve())
    plumbline.run(tmp_path / "other name").maps.save(tmp_path / "other.plb")
    assert (tmp_path / "map.plb").read_bytes() == (tmp_path / "other.plb").read_bytes()


def test_seed_and_mode_are_plain_arguments(dataset):
    run = plumbline.run(dataset, stop=2, seed=7, mode="inline")
    for options in (run.system.options, plumbline.options(seed=7, mode="inline"),
                    plumbline.System(dataset.calibration, 7, "inline").options):
        assert options["slam"]["seed"] == 7 and options["slam"]["mode"] == "inline"
    assert plumbline.options(seed=np.int64(3))["slam"]["seed"] == 3


def test_what_comes_out_tells_what_it_is(dataset, finished):
    assert repr(finished).endswith("12 of 12 frames tracked>")
    assert repr(finished.trajectory).startswith("<Trajectory of 12 poses, ")
    assert repr(plumbline.Trajectory([], np.zeros((0, 3)), np.zeros((0, 4)))) == \
        "<Trajectory of 0 poses>"
    assert repr(finished.system) == "<System, stereo, finished>"
    assert repr(plumbline.System(dataset.calibration)) == "<System, stereo, runs>"
    frame = dataset[0]
    rows, columns = frame.left.shape
    assert repr(frame).endswith(f" s: pair of {columns} x {rows}>")
    world = plumbline.Synth("room", frames=2, scale=0.1)
    assert repr(world) == "<Synth room: 2 frames>"


def test_a_live_run_follows_the_clock(dataset):
    run = plumbline.run(dataset, stop=4, mode="live")
    assert len(run.results) == 4


def test_a_live_run_reads_each_frame_shortly_before_it_is_due(monkeypatch):
    ms = 1_000_000
    now, read, fed = 7 * ms, [], []

    def sleep(seconds):
        nonlocal now
        now += round(1e9 * seconds)

    def read_frame(index):
        nonlocal now
        read.append(now // ms)
        now += 40 * ms
        return None if index == 2 else index

    told = types.SimpleNamespace(tell=lambda: None)
    stamps = np.array([0, 100, 200, 2000]) * ms  # the last one behind a gap of the recording
    dataset = types.SimpleNamespace(stamps_ns=stamps, _read=read_frame)
    system = types.SimpleNamespace(options={"slam": {"mode": "live"}},
                                   feed=lambda frame: fed.append(now // ms),
                                   skip=lambda stamp_ns, reason: fed.append(now // ms))
    monkeypatch.setattr(recorded, "time",
                        types.SimpleNamespace(monotonic_ns=lambda: now, sleep=sleep))
    recorded._feed(system, dataset, [0, 1, 2, 3], told)
    assert read == [7, 97, 197, 1997]  # 50 ms before, since reading takes 40 ms
    assert fed == [47, 147, 247, 2047]


def test_results_come_in_order(dataset):
    seen = []
    run = plumbline.run(dataset, start=2, stop=9, stride=2, on_frame=seen.append)
    assert [result.index for result in seen] == [0, 1, 2, 3]
    assert [result.stamp_ns for result in run.results] == dataset.stamps_ns[2:9:2].tolist()
    assert seen[0].keyframe
    np.testing.assert_allclose(seen[0].world_from_camera, np.eye(4), atol=1e-12)
    assert seen[1].inlier_points > 100 and seen[1].inlier_lines > 10
    assert seen[1].times_ms["total"] > 0


def test_errors_of_one_camera_leave_the_scale_free(sequence, dataset):
    assert dataset._error_options() == {"alignment": "se3", "max_gap_s": 0.1}
    mono = plumbline.open(sequence, sensor="mono")
    assert mono._error_options() == {"alignment": "sim3", "max_gap_s": 0.1}


def test_errors_are_small(finished):
    assert finished.errors["ate"]["count"] == 12
    assert finished.errors["ate"]["rmse"] < 0.01
    assert np.linalg.norm(finished.trajectory.positions[-1]) == pytest.approx(
        np.linalg.norm(finished.dataset.ground_truth.positions[-1]
                       - finished.dataset.ground_truth.positions[0]), abs=0.5)


def test_a_snapshot_changes_no_result(dataset):
    system = plumbline.System(dataset.calibration)
    sizes = []
    for frame in dataset:
        system.process(frame)
        sizes.append(len(system.maps()[0].keyframe_ids))
        assert system.events()["loops"] == []
    system.finish()
    assert sizes == sorted(sizes) and 1 <= sizes[0] < sizes[-1]
    assert system.trajectory().to_tum() == plumbline.run(dataset, imu="off").trajectory.to_tum()


def test_the_camera_is_found_in_a_map(finished, dataset, tmp_path):
    finished.maps.save(tmp_path / "map.plb")
    events = []
    run = plumbline.run(dataset, start=3, map=tmp_path / "map.plb", localize=True,
                        on_event=events.append)
    assert sum(result.status == "tracked" for result in run.results) >= 7
    told = run.system.events()["relocalizations"]
    assert len(told) >= 1
    assert events == [one | {"kind": "relocalization"} for one in told]
    assert run.system.new_events() == []
    assert events[0]["points"] + events[0]["lines"] > 20 and events[0]["frame"] >= 0
    np.testing.assert_array_equal(run.map.points, finished.map.points)
    centre = run.trajectory.positions[-1]
    assert np.linalg.norm(centre - finished.trajectory.positions[-1]) < 0.01


def test_one_camera_and_depth(dataset):
    world = plumbline.Synth("room", frames=5, scale=0.4, samples=1, rate_hz=10)
    calibration = world.calibration
    text = calibration.to_yaml().split("right:")[0] + "depth_factor: 5000\n"
    for factor in (None, 5000):
        system = plumbline.System(plumbline.Calibration.parse(text, "rgbd"))
        for frame in world:
            depth = frame.depth if factor is None else np.uint16(np.minimum(
                np.round(frame.depth * factor), 65535))
            result = system.process([frame.left, depth], frame.stamp_ns)
        assert result.status == "tracked"
    mono = plumbline.System(plumbline.Calibration.parse(text, "mono"))
    assert mono.process(world[0].left, 0).status == "initializing"


def interrupted(code: str, *arguments) -> subprocess.CompletedProcess:
    """Runs code that prints a line when it begins, and sends it Ctrl-C then."""
    child = subprocess.Popen([sys.executable, "-c", textwrap.dedent(code), *map(str, arguments)],
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    child.stdout.readline()
    child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=60)
    return subprocess.CompletedProcess(child.args, child.returncode, out, err)


def test_ctrl_c_ends_a_run_and_keeps_its_results(sequence, tmp_path):
    done = interrupted("""
        import sys, time, plumbline
        def slowly(result):
            print(result.index, flush=True)
            time.sleep(0.2)
        try:
            plumbline.run(sys.argv[1], out=sys.argv[2], on_frame=slowly)
        except KeyboardInterrupt:
            print("interrupted")
        """, sequence, tmp_path / "out")
    assert done.stdout.endswith("interrupted\n"), done
    lines = len((tmp_path / "out" / "trajectory.txt").read_text().splitlines())
    assert 1 <= lines < 12


def test_ctrl_c_at_the_end_of_a_run_keeps_its_results(sequence, tmp_path, monkeypatch):
    class Interrupted(plumbline.System):
        def finish(self):
            super().finish()
            raise KeyboardInterrupt

    monkeypatch.setattr("plumbline.recorded.System", Interrupted)
    with pytest.raises(KeyboardInterrupt):
        plumbline.run(sequence, out=tmp_path / "out")
    assert len((tmp_path / "out" / "trajectory.txt").read_text().splitlines()) == 12


@pytest.mark.parametrize("failure", [ZeroDivisionError, SystemExit])
def test_what_was_done_before_a_function_fails_is_kept(sequence, tmp_path, failure):
    def fail_at_the_fifth(result):
        if result.index == 4:
            raise failure("mine")

    with pytest.raises(failure, match="mine"):
        plumbline.run(sequence, out=tmp_path / "out", on_frame=fail_at_the_fifth)
    lines = len((tmp_path / "out" / "trajectory.txt").read_text().splitlines())
    assert 5 <= lines < 12
    assert (tmp_path / "out" / "map.plb").exists()


def test_what_was_done_before_an_event_is_refused_is_kept(finished, dataset, tmp_path):
    def fail(event):
        raise ZeroDivisionError(event["kind"])

    with pytest.raises(ZeroDivisionError, match="relocalization"):
        plumbline.run(dataset, start=3, map=finished.maps, localize=True, out=tmp_path / "out",
                      on_event=fail)
    assert (tmp_path / "out" / "trajectory.txt").exists()


def test_ctrl_c_ends_a_rendering(tmp_path):
    done = interrupted("""
        import sys, plumbline
        try:
            print("begins", flush=True)
            plumbline.render("room", sys.argv[1], frames=2000, scale=0.3, samples=1)
        except KeyboardInterrupt:
            print("interrupted")
        """, tmp_path / "world")
    assert done.stdout == "interrupted\n", done
