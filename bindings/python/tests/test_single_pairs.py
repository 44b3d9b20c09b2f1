"""Single pairs: distances and contacts known by hand, and those that worlds find."""

from __future__ import annotations

from typing import Any

import numpy as np
import pliant
import pytest
from pliant import ContactKind, FeatureKind, Selection

from test_candidates import sheet


def test_distances_by_hand() -> None:
    corners = np.array([[[1, 1, 2], [0, 0, 0], [4, 0, 0], [0, 4, 0]], [[1, 1, 0], [0, 0, 0], [4, 0, 0], [0, 4, 0]]])
    found = pliant.vertex_triangle_distances(corners.astype(np.float32))
    assert found.distance.tolist() == [2, 0] and found.direction.tolist() == [[0, 0, 1], [0, 0, 0]]
    assert found.weights.tolist() == [[1, 0.5, 0.25, 0.25]] * 2
    assert found.kind.tolist() == [FeatureKind.VERTEX_FACE] * 2
    edges = np.array([[[-1, 0, 1], [1, 0, 1], [0, -1, 0], [0, 1, 0]], [[2, 0, 0], [3, 0, 0], [0, -1, 0], [0, 1, 0]]], dtype=float)
    found = pliant.edge_edge_distances(edges)
    assert found.distance.tolist() == [1, 2] and found.direction.tolist() == [[0, 0, 1], [1, 0, 0]]
    assert found.kind.tolist() == [FeatureKind.EDGE_EDGE, FeatureKind.VERTEX_EDGE]
    assert [len(column) for column in pliant.edge_edge_distances(edges[:0])] == [0] * 4


def test_contacts_by_hand() -> None:
    floor = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0]], dtype=float)
    leaves = [np.array([[1, 1, z], [1, 1, 9], [2, 1, 9]]) for z in (1e-300, 0, -1e-300)] + [floor / 4 + [1, 1, 0]]
    kinds = pliant.triangle_contacts(np.array([[*floor, *leaf] for leaf in leaves]))
    assert kinds.dtype == np.int8
    assert kinds.tolist() == [-1, ContactKind.TOUCHING, ContactKind.CROSSING, ContactKind.OVERLAPPING]


@pytest.mark.parametrize(
    ("ask", "corners"),
    [(pliant.vertex_triangle_distances, 4), (pliant.edge_edge_distances, 4), (pliant.triangle_contacts, 6)],
)
def test_what_is_refused(ask: Any, corners: int) -> None:
    for array, kind in ((np.zeros((2, 5, 3)), "BadArray"), (np.full((2, corners, 3), np.inf), "BadCorner")):
        with pytest.raises(pliant.Error) as refused:
            ask(array)
        assert refused.value.kind == kind


def test_worlds_say_what_single_pairs_say() -> None:
    random = np.random.default_rng(5)
    faces, flat = sheet(5)
    world = pliant.World()
    shapes = [flat + random.normal(0, 0.2, flat.shape) for _ in range(2)]
    for shape in shapes:
        world.add(faces, shape)
    close = world.close_vertex_triangle_pairs(Selection.WORLD, 0.3).all()
    assert len(close.pairs) > 20
    corners = [[shapes[a][vertex], *shapes[b][faces[triangle]]] for a, vertex, b, triangle in close.pairs]
    found = pliant.vertex_triangle_distances(corners)
    assert found.distance.tobytes() == close.distance.tobytes()
    assert found.direction.tobytes() == close.direction.tobytes()
    assert found.weights[:, 1:].tobytes() == close.barycentric.tobytes()
    assert found.kind.tolist() == close.features().tolist()
    contacts = world.contacts(Selection.WORLD).all()
    triangles = [[*shapes[a][faces[i]], *shapes[b][faces[j]]] for a, i, b, j in contacts.pairs]
    assert len(contacts.pairs) > 20 and pliant.triangle_contacts(triangles).tolist() == contacts.kind.tolist()
