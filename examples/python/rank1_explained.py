# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""The start of a monocular map by rank-1 factorization, explained on real tracks.

    python rank1_explained.py data/MH_01_easy
    python rank1_explained.py             on a rendered room

A run gives the tracks: where each keyframe shows each point. Of one reference keyframe and the m
after it this takes what a single camera could know: the image coordinates, the rotations and the
*directions* of the motions. Neither the distances of the points nor the lengths of the motions go
in; one factorization gives all of them at once, up to a common scale. Then it takes the tracks apart
again: points that only the first and the last keyframe show are placed in those between by geometric
interpolation, which is what makes the matrix full. docs/methods/initialization.md has the equations.

Writes rank1.png.
"""
import argparse
import pathlib
from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import plumbline

Doubles = NDArray[np.float64]


@dataclass
class Tracks:
    """N points that a reference keyframe and M others show, and where the map has all of it."""
    reference: Doubles  # (N, 2) ideal image coordinates x/z, y/z
    views: Doubles  # (M, N, 2)
    sigmas: Doubles  # (M, N) of each coordinate
    cam_from_reference: Doubles  # (M, 4, 4)
    distances: Doubles  # (N,) from the reference camera


def choose_tracks(world: plumbline.Map, views: int) -> Tracks:
    """Those of the keyframes in a row that have most points in common."""
    table, ids = world.point_tracks, world.keyframe_ids
    shown = {int(k): table[table["keyframe"] == k] for k in ids}

    def common(start: int) -> list[int]:
        sets = [set(shown[int(k)]["point"].tolist()) for k in ids[start:start + views + 1]]
        return sorted(set.intersection(*sets))

    start = max(range(len(ids) - views), key=lambda i: len(common(i)))
    points = common(start)
    if len(points) < 20:
        raise SystemExit(f"rank1_explained: {views + 1} keyframes in a row have {len(points)} points "
                         "in common; 20 are needed")
    K = world.camera.K
    places: list[Doubles] = []
    sigmas: list[Doubles] = []
    for k in ids[start:start + views + 1]:
        rows = shown[int(k)][np.isin(shown[int(k)]["point"], points)]
        _, first = np.unique(rows["point"], return_index=True)
        places.append((rows["px"][first] - K[:2, 2]) / [K[0, 0], K[1, 1]])
        sigmas.append(rows["sigma_px"][first] / K[0, 0])
    poses = np.linalg.inv(world.keyframe_poses[start:start + views + 1])
    seen = world.points[np.searchsorted(world.point_ids, points)]
    in_reference = seen @ poses[0, :3, :3].T + poses[0, :3, 3]
    relative: Doubles = np.matmul(poses[1:], np.linalg.inv(poses[0]))
    return Tracks(places[0], np.array(places[1:]), np.array(sigmas[1:]), relative,
                  np.asarray(np.linalg.norm(in_reference, axis=1), dtype=np.float64))


def factorize(tracks: Tracks, views: Doubles, sigmas: Doubles) -> tuple[Doubles, Doubles]:
    """Centres (M, 3) and inverse distances (N,), in the map's unit."""
    rotations = np.swapaxes(tracks.cam_from_reference[:, :3, :3], 1, 2)
    centres = -np.einsum("mij,mj->mi", rotations, tracks.cam_from_reference[:, :3, 3])
    solution = plumbline.factorize_rank1(
        tracks.reference, views, sigmas, rotations,
        centres / np.linalg.norm(centres, axis=1)[:, None])  # directions alone
    if solution is None:
        raise SystemExit("rank1_explained: the tracks do not determine the motion")
    # The scale is free: taken from the map, to compare.
    scale = np.linalg.norm(centres)
    return solution["centres"] * scale, solution["inverse_distances"] / scale


def interpolated(tracks: Tracks, between: int) -> tuple[Doubles, Doubles]:
    """Places in a view of points matched in the reference and the last view alone, and by how many
    of their standard deviations they miss where the point was seen."""
    sigma = float(np.median(tracks.sigmas))
    found = plumbline.interpolate_points(
        tracks.reference, tracks.views[-1], tracks.cam_from_reference[between],
        tracks.cam_from_reference[-1], sigma)
    off = found["points"] - tracks.views[between]
    good = found["line_angles"] > np.radians(5)  # epipolar lines that meet at a wide angle
    spread = found["covariances"] + sigma**2 * np.eye(2)
    score = np.full(len(off), np.nan)
    score[good] = np.sqrt(np.einsum("ni,nij,nj->n", off[good], np.linalg.inv(spread[good]), off[good]))
    places = np.where(good[:, None], found["points"], np.nan)
    return places, score


