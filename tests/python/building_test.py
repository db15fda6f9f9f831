# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Building blocks: lines, rank-1, interpolation, cutting, trajectories, worlds."""
import pathlib

import numpy as np
import pytest

import plumbline

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def images(dataset):
    return [dataset[i].left for i in range(4)]


@pytest.mark.parametrize("detector", ["drawing", "lsd", "edlines"])
def test_lines_are_found_again(images, detector):
    a, b = (plumbline.detect_lines(image, detector=detector) for image in images[:2])
    assert len(a) > 20
    matches = plumbline.match_lines(a, b)
    assert len(matches) > 0.4 * min(len(a), len(b))
    assert len(set(matches[:, 0])) == len(matches) == len(set(matches[:, 1]))
    middle = [0.5 * (lines["start"] + lines["end"]) for lines in (a, b)]
    moved = np.linalg.norm(middle[0][matches[:, 0]] - middle[1][matches[:, 1]], axis=1)
    assert np.median(moved) < 30
    bits = np.unpackbits(a["descriptor"][matches[:, 0]] ^ b["descriptor"][matches[:, 1]], axis=1)
    np.testing.assert_array_equal(bits.sum(axis=1), matches[:, 2])
    assert (plumbline.match_lines(a, b, max_distance=20)[:, 2] <= 20).all()


def test_the_bright_side_is_on_the_left():
    image = np.zeros((120, 160), np.uint8)
    image[:, 80:] = 200
    line = plumbline.detect_lines(image)[0]
    assert abs(line["start"][0] - 79.5) < 0.1 and abs(line["end"][0] - 79.5) < 0.1
    direction = line["end"] - line["start"]
    left = np.array([direction[1], -direction[0]])  # y points down
    assert left[0] > 0
    masked = plumbline.detect_lines(image, mask=np.zeros_like(image))
    assert len(masked) == 0
    assert len(plumbline.detect_lines(image, count=0)) == 0
    assert len(plumbline.detect_lines(image, min_length=0.5)) == 1
    assert len(plumbline.detect_lines(np.ascontiguousarray(image[:50]), min_length=0.5)) == 0


def test_lines_of_a_pair(finished):
    world = plumbline.Synth("room", frames=1, scale=0.5, samples=1, distortion=False)
    frame, camera = world[0], world.calibration.rectified_camera()
    left, right = (plumbline.detect_lines(image) for image in (frame.left, frame.right))
    segments, sigmas = plumbline.match_stereo_lines(camera, left, right)
    assert segments.shape == (len(left), 2, 2) and sigmas.shape == (len(left),)
    found = ~np.isnan(sigmas)
    assert found.sum() > 10
    middle = 0.5 * (left["start"] + left["end"])[found, 0]
    assert (middle > segments[found].mean(axis=1)[:, 0] - 2).mean() > 0.9


def tracks(rng, count=60, views=4, noise=0.0):
    """A scene with its cameras: poses, ideal image coordinates in the reference and the views."""
    points = rng.uniform([-2, -2, 3], [2, 2, 8], (count, 3))
    poses, places = [], []
    for i in range(views):
        angle = 0.05 * (i + 1)
        turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0],
                         [-np.sin(angle), 0, np.cos(angle)]])
        pose = np.eye(4)  # camera from reference
        pose[:3, :3] = turn
        pose[:3, 3] = [0.1 * (i + 1), 0.02, 0.03 * i]
        seen = points @ turn.T + pose[:3, 3]
        poses.append(pose)
        places.append(seen[:, :2] / seen[:, 2:] + noise * rng.standard_normal((count, 2)))
    return points, np.array(poses), points[:, :2] / points[:, 2:], np.array(places)


def rank1_arguments(poses, reference, places, sigma):
    rotations = np.swapaxes(poses[:, :3, :3], 1, 2)
    centres = -np.einsum("nij,nj->ni", rotations, poses[:, :3, 3])
    return dict(reference=reference, views=places, sigmas=np.full(places.shape[:2], sigma),
                rotations=rotations, centre_directions=centres), centres


