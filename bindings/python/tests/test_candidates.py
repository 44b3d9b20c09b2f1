"""Candidates within a margin, and motions: lists against comparing all with all, in plain numpy and integers."""

from __future__ import annotations

import copy
import pickle
from itertools import combinations, product
from typing import Any

import numpy as np
import pliant
import pytest
from pliant import Selection


def sheet(side: int) -> tuple[Any, Any]:
    at = np.arange(side * side).reshape(side, side)
    a, b, c, d = (corner.ravel() for corner in (at[:-1, :-1], at[:-1, 1:], at[1:, :-1], at[1:, 1:]))
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    return np.concatenate([np.stack([a, b, c], 1), np.stack([b, d, c], 1)]), np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], 1).astype(np.float64)


def boxes(elements: Any, start: Any, end: Any) -> tuple[Any, Any]:
    corners = np.concatenate([start[elements], end[elements]], 1)
    return corners.min(1), corners.max(1)


def expected(bodies: list[tuple[int, Any, Any, Any]], edges: dict[int, Any], radius: float) -> tuple[list[tuple[int, ...]], list[tuple[int, ...]]]:
    """On a lattice of eighths numpy's differences are exact."""

    def near(a: Any, b: Any) -> bool:
        return bool((a[0] - b[1] <= 2 * radius).all() and (b[0] - a[1] <= 2 * radius).all())

    vertex_triangle, edge_edge = [], []
    for (i, faces_i, start_i, end_i), (j, faces_j, start_j, end_j) in product(bodies, bodies):
        lo, hi = boxes(faces_j, start_j, end_j)
        for v in np.unique(faces_i):
            one = boxes(np.array([[v]]), start_i, end_i)
            hits = [t for t in range(len(faces_j)) if near((one[0][0], one[1][0]), (lo[t], hi[t])) and not (i == j and v in faces_j[t])]
            vertex_triangle += [(i, int(v), j, t) for t in hits]
    all_edges = [(i, e, edge, *boxes(np.array([edge]), start, end)) for i, _, start, end in bodies for e, edge in enumerate(edges[i])]
    for (i, e, ends_e, lo_e, hi_e), (j, f, ends_f, lo_f, hi_f) in combinations(all_edges, 2):
        if near((lo_e[0], hi_e[0]), (lo_f[0], hi_f[0])) and not (i == j and set(ends_e) & set(ends_f)):
            edge_edge.append((i, e, j, f))
    return sorted(vertex_triangle), sorted(edge_edge)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("radius", [0.0, 0.125, 0.25])
def test_lists_are_those_of_comparing_all_with_all(dtype: Any, radius: float) -> None:
    random = np.random.default_rng(3)
    faces, flat = sheet(4)
    world = pliant.World(leaf_size=2)
    bodies = []
    for height in (0.0, 0.5):
        start = (flat + [0, 0, height] + random.integers(-2, 3, flat.shape) / 8).astype(dtype)
        end = start + (random.integers(-4, 5, flat.shape) / 8).astype(dtype)
        body = world.add(faces, start)
        world.set_motion(body, end)
        got = world.end_positions(body)
        assert got is not None and got.dtype == dtype and (got == end).all()
        bodies.append((body, faces, start.astype(np.float64), end.astype(np.float64)))
    edges = {body: world.edges(body) for body, *_ in bodies}
    assert edges[0].dtype == np.uint32 and (edges[0][:, 0] < edges[0][:, 1]).all()
    vertex_triangle, edge_edge = expected(bodies, edges, radius)
    for query, rows, kind in (
        (world.vertex_triangle_candidates(Selection.EVERYTHING, radius), vertex_triangle, pliant.VertexTriangle),
        (world.edge_edge_candidates(Selection.EVERYTHING, radius), edge_edge, pliant.EdgeEdge),
    ):
        found = query.all()
        assert found.dtype == np.uint32 and found.shape == (len(rows), 4)
        assert [tuple(row) for row in found.tolist()] == rows
        first = query.first()
        assert isinstance(first, kind) and tuple(first) in rows
        shown: list[Any] = []
        assert not query.visit_some(lambda some: shown.extend(some.tolist()))
        assert sorted(map(tuple, shown)) == rows
        assert query.visit_some(lambda some: True)
        with pytest.raises(pliant.Error) as refused:
            query.all(at_most=len(rows) - 1)
        assert refused.value.kind == "TooManyHits"


def test_a_motion_ends_where_it_is_told_to() -> None:
    faces, flat = sheet(3)
    world = pliant.World()
    body = world.add(faces, flat)
    assert world.end_positions(body) is None
    world.set_motion(body, flat + [0, 0, 4])
    world.advance_motion(0.25)
    assert (world.positions(body) == flat + [0, 0, 1]).all() and world.end_positions(body) is None
    world.set_motion(body, flat)
    world.finish_motion()
    assert (world.positions(body) == flat).all()
    for t in (-0.5, 1.5, float("nan")):
        with pytest.raises(pliant.Error) as refused:
            world.advance_motion(t)
        assert refused.value.kind == "BadTime"
    for radius in (-1.0, float("inf"), float("nan")):
        with pytest.raises(pliant.Error) as refused:
            world.edge_edge_candidates(Selection.WORLD, radius).all()
        assert refused.value.kind == "BadMargin"


def test_vertices_of_one_group_do_not_meet() -> None:
    faces, flat = sheet(3)
    world = pliant.World()
    body = world.add(faces, flat)
    query = world.vertex_triangle_candidates(Selection.within(body), 1.0)
    some = len(query.all())
    assert some > 0
    world.set_vertex_groups(body, np.full(9, 7))
    assert len(query.all()) == 0 and world.vertex_groups(body).tolist() == [7] * 9
    world.set_vertex_groups(body, [0] * 9)
    assert len(query.all()) == some
    for bad in ([1.5] * 9, [-1] * 9, [2**32] * 9, [[1] * 9], [1] * 8):
        with pytest.raises(pliant.Error):
            world.set_vertex_groups(body, bad)
    assert len(query.all()) == some


def test_motions_and_groups_are_pickled_and_copied() -> None:
    faces, flat = sheet(3)
    world = pliant.World()
    body = world.add(faces, flat)
    world.set_motion(body, flat + [0, 0, 4])
    world.set_vertex_groups(body, range(9))
    for again in (copy.copy(world), pickle.loads(pickle.dumps(world))):
        end = again.end_positions(body)
        assert end is not None and (end == flat + [0, 0, 4]).all()
        assert again.vertex_groups(body).tolist() == list(range(9))


def test_edges_are_numbered_as_given() -> None:
    faces, flat = sheet(4)
    world = pliant.World()
    body = world.add(faces, flat)
    edges = world.edges(body)
    world.set_edges(body, edges[::-1].astype(np.int16)[:, ::-1])
    assert (world.edges(body) == edges[::-1]).all()
    found = world.edge_edge_candidates(Selection.within(body), 0.1).all()
    assert len(found) > 10 and not (np.isin(edges[::-1][found[:, 1]], edges[::-1][found[:, 3]]).all(1)).all()
    with pytest.raises(pliant.Error) as refused:
        world.set_edges(body, edges[1:])
    assert refused.value.kind == "MissingEdge" and refused.value.ends == tuple(edges[0].tolist())
    assert (pickle.loads(pickle.dumps(world)).edges(body) == edges[::-1]).all()
