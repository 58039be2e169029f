# SPDX-License-Identifier: BSD-3-Clause
"""FRESCO_BIN names the folder of the tools."""
from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import fresco
import numpy as np
import pytest

Tool = Callable[..., None]


def run_tool(name: str, *words: object) -> None:
    subprocess.run([os.path.join(os.environ["FRESCO_BIN"], f"fresco_{name}"), *map(str, words), "-quiet"], check=True)


@pytest.fixture(scope="session")
def tool() -> Tool:
    return run_tool


@pytest.fixture(scope="session")
def room(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two scans and three photographs of a virtual room."""
    folder = tmp_path_factory.mktemp("room") / "data"
    run_tool("scan", "conference_room", folder, "-stations", 2, "-points", 8000, "-views", 3, "-images", "120x90")
    return folder


@pytest.fixture(scope="session")
def oriented(room: Path) -> fresco.PointSet:
    points = fresco.read_points(room / "scans/scan_00.pcd")
    points.normals = fresco.estimate_normals(points).normals
    return points


@pytest.fixture(scope="session")
def sphere() -> fresco.PointSet:
    directions = np.random.default_rng(7).normal(size=(5000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    normals = directions.astype(np.float32)
    return fresco.PointSet(normals.copy(), normals=normals)
