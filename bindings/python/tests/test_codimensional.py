"""What bodies of edges and points answer, question by question, as the table in the guide says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pliant
import pytest
from numpy.typing import NDArray
from pliant import ContactKind, FeatureKind, Selection

ALL = Selection.EVERYTHING
FACE = np.array([[-9.0, -9, 0], [9, -9, 0], [0, 9, 0]])


def world_of(*bodies: Any) -> pliant.World:
    """A world of these: positions, then edges, points and faces where there are any."""
    world = pliant.World()
    for positions, *rest in bodies:
        edges, points, faces = (*rest, None, None, None)[:3]
        world.add(faces, np.array(positions, float), edges=edges, points=points)
    return world


def kinds(world: pliant.World) -> list[int]:
    contacts = world.contacts(ALL).all()
    np.testing.assert_array_equal(contacts.pairs, world.intersections(ALL).all())
    return list(contacts.kind.tolist())


face: Any = (FACE, None, None, [[0, 1, 2]])
edge: Any = ([[0, 0, 0], [1, 0, 0]], [[0, 1]])


@pytest.mark.parametrize(
    ("other", "kind", "count"),
    [
        (([[0, 0, -1], [0, 0, 1]], [[0, 1]]), ContactKind.CROSSING, 1),  # through the face
        (([[0, 0, 0], [0, 0, 1]], [[0, 1]]), ContactKind.TOUCHING, 1),  # its end on the face
        (([[0, 0, 0], [1, 0, 0]], [[0, 1]]), ContactKind.TOUCHING, 2),  # in the face
        (([[0, 0, 0]], None, [0]), ContactKind.TOUCHING, 1),  # a point on the face
    ],
)
def test_meeting_a_face(other: Any, kind: ContactKind, count: int) -> None:
    world = world_of(face, other)
    assert kinds(world) == [kind]
    is_crossing = kind == ContactKind.CROSSING
    assert world.crossing_edges(ALL).all().tolist() == [[1, 0, 0, 0]] * is_crossing
    curves = pliant.curves(world, world.intersections().all())
    assert len(curves.segments.points) == count and len(curves.closed) == 0
    assert world.close_triangle_pairs(ALL, 1.0).all().distance.tolist() == [0]


def test_meeting_edges_and_points() -> None:
    crossing: Any = ([[0.5, -1, 0], [0.5, 1, 0]], [[0, 1]])
    along: Any = ([[0.5, 0, 0], [2, 0, 0]], [[0, 1]])
    point: Any = ([[0.5, 0, 0]], None, [0])
    for a, b in ((edge, crossing), (edge, along), (edge, point), (point, point)):
        world = world_of(a, b)
        assert kinds(world) == [ContactKind.TOUCHING]
        assert len(world.crossing_edges(ALL).all()) == 0
        assert len(pliant.curves(world, world.intersections().all()).closed) == 0
    # A cable that meets itself, but for edges with an end in common.
    assert kinds(world_of(([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, -1, 0]], [[0, 1], [1, 2], [2, 3]]))) == [ContactKind.TOUCHING]
    assert kinds(world_of((*edge[:1], [[0, 1], [1, 0]], [0, 0]))) == []


def test_adjacent() -> None:
    for positions, edges, points, faces, count in (
        ([[0, 0, 0], [1, 0, 0], [0.2, 0, 0]], [[0, 1], [1, 2]], None, None, 1),  # folded back
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1], [1, 2]], None, None, 0),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 0]], [[0, 3]], None, [[0, 1, 2]], 1),  # along the face
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1]], [[0, 3]], None, [[0, 1, 2]], 0),
        ([[0, 0, 0], [1, 0, 0]], [[0, 1], [1, 0]], [0, 0], None, 0),  # all twice
    ):
        world = world_of((positions, edges, points, faces))
        adjacent = world.adjacent_intersections().all()
        assert adjacent.kind.tolist() == [ContactKind.TOUCHING] * count
        assert len(world.intersections(ALL).all()) == 0


def test_near() -> None:
    """A cable of two edges, a point, and a vertex that nothing names, above a face."""
    positions = [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0.5, 0.5, 1], [0.4, 0.5, 1]]
    world = world_of(face, (positions, [[0, 1], [1, 2]], [3]))
    assert world.triangles(1).tolist() == [[0, 1, 1], [1, 2, 2], [3, 3, 3]]
    for pairs in (world.vertex_triangle_candidates(ALL, 0.5).all(), world.close_vertex_triangle_pairs(ALL, 1.0).all().pairs):
        within = [[1, 0, 1, 1], [1, 2, 1, 0], *([1, v, 1, 2] for v in range(3)), [1, 3, 1, 0], [1, 3, 1, 1]]
        assert pairs.tolist() == sorted([*([1, v, 0, 0] for v in range(4)), *within])
    assert len(world.edge_edge_candidates(Selection.within(1), 9.0).all()) == 0  # they share an end
    assert len(world.edge_edge_candidates(Selection.between(0, 1), 9.0).all()) == 6
    assert world.close_edge_edge_pairs(ALL, 20.0).all().pairs[:, [0, 2]].tolist() == [[0, 1]] * 6
    nearest = world.distance(0, 1)
    assert nearest and nearest.distance == 1 and world.nearest_body(1) == world.distance(1, 0)
    assert world.close_triangle_pairs(Selection.between(0, 1), 1.0).all().pairs.tolist() == [[0, 0, 1, row] for row in range(3)]
    clearance = world.clearance(ALL, 4.0)[1]
    np.testing.assert_allclose(clearance, [0.25] * 4 + [2], rtol=1e-6)
    assert world.components(1).tolist() == [0, 0, 1] and len(world.split(1)) == 1


def test_contacts() -> None:
    def rows(reach: float, *bodies: Any) -> list[tuple[int, list[int], int]]:
        found = pliant.feature_pairs(world_of(*bodies), ALL, reach)
        used = [[int(v) for v in row if v != 0xFFFFFFFF] for row in found.vertices]
        return list(zip(found.kind.tolist(), used, found.multiplicity.tolist()))

    points: Any = ([[0, 0, 0], [0, 0, 1]], None, [0, 1])
    assert rows(1.0, points) == [(FeatureKind.VERTEX_VERTEX, [0, 1], 2)]
    over: Any = ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.3, 0.3, 0.2]], None, [3], [[0, 1, 2]])
    assert rows(0.4, over) == [(FeatureKind.VERTEX_FACE, [3, 0, 1, 2], 1)]
    assert rows(0.5, over) == [(FeatureKind.VERTEX_VERTEX, [0, 3], 1), (FeatureKind.VERTEX_FACE, [3, 0, 1, 2], 1)]
    beside: Any = ([[0, 0, 0], [1, 0, 0], [0.5, 0.1, 0]], [[0, 1]], [2])
    assert rows(0.2, beside) == [(FeatureKind.VERTEX_EDGE, [2, 0, 1], 1)]
    assert rows(0.2, edge, ([[0.5, -1, 0.1], [0.5, 1, 0.1]], [[0, 1]])) == [(FeatureKind.EDGE_EDGE, [0, 1, 0, 1], 1)]
    # The end of a cable that is nearly folded back is near the next edge.
    assert rows(0.2, ([[0, 0, 0], [1, 0, 0], [0.2, 0.1, 0]], [[0, 1], [1, 2]])) == [(FeatureKind.VERTEX_EDGE, [2, 0, 1], 1)]


def test_moving() -> None:
    def moved(end: Any, *bodies: Any) -> tuple[NDArray[np.uint32], NDArray[np.uint32], pliant.FreeStep]:
        """The last body moves."""
        world = world_of(*bodies)
        world.set_motion(len(bodies) - 1, np.array(end, float))
        impacts = world.vertex_triangle_impacts(ALL).all(), world.edge_edge_impacts(ALL).all()
        times = [time for impact in impacts for time in impact.high.tolist()]
        first, free = world.first_impact(ALL), world.free_step(ALL)
        assert free.moves and free.begins_in_contact is None
        assert (first.high if first else 1.0) == min(times, default=1.0)
        assert 0.9 * min(times) < free.t < min(times) if times else free.t == 1
        world.advance_motion(free.t)
        assert world.intersections(ALL).first() is None
        return impacts[0].pairs, impacts[1].pairs, free

    up, down = [[0.5, -1, 1], [0.5, 1, 1]], [[0.5, -1, -1], [0.5, 1, -1]]
    vertices, edges, _ = moved(down, face, (up, [[0, 1]]))  # an edge onto a face: its ends
    assert vertices.tolist() == [[1, 0, 0, 0], [1, 1, 0, 0]] and len(edges) == 0
    vertices, edges, _ = moved(down, edge, (up, [[0, 1]]))  # across an edge
    assert len(vertices) == 0 and edges.tolist() == [[0, 0, 1, 0]]
    vertices, edges, _ = moved([[0.5, 0, -1]], edge, ([[0.5, 0, 1]], None, [0]))  # a point onto an edge
    assert vertices.tolist() == [[1, 0, 0, 0]] and len(edges) == 0
    origin: Any = ([[0, 0, 0]], None, [0])
    vertices, _, _ = moved([[0, 0, -1]], origin, ([[0, 0, 1]], None, [0]))  # a point onto a point
    assert vertices.tolist() == [[0, 0, 1, 0], [1, 0, 0, 0]]
    vertices, _, _ = moved([[1e-9, 0, -1]], origin, ([[0, 0, 1]], None, [0]))  # and past it
    assert len(vertices) == 0
    # The end of a cable is folded through the next edge, with which it shares a vertex.
    vertices, edges, _ = moved([[0, 0, 0], [1, 0, 0], [0.2, -0.2, 0]], ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1], [1, 2]]))
    assert vertices.tolist() == [[0, 2, 0, 0]] and len(edges) == 0
    # Points that pass each other keep a distance, where one is asked for.
    world = world_of(origin, ([[1e-9, 0, 1]], None, [0]))
    world.set_motion(1, np.array([[1e-9, 0, -1]]))
    world.advance_motion(world.collision_free_step(ALL, 0.1))
    nearest = world.distance(0, 1)
    assert nearest and 0.1 < nearest.distance < 0.2


def test_inside_of_nothing() -> None:
    octahedron = np.concatenate([np.eye(3), -np.eye(3)])
    faces = [[a, b, c] for a in (0, 3) for b in (1, 4) for c in (2, 5)]
    world = world_of((octahedron, None, None, faces), ([[-0.1, 0, 0], [0.1, 0, 0], [0, 0.1, 0]], [[0, 1]], [2]))
    assert len(world.intersections(ALL).all()) == 0 and len(world.crossing_edges(ALL).all()) == 0
    nearest = world.distance(0, 1)
    assert nearest and nearest.distance == pytest.approx(0.9 / 3**0.5)
