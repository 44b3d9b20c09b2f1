"""Small meshes, and the folder of real ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pliant
import pytest
from numpy.typing import NDArray

HERE = Path(__file__).parent
#: Real meshes, beside the checkout; tests that read them skip where they are absent.
DATA = HERE.parents[3] / "shared" / "data"


def data(name: str) -> Path:
    """A file of the data folder, or a skip that says so."""
    if not (DATA / name).exists():
        pytest.skip(f"there is no shared/data/{name} beside the checkout")
    return DATA / name


def grid(n: int) -> tuple[NDArray[np.uint32], NDArray[np.float64]]:
    """A flat square sheet of 2 n^2 triangles, side 1, at z = 0."""
    x, y = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
    positions = np.stack([x.ravel() / n, y.ravel() / n, np.zeros((n + 1) ** 2)], axis=1)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    a, b, c, d = (i * (n + 1) + j, (i + 1) * (n + 1) + j, (i + 1) * (n + 1) + j + 1, i * (n + 1) + j + 1)
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return faces.astype(np.uint32), positions


def fold(positions: NDArray[np.float64], amount: float) -> NDArray[np.float64]:
    """The sheet in waves, which meet themselves when the amount is large."""
    x, y, _ = positions.T
    return np.stack([x + 0.35 * amount * np.sin(9 * x + y), y, 0.2 * np.cos(9 * x) + 0.05 * amount * np.sin(7 * y)], axis=1)


def pairs_between(world: pliant.World, a: int, b: int) -> NDArray[np.uint32]:
    """The triangles of all hits of two bodies, (k, 2) as the reference has them; each hit names the bodies in the order asked."""
    hits = world.intersections(pliant.Selection.between(a, b)).all()
    assert hits.dtype == np.uint32 and (hits[:, [0, 2]] == [a, b]).all()
    return hits[:, [1, 3]]


def pairs_within(world: pliant.World, body: int) -> NDArray[np.uint32]:
    """The triangles of all hits of a body with itself, (k, 2) as the reference has them."""
    hits = world.intersections(pliant.Selection.within(body)).all()
    assert hits.dtype == np.uint32 and (hits[:, [0, 2]] == body).all()
    return hits[:, [1, 3]]
