# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Poses from points and lines, and bundle adjustment."""
import numpy as np
import pytest

import plumbline

CAMERA = plumbline.RectifiedCamera(450, 450, 376, 240, 752, 480, baseline=0.11)


def turned(angles):
    x, y, z = angles
    rx = np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]])
    ry = np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]])
    rz = np.array([[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]])
    return rx @ ry @ rz


def pose(angles, place):
    out = np.eye(4)
    out[:3, :3] = turned(angles)
    out[:3, 3] = place
    return out


def project(cam_from_world, points):
    seen = points @ cam_from_world[:3, :3].T + cam_from_world[:3, 3]
    pixels = seen @ CAMERA.K.T
    return pixels[..., :2] / pixels[..., 2:], CAMERA.fx * CAMERA.baseline / seen[..., 2]


def pluecker(segments):
    direction = segments[:, 1] - segments[:, 0]
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return np.hstack([np.cross(segments[:, 0], direction), direction])


def landmarks(rng, count):
    return rng.uniform([-2, -1.5, 4], [2, 1.5, 8], (count, 3))


TRUE = pose([0.05, -0.1, 0.02], [0.2, -0.1, 0.3])


def test_a_pose_from_points():
    rng = np.random.default_rng(1)
    world = landmarks(rng, 40)
    pixels, disparities = project(TRUE, world)
    pixels[:5] += 60  # wrong matches
    found = plumbline.solve_pose(CAMERA, np.eye(4), points=dict(
        world=world, pixels=pixels, sigma_px=0.8, disparities=disparities))
    assert found["converged"]
    np.testing.assert_allclose(found["cam_from_world"], TRUE, atol=1e-7)
    assert found["point_inliers"].tolist() == [False] * 5 + [True] * 35
    assert (np.linalg.eigvalsh(found["information"]) > 0).all()


def test_a_pose_from_lines_alone_and_with_points():
    rng = np.random.default_rng(2)
    segments = landmarks(rng, 40).reshape(20, 2, 3)
    image = project(TRUE, segments)[0]
    lines = dict(world=pluecker(segments), segments=image, sigma_px=np.full(20, 0.5))
    found = plumbline.solve_pose(CAMERA, np.eye(4), lines=lines)
    assert found["converged"]
    np.testing.assert_allclose(found["cam_from_world"], TRUE, atol=1e-6)
    assert found["line_inliers"].all() and found["point_inliers"].shape == (0,)
    world = landmarks(rng, 10)
    both = plumbline.solve_pose(CAMERA, np.eye(4), lines=lines, points=dict(
        world=world, pixels=project(TRUE, world)[0]), rounds=2)
    np.testing.assert_allclose(both["cam_from_world"], TRUE, atol=1e-6)
    assert np.trace(both["information"]) > np.trace(found["information"])


@pytest.mark.parametrize("sigma", [0.8, np.float32(0.8), np.array(0.8), np.full(40, 0.8)])
def test_one_deviation_of_all_is_a_number_of_any_kind(sigma):
    world = landmarks(np.random.default_rng(4), 40)
    pixels = project(TRUE, world)[0]
    found = plumbline.solve_pose(CAMERA, np.eye(4), points=dict(
        world=world, pixels=pixels, sigma_px=sigma))
    np.testing.assert_allclose(found["cam_from_world"], TRUE, atol=1e-7)
    whole = plumbline.solve_pose(CAMERA, np.eye(4), points=dict(
        world=world, pixels=pixels, sigma_px=np.int64(2)))
    assert np.trace(found["information"]) > np.trace(whole["information"])


def test_bundle_adjustment_of_points_and_lines():
    rng = np.random.default_rng(3)
    poses = np.array([pose(rng.normal(0, 0.05, 3), [0.3 * i, 0.02 * i, 0]) for i in range(4)])
    poses[0] = np.eye(4)
    world, segments = landmarks(rng, 60), landmarks(rng, 40).reshape(20, 2, 3)
    seen = [project(p, world) for p in poses]
    images = [project(p, segments)[0] for p in poses]
    start = poses.copy()
    start[1:, :3, 3] += rng.normal(0, 0.02, (3, 3))
    result = plumbline.bundle_adjust(
        CAMERA, start,
        points=world + rng.normal(0, 0.03, world.shape),
        point_observations=dict(
            pose=np.repeat(np.arange(4), 60), point=np.tile(np.arange(60), 4),
            pixels=np.concatenate([s[0] for s in seen]),
            disparities=np.concatenate([s[1] for s in seen]), disparity_sigma_px=0.7),
        lines=pluecker(segments + rng.normal(0, 0.01, segments.shape)),
        line_observations=dict(
            pose=np.repeat(np.arange(4), 20), line=np.tile(np.arange(20), 4),
            segments=np.concatenate(images)),
        max_iterations=50, function_tolerance=1e-12)
    assert result["final_cost"] < 1e-6 < result["initial_cost"]
    np.testing.assert_array_equal(result["cam_from_world"][0], poses[0])
    np.testing.assert_allclose(result["cam_from_world"], poses, atol=1e-4)
    np.testing.assert_allclose(result["points"], world, atol=1e-3)
    np.testing.assert_allclose(result["lines"], pluecker(segments), atol=2e-2)
    assert result["point_inliers"].all() and result["line_inliers"].all()
    assert result["point_chi2"].shape == (240,) and result["line_chi2"].shape == (80,)
    assert result["termination"] in ("converged", "max_iterations", "no_progress")


def test_nothing_to_do():
    result = plumbline.bundle_adjust(CAMERA, [np.eye(4)], points=[[0, 0, 5.0]])
    assert result["termination"] == "nothing_to_do"
    np.testing.assert_array_equal(result["points"], [[0, 0, 5]])
