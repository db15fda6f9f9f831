# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Maps as arrays, and what is written of them."""
import gc
import pathlib
import subprocess

import numpy as np
import pytest

import plumbline


def test_arrays_fit_together(finished):
    m = finished.map
    points, lines, ends = m.points, m.lines, m.line_ends
    assert points.shape == (len(m.point_ids), 3) and len(points) > 500
    assert lines.shape == (len(m.line_ids), 6) and ends.shape == (len(lines), 2, 3)
    assert m.line_information.shape == (len(lines), 4, 4)
    np.testing.assert_allclose(m.line_information, np.swapaxes(m.line_information, 1, 2), rtol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(lines[:, 3:], axis=1), 1)
    for end in (0, 1):  # moment = X x direction
        np.testing.assert_allclose(np.cross(ends[:, end], lines[:, 3:]), lines[:, :3], atol=1e-9)
    assert m.keyframe_poses.shape == (len(m.keyframe_ids), 4, 4)
    assert sorted(m.keyframe_stamps_ns) == list(m.keyframe_stamps_ns)


def test_tracks_are_where_points_project(finished):
    m = finished.map
    tracks = m.point_tracks
    points = m.points[np.searchsorted(m.point_ids, tracks["point"])]
    poses = m.keyframe_poses[np.searchsorted(m.keyframe_ids, tracks["keyframe"])]
    in_camera = np.einsum("nji,nj->ni", poses[:, :3, :3], points - poses[:, :3, 3])
    pixels = in_camera @ m.camera.K.T
    pixels = pixels[:, :2] / pixels[:, 2:]
    errors = np.linalg.norm(pixels - tracks["px"], axis=1) / tracks["sigma_px"]
    assert np.median(errors) < 2
    depth = m.camera.fx * m.camera.baseline / in_camera[:, 2]
    seen = ~np.isnan(tracks["disparity"])
    assert seen.mean() > 0.5
    assert np.median(np.abs(depth - tracks["disparity"])[seen]) < 1


def test_tracks_of_lines_are_where_lines_project(finished):
    m = finished.map
    tracks = m.line_tracks
    lines = m.lines[np.searchsorted(m.line_ids, tracks["line"])]
    world_from_camera = m.keyframe_poses[np.searchsorted(m.keyframe_ids, tracks["keyframe"])]
    turn = np.swapaxes(world_from_camera[:, :3, :3], 1, 2)
    centre = world_from_camera[:, :3, 3]
    moment = np.einsum("nij,nj->ni", turn, lines[:, :3] - np.cross(centre, lines[:, 3:]))
    inverse = np.linalg.inv(m.camera.K)
    image = moment @ inverse  # K^-T m
    image /= np.linalg.norm(image[:, :2], axis=1)[:, None]
    distance = np.einsum("ni,ni->n", image[:, :2], tracks["start"]) + image[:, 2]
    assert np.median(np.abs(distance)) < 0.5


def test_covariances_are_what_the_observations_tell(finished):
    m = finished.map
    covariances = m.point_covariances
    assert covariances.shape == (len(m.points), 3, 3)
    known = np.isfinite(covariances[:, 0, 0])
    assert known.mean() > 0.9
    assert (np.linalg.eigvalsh(covariances[known]) > 0).all()
    # Of a point that one keyframe shows: the covariance of a stereo measurement.
    tracks = m.point_tracks
    ids, counts = np.unique(tracks["point"], return_counts=True)
    once = tracks[np.isin(tracks["point"], ids[counts == 1]) & ~np.isnan(tracks["disparity"])]
    assert len(once) > 10
    for row in once[:10]:
        place = np.searchsorted(m.point_ids, row["point"])
        pose = m.keyframe_poses[np.searchsorted(m.keyframe_ids, row["keyframe"])]
        in_camera = pose[:3, :3].T @ (m.points[place] - pose[:3, 3])
        expected = plumbline.covariance_from_disparity(
            m.camera, [in_camera], row["sigma_px"], row["disparity_sigma"])[0]
        np.testing.assert_allclose(pose[:3, :3].T @ covariances[place] @ pose[:3, :3], expected,
                                   rtol=1e-6, atol=1e-12)


