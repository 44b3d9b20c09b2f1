"""What a body looks like now: its faces, its positions, and the boxes of its tree."""

from __future__ import annotations

import numpy as np
import pliant
import pytest
from conftest import fold, grid, pairs_between


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_faces_and_positions_come_back(dtype: type[np.floating]) -> None:
    faces, flat = grid(4)
    world = pliant.World()
    body = world.add(faces, flat.astype(dtype))
    shape = fold(flat, 0.5).astype(dtype)
    world.set_positions(body, shape)
    assert world.triangles(body).dtype == np.uint32 and (world.triangles(body) == faces).all()
    now = world.positions(body)
    assert now.dtype == dtype and (now == shape).all()
    now[:] = 0  # A copy: the world keeps its shape.
    assert (world.positions(body) == shape).all()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_boxes_are_those_of_the_parts_and_valid_when_they_were_needed(dtype: type[np.floating]) -> None:
    faces, flat = grid(16)
    world = pliant.World(update="top-down")
    body = world.add(faces, flat.astype(dtype))
    needle = world.add([[0, 1, 2]], np.array([[0.5, 0.5, -1], [0.5, 0.5, 1], [0.51, 0.5, 1]], dtype))
    shape = fold(flat, 0.1).astype(dtype)
    world.set_positions(body, shape)
    depth = world.tree_shape(body).depth
    for level in range(depth + 1):
        boxes, parts = world.tree_boxes(body, level), world.tree_cut(body, level)
        assert boxes.lower.dtype == dtype and not boxes.valid.any()
        for part, (lower, upper) in enumerate(zip(boxes.lower, boxes.upper, strict=True)):
            corners = shape[faces[parts == part]].reshape(-1, 3)
            assert (lower == corners.min(axis=0)).all() and (upper == corners.max(axis=0)).all()
    assert len(pairs_between(world, body, needle)) > 0
    valid = [world.tree_boxes(body, level).valid for level in range(depth + 1)]
    assert valid[0].all() and 0 < valid[-1].sum() < len(valid[-1])
    world.set_positions(body, shape)
    assert not any(world.tree_boxes(body, level).valid.any() for level in range(depth + 1))
