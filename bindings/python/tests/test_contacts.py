"""How triangles intersect: kinds known by hand, columns that belong together, and one kind alone."""

from __future__ import annotations

import numpy as np
import pliant
import pytest
from pliant import ContactKind, Selection

FLOOR = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]
KNOWN = [
    ([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]], ContactKind.CROSSING),
    ([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 0.5]], ContactKind.CROSSING),
    ([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]], ContactKind.TOUCHING),
    ([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 4.0, 0.0]], ContactKind.TOUCHING),
    (FLOOR, ContactKind.OVERLAPPING),
]


def world_of(dtype: type = np.float64) -> pliant.World:
    """A floor, and all that is known on it as one body of triangles that share no corner."""
    world = pliant.World()
    world.add(faces=[[0, 1, 2]], positions=np.array(FLOOR, dtype))
    corners = np.concatenate([np.array(known, dtype) for known, _ in KNOWN])
    world.add(faces=np.arange(len(corners)).reshape(-1, 3), positions=corners)
    return world


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_kinds_that_are_known(dtype: type) -> None:
    world = world_of(dtype)
    contacts = world.contacts(Selection.between(0, 1)).all()
    assert contacts.pairs.dtype == np.uint32 and contacts.kind.dtype == np.uint8
    assert contacts.pairs.tolist() == [[0, 0, 1, number] for number in range(len(KNOWN))]
    assert contacts.kind.tolist() == [kind for _, kind in KNOWN]
    everything = world.contacts(Selection.EVERYTHING).all()
    assert (everything.pairs == world.intersections(Selection.EVERYTHING).all()).all()


@pytest.mark.parametrize("kind", ContactKind)
def test_one_kind_alone(kind: ContactKind) -> None:
    world = world_of()
    every = world.contacts(Selection.EVERYTHING).all()
    query = world.contacts(Selection.EVERYTHING, only=kind)
    found = query.all()
    assert (found.kind == kind).all() and (found.pairs == every.pairs[every.kind == kind]).all()
    first = query.first()
    assert first is not None and first.kind is kind and list(first.pair) in found.pairs.tolist()
    shown: list[pliant.Contacts] = []
    assert not query.visit_some(shown.append)
    assert sorted(np.concatenate([some.pairs for some in shown]).tolist()) == found.pairs.tolist()
    with pytest.raises(pliant.Error, match="more hits than the") as refused:
        query.all(at_most=len(found.pairs) - 1)
    assert refused.value.kind == "TooManyHits"
    assert kind.name.capitalize() in repr(query)


def test_kinds_that_are_none() -> None:
    with pytest.raises(ValueError, match="3 is not a pliant.ContactKind: give only=ContactKind.CROSSING"):
        world_of().contacts(only=3)
    with pytest.raises(TypeError):
        world_of().contacts(only="crossing")  # type: ignore[arg-type]


# Two triangles with a corner, an edge or all corners in common.
ADJACENT = [
    ([[0, 1, 2], [0, 3, 4]], [[0, 0, 0], [3, 1, -1], [3, 1, 1], [4, 0, 0], [4, 2, 0]], ContactKind.CROSSING),
    ([[0, 1, 2], [1, 0, 3]], [[0, 0, 0], [4, 0, 0], [1, 2, 0], [2, 1, 0]], ContactKind.OVERLAPPING),
    ([[0, 1, 2], [0, 2, 1]], [[0, 0, 0], [4, 0, 0], [1, 2, 0]], ContactKind.OVERLAPPING),
    ([[0, 1, 2], [0, 3, 4]], [[0, 0, 0], [4, 0, 0], [4, 1, 0], [2, 0, 0], [2, -1, 1]], ContactKind.TOUCHING),
    ([[0, 1, 2], [0, 3, 4]], [[0, 0, 0], [4, 0, 0], [4, 1, 0], [-4, 0, 0], [-4, 1, 0]], None),
]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_triangles_that_share_a_vertex(dtype: type) -> None:
    world = pliant.World()
    for faces, corners, _ in ADJACENT:
        world.add(faces, np.array(corners, dtype))
    contacts = world.adjacent_intersections().all()
    expected = [(body, kind) for body, (_, _, kind) in enumerate(ADJACENT) if kind is not None]
    assert contacts.pairs.tolist() == [[body, 0, body, 1] for body, _ in expected]
    assert contacts.kind.tolist() == [kind for _, kind in expected]
    crossing = world.adjacent_intersections(Selection.within(0), only=ContactKind.CROSSING)
    first = crossing.first()
    assert first is not None and tuple(first.pair) == (0, 0, 0, 1) and first.kind is ContactKind.CROSSING
    assert world.adjacent_intersections(Selection.within(4)).first() is None
    for of in (Selection.WORLD, Selection.between(0, 1)):
        assert len(world.adjacent_intersections(of).all().pairs) == 0
    assert repr(crossing) == "<pliant.ContactQuery of Selection.within(0), adjacent, only Crossing>"


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_edges_that_cross_triangles(dtype: type) -> None:
    world = pliant.World()
    floor = world.add([[0, 1, 2]], np.array(FLOOR, dtype))
    leaf = world.add([[0, 1, 2]], np.array([[1, 1, -1], [1, 1, 1], [2, 1, 1]], dtype))
    rows = world.crossing_edges().all()
    assert rows.dtype == np.uint32 and rows.shape == (2, 4)
    assert world.edges(leaf)[rows[:, 1]].tolist() == [[0, 1], [0, 2]]
    assert rows[:, [0, 2, 3]].tolist() == [[leaf, floor, 0]] * 2
    first = world.crossing_edges(Selection.between(floor, leaf)).first()
    assert first == pliant.CrossingEdge(*rows[0])
    # The crossing is far from the vertex that the two triangles share.
    faces, corners, _ = ADJACENT[0]
    bow = world.add(faces, np.array(corners, dtype))
    crossing = world.crossing_edges(Selection.within(bow))
    assert [world.edges(bow)[row[1]].tolist() for row in crossing.all()] == [[1, 2]]
    assert repr(crossing) == f"<pliant.Query of Selection.within({bow}), edges that cross triangles>"


