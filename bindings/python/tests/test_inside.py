"""Inside, closest points, containment and depth: known by hand, and against sums over all triangles."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import grid
from numpy.typing import NDArray
from pliant import Selection
from test_arrays import OnlyDlpack

Shape = NDArray[np.float64]

#: A box of side 2 about the origin, its triangles turned outward.
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
BOX = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)
TYPES = pytest.mark.parametrize("dtype", [np.float32, np.float64])
ON = 0
RULES: Any = ("nonzero", "positive", "parity")


def world_of(*shapes: Any, faces: Any = BOX, dtype: Any = np.float64) -> pliant.World:
    world = pliant.World()
    for shape in shapes:
        world.add(faces, np.asarray(shape, dtype))
    return world


def boxes(*shapes: Shape) -> tuple[NDArray[np.int64], Shape]:
    """One mesh of several boxes."""
    faces = np.concatenate([BOX + 8 * place for place in range(len(shapes))])
    return faces, np.concatenate(shapes)


@TYPES
def test_points_are_inside_on_or_outside(dtype: Any) -> None:
    world = world_of(CORNERS, dtype=dtype)
    tiny = np.finfo(dtype).smallest_subnormal
    next_to = np.nextafter(dtype(1), dtype(2))
    points = np.array([[0, 0, 0], [1, 0, 0.5], [1, 1, 1], [-1, 1, tiny], [next_to, 0, 0], [0, 3, 0]], dtype)
    found = world.points_inside(points, 0)
    assert isinstance(found, pliant.Located) and found._fields == ("sides", "windings")
    assert [column.dtype.name for column in (found.sides, found.windings, found.is_inside)] == ["int8", "int32", "bool"]
    assert found.sides.tolist() == [1, ON, ON, ON, -1, -1]
    assert found.windings.tolist() == [1, 0, 0, 0, 0, 0]
    assert found.is_inside.tolist() == [True] + [False] * 5
    for rule in RULES:
        assert world.points_inside(points, 0, rule).sides.tolist() == found.sides.tolist()
        assert [column.shape for column in world.points_inside(points[:0], 0, rule)] == [(0,), (0,)]


def test_points_are_arrays_as_positions_are() -> None:
    double, single = world_of(CORNERS), world_of(CORNERS, dtype=np.float32)
    points = np.array([[0.5, 0, 0], [2, 0, 0]])
    given: list[Any] = [points, points.tolist(), points.astype("f4"), points.astype(">f8"), points[::-1][::-1], OnlyDlpack(points)]
    for asked in given:
        assert double.points_inside(asked, 0).sides.tolist() == [1, -1]
        assert double.closest_points(asked).distance.tolist() == [0.5, 1]
    assert single.points_inside(points.astype("f4"), 0).sides.tolist() == [1, -1]
    calls: list[tuple[str, str, Callable[[], object]]] = [
        ("Precision", r"^points are float64 in a world of float32.*points.astype\(numpy.float32\)", lambda: single.points_inside(points, 0)),
        ("Precision", "^points are float64", lambda: single.closest_points(points)),
        ("Precision", "^points are float64", lambda: single.signed_closest_points(points, 0)),
        ("BadArray", r"points have shape \(2, 2\); it must be \(k, 3\): two coord", lambda: double.points_inside(points[:, :2], 0)),
        ("BadArray", r"points have shape \(3,\).*flat; give points.reshape\(-1, 3\)", lambda: double.closest_points(points[0])),
        ("BadArray", "points are of type int64", lambda: double.closest_points(np.zeros((1, 3), np.int64))),
        ("BadArray", "points are masked", lambda: double.closest_points(np.ma.masked_equal(points, 0))),
    ]
    for kind, message, call in calls:
        with pytest.raises(pliant.Error, match=message) as refused:
            call()
        assert refused.value.kind == kind


def test_rules_where_a_body_overlaps_itself_and_is_turned() -> None:
    # A box, another that overlaps it, and one turned inside out.
    faces, shape = boxes(CORNERS, CORNERS + 1, CORNERS + [9, 0, 0])
    faces[24:] = faces[24:, ::-1]
    world = world_of(shape, faces=faces)
    points = np.array([[0.5, 0.5, 0.5], [-0.5, 0, 0], [9, 0, 0], [5, 0, 0], [0.5, 0.5, 1]])
    expected = [
        ([1, 1, 1, -1, ON], [2, 1, -1, 0, 0]),
        ([1, 1, -1, -1, ON], [2, 1, -1, 0, 0]),
        ([-1, 1, 1, -1, ON], [0, 1, 1, 0, 0]),
    ]
    for rule, (sides, windings) in zip(RULES, expected, strict=True):
        found = world.points_inside(points, 0, rule=rule)
        assert (found.sides.tolist(), found.windings.tolist()) == (sides, windings)


@TYPES
def test_vertices_inside_another_body(dtype: Any) -> None:
    world = world_of(CORNERS, CORNERS + 1, dtype=dtype)
    found = world.inside(1, 0)
    assert found.sides.tolist() == world.points_inside(world.positions(1), 0).sides.tolist()
    assert found.sides.tolist() == [1] + [-1] * 7 and found.windings.tolist() == [1] + [0] * 7
    world.set_positions(1, (CORNERS + [1, 0, 0]).astype(dtype))
    assert world.inside(1, 0, "parity").sides.tolist() == [ON] * 4 + [-1] * 4
    edit = world.edit(1)
    edit.remove_triangles(np.flatnonzero((world.triangles(1) == 0).any(axis=1)))
    world.apply(edit)
    assert world.inside(1, 0).sides.tolist() == [-1] + [ON] * 3 + [-1] * 4


@TYPES
def test_edges_at_which_a_mesh_is_not_closed(dtype: Any) -> None:
    closed = world_of(CORNERS, dtype=dtype).watertight(0)
    assert isinstance(closed, pliant.Watertight) and closed.is_closed is closed.is_even is True
    assert all(edges.shape == (0, 2) and edges.dtype == np.uint32 for edges in closed)
    world = world_of(CORNERS, faces=BOX[1:], dtype=dtype)
    assert world.watertight(0).open.tolist() == [[0, 1], [0, 3], [1, 3]]
    assert world.watertight(0).is_closed is world.watertight(0).is_even is False
    world.set_mesh(0, np.concatenate([BOX[:1, ::-1], BOX[1:]]), CORNERS.astype(dtype))
    found = world.watertight(0)
    assert found.turned.tolist() == [[0, 1], [0, 3], [1, 3]] and found.open.tolist() == found.doubled.tolist() == []
    assert found.is_even and not found.is_closed
    # Which way triangles are turned matters to numbers, not to parity.
    assert world.points_inside(np.zeros((1, 3), dtype), 0, "parity").is_inside.all()
    with pytest.raises(pliant.Error):
        world.points_inside(np.zeros((1, 3), dtype), 0)
    doubled = world_of(CORNERS, faces=np.concatenate([BOX, BOX]), dtype=dtype)
    assert len(doubled.watertight(0).doubled) == 18 and doubled.watertight(0).is_closed
    assert doubled.points_inside(np.zeros((1, 3), dtype), 0).windings.tolist() == [2]


@TYPES
def test_refusals(dtype: Any) -> None:
    world = world_of(CORNERS, CORNERS + 1, dtype=dtype)
    points = np.zeros((3, 3), dtype)
    hole = world.add(BOX[1:], CORNERS.astype(dtype))
    edges = [(0, 1), (0, 3), (1, 3)]
    needs_an_inside: list[Callable[[], object]] = [
        lambda: world.points_inside(points, hole),
        lambda: world.points_inside(points[:0], hole, "parity"),
        lambda: world.inside(0, hole),
        lambda: world.signed_closest_points(points, hole),
        lambda: world.depth(0, hole),
    ]
    for call in needs_an_inside:
        with pytest.raises(pliant.Error, match=f"^body {hole}: has no inside.* 3 edges, such as 0-1, 0-3, 1-3") as refused:
            call()
        error = refused.value
        assert (error.kind, error.body, error.some_edges, error.count, error.edges) == ("NotClosed", hole, edges, 3, None)
    for value in (np.nan, -np.inf):
        points[1] = [1, 2, value]
        take_points: list[Callable[[], object]] = [
            lambda: world.points_inside(points, 0),
            lambda: world.closest_points(points),
            lambda: world.closest_points(points, hole),
            lambda: world.signed_closest_points(points, 0),
        ]
        for call in take_points:
            with pytest.raises(pliant.Error, match="^point 1 is at ") as refused:
                call()
            error = refused.value
            assert (error.kind, error.point, error.vertex) == ("BadPoint", 1, None)
            assert error.position is not None and error.position[:2] == (1.0, 2.0)
    points[1] = 0
    any_world: Any = world
    others: list[tuple[str, Callable[[], object]]] = [
        ("NoSuchBody", lambda: world.watertight(9)),
        ("NoSuchBody", lambda: world.points_inside(points, 9)),
        ("NoSuchBody", lambda: world.inside(9, 0)),
        ("NoSuchBody", lambda: world.contained(Selection.between(0, 9))),
        ("NoSuchBody", lambda: world.closest_points(points, 9)),
        ("NoSuchBody", lambda: world.closest_points(points, -1)),
        ("NoSuchBody", lambda: world.signed_closest_points(points, 9)),
        ("NoSuchBody", lambda: world.depth(0, 9)),
        ("SameBody", lambda: world.inside(0, 0)),
        ("SameBody", lambda: world.contained(Selection.between(0, 0))),
        ("SameBody", lambda: world.depth(1, 1)),
        ("BadOption", lambda: any_world.points_inside(points, 0, "odd")),
        ("BadOption", lambda: any_world.inside(0, 1, rule="")),
        *(("BadDistance", lambda far=far: world.closest_points(points, cut_off=far)) for far in (-1.0, np.nan)),
        *(("BadDistance", lambda far=far: world.signed_closest_points(points, 0, far)) for far in (-1.0, np.nan)),
    ]
    for kind, call in others:
        with pytest.raises(pliant.Error) as refused:
            call()
        assert refused.value.kind == kind
        if kind == "BadOption":
            assert 'it can be one of "nonzero", "positive", "parity"' in str(refused.value)
        if kind == "BadDistance":
            assert str(refused.value).endswith("this is the argument cut_off")
    world.validate()


@TYPES
def test_closest_points_by_hand(dtype: Any) -> None:
    world = world_of(CORNERS, CORNERS + [9, 0, 0], dtype=dtype)
    points = np.array([[0, 0, 4], [2, 2, 1], [8, 0.5, 0.25], [4.75, 0, 0], [0, 0, 0.5]], dtype)
    found = world.closest_points(points)
    assert isinstance(found, pliant.ClosestPoints)
    types = [np.bool_, np.uint32, np.uint32, *[np.float64] * 4, np.uint8]
    assert [(column.dtype, len(column)) for column in found] == [(np.dtype(kind), 5) for kind in types]
    assert found.found.all() and found.bodies.tolist() == [0, 0, 1, 1, 0]
    assert found.distance.tolist() == pytest.approx([3, np.sqrt(2), 0, 3.25, 0.5], rel=1e-9, abs=0)
    assert found.points.tolist() == [[0, 0, 1], [1, 1, 1], [8, 0.5, 0.25], [8, 0, 0], [0, 0, 1]]
    assert found.direction[[0, 2, 3, 4]].tolist() == [[0, 0, 1], [0, 0, 0], [-1, 0, 0], [0, 0, -1]]
    # On the diagonal of a side, at a corner, and in a triangle.
    assert found.features[1] in (0, 1, 2) and found.features[2] == 6
    assert all(feature in (3, 4, 5) for feature in found.features[[0, 3, 4]])
    signed = world.signed_closest_points(points, 0, cut_off=3.0)
    assert signed.found.tolist() == [True, True, False, False, True]
    assert signed.distance.tolist() == pytest.approx([3, np.sqrt(2), np.inf, np.inf, -0.5], rel=1e-9)
    assert signed.direction[4].tolist() == [0, 0, -1]
    none = world.closest_points(points, 1, 1.0)
    assert none.found.tolist() == [False, False, True, False, False]
    for place in (0, 1, 3, 4):
        assert none.bodies[place] == none.triangles[place] == 2**32 - 1 and none.features[place] == 255
        assert np.isnan(none.points[place]).all() and np.isnan(none.barycentric[place]).all()
        assert np.isnan(none.direction[place]).all() and none.distance[place] == np.inf
    assert [column.shape for column in world.closest_points(points[:0])] == [(0,), (0,), (0,), (0,), (0, 3), (0, 3), (0, 3), (0,)]
    assert not pliant.World().closest_points(points).found.any()


@TYPES
def test_components_that_are_contained(dtype: Any) -> None:
    faces, shape = boxes(CORNERS, 0.25 * CORNERS, CORNERS + 20)
    world = world_of(4 * CORNERS, dtype=dtype)
    pair = world.add(faces, shape.astype(dtype))
    hole = world.add(BOX[1:], (9 * CORNERS).astype(dtype))
    found = world.contained()
    assert isinstance(found, pliant.Containment) and found.all.dtype == np.uint32
    assert found.all.tolist() == [[pair, 0, 0], [pair, 1, 0]] and found.open == [hole]
    assert len(world.intersections().all()) == 0
    world.ignore(0, pair)
    assert world.contained(Selection.EVERYTHING).all.shape == (0, 3)
    between = world.contained(Selection.between(0, pair))
    assert between.all.tolist() == found.all.tolist() and between.open == []
    # The first component reaches out of the box now.
    moved = shape.copy()
    moved[:8] += [4, 0, 0]
    world.set_positions(pair, moved.astype(dtype))
    assert world.contained(Selection.between(pair, 0)).all.tolist() == [[pair, 1, 0]]
    assert pliant.World().contained().open == []


@TYPES
def test_depth_is_bracketed(dtype: Any) -> None:
    world = world_of(CORNERS, 4 * CORNERS + [0, 0, -4.5], dtype=dtype)
    depth = world.depth(0, 1)
    assert isinstance(depth, pliant.Depth) and depth.of_vertices.dtype == np.float64
    # The lower half of the box is in the table, which begins at z = -0.5.
    assert depth.of_vertices.tolist() == [0.5, 0] * 4
    assert (depth.vertex, depth.at_least) == (0, 0.5) and 0.5 <= depth.at_most <= 0.5 + 1.5
    faces, flat = grid(8)
    for height, depths in ((-1.0, (0.5, 1.0)), (3.0, (0.0, 0.0))):
        sheet = world.add(faces, (flat + [-0.5, -0.5, height]).astype(dtype))
        depth = world.depth(sheet, 1)
        assert depth.at_least == depths[0] and depth.at_least <= depth.at_most <= depths[1]
        assert (depth.vertex is None) == (depth.at_least == 0) == (not depth.of_vertices.any())
    # A plate goes right through a stick, and no vertex of it is inside.
    stick = world.add(BOX, (CORNERS * [0.1, 0.1, 9]).astype(dtype))
    plate = world.add([[0, 1, 2]], np.array([[-50, -50, 0], [50, -50, 0], [0, 50, 0]], dtype))
    depth = world.depth(plate, stick)
    assert depth.vertex is None and depth.at_least == 0 and depth.at_most >= 0.1


def windings(faces: Any, shape: Shape, points: Shape) -> NDArray[np.int64]:
    """Winding numbers: solid angles of all triangles, summed."""
    a, b, c = (shape[faces[:, k]][None] - points[:, None] for k in range(3))
    x, y, z = (np.linalg.norm(way, axis=-1) for way in (a, b, c))
    volume = (a * np.cross(b, c)).sum(-1)
    rest = x * y * z + (a * b).sum(-1) * z + (b * c).sum(-1) * x + (c * a).sum(-1) * y
    turns: Shape = np.arctan2(volume, rest).sum(1) / (2 * np.pi)
    assert np.abs(turns - np.rint(turns)).max() < 1e-6
    return np.rint(turns).astype(np.int64)


def distances(faces: Any, shape: Shape, points: Shape) -> Shape:
    """Distances (k, m) of points from triangles: from their insides, or from the nearest edge."""
    corners, at = shape[faces][None], points[:, None]
    nearest = np.full((len(points), len(faces)), np.inf)
    for k in range(3):
        foot, way = corners[:, :, k], corners[:, :, (k + 1) % 3] - corners[:, :, k]
        along = np.clip(((at - foot) * way).sum(-1) / (way**2).sum(-1), 0, 1)
        nearest = np.minimum(nearest, np.linalg.norm(foot + along[..., None] * way - at, axis=-1))
    normals = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    height = ((at - corners[:, :, 0]) * normals).sum(-1)
    foot = at - height[..., None] * normals
    is_over = np.ones_like(height, dtype=bool)
    for k in range(3):
        way = corners[:, :, (k + 1) % 3] - corners[:, :, k]
        is_over &= (np.cross(way, foot - corners[:, :, k]) * normals).sum(-1) >= 0
    return np.where(is_over, np.abs(height), nearest)


@TYPES
@pytest.mark.parametrize("threads", [1, 2])
def test_random_bodies_against_all_triangles(dtype: Any, threads: int) -> None:
    random = np.random.default_rng(7)
    shapes = [CORNERS * random.uniform(0.3, 1.5, 3) + random.normal(0, 0.6, (8, 3)) + random.normal(0, 1, 3) for _ in range(12)]
    faces, shape = boxes(*shapes)
    shape = shape.astype(dtype).astype(np.float64)
    world = pliant.World(threads=threads, leaf_size=2)
    body = world.add(faces, shape.astype(dtype))
    points = random.uniform(-3, 3, (400, 3)).astype(dtype).astype(np.float64)
    asked: Any = points.astype(dtype)

    expected = windings(faces, shape, points)
    assert len(np.unique(expected)) >= 4
    for rule, is_inside in zip(RULES, (expected != 0, expected > 0, expected % 2 == 1), strict=True):
        found = world.points_inside(asked, body, rule)
        assert (found.sides == np.where(is_inside, 1, -1)).all() and (found.is_inside == is_inside).all()
        assert (found.windings == (expected % 2 if rule == "parity" else expected)).all()
    other = world.add(np.array([[0, 1, 2]]), asked[:3])
    assert world.inside(other, body).windings.tolist() == expected[:3].tolist()
    world.remove(other)

    of_each = distances(faces, shape, points)
    least = of_each.min(1)
    for closest in (world.closest_points(asked), world.closest_points(asked, body)):
        assert closest.found.all() and (closest.bodies == body).all()
        np.testing.assert_allclose(closest.distance, least, rtol=1e-7, atol=1e-12)
        np.testing.assert_allclose(of_each[np.arange(400), closest.triangles], least, rtol=1e-7, atol=1e-12)
        corners = shape[faces[closest.triangles]]
        np.testing.assert_allclose((closest.barycentric[:, :, None] * corners).sum(1), closest.points, atol=1e-12)
        np.testing.assert_allclose(closest.points + closest.distance[:, None] * closest.direction, points, atol=1e-7)
        # Weights of 0 are those of corners away from the feature.
        sizes = np.array([1, 1, 1, 2, 2, 2, 3])[closest.features]
        assert ((closest.barycentric > 0).sum(1) <= sizes).all() and (closest.features[sizes == 1] == closest.barycentric.argmax(1)[sizes == 1]).all()
    signed = world.signed_closest_points(asked, body, 0.5)
    near = closest.distance <= 0.5
    assert (signed.found == near).all() and 0 < near.sum() < 400
    assert (signed.distance[near] == np.where(expected != 0, -1, 1)[near] * closest.distance[near]).all()

    cloud = world.add(np.arange(399).reshape(-1, 3), asked[:399])
    depth = world.depth(cloud, body)
    assert (depth.of_vertices == np.where(expected != 0, closest.distance, 0)[:399]).all()
    assert depth.vertex == depth.of_vertices.argmax() and depth.at_least == depth.of_vertices.max() < depth.at_most
    # Points of its triangles are no deeper.
    weights = random.dirichlet([1, 1, 1], (133, 20))
    within = (weights[..., None] * points[:399].reshape(133, 1, 3, 3)).sum(2).reshape(-1, 3).astype(dtype)
    deepest = -world.signed_closest_points(within, body).distance.min()
    assert 0 < deepest <= depth.at_most


def test_checked_files_say_what_lies_inside(tmp_path: Path) -> None:
    def box(name: str, low: float, high: float) -> str:
        corners = [[(low, high)[k >> axis & 1] for axis in range(3)] for k in range(8)]
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        lines = ["v {} {} {}".format(*corner) for corner in corners]
        lines += ["f {} {} {} {}".format(*(k + 1 for k in quad)) for quad in quads]
        file = tmp_path / name
        file.write_text("\n".join(lines) + "\n")
        return str(file)

    large, small, deep = box("large.obj", 0, 8), box("small.obj", 1, 2), box("deep.obj", 7, 9)
    (frame,) = pliant.check(small, large)
    assert (frame.count, frame.inside, frame.not_closed) == (0, ((0, 0, 1),), ())
    (frame,) = pliant.check(deep, large, places=True, solid=True)
    assert frame.inside == ()
    assert [place.depth for place in frame.places or ()] == [1]
    (frame,) = pliant.check(deep, large, places=True)
    assert [place.depth for place in frame.places or ()] == [None]
