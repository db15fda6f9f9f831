# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""Calibrations from numbers."""
from __future__ import annotations

import numbers
from collections.abc import Collection

from ._plumbline import Calibration, InputError


def _number(name: str, value: object) -> str:
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise InputError(f"{name}: expected a number, found {type(value).__name__}")
    return repr(value.item() if hasattr(value, "item") else value)


def pinhole(width: int, height: int, fx: float, fy: float, cx: float, cy: float, *,
            distortion: str = "none", coefficients: Collection[float] = (),
            rectified: bool = False, baseline: float | None = None,
            depth_factor: float | None = None, rate_hz: float | None = None) -> Calibration:
    """The calibration of one camera, of a rectified pair or of an RGB-D camera.

    width, height, focal lengths and principal point in pixels; distortion "none", "radtan" (k1 k2
    p1 p2 [k3]) or "equidistant" (k1 k2 k3 k4) with its coefficients. baseline: metres to a second,
    equal camera of a rectified pair. depth_factor: value of a 16-bit depth image per metre.
    Raises InputError for what no real sensor has. A pair that is not rectified is read from a camera
    file (Calibration.load, Calibration.parse).
    """
    rectified = bool(rectified) or baseline is not None
    own = [
        "model: pinhole",
        f"size: [{_number('width', width)}, {_number('height', height)}]",
        "intrinsics: [" + ", ".join(
            _number(name, value)
            for name, value in (("fx", fx), ("fy", fy), ("cx", cx), ("cy", cy))) + "]",
    ]
    if not isinstance(distortion, str):
        raise InputError(f"distortion: expected a text, found {type(distortion).__name__}")
    if distortion != "none":
        listed = ", ".join(_number("coefficients", value) for value in coefficients)
        own += [f"distortion: {distortion}", f"distortion_coefficients: [{listed}]"]
    elif len(coefficients) > 0:
        raise InputError(
            f"coefficients: expected none without distortion, found {len(coefficients)}")
    text = list(own)
    if rectified:
        text.append("rectified: true")
    for name, value in (("rate_hz", rate_hz), ("depth_factor", depth_factor),
                        ("baseline", baseline)):
        if value is not None:
            text.append(f"{name}: {_number(name, value)}")
    if baseline is not None:
        text += ["right:"] + ["  " + line for line in own]
    return Calibration.parse("\n".join(text) + "\n")