def test_segments_and_curves() -> None:
    world = pliant.World()
    corners = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    faces = np.array([half for a, b, c, d in quads for half in ([a, b, c], [a, c, d])])
    world.add(faces, corners)
    world.add(faces, corners + [0.5, 0.25, 0.25])
    pairs = world.intersections().all()
    segments = pliant.segments(world, pairs)
    assert segments.offsets[-1] == len(segments.points) == len(segments.on) and not segments.flat.any()
    # Each end is where its feature of either triangle is.
    shapes = [world.positions(body)[world.triangles(body)] for body in (0, 1)]
    for pair, start, stop in zip(pairs.reshape(-1, 2, 2), segments.offsets, segments.offsets[1:]):
        for end in range(int(start), int(stop)):
            for side, (body, triangle) in enumerate(pair):
                on, t = segments.on[end, side], segments.parameters[end, side]
                three = shapes[body][triangle]
                assert np.isnan(t) == (on not in (3, 4, 5))
                if on < 3:
                    assert (segments.points[end] == three[on]).all()
                elif on < 6:
                    there = three[on - 3] + t * (three[(on - 2) % 3] - three[on - 3])
                    assert np.allclose(segments.points[end], there)
    three = shapes[0][pairs[0, 1]]
    up = np.cross(three[1] - three[0], three[2] - three[0])
    assert np.allclose(segments.normals[0, 0], up / np.linalg.norm(up))
    # Inside the first cube is the part 0.5 to 1, 0.25 to 1, 0.25 to 1: six sides of it are the curve.
    curves = pliant.curves(world, pairs, areas=True)
    assert len(curves.length) == 1 and curves.closed.all() and (curves.ends == 255).all()
    assert np.isclose(curves.length[0], 2 * (0.5 + 0.75 + 0.75)) and len(curves.touching) == 0
    line = curves.polyline(0)
    assert len(line) == len(curves.steps)
    sides = np.linalg.norm(np.roll(line, -1, axis=0) - line, axis=1)
    assert np.isclose(sides.sum(), curves.length[0])
    # A floor below cuts off a part of each cube that it meets.
    floor = world.add([[0, 1, 2]], [[-9.0, -9.0, 0.3], [9.0, -9.0, 0.3], [0.0, 9.0, 0.3]])
    below = pliant.curves(world, world.intersections(Selection.between(0, floor)).all(), areas=True)
    assert below.areas is not None
    assert np.allclose(below.areas, [[1 + 4 * 0.3, -1]])
    assert pliant.curves(world, pairs).areas is None
    # Open: the floor alone, through the border of a triangle.
    leaf = world.add([[0, 1, 2]], [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [50.0, 0.0, 1.0]])
    one = pliant.curves(world, world.intersections(Selection.between(floor, leaf)).all())
    assert not one.closed.any() and one.ends.tolist() == [[pliant.CurveEnd.BORDER] * 2]
    assert one.polyline(0).shape == (2, 3)
    with pytest.raises(pliant.Error, match="triangle 12") as refused:
        pliant.segments(world, np.array([[0, 12, 1, 0]], np.uint32))
    assert refused.value.kind == "NoSuchTriangle"
    with pytest.raises(pliant.Error, match=r"pairs are an array of shape .*; they must be \(k, 4\) uint32"):
        pliant.curves(world, pairs[:, :2])
