"""Close pairs: distances against the least of a grid of points, and figures that belong together."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pliant
import pytest
from pliant import Selection

from conftest import fold, grid
from test_candidates import sheet


def bodies(dtype: Any) -> tuple[pliant.World, Any, list[Any]]:
    random = np.random.default_rng(5)
    faces, flat = sheet(4)
    world = pliant.World(leaf_size=2)
    shapes = [(flat + [0.3 * height, 0, height] + random.normal(0, 0.1, flat.shape)).astype(dtype) for height in (0.0, 0.4)]
    for shape in shapes:
        world.add(faces, shape)
    return world, faces, shapes


def points_of(rows: Any, place: int, shapes: list[Any], corners: Any, barycentric: Any) -> Any:
    """The points that barycentric coordinates name, of the elements in two columns."""
    chosen = np.array([[shapes[row[place]][v] for v in corners(row)] for row in rows.tolist()], dtype=np.float64)
    return (chosen * barycentric[:, :, None]).sum(1)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_figures_belong_together(dtype: Any) -> None:
    world, faces, shapes = bodies(dtype)
    edges = world.edges(0)
    near = 0.35
    for are_edges in (False, True):
        ask = world.close_edge_edge_pairs if are_edges else world.close_vertex_triangle_pairs
        candidates = world.edge_edge_candidates if are_edges else world.vertex_triangle_candidates
        close = ask(Selection.EVERYTHING, near).all()
        assert close.pairs.dtype == np.uint32 and close.pairs.shape == (len(close.distance), 4)
        assert 10 < len(close.distance) < len(candidates(Selection.EVERYTHING, near / 2).all())
        if are_edges:
            first = points_of(close.pairs, 0, shapes, lambda row: edges[row[1]], close.barycentric[:, :2])
            second = points_of(close.pairs, 2, shapes, lambda row: edges[row[3]], close.barycentric[:, 2:])
        else:
            first = points_of(close.pairs, 0, shapes, lambda row: [row[1]], np.ones((len(close.pairs), 1)))
            second = points_of(close.pairs, 2, shapes, lambda row: faces[row[3]], close.barycentric)
        way = first - second
        assert np.allclose(np.linalg.norm(way, axis=1), close.distance, rtol=1e-9, atol=1e-12)
        assert np.allclose(close.direction * close.distance[:, None], way, rtol=0, atol=1e-12)
        assert (close.distance <= near * (1 + 1e-9)).all() and (close.barycentric >= 0).all()
        # All those of a larger distance that are no further than this are these.
        larger = ask(Selection.EVERYTHING, 2 * near).all()
        assert (larger.pairs[larger.distance <= near] == close.pairs).all()

        one = ask(Selection.EVERYTHING, near).first()
        assert isinstance(one, pliant.ClosePair) and type(one.pair) is (pliant.EdgeEdge if are_edges else pliant.VertexTriangle)
        place = close.pairs.tolist().index(list(one.pair))
        assert one.distance == close.distance[place] and one.direction == tuple(close.direction[place])
        assert one.barycentric == tuple(close.barycentric[place])
        shown: list[pliant.ClosePairs] = []
        assert not ask(Selection.EVERYTHING, near).visit_some(shown.append)
        pairs = np.concatenate([some.pairs for some in shown])
        order = np.lexsort(pairs.T[::-1])
        assert (pairs[order] == close.pairs).all()
        assert (np.concatenate([some.distance for some in shown])[order] == close.distance).all()
        assert ask(Selection.EVERYTHING, near).visit_some(lambda some: True)


def test_touching_has_no_direction_and_refusals() -> None:
    world = pliant.World()
    floor = world.add([[0, 1, 2]], np.array([[-9.0, -9, 0], [9, -9, 0], [0, 9, 0]]))
    leaf = world.add([[0, 1, 2]], np.array([[0.0, 0, 0], [1, 0, 3], [0, 1, 3]]))
    query = world.close_vertex_triangle_pairs(Selection.between(floor, leaf), 0.0)
    one = query.first()
    assert one is not None and one.direction is None and one.distance == 0
    assert tuple(one.pair) == (leaf, 0, floor, 0)
    assert (query.all().direction == 0).all()
    query.prepare()
    assert repr(query).startswith("<pliant.CloseQuery of Selection.between(0, 1), vertices and triangles, within 0")
    assert world.close_edge_edge_pairs(Selection.WORLD, 0.0).first() is None
    with pytest.raises(pliant.Error) as refused:
        world.close_vertex_triangle_pairs(Selection.WORLD, 9.0).all(at_most=1)
    assert refused.value.kind == "TooManyHits"
    for distance in (-1.0, float("inf"), float("nan")):
        with pytest.raises(pliant.Error) as refused:
            world.close_edge_edge_pairs(Selection.WORLD, distance).all()
        assert refused.value.kind == "BadDistance"


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_distances_of_bodies_and_triangles(dtype: Any) -> None:
    world, faces, shapes = bodies(dtype)
    apart = shapes[1] + np.array([0, 0, 2], dtype)
    world.set_positions(1, apart)
    nearest = world.distance(0, 1)
    assert nearest is not None and isinstance(nearest.pair, pliant.Pair) and nearest.direction is not None
    ends = [
        np.asarray(nearest.barycentric[3 * k : 3 * k + 3]) @ shape[faces[triangle]].astype(np.float64)
        for k, (shape, triangle) in enumerate(((shapes[0], nearest.pair.triangle_a), (apart, nearest.pair.triangle_b)))
    ]
    assert np.allclose(ends[0] - ends[1], nearest.distance * np.asarray(nearest.direction), atol=1e-12)
    assert world.distance(0, 1, nearest.distance * 0.999) is None
    assert world.nearest_body(1) is not None and world.nearest_body(1, 0.1) is None
    close = world.close_triangle_pairs(Selection.between(0, 1), nearest.distance * 1.2).all()
    assert close.barycentric.shape == (len(close.pairs), 6)
    assert close.distance.min() == pytest.approx(nearest.distance, rel=1e-8)
    world.set_positions(1, shapes[0])
    touching = world.distance(0, 1)
    assert touching is not None and touching.distance == 0 and touching.direction is None
    with pytest.raises(pliant.Error) as refused:
        world.distance(0, 1, -1.0)
    assert refused.value.kind == "BadDistance"


def test_clearance_is_half_the_least_distance() -> None:
    world, _, shapes = bodies(np.float64)
    clearance = world.clearance(Selection.WORLD, 0.5)
    close = world.close_vertex_triangle_pairs(Selection.WORLD, 0.5).all()
    assert [len(clearance[body]) for body in (0, 1)] == [len(shape) for shape in shapes]
    assert all((of_body <= 0.25).all() for of_body in clearance.values())
    for (body, vertex, _, _), distance in zip(close.pairs.tolist(), close.distance, strict=True):
        assert clearance[body][vertex] <= distance / 2


def test_only_what_touches_is_at_distance_0() -> None:
    u = 5e-324
    world = pliant.World()
    corner = world.add([[0, 1, 2]], np.array([[0, 0, 0], [-9, 0, 0], [0, -9, 0]]) * u)
    # In the plane x + 2 y + 2 z = u, which is u / 3 away.
    over_it = world.add([[0, 1, 2]], np.array([[1, 0, 0], [-1, 1, 0], [-1, 0, 1]]) * u)
    nearest = world.distance(corner, over_it)
    assert nearest is not None and nearest.distance == u
    assert nearest.direction == pytest.approx([-1 / 3, -2 / 3, -2 / 3])
    assert world.distance(corner, over_it, 0.0) is None
    touching = world.add([[0, 1, 2]], np.array([[0, 0, 0], [-9, 0, 0], [0, 0, -9]]) * u)
    nearest = world.nearest_body(corner)
    assert nearest is not None and isinstance(nearest.pair, pliant.Pair)
    assert (nearest.pair.body_b, nearest.distance, nearest.direction) == (touching, 0, None)


def test_feature_pairs_are_each_contact_once() -> None:
    world, _, shapes = bodies(np.float64)
    vertices = world.close_vertex_triangle_pairs(Selection.EVERYTHING, 0.5).all()
    edges = world.close_edge_edge_pairs(Selection.EVERYTHING, 0.5).all()
    contacts = pliant.feature_pairs(world, Selection.EVERYTHING, 0.5)
    assert isinstance(contacts, pliant.FeaturePairs)
    assert contacts.multiplicity.sum() == len(vertices.pairs) + len(edges.pairs)
    # In general position rounding decides no features.
    plain = np.concatenate([vertices.features(), edges.features()])
    assert [(plain == kind).sum() for kind in range(4)] == [contacts.multiplicity[contacts.kind == kind].sum() for kind in range(4)]
    with pytest.raises(ValueError, match="features are of"):
        world.close_triangle_pairs(Selection.EVERYTHING, 0.1).all().features()
    assert len(contacts.kind) > 20 and contacts.multiplicity.max() > 1
    names = np.c_[contacts.kind, contacts.bodies[:, 0], contacts.numbers[:, 0], contacts.bodies[:, 1], contacts.numbers[:, 1]]
    assert (np.unique(names, axis=0) == names).all()
    assert set(contacts.distance) <= set(vertices.distance) | set(edges.distance)
    for row in range(len(names)):
        kind = pliant.FeatureKind(contacts.kind[row])
        count = {pliant.FeatureKind.EDGE_EDGE: 2}.get(kind, 1)
        ends = []
        for side, places in enumerate((slice(0, count), slice(count, 4))):
            numbers = contacts.vertices[row, places]
            used = numbers != 0xFFFFFFFF
            weights = contacts.weights[row, places]
            assert weights.sum() == pytest.approx(1) and not weights[~used].any()
            ends.append(weights[used] @ shapes[contacts.bodies[row, side]][numbers[used]])
        assert np.allclose(ends[0] - ends[1], contacts.distance[row] * contacts.direction[row], atol=1e-9)
    with pytest.raises(pliant.Error) as refused:
        pliant.feature_pairs(world, Selection.EVERYTHING, -1.0)
    assert refused.value.kind == "BadDistance" and "distance" in str(refused.value)


def test_edges_and_points_are_elements() -> None:
    world = pliant.World()
    floor = world.add([[0, 1, 2]], [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])
    at = np.array([[0.0, 0, 0.25], [1, 0, 0.25], [2, 0, 0.25], [0, 1, 0.25], [3, 3, 0.25]])
    cable = world.add(None, at, edges=[[0, 1], [1, 2]], points=[3])
    assert world.triangles(cable).tolist() == [[0, 1, 1], [1, 2, 2], [3, 3, 3]]
    assert world.edges(cable).tolist() == [[0, 1], [1, 2]]
    contacts = pliant.feature_pairs(world, Selection.between(floor, cable), 0.3)
    # Each vertex that is named is above the face, once.
    assert (contacts.kind == pliant.FeatureKind.VERTEX_FACE).all()
    assert contacts.numbers[:, 0].tolist() == [0, 1, 2, 3] and (contacts.distance == 0.25).all()
    # Two cables that cross, and a point beside one.
    other = world.add(np.empty((0, 3), int), at + [0.5, -0.5, 0.1], edges=np.array([[0, 3]]), points=np.array([2, 2]))
    contacts = pliant.feature_pairs(world, Selection.between(cable, other), 0.11)
    assert contacts.kind.tolist() == [pliant.FeatureKind.EDGE_EDGE]
    assert contacts.vertices.tolist() == [[0, 1, 0, 3]] and contacts.weights.tolist() == [[0.5] * 4]
    for arguments, wrong in (
        ({"edges": [[0, 5]]}, "row 0 of edges names vertex 5"),
        ({"points": [0, 7]}, "row 1 of points names vertex 7"),
        ({"edges": [0, 1]}, "edges have shape"),
        ({"edges": [[0.0, 1.0]]}, "integers"),
    ):
        with pytest.raises(pliant.Error) as refused:
            world.add(None, at, **arguments)
        assert refused.value.kind == "BadArray" and wrong in str(refused.value), refused.value
    with pytest.raises(pliant.Error) as refused:
        world.add(None, at)
    assert refused.value.kind == "NoTriangles"


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_what_is_close_at_rest_is_left_out(dtype: Any) -> None:
    """A sheet folded in two: of it only what lies on each other is left."""
    faces, flat = sheet(6)
    flat = flat.astype(dtype)
    half = flat[:, 0].max() / 2
    folded = np.where(flat[:, :1] > half, flat * [-1, 1, 1] + [2 * half, 0, 0.1], flat).astype(dtype)
    world = pliant.World()
    cloth = world.add(faces, folded)
    ask = [world.close_vertex_triangle_pairs, world.close_edge_edge_pairs, world.close_triangle_pairs]

    def rows() -> list[set[tuple[int, ...]]]:
        return [set(map(tuple, one(Selection.within(cloth), 1.1).all().pairs.tolist())) for one in ask]

    every = rows()
    world.set_positions(cloth, flat)
    at_rest = rows()
    world.set_positions(cloth, folded)
    assert world.rest_positions(cloth) is None
    world.set_rest_positions(cloth, flat)
    kept = world.rest_positions(cloth)
    assert kept is not None and kept.dtype == dtype and (kept == flat).all()
    found = rows()
    assert all(one and before and one == all_ - before for one, all_, before in zip(found, every, at_rest))
    for again in (copy.deepcopy(world), pickle.loads(pickle.dumps(world))):
        assert len(again.close_triangle_pairs(Selection.EVERYTHING, 1.1).all().pairs) == len(found[2])
    with pytest.raises(pliant.Error) as refused:
        world.set_rest_positions(cloth, flat[1:])
    assert refused.value.kind == "WrongLength" and "positions" in str(refused.value)
    world.set_rest_positions(cloth, None)
    assert rows() == every


def test_thickness_counts_for_close_pairs_and_candidates() -> None:
    faces, flat = sheet(4)
    world = pliant.World()
    low, high = (world.add(faces, flat + [0.3, 0.2, height]) for height in (0.0, 1.0))
    of = Selection.between(low, high)
    asked: list[Callable[[], Any]] = [
        lambda: world.close_vertex_triangle_pairs(of, 0.25),
        lambda: world.close_edge_edge_pairs(of, 0.25),
        lambda: world.close_triangle_pairs(of, 0.25),
        lambda: world.edge_edge_candidates(of, 0.125),
        lambda: world.vertex_triangle_candidates(of, 0.125),
    ]
    assert not any(one().first() for one in asked)
    world.set_thickness(low, 0.25)
    world.set_thickness(high, 0.5)
    assert all(one().first() for one in asked)
    assert world.close_vertex_triangle_pairs(of, 0.25).all().distance.min() == 1.0
    assert world.clearance(of, 2.0)[low].min() == pytest.approx(0.125, abs=1e-6)
    every = world.close_vertex_triangle_pairs(of, 0.25).all()
    # One vertex that is thick enough: its own triangles, and itself.
    of_vertices = np.zeros(16)
    of_vertices[5] = 0.5
    world.set_vertex_thickness(high, of_vertices)
    some = world.close_vertex_triangle_pairs(of, 0.25).all()
    is_thick = np.where(some.pairs[:, 2] == high, (faces[some.pairs[:, 3]] == 5).any(1), some.pairs[:, 1] == 5)
    assert 0 < len(some.pairs) < len(every.pairs) and is_thick.all()
    again = pickle.loads(pickle.dumps(world))
    assert again.thickness(high).tolist() == world.thickness(high).tolist() == of_vertices.tolist()
    assert again.thickness(low).tolist() == [0.25] * 16
    for bad, kind in (([1.0], "WrongLength"), (["thick"] * 16, "BadArray"), (np.full(16, np.nan), "BadThickness")):
        with pytest.raises(pliant.Error) as refused:
            world.set_vertex_thickness(low, bad)
        assert refused.value.kind == kind, refused.value
    with pytest.raises(pliant.Error, match="the thickness of vertex 0 is -1") as refused:
        world.set_thickness(low, -1)
    assert (refused.value.body, refused.value.vertex, refused.value.thickness) == (low, 0, -1)


def as_rows(hits: Any) -> Any:
    return hits if isinstance(hits, np.ndarray) else hits.pairs


def test_lists_come_in_job_order_and_in_rows() -> None:
    world, _, _ = bodies(np.float32)
    asked: list[tuple[Any, Callable[[int], int]]] = [
        (world.vertex_triangle_candidates(Selection.EVERYTHING, 0.3), world.vertex_count),
        (world.edge_edge_candidates(Selection.EVERYTHING, 0.3), lambda body: len(world.edges(body))),
        (world.close_edge_edge_pairs(Selection.EVERYTHING, 0.5), lambda body: len(world.edges(body))),
        (world.close_triangle_pairs(Selection.EVERYTHING, 0.5), world.triangle_count),
    ]

    for query, count in asked:
        hits = as_rows(query.all(sort=False))
        assert sorted(hits.tolist()) == as_rows(query.all()).tolist() and len(hits)
        with pytest.raises(pliant.Error):
            query.all(sort=False, at_most=len(hits) - 1)
        rows = query.rows()
        assert (as_rows(rows.hits) == hits).all() and len(rows.places) == len(hits)
        assert rows.starts == {0: 0, 1: count(0)} and len(rows.offsets) == count(0) + count(1) + 1
        for body in (0, 1):
            for element in range(count(body)):
                own = np.flatnonzero((hits[:, 0] == body) & (hits[:, 1] == element))
                assert rows.row(body, element).tolist() == own.tolist()


def test_long_lists_are_the_same_on_several_threads() -> None:
    """Beyond 131,072 hits several threads fill the arrays."""
    faces, flat = grid(50)
    listed: list[list[Any]] = []
    for threads in (1, 3):
        world = pliant.World(threads=threads)
        world.add(faces, fold(flat, 0.3))
        before = world.memory_usage()
        close = world.close_edge_edge_pairs(Selection.EVERYTHING, 0.1)
        candidates = world.edge_edge_candidates(Selection.EVERYTHING, 0.05)
        listed.append([])
        for query in (close, candidates):
            in_order = query.all()
            sorted_numbers = as_rows(in_order)
            assert len(sorted_numbers) > 200_000
            hits = as_rows(query.all(sort=False))
            order = np.lexsort(hits.T[::-1])
            assert not (hits == sorted_numbers).all() and (hits[order] == sorted_numbers).all()
            assert (as_rows(query.rows().hits) == hits).all()
            listed[-1] += [in_order, hits]
        # The list of hits is kept, so that the next has its memory.
        assert world.memory_usage() - before > 2 * 16 * len(sorted_numbers)
    for one, many in zip(*listed, strict=True):
        pairs = zip(one, many, strict=True) if isinstance(one, tuple) else [(one, many)]
        assert all((a == b).all() for a, b in pairs)