def test_rank_1_gives_all_centres_and_distances():
    points, poses, reference, places = tracks(np.random.default_rng(1))
    arguments, centres = rank1_arguments(poses, reference, places, 0.001)
    entries, weights = plumbline.rank1_matrix(**arguments)
    values = np.linalg.svd(entries, compute_uv=False)
    assert values[1] < 1e-9 * values[0] and weights.shape == (4, 60)
    solution = plumbline.factorize_rank1(**arguments)
    scale = np.linalg.norm(centres)
    np.testing.assert_allclose(solution["centres"], centres / scale, atol=1e-9)
    np.testing.assert_allclose(solution["inverse_distances"],
                               scale / np.linalg.norm(points, axis=1), rtol=1e-6)
    assert solution["solved"] == solution["in_front"] == 60


def test_rank_1_takes_what_is_not_seen():
    _, poses, reference, places = tracks(np.random.default_rng(2), noise=1e-3)
    arguments, centres = rank1_arguments(poses, reference, places, 0.001)
    arguments["sigmas"][1, :20] = 0
    arguments["views"][1, :20] = np.nan
    solution = plumbline.factorize_rank1(**arguments)
    np.testing.assert_allclose(solution["centres"], centres / np.linalg.norm(centres), atol=0.02)
    arguments["sigmas"][2] = 0
    assert plumbline.factorize_rank1(**arguments) is None


def test_interpolation_places_points_where_they_are():
    _, poses, reference, places = tracks(np.random.default_rng(3))
    found = plumbline.interpolate_points(reference, places[3], poses[1], poses[3], 1e-3,
                                         1e-8 * np.eye(12))
    good = found["line_angles"] > 0.02
    assert good.sum() > 20
    np.testing.assert_allclose(found["points"][good], places[1][good], atol=1e-6)
    assert (np.linalg.eigvalsh(found["covariances"][good]) > 0).all()


def test_points_are_followed(images):
    lines = plumbline.detect_lines(images[0], count=30)
    places = plumbline.follow_points(images, lines["start"])
    assert places.shape == (4, 30, 2)
    np.testing.assert_allclose(places[0], lines["start"], atol=1e-4)
    assert (~np.isnan(places[3, :, 0])).sum() > 5
    # Images in one array, whose items are made as they are asked for.
    np.testing.assert_array_equal(
        plumbline.follow_points(np.stack(images), lines["start"]), places)


def test_a_trajectory_may_be_empty():
    for none in ([], np.zeros(0), np.zeros(0, int)):
        poses = plumbline.Trajectory(none, np.zeros((0, 3)), np.zeros((0, 4)))
        assert poses.to_tum() == ""


def cutting_problem(rng, count=12):
    camera = plumbline.RectifiedCamera(450, 450, 376, 240, 752, 480, baseline=0.1)
    starts = rng.uniform([-2, -1, 2], [2, 1, 4], (count, 3))
    segments = np.stack([starts, starts + rng.uniform([-1, -1, 0], [1, 1, 5], (count, 3))], axis=1)
    covariances = plumbline.covariance_from_disparity(
        camera, segments.reshape(-1, 3), 0.5, 0.7).reshape(count, 2, 3, 3)
    pixels = segments @ camera.K.T
    return camera, segments, covariances, pixels[..., :2] / pixels[..., 2:]


def test_cutting_gains_information():
    problem = cutting_problem(np.random.default_rng(4))
    for information in ("independent", "printed"):
        cut = plumbline.cut_lines(*problem, information=information)
        assert cut["log_det_cut"] > cut["log_det_whole"] + 0.1
        assert (cut["ratios"][:, 0] <= cut["ratios"][:, 1]).all()
    correlated = plumbline.cut_lines(*problem, information="correlated")
    assert 0 <= correlated["log_det_cut"] - correlated["log_det_whole"] < 1e-3
    cut = plumbline.cut_lines(*problem)
    known = plumbline.cut_lines(*problem, other_information=1e6 * np.eye(6))
    assert known["log_det_whole"] > cut["log_det_whole"]
    blurred = plumbline.cut_lines(*problem, sigma_px=[5.0] * 12)
    assert blurred["log_det_whole"] < cut["log_det_whole"]
    # The far ends are the uncertain ones.
    lost = 1 - np.diff(plumbline.cut_lines(*problem)["ratios"], axis=1)[:, 0]
    assert lost.max() > 0.1


