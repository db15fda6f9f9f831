# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests share: a rendered sequence and a run on it, that nobody changes."""
import os
import pathlib

import pytest

import plumbline


@pytest.fixture(scope="session")
def sequence(tmp_path_factory) -> pathlib.Path:
    given = os.environ.get("PLUMBLINE_TEST_SEQUENCE")
    if given:
        return pathlib.Path(given)
    path = tmp_path_factory.mktemp("rendered") / "room"
    plumbline.render("room", path, frames=12, rate_hz=10, scale=0.5, samples=1)
    return path


@pytest.fixture(scope="session")
def dataset(sequence):
    return plumbline.open(sequence)


@pytest.fixture(scope="session")
def finished(dataset):
    return plumbline.run(dataset)


@pytest.fixture(scope="session")
def program() -> str:
    path = os.environ.get("PLUMBLINE_BINARY")
    if not path:
        pytest.skip("PLUMBLINE_BINARY does not name the program")
    return path
