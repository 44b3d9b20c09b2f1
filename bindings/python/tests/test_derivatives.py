"""Derivatives of squared distances: against finite differences, and against the distances of contacts."""

from __future__ import annotations

import numpy as np
import pliant
import pytest
from pliant import FeatureKind, Selection, derivatives

from test_close_pairs import bodies


def rows(kind: FeatureKind, count: int) -> np.ndarray:
    """Corners whose distance is neither small nor near a change of features."""
    random = np.random.default_rng(int(kind))
    corners = random.normal(size=(count, 4, 3))
    used = {FeatureKind.VERTEX_VERTEX: 2, FeatureKind.VERTEX_EDGE: 3}.get(kind, 4)
    corners[:, used:] = 0
    return corners


@pytest.mark.parametrize("kind", FeatureKind)
def test_finite_differences_agree(kind: FeatureKind) -> None:
    corners = rows(kind, 200)
    kinds = np.full(len(corners), kind)
    _, gradient, hessian = derivatives.squared_distance(kinds, corners)
    step = 1e-5
    difference = np.zeros_like(gradient).reshape(-1, 12)
    second = np.zeros_like(hessian)
    for at in range(12):
        moved = [corners.copy(), corners.copy()]
        for sign, shape in zip((1, -1), moved, strict=True):
            shape.reshape(-1, 12)[:, at] += sign * step
        (above, of_above, _), (below, of_below, _) = (derivatives.squared_distance(kinds, shape) for shape in moved)
        difference[:, at] = (above - below) / (2 * step)
        second[:, at] = (of_above - of_below).reshape(-1, 12) / (2 * step)
    scale = 1 + abs(hessian).max((1, 2))
    assert (abs(difference - gradient.reshape(-1, 12)).max(1) <= 1e-6 * scale).all()
    assert np.median(abs(second - hessian).max((1, 2)) / scale) <= 1e-6
    assert (abs(second - hessian).max((1, 2)) <= 1e-4 * scale**2).all()
    assert np.allclose(hessian, hessian.transpose(0, 2, 1), rtol=0, atol=1e-9 * scale.max())
    # Nothing of it changes when all move alike.
    assert np.allclose(gradient.sum(1), 0, atol=1e-12)
    assert np.allclose(hessian.reshape(-1, 12, 4, 3).sum(2), 0, atol=1e-8 * scale.max())


def test_squares_are_those_of_contacts() -> None:
    world, _, _ = bodies(np.float64)
    contacts = pliant.feature_pairs(world, Selection.EVERYTHING, 0.5)
    assert len(set(contacts.kind.tolist())) == 4
    corners = derivatives.corners(contacts, {body: world.positions(body) for body in world.bodies()})
    square, gradient, hessian = derivatives.squared_distance(contacts.kind, corners)
    assert np.allclose(square, contacts.distance**2, rtol=1e-9, atol=1e-14)
    first = np.where(contacts.kind == FeatureKind.EDGE_EDGE, 2, 1)
    signs = np.where(np.arange(4) < first[:, None], 1, -1)
    expected = 2 * (contacts.distance * contacts.direction.T).T[:, None] * (signs * contacts.weights)[:, :, None]
    assert np.allclose(gradient, expected, atol=1e-8)
    positive = derivatives.positive_part(hessian)
    least = np.linalg.eigvalsh(positive)[:, 0]
    assert (least > -1e-9).all() and np.linalg.eigvalsh(hessian)[:, 0].min() < -0.1
    # What is positive is left as it is.
    assert np.allclose(derivatives.positive_part(positive), positive, atol=1e-9)


def test_nothing_is_well() -> None:
    square, gradient, hessian = derivatives.squared_distance(np.zeros(0, np.uint8), np.zeros((0, 4, 3)))
    assert (square.shape, gradient.shape, hessian.shape) == ((0,), (0, 4, 3), (0, 12, 12))
