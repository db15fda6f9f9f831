# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""A first run: track a sequence, look at what came of it, plot it.

    python first_run.py                   renders a short sequence of a room and runs on it
    python first_run.py data/MH_01_easy   runs on a sequence of yours

Writes first_run.png beside the files of `plumbline run` (report.html is the page to open next).
"""
import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import plumbline


def plot(run: plumbline.Run, path: pathlib.Path) -> None:
    """The map with the trajectory from above, and the error over time where the truth is known."""
    truth, errors = run.dataset.ground_truth, run.errors
    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 9), height_ratios=[3, 1],
                                          layout="constrained")
    if run.map is not None:
        points, lines = run.map.points, run.map.line_map()["segments"]
        above.plot(points[:, 0], points[:, 2], ".", color="0.75", ms=1.5, label="points")
        for segment in lines:
            above.plot(segment[:, 0], segment[:, 2], "-", color="tab:orange", lw=0.8)
        # The room and the way, not the farthest points.
        corners = np.vstack([np.percentile(points, [3, 97], axis=0), run.trajectory.positions])
        low, high = corners.min(axis=0) - 0.2, corners.max(axis=0) + 0.2
        above.set(xlim=(low[0], high[0]), ylim=(low[2], high[2]))
    if truth is not None and errors is not None:
        to_map = np.linalg.inv(errors["reference_from_estimate"])
        places = truth.positions @ to_map[:3, :3].T + to_map[:3, 3]
        above.plot(places[:, 0], places[:, 2], "k--", lw=1, label="truth")
        seconds = 1e-9 * (errors["stamps_ns"] - errors["stamps_ns"][0])
        below.plot(seconds, 1e3 * errors["position_errors"], lw=1)
    places = run.trajectory.positions
    above.plot(places[:, 0], places[:, 2], "-", color="tab:blue", label="estimate")
    above.set(xlabel="x [m]", ylabel="z [m]", aspect="equal", title=f"{run.dataset.name} from above")
    above.legend()
    below.set(xlabel="time [s]", ylabel="position error [mm]")
    figure.savefig(path, dpi=120)
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("path", nargs="?", type=pathlib.Path, help="default: a rendered room")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("first_run"))
    parser.add_argument("--stop", type=int, help="frames to run on")
    arguments = parser.parse_args()

    path = arguments.path
    if path is None:
        path = arguments.out.with_name(arguments.out.name + "_room")
        if not path.exists():
            plumbline.render("room", path, frames=60, scale=0.5)

    run = plumbline.run(path, stop=arguments.stop, out=arguments.out,
                        on_event=lambda event: print(f"{event['kind']} at frame {event['frame']}"))
    print(run)
    print(run.map)
    if run.errors is not None:
        print(f"ATE {1e3 * run.errors['ate']['rmse']:.1f} mm over {run.errors['ate']['count']} poses")
    plot(run, arguments.out / "first_run.png")
    print(f"written: {arguments.out / 'first_run.png'}, {arguments.out / 'report.html'}")


if __name__ == "__main__":
    main()