def test_covariances_of_ends_lie_across_lines(finished):
    m = finished.map
    ends, lines = m.line_end_covariances, m.lines
    assert ends.shape == (len(lines), 2, 3, 3)
    np.testing.assert_allclose(ends, np.swapaxes(ends, 2, 3), rtol=1e-6, atol=1e-15)
    along = np.einsum("ni,neij,nj->ne", lines[:, 3:], ends, lines[:, 3:])
    across = np.einsum("neii->ne", ends) - along
    np.testing.assert_allclose(along, across, rtol=1e-6)  # as documented
    assert 0 < np.sqrt(np.median(across)) < 0.1


def test_arrays_of_maps_are_read_only_copies(finished):
    m = finished.map
    for name in ("points", "lines", "line_ends", "line_information", "point_ids", "line_ids",
                 "keyframe_ids", "keyframe_stamps_ns", "keyframe_poses", "point_tracks",
                 "line_tracks", "point_covariances", "line_end_covariances"):
        array = getattr(m, name)
        with pytest.raises(ValueError, match="read-only"):
            array[...] = array[0]
        assert getattr(m, name) is not array


def test_arrays_outlive_their_owners(sequence):
    dataset = plumbline.open(sequence)
    frame = dataset[0]
    before = np.array(frame.left)
    left = frame.left
    del frame, dataset
    gc.collect()
    np.testing.assert_array_equal(left, before)
    with pytest.raises(ValueError, match="read-only"):
        left[0, 0] = 1
    one = plumbline.run(plumbline.open(sequence), stop=3).maps[0]
    gc.collect()
    assert len(one.points) == len(one.point_ids)


def test_maps_are_saved_and_read(finished, tmp_path):
    finished.maps.save(tmp_path / "a.plb")
    atlas = plumbline.load_map(tmp_path / "a.plb")
    atlas.save(tmp_path / "b.plb")
    assert (tmp_path / "a.plb").read_bytes() == (tmp_path / "b.plb").read_bytes()
    assert len(atlas) == 1 and atlas.active.id == atlas[0].id == atlas[-1].id
    np.testing.assert_array_equal(atlas[0].points, finished.map.points)
    with pytest.raises(IndexError, match="expected -1 to 0, found 1"):
        atlas[1]
    with pytest.raises(plumbline.InputError, match="nothing.plb"):
        plumbline.load_map(tmp_path / "nothing.plb")


def test_no_export_replaces_the_map_file(finished, tmp_path, monkeypatch):
    file = tmp_path / "map.plb"
    finished.maps.save(file)
    before = file.read_bytes()
    monkeypatch.chdir(tmp_path)
    atlas = plumbline.load_map("map.plb")
    (tmp_path / "link.plb").symlink_to(file)
    monkeypatch.chdir(tmp_path.parent)
    for one in (atlas[0], atlas.active, next(iter(atlas))):
        for path in (file, tmp_path / "link.plb"):
            with pytest.raises(plumbline.InputError, match="expected another file than .*, which is read"):
                one.export(path, "ply")
    assert file.read_bytes() == before
    atlas.save(file)
    assert file.read_bytes() == before


# What a user may have at a place that is named by a slip.
VICTIMS = {
    "camera.yaml": "model: pinhole\nsize: [160, 120]\n",
    "README.md": "# My data\n",
    "summary.json": '{\n  "program": "plumbline"\n}\n',
    "groundtruth.txt": "# timestamp tx ty tz qx qy qz qw\n1.5 0 0 0 0 0 0 1\n",
}
# Everything that writes a file, and what it may replace.
WRITERS = {
    "save of an atlas": (lambda run, path: run.maps.save(path), "a map"),
    "save of a trajectory": (lambda run, path: run.trajectory.save(path), "a trajectory"),
    "ply": (lambda run, path: run.map.export(path, "ply"), "a PLY file"),
    "obj": (lambda run, path: run.map.export(path, "obj"), "lines"),
    "dxf": (lambda run, path: run.map.export(path, "dxf"), "a DXF file"),
    "tum": (lambda run, path: run.map.export(path, "tum"), "a trajectory"),
}


@pytest.mark.parametrize("writer", WRITERS)
def test_nothing_of_a_users_is_replaced(writer, finished, tmp_path):
    write, kind = WRITERS[writer]
    for name, text in VICTIMS.items():
        path = tmp_path / name
        path.write_text(text)
        with pytest.raises(plumbline.InputError, match=f"path .*{name}: expected {kind}.* to replace,"):
            write(finished, path)
        assert path.read_text() == text
    path = tmp_path / "own"
    for _ in range(2):  # a file of its kind is replaced
        write(finished, path)
    assert path.stat().st_size > 100


