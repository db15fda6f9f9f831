#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Checks `plumbline evaluate` against an independent implementation with numpy.

usage: evaluate_oracle.py PLUMBLINE_BINARY

Makes a noisy trajectory with gaps, runs the binary with many combinations of options and compares
every figure of its JSON to 1e-9 relative. Rotations are handled as matrices here, not as
quaternions. Exit status: 0 agreement, 1 disagreement, 77 numpy is missing.
"""
import decimal
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("numpy is not installed: skipped")
    sys.exit(77)

TOLERANCE = 1e-9


def rotation_exp(w):
    angle = np.linalg.norm(w)
    if angle == 0:
        return np.eye(3)
    k = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]]) / angle
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def rotation_vector(r):
    """Axis times angle, for angles well below pi."""
    v = 0.5 * np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    sine = np.linalg.norm(v)
    if sine == 0:
        return np.zeros(3)
    return v / sine * np.arctan2(sine, 0.5 * (np.trace(r) - 1))


def rotation_angle(r):
    return np.linalg.norm(rotation_vector(r))


def quaternion_from_rotation(r):
    """(x, y, z, w); only for writing files."""
    w, v = np.linalg.eigh(np.array([
        [r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
        [r[0, 1] + r[1, 0], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
        [r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], r[2, 2] - r[0, 0] - r[1, 1], 0],
        [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], np.trace(r)]]), UPLO="L")
    return v[:, 3]


def rotation_from_quaternion(q):
    x, y, z, w = np.asarray(q) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def pose_matrix(r, t):
    m = np.eye(4)
    m[:3, :3], m[:3, 3] = r, t
    return m


def write_tum(path, rows):
    with open(path, "w") as file:
        for stamp, pose in rows:
            numbers = list(pose[:3, 3]) + list(quaternion_from_rotation(pose[:3, :3]))
            seconds = f"{stamp // 10**9}.{stamp % 10**9:09d}"
            file.write(seconds + "".join(f" {v:.12f}" for v in numbers) + "\n")


def read_tum(path):
    rows = []
    for line in open(path):
        fields = line.split()
        v = [float(f) for f in fields[1:]]
        rows.append((int(decimal.Decimal(fields[0]) * 10**9),
                     pose_matrix(rotation_from_quaternion(v[3:]), v[:3])))
    return rows


def interpolate(reference, stamp, max_gap):
    stamps = [s for s, _ in reference]
    i = int(np.searchsorted(stamps, stamp))
    if i < len(stamps) and stamps[i] == stamp:
        return reference[i][1]
    if i == 0 or i == len(stamps) or stamps[i] - stamps[i - 1] > max_gap:
        return None
    a, b = reference[i - 1][1], reference[i][1]
    s = (stamp - stamps[i - 1]) / (stamps[i] - stamps[i - 1])
    r = a[:3, :3] @ rotation_exp(s * rotation_vector(a[:3, :3].T @ b[:3, :3]))
    return pose_matrix(r, (1 - s) * a[:3, 3] + s * b[:3, 3])


def nearest(stamps, stamp, max_difference):
    differences = [abs(s - stamp) for s in stamps]
    i = int(np.argmin(differences))  # the first of equals
    return i if differences[i] <= max_difference else None


def umeyama(source, target, with_scale):
    ms, mt = source.mean(0), target.mean(0)
    s, t = source - ms, target - mt
    u, d, vt = np.linalg.svd(t.T @ s / len(s))
    e = np.diag([1, 1, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    r = u @ e @ vt
    scale = np.trace(np.diag(d) @ e) / (s ** 2).sum(1).mean() if with_scale else 1.0
    return scale, r, mt - scale * r @ ms


def statistics(errors):
    if not errors:
        return None
    e = np.array(errors)
    return {"count": len(e), "rmse": np.sqrt((e ** 2).mean()), "mean": e.mean(),
            "median": np.median(e), "max": e.max()}


def window_pairs(matched, estimate, delta):
    number, unit = float(delta[:-1]), delta[-1]
    if unit == "s":
        stamps = [estimate[row][0] for row, _ in matched]
        window = int(round(number * 1e9))
        for a, stamp in enumerate(stamps):
            b = nearest(stamps, stamp + window, window // 20)
            if b is not None and b > a:
                yield a, b
        return
    longest = 1.5 * number * np.median(np.diff([s for s, _ in estimate]))
    place = {row: i for i, (row, _) in enumerate(matched)}
    for a, (row, _) in enumerate(matched):
        b = place.get(row + int(number))
        if b is not None and estimate[row + int(number)][0] - estimate[row][0] <= longest:
            yield a, b


def evaluate(reference, estimate, align, delta, associate):
    matched = []
    for row, (stamp, _) in enumerate(estimate):
        if associate == "interpolate":
            pose = interpolate(reference, stamp, 10**8)
        else:
            i = nearest([s for s, _ in reference], stamp, 2 * 10**7)
            pose = None if i is None else reference[i][1]
        if pose is not None:
            matched.append((row, pose))
    target = np.array([pose[:3, 3] for _, pose in matched])
    source = np.array([estimate[row][1][:3, 3] for row, _ in matched])
    scale, r, t = (1.0, np.eye(3), np.zeros(3)) if align == "none" else \
        umeyama(source, target, align == "sim3")
    aligned = [pose_matrix(r @ estimate[row][1][:3, :3], scale * r @ estimate[row][1][:3, 3] + t)
               for row, _ in matched]
    rpe, roe = [], []
    for a, b in window_pairs(matched, estimate, delta):
        motion_ref = np.linalg.inv(matched[a][1]) @ matched[b][1]
        motion_est = np.linalg.inv(aligned[a]) @ aligned[b]
        error = np.linalg.inv(motion_ref) @ motion_est
        seconds = (estimate[matched[b][0]][0] - estimate[matched[a][0]][0]) * 1e-9
        rpe.append(np.linalg.norm(error[:3, 3]) / seconds)
        roe.append(np.degrees(rotation_angle(error[:3, :3])) / seconds)
    ate = [np.linalg.norm(pose[:3, 3] - t) for pose, t in zip(aligned, target)]
    return {"frames_with_pose": len(estimate), "frames_compared": len(matched), "scale": scale,
            "ate_m": statistics(ate), "rpe_m_per_s": statistics(rpe),
            "roe_deg_per_s": statistics(roe)}


def make_trajectories(rng):
    start = 1403636584763555584
    def truth(stamp):
        t = (stamp - start) * 1e-9
        return pose_matrix(rotation_exp(np.array([0.4 * np.sin(t), 0.3 * np.cos(0.7 * t), 0.5 * t])),
                           [2 * np.sin(0.5 * t), 1.5 * np.cos(0.4 * t), 0.3 * np.sin(1.1 * t)])
    reference = [(s, truth(s)) for s in (start + i * 10**7 for i in range(1200))
                 if not 4.0 < (s - start) * 1e-9 < 4.5]
    world = pose_matrix(rotation_exp(np.array([0.3, -1.0, 0.7])), [4, -3, 2])
    estimate = []
    for i in range(-3, 245):
        stamp = start + i * 49999872 + 1234567
        if 90 < i < 99 or i == 150:
            continue
        drift = pose_matrix(rotation_exp(0.01 * rng.standard_normal(3)),
                            0.02 * rng.standard_normal(3))
        pose = world @ truth(stamp) @ drift
        pose[:3, 3] *= 0.8
        estimate.append((stamp, pose))
    return reference, estimate


def differences(expected, found, path=""):
    if isinstance(expected, dict) and isinstance(found, dict):
        for key, value in expected.items():
            yield from differences(value, found.get(key), f"{path}.{key}")
    elif expected is None or found is None:
        if expected is not found:
            yield f"{path}: expected {expected}, found {found}"
    elif abs(expected - found) > TOLERANCE * max(abs(expected), 1e-12):
        yield f"{path}: expected {expected!r}, found {found!r}"


def main():
    binary = sys.argv[1]
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        reference, estimate = make_trajectories(np.random.default_rng(7))
        write_tum(root / "reference.txt", reference)
        write_tum(root / "estimate.txt", estimate)
        reference, estimate = read_tum(root / "reference.txt"), read_tum(root / "estimate.txt")
        cases = list(itertools.product(["none", "se3", "sim3"], ["3s", "0.5s", "1f", "20f"],
                                       ["interpolate", "nearest"]))
        for align, delta, associate in cases:
            command = [binary, "evaluate", root / "reference.txt", root / "estimate.txt", "--align",
                       align, "--delta", delta, "--associate", associate, "--json",
                       root / "out.json"]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            found = json.loads((root / "out.json").read_text())
            expected = evaluate(reference, estimate, align, delta, associate)
            name = f"{align} {delta} {associate}"
            assert expected["rpe_m_per_s"] is not None and expected["frames_compared"] > 200, name
            problems += [f"{name}: {text}" for text in differences(expected, found)]
    print("\n".join(problems) or f"{len(cases)} combinations agree")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