def relative_errors(inverse: Doubles, distances: Doubles) -> Doubles:
    known = inverse > 0
    return np.abs(1 / inverse[known] - distances[known]) / distances[known]


def plot(tracks: Tracks, world: plumbline.Map, singular: Doubles, inverse: Doubles,
         scores: Doubles, path: pathlib.Path) -> None:
    figure, axes = plt.subplots(2, 2, figsize=(12, 9), layout="constrained")
    K = world.camera.K
    for k in range(len(tracks.reference)):
        line = np.vstack([tracks.reference[k], tracks.views[:, k]]) @ K[:2, :2].T + K[:2, 2]
        axes[0, 0].plot(line[:, 0], line[:, 1], "-", lw=0.8)
    axes[0, 0].set(title=f"{len(tracks.reference)} tracks through {len(tracks.views) + 1} keyframes",
                   xlabel="column [px]", ylabel="row [px]", aspect="equal",
                   xlim=(0, world.camera.width), ylim=(world.camera.height, 0))
    axes[0, 1].semilogy(np.arange(1, 7), singular[:6] / singular[0], "o-")
    axes[0, 1].set(title="singular values of the matrix of 3 m x n: rank one but for noise",
                   xlabel="number", ylabel="by the first")
    known = inverse > 0
    axes[1, 0].loglog(tracks.distances[known], 1 / inverse[known], ".", ms=3)
    ends = np.array([tracks.distances.min(), tracks.distances.max()])
    axes[1, 0].loglog(ends, ends, "k--", lw=1)
    axes[1, 0].set(title="distances of the points", xlabel="in the map", ylabel="by the factorization")
    axes[1, 1].hist(scores[np.isfinite(scores)], bins=30, range=(0, 6))
    axes[1, 1].set(title="interpolated places: off by how many standard deviations", xlabel="sigma",
                   ylabel="points")
    figure.savefig(path, dpi=120)
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path", nargs="?", type=pathlib.Path, help="default: a rendered room")
    parser.add_argument("--stop", type=int, default=60, help="frames to run on")
    parser.add_argument("--views", type=int, default=3, help="m, keyframes beside the reference")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    path = arguments.path
    if path is None:
        path = arguments.out / "room"
        if not path.exists():
            plumbline.render("room", path, frames=40, scale=0.5)

    world = plumbline.run(path, stop=arguments.stop).map
    if world is None:
        raise SystemExit("rank1_explained: the camera was not tracked")
    tracks = choose_tracks(world, arguments.views)
    rotations = np.swapaxes(tracks.cam_from_reference[:, :3, :3], 1, 2)
    centres = -np.einsum("mij,mj->mi", rotations, tracks.cam_from_reference[:, :3, 3])
    entries, weights = plumbline.rank1_matrix(tracks.reference, tracks.views, tracks.sigmas, rotations,
                                              centres)
    whitened = entries * np.sqrt(np.repeat(weights / weights.max(), 3, axis=0))
    singular = np.linalg.svd(whitened, compute_uv=False)
    print(f"matrix of {entries.shape[0]} x {entries.shape[1]}: the second singular value is "
          f"{singular[1] / singular[0]:.1e} of the first")

    found, inverse = factorize(tracks, tracks.views, tracks.sigmas)
    off = np.linalg.norm(found - centres) / np.linalg.norm(centres)
    print(f"all tracks: centres off by {100 * off:.1f} % of their size, distances by "
          f"{100 * np.median(relative_errors(inverse, tracks.distances)):.1f} % (median)")

    # Every second point is seen in the last view alone, and interpolated between.
    views, sigmas = tracks.views.copy(), tracks.sigmas.copy()
    scores: list[Doubles] = []
    half = np.arange(len(tracks.reference)) % 2 == 0
    for between in range(arguments.views - 1):
        places, score = interpolated(tracks, between)
        views[between, half] = places[half]
        scores.append(score)
        sigmas[between, half] = np.where(np.isfinite(places[half, 0]), sigmas[between, half], 0)
    found, completed = factorize(tracks, views, sigmas)
    off = np.linalg.norm(found - centres) / np.linalg.norm(centres)
    print(f"half of them interpolated: centres off by {100 * off:.1f} %, distances by "
          f"{100 * np.median(relative_errors(completed, tracks.distances)):.1f} % (median)")

    plot(tracks, world, singular, inverse, np.concatenate(scores), arguments.out / "rank1.png")
    print(f"written: {arguments.out / 'rank1.png'}")


if __name__ == "__main__":
    main()