@pytest.mark.parametrize("writer", WRITERS)
def test_no_result_of_a_run_is_replaced(writer, dataset, finished, tmp_path):
    plumbline.run(dataset, stop=2, out=tmp_path)
    for name in ("map.plb", "trajectory.txt", "map.ply", "lines.obj", "lines.dxf", "summary.json"):
        before = (tmp_path / name).read_bytes()
        with pytest.raises(plumbline.InputError, match="expected another name"):
            WRITERS[writer][0](finished, tmp_path / name)
        assert (tmp_path / name).read_bytes() == before


@pytest.mark.parametrize("form", ("colmap", "nerfstudio"))
def test_folders_take_the_place_of_nothing(form, finished, tmp_path):
    (tmp_path / "notes").write_text("mine")
    for path in (tmp_path, tmp_path / "notes"):
        with pytest.raises(plumbline.InputError, match="expected a"):
            finished.map.export(path, form, images=finished.dataset)
    assert (tmp_path / "notes").read_text() == "mine"


def files_of(folder):
    return {path.relative_to(folder): path.read_bytes()
            for path in folder.rglob("*") if path.is_file()}


def test_maps_are_exported_with_images(program, sequence, dataset, tmp_path):
    run = plumbline.run(dataset, out=tmp_path / "out")
    file = tmp_path / "out" / "map.plb"
    for form, frames, images in (("nerfstudio", "keyframes", 0), ("nerfstudio", "all", 12),
                                 ("colmap", "all", 12), ("colmap", "every:4", 0)):
        ways = {
            "objects": {"images": dataset, "trajectory": plumbline.Trajectory.load(
                tmp_path / "out" / "trajectory.txt")},
            "paths": {"images": sequence, "trajectory": tmp_path / "out" / "trajectory.txt"},
        }
        subprocess.run([program, "map", "export", file, "--to", form, "--images", sequence,
                        "--frames", frames, "--out", tmp_path / form / frames / "program"],
                       check=True, stdout=subprocess.DEVNULL)
        expected = files_of(tmp_path / form / frames / "program")
        assert images in (0, sum(path.suffix == ".png" for path in expected))
        for name, way in ways.items():
            if frames == "keyframes":
                del way["trajectory"]
            run.map.export(tmp_path / form / frames / name, form, frames=frames, **way)
            assert files_of(tmp_path / form / frames / name) == expected
        # Beside a map that was read lies the trajectory.
        plumbline.load_map(file)[0].export(tmp_path / form / frames / "read", form,
                                           images=dataset, frames=frames)
        assert files_of(tmp_path / form / frames / "read") == expected
    run.map.export(tmp_path / "of the run", "nerfstudio", images=dataset, frames="all",
                   trajectory=run.trajectory)  # it has more decimals than its file
    assert len(files_of(tmp_path / "of the run")) == 14
    with pytest.raises(plumbline.InputError, match="undistort: goes with"):
        run.map.export(tmp_path / "a", "colmap", undistort=True)
    for images in (dataset, sequence):
        with pytest.raises(plumbline.InputError, match="outside of .*, which is read"):
            run.map.export(sequence / "exp", "colmap", images=images)
    run.map.export(tmp_path / "whole", "colmap", images=dataset, undistort=True)
    assert b" PINHOLE " in files_of(tmp_path / "whole")[pathlib.Path("sparse/0/cameras.txt")]
    run.map.export(tmp_path / "grey.ply", "ply")
    run.map.export(tmp_path / "seen.ply", "ply", images=dataset)
    grey, seen = ((tmp_path / name).read_text() for name in ("grey.ply", "seen.ply"))
    assert "128 128 128" in grey and len(grey.splitlines()) == len(seen.splitlines())
    assert len({line.rpartition(" ")[2] for line in seen.splitlines()[12:]}) > 20


