"""Impacts: times known by hand, single pairs and worlds alike, and steps that are free of collision."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pliant
import pytest
from pliant import Selection

from test_candidates import sheet


def test_a_vertex_falls_on_a_triangle() -> None:
    a, b, c = [0, 0, 0], [4, 0, 0], [0, 4, 0]
    start = np.array([[[1, 1, 1], a, b, c], [[1, 1, 1], a, b, c], [[9, 9, 1], a, b, c], [[1, 1, 0], a, b, c]], dtype=np.float64)
    end = start.copy()
    end[:, 0, 2] = [-2, 0.5, -2, 7]
    hit, low, high = pliant.vertex_triangle_impacts(start, end)
    assert hit.dtype == np.bool_ and low.dtype == high.dtype == np.float64
    assert hit.tolist() == [True, False, False, True]
    assert Fraction(low[0]) < Fraction(1, 3) <= Fraction(high[0]) and high[0] - low[0] <= 1e-6
    assert np.isnan(low[1:3]).all() and np.isnan(high[1:3]).all()
    assert low[3] == high[3] == 0
    _, low, high = pliant.vertex_triangle_impacts(start, end, width=0)
    assert high[0] == np.nextafter(low[0], 1) and Fraction(low[0]) < Fraction(1, 3) <= Fraction(high[0])
    # Lists and single precision are as good.
    assert pliant.vertex_triangle_impacts(start.tolist(), end.astype(np.float32))[0].tolist() == hit.tolist()
    assert [len(it) for it in pliant.vertex_triangle_impacts(start[:0], end[:0])] == [0, 0, 0]


def test_edges_cross() -> None:
    start = np.array([[[-1, 0, 1], [1, 0, 1], [0, -1, 0], [0, 1, 0]]], dtype=np.float64)
    end = start.copy()
    end[0, :2, 2] = -1
    hit, low, high = pliant.edge_edge_impacts(start, end, width=1e-9)
    assert hit[0] and low[0] < 0.5 == high[0] and high[0] - low[0] <= 1e-9
    # Reversed in time it is the same.
    assert pliant.edge_edge_impacts(end, start, width=1e-9)[0][0]


@pytest.mark.parametrize(
    ("start", "end", "width", "kind"),
    [
        (np.zeros((2, 4, 3)), np.zeros((1, 4, 3)), 1e-6, "DifferentCounts"),
        (np.zeros((2, 4, 3)), np.full((2, 4, 3), np.nan), 1e-6, "BadCorner"),
        (np.zeros((2, 3, 3)), np.zeros((2, 3, 3)), 1e-6, "BadArray"),
        (np.zeros((2, 12)), np.zeros((2, 12)), 1e-6, "BadArray"),
        (np.zeros((1, 4, 3)), np.zeros((1, 4, 3)), -1.0, "BadWidth"),
        (np.zeros((1, 4, 3)), np.zeros((1, 4, 3)), np.inf, "BadWidth"),
    ],
)
def test_what_is_refused(start: Any, end: Any, width: float, kind: str) -> None:
    for ask in (pliant.vertex_triangle_impacts, pliant.edge_edge_impacts):
        with pytest.raises(pliant.Error) as refused:
            ask(start, end, width)
        assert refused.value.kind == kind


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_worlds_say_what_single_pairs_say(dtype: Any) -> None:
    random = np.random.default_rng(3)
    faces, flat = sheet(5)
    world = pliant.World(leaf_size=2)
    starts = [(flat + [0, 0, height] + random.normal(0, 0.05, flat.shape)).astype(dtype) for height in (0.0, 0.4)]
    ends = [(start + [0, 0, shift] + random.normal(0, 0.05, flat.shape)).astype(dtype) for start, shift in zip(starts, (0.5, -0.5))]
    for start in starts:
        world.add(faces, start)
    for body, end in enumerate(ends):
        world.set_motion(body, end)
    met = 0
    for are_edges in (False, True):
        ask = world.edge_edge_impacts if are_edges else world.vertex_triangle_impacts
        alone = pliant.edge_edge_impacts if are_edges else pliant.vertex_triangle_impacts
        impacts = ask(Selection.EVERYTHING).all()
        assert impacts.pairs.dtype == np.uint32 and impacts.pairs.shape == (len(impacts.low), 4)

        def corners(row: list[int], shapes: list[Any]) -> list[Any]:
            body_a, a, body_b, b = row
            if are_edges:
                return [shapes[body_a][v] for v in world.edges(body_a)[a]] + [shapes[body_b][v] for v in world.edges(body_b)[b]]
            return [shapes[body_a][a]] + [shapes[body_b][v] for v in faces[b]]

        start, end = (np.array([corners(row, shapes) for row in impacts.pairs.tolist()], dtype=np.float64) for shapes in (starts, ends))
        hit, low, high = alone(start, end)
        assert hit.all() and (low == impacts.low).all() and (high == impacts.high).all()
        met += len(low)
        first = ask(Selection.EVERYTHING, width=0.0).first()
        assert isinstance(first, pliant.Impact) and type(first.pair) is (pliant.EdgeEdge if are_edges else pliant.VertexTriangle)
        assert first.high <= impacts.high.min()
        shown: list[pliant.Impacts] = []
        assert not ask(Selection.EVERYTHING).visit_some(shown.append)
        assert sum(len(some.low) for some in shown) == len(low)
    assert met > 50
    earliest = world.first_impact(Selection.EVERYTHING)
    assert earliest is not None and 0 < earliest.high < 1
    step = world.collision_free_step(Selection.EVERYTHING)
    assert 0.9 * earliest.low <= step < earliest.high
    kept = world.collision_free_step(Selection.EVERYTHING, min_distance=0.001)
    assert kept < earliest.high
    world.advance_motion(step)
    assert len(world.intersections(Selection.EVERYTHING).all()) == 0
    with pytest.raises(pliant.Error) as refused:
        world.vertex_triangle_impacts(Selection.WORLD, width=-1.0).all()
    assert refused.value.kind == "BadWidth"
    assert repr(world.edge_edge_impacts(Selection.WORLD)) == "<pliant.ImpactQuery of Selection.WORLD, edges and edges, width 0.000001>"


def test_steps_say_how_they_begin_and_whether_anything_moves() -> None:
    world = pliant.World()
    floor = world.add([[0, 1, 2]], np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], np.float64))
    through = np.array([[0, 0, -1], [1, 0, 2], [-1, 0, 2]], np.float64)
    leaf = world.add([[0, 1, 2]], through)
    of = Selection.EVERYTHING
    assert world.free_step(of) == pliant.FreeStep(1.0, pliant.Pair(floor, 0, leaf, 0), False)
    # Each way out is a contact.
    world.set_motion(leaf, through + [0, 0, 4])
    step = world.free_step(of)
    assert 0.2 < step.t == world.collision_free_step(of) < 0.25
    assert step.moves and step.begins_in_contact == pliant.Pair(floor, 0, leaf, 0)
    # What is glued together is no contact.
    for body in (floor, leaf):
        world.set_vertex_groups(body, [7, 7, 7])
    assert world.free_step(of).begins_in_contact is None
    for body in (floor, leaf):
        world.set_vertex_groups(body, [0, 0, 0])
    above = through + [0, 0, 1.25]
    world.set_positions(leaf, above)
    assert world.free_step(of) == (1.0, None, False)
    world.set_motion(leaf, above - [0, 0, 4])
    assert world.free_step(of).begins_in_contact is None
    near = world.free_step(of, min_distance=0.25)
    assert near.begins_in_contact == pliant.VertexTriangle(leaf, 0, floor, 0) and type(near.begins_in_contact) is pliant.VertexTriangle
    assert world.free_step(of, np.nextafter(0.25, 0)).begins_in_contact is None
    # Of the others nobody is asked.
    assert not world.free_step(Selection.within(floor)).moves and world.free_step(Selection.between(floor, leaf)).moves
    blade = world.add([[0, 1, 2]], np.array([[-1, 5, 3], [1, 5, 3], [0, 5, 9]], np.float64))
    other = world.add([[0, 1, 2]], np.array([[0, 4, 2.9], [0, 6, 2.9], [0, 5, 1]], np.float64))
    edges = world.free_step(Selection.between(blade, other), 0.11)
    assert type(edges.begins_in_contact) is pliant.EdgeEdge and edges == (1.0, (blade, 0, other, 0), False)
    with pytest.raises(pliant.Error) as refused:
        world.free_step(of, -1.0)
    assert refused.value.kind == "BadDistance"