def test_information_of_pieces_is_what_cutting_raises():
    problem = cutting_problem(np.random.default_rng(7))
    cut = plumbline.cut_lines(*problem)
    for ratios, expected in ((None, cut["log_det_whole"]), (cut["ratios"], cut["log_det_cut"])):
        information = plumbline.pose_information(*problem, ratios)
        np.testing.assert_allclose(information, information.T, rtol=1e-12)
        assert np.linalg.slogdet(information)[1] == pytest.approx(expected, abs=1e-9)
    more = plumbline.pose_information(*problem, other_information=np.eye(6)) - \
        plumbline.pose_information(*problem)
    np.testing.assert_allclose(more, np.eye(6), atol=1e-6)


def test_trajectories_are_compared(tmp_path):
    rng = np.random.default_rng(5)
    stamps = np.arange(50) * 100_000_000
    positions = np.cumsum(rng.uniform(-0.1, 0.2, (50, 3)), axis=0)
    turns = np.tile([0.0, 0, 0, 1], (50, 1))
    a = plumbline.Trajectory(stamps, positions, turns)
    b = plumbline.Trajectory(stamps, 2 * positions + [1, 2, 3], turns)
    assert plumbline.compare_trajectories(a, b, alignment="sim3")["ate"]["rmse"] < 1e-9
    assert plumbline.compare_trajectories(a, b, alignment="sim3")["scale"] == pytest.approx(0.5)
    assert plumbline.compare_trajectories(a, b)["ate"]["rmse"] > 0.1
    none = plumbline.compare_trajectories(a, b, alignment="none")
    np.testing.assert_allclose(none["position_errors"],
                               np.linalg.norm(positions + [1, 2, 3], axis=1))
    assert plumbline.compare_trajectories(a, b, window_s=100)["rpe"] is None
    a.save(tmp_path / "a.txt")
    again = plumbline.Trajectory.load(tmp_path / "a.txt")
    np.testing.assert_allclose(again.positions, positions, atol=1e-9)
    np.testing.assert_array_equal(again.stamps_ns, stamps)
    np.testing.assert_array_equal(again.quaternions, turns)
    assert len(again) == 50 and again.poses.shape == (50, 4, 4)
    assert again.length == pytest.approx(
        np.linalg.norm(np.diff(positions, axis=0), axis=1).sum(), rel=1e-6)


def test_points_are_aligned():
    source = np.random.default_rng(6).standard_normal((20, 3))
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    motion, rmse = plumbline.align_points(source, source @ turn.T + [1, 2, 3])
    np.testing.assert_allclose(motion[:3, :3], turn, atol=1e-12)
    np.testing.assert_allclose(motion[:3, 3], [1, 2, 3], atol=1e-12)
    assert rmse < 1e-12
    scaled, _ = plumbline.align_points(source, 3 * source, with_scale=True)
    np.testing.assert_allclose(scaled[:3, :3], 3 * np.eye(3), atol=1e-12)


def test_the_file_of_a_world_is_not_removed(tmp_path):
    few = {"frames": 1, "scale": 0.25, "samples": 1}
    plumbline.render("room", tmp_path / "out", **few)
    own = tmp_path / "out" / "described_world.yaml"
    own.write_text((EXAMPLES / "worlds" / "shed.yaml").read_text())
    with pytest.raises(plumbline.InputError, match="described_world.yaml, which is read"):
        plumbline.render(str(own), tmp_path / "out", **few)
    assert own.exists()


def test_worlds_are_rendered():
    assert "room" in plumbline.worlds()
    world = plumbline.Synth("room", frames=2, scale=0.3, samples=1)
    frame = world[-1]
    assert len(world) == 2 and world.world == "room"
    assert frame.left.shape == frame.right.shape == frame.depth.shape == (144, 226)
    assert frame.left.std() > 10 and (frame.depth > 0).mean() > 0.9
    np.testing.assert_array_equal(frame.left, world[1].left)
    assert [f.stamp_ns for f in world] == world.ground_truth.stamps_ns.tolist()
    assert world.true_lines().shape[1:] == (2, 3)