def test_maps_are_exported(program, finished, tmp_path):
    finished.maps.save(tmp_path / "map.plb")
    for form in ("ply", "obj", "dxf", "tum"):
        finished.map.export(tmp_path / f"python.{form}", form)
        subprocess.run([program, "map", "export", tmp_path / "map.plb", "--to", form, "--out",
                        tmp_path / f"program.{form}"], check=True, stdout=subprocess.DEVNULL)
        assert (tmp_path / f"python.{form}").read_bytes() == \
            (tmp_path / f"program.{form}").read_bytes()
    finished.map.export(tmp_path / "python", "colmap")
    subprocess.run([program, "map", "export", tmp_path / "map.plb", "--to", "colmap", "--out",
                    tmp_path / "program"], check=True, stdout=subprocess.DEVNULL)
    files = [path for path in (tmp_path / "program").rglob("*") if path.is_file()]
    assert len(files) == 9
    for path in files:
        other = tmp_path / "python" / path.relative_to(tmp_path / "program")
        assert other.read_bytes() == path.read_bytes(), other
    with pytest.raises(plumbline.InputError,
                       match="format: expected ply, obj, dxf, tum, colmap or nerfstudio, found xml"):
        finished.map.export(tmp_path / "a", "xml")


def test_maps_are_merged_as_by_the_program(program, dataset, tmp_path):
    first = plumbline.run(dataset, stop=7).maps
    second = plumbline.run(dataset, start=5).maps
    both, told = plumbline.merge_maps(first, second)
    first.save(tmp_path / "first.plb")
    second.save(tmp_path / "second.plb")
    both.save(tmp_path / "both.plb")
    subprocess.run([program, "map", "merge", tmp_path / "first.plb", tmp_path / "second.plb",
                    "--out", tmp_path / "program.plb"], check=True, stdout=subprocess.DEVNULL)
    assert (tmp_path / "both.plb").read_bytes() == (tmp_path / "program.plb").read_bytes()
    assert len(both) == 1
    assert len(both.active.keyframe_ids) == len(first.active.keyframe_ids) + \
        len(second.active.keyframe_ids)
    assert len(told["pairs"]) >= 2 and told["ties"] >= 1 and told["remarks"] == []
    assert set(told["pairs"][:, 0]) <= set(first.active.keyframe_ids.tolist())
    truth = {pose[0]: pose[1] for pose in zip(dataset.ground_truth.stamps_ns.tolist(),
                                              dataset.ground_truth.poses)}
    starts = [truth[one.active.keyframe_stamps_ns[0]] for one in (first, second)]
    np.testing.assert_allclose(told["first_from_second"], np.linalg.inv(starts[0]) @ starts[1],
                               atol=0.02)


def test_maps_are_merged_as_told(finished):
    moved = np.eye(4)
    moved[:3, 3] = [0, 0, 20]
    both, told = plumbline.merge_maps(finished.maps, finished.maps, moved)
    np.testing.assert_array_equal(told["first_from_second"], moved)
    assert told["pairs"].shape == (0, 2) and told["ties"] == 0
    np.testing.assert_allclose(
        both.active.points, np.concatenate([finished.map.points, finished.map.points + moved[:3, 3]]),
        atol=1e-9)


def test_the_line_map_is_what_a_run_gives_out(finished, tmp_path):
    lines = finished.map.line_map()
    finished.map.export(tmp_path / "lines.obj", "obj")
    written = (tmp_path / "lines.obj").read_text().count("\nl ")
    assert len(lines["segments"]) == written >= 10
    assert lines["segments"].shape == (len(lines["sigmas"]), 2, 3)
    assert (lines["sigmas"] > 0).all() and (lines["keyframes"] >= 4).all()


def test_the_line_map_has_the_options_of_the_run(dataset, finished, tmp_path):
    other = plumbline.run(dataset, out=tmp_path,
                          **{"mapping.line_map.min_keyframes": 2})
    lines = plumbline.load_map(tmp_path / "map.plb").active.line_map()
    assert lines["keyframes"].min() < 4 <= finished.map.line_map()["keyframes"].min()
    np.testing.assert_array_equal(lines["segments"], other.map.line_map()["segments"])
    other.map.export(tmp_path / "again.obj", "obj")
    assert (tmp_path / "again.obj").read_bytes() == (tmp_path / "lines.obj").read_bytes()


def test_trajectories_of_keyframes_are_of_the_camera_as_delivered(finished):
    m = finished.map
    np.testing.assert_array_equal(m.keyframe_trajectory().stamps_ns, m.keyframe_stamps_ns)
    np.testing.assert_allclose(m.keyframe_trajectory().positions, m.keyframe_poses[:, :3, 3])
    assert m.keyframe_trajectory().to_tum() == finished.system.keyframe_trajectory().to_tum()
