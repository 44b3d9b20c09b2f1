"""Answers: against integers and another definition, and against the reference, for every option, precision and query."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import exact
import numpy as np
import pliant
import pytest
from conftest import fold, grid, pairs_between, pairs_within
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst
from numpy.typing import NDArray

Soup = tuple[NDArray[Any], NDArray[Any]]

#: Every value of every option at least once.
OPTIONS: list[dict[str, Any]] = [
    {},
    {"degree": 2, "update": "bottom-up", "broad": "sweep"},
    {"degree": 4, "update": "top-down", "broad": "brute", "partition": "mean"},
    {"partition": "centre", "leaf_size": 1},
    {"partition": "connectivity", "leaf_size": 3, "level": 0, "threads": 2},
]


@st.composite
def soups(draw: st.DrawFn, coordinate: st.SearchStrategy[Any], dtype: Any) -> Soup:
    """Triangles over few vertices, so that they share corners, repeat them, touch and lie in one plane."""
    vertices = draw(st.integers(1, 9))
    positions = draw(npst.arrays(dtype, (vertices, 3), elements=coordinate))
    triangles = draw(st.integers(1, 10))
    faces = draw(npst.arrays(np.int64, (triangles, 3), elements=st.integers(0, vertices - 1)))
    return faces, positions


small_integers = soups(st.integers(-3, 3), np.int64)
any_float32 = soups(st.floats(-4, 4, width=32), np.float32)
any_float64 = soups(st.floats(allow_nan=False, min_value=-3e38, max_value=3e38), np.float64)


def ask_in_every_way(world: pliant.World, a: int, b: int) -> None:
    """Asks for all pairs, the first, and with a visitor, and holds the answers against each other and the reference."""
    between, itself = pairs_between(world, a, b).tolist(), pairs_within(world, a).tolist()
    whole = world.intersections().all().tolist()
    assert whole == [[a, i, b, j] for i, j in between]
    assert [[j, i] for i, j in between] == sorted(pairs_between(world, b, a).tolist(), key=lambda p: p[::-1])
    of_itself = [[a, i, a, j] for i, j in itself]
    everything = sorted(whole + of_itself + [[b, i, b, j] for i, j in pairs_within(world, b).tolist()])

    expected: dict[pliant.Selection, list[list[int]]] = {
        pliant.Selection.WORLD: whole,
        pliant.Selection.EVERYTHING: everything,
        pliant.Selection.between(a, b): whole,
        pliant.Selection.between(b, a): sorted([b, j, a, i] for i, j in between),
        pliant.Selection.within(a): of_itself,
    }
    for of, hits in expected.items():
        query = world.intersections(of)
        shown: list[Any] = []
        assert not query.visit(shown.append)
        assert sorted(list(pair) for pair in shown) == hits
        assert all(isinstance(pair, pliant.Pair) for pair in shown)
        first = query.first()
        assert list(first) in hits if first is not None else hits == []
        assert first is None or isinstance(first, pliant.Pair)
        query.prepare()
        assert query.all().tolist() == hits == query.all(at_most=len(hits)).tolist()
        if hits:
            with pytest.raises(pliant.Error, match=f"more hits than the {len(hits) - 1} that were allowed") as refused:
                query.all(at_most=len(hits) - 1)
            assert (refused.value.kind, refused.value.limit, refused.value.body) == ("TooManyHits", len(hits) - 1, None)
    world.validate()


@settings(max_examples=150, deadline=None)
@given(small_integers, small_integers, st.sampled_from([np.float32, np.float64]))
def test_small_integers_are_decided_as_in_integers(a: Soup, b: Soup, dtype: Any) -> None:
    (fa, va), (fb, vb) = a, b
    expected = exact.intersection_pairs(va, fa, vb, fb)
    itself = exact.self_intersection_pairs(va, fa)
    wa, wb = va.astype(dtype), vb.astype(dtype)
    for module in (pliant, pliant.reference):
        np.testing.assert_array_equal(module.intersection_pairs(wa, fa, wb, fb), expected)
        np.testing.assert_array_equal(module.self_intersection_pairs(wa, fa), itself)


@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("soup", [any_float32, any_float64], ids=["float32", "float64"])
def test_every_option_equals_the_reference(options: dict[str, Any], soup: st.SearchStrategy[Soup]) -> None:
    @settings(max_examples=25, deadline=None)
    @given(soup, soup, soup)
    def check(a: Soup, b: Soup, moved: Soup) -> None:
        world = pliant.World(**options)
        bodies = [world.add(*a), world.add(*b)]
        shapes = [a[1], b[1]]
        for _ in range(2):
            for body, (faces, _) in zip(bodies, (a, b)):
                expected = pliant.reference.self_intersection_pairs(shapes[body], faces)
                np.testing.assert_array_equal(pairs_within(world, body), expected)
            expected = pliant.reference.intersection_pairs(shapes[0], a[0], shapes[1], b[0])
            np.testing.assert_array_equal(pairs_between(world, *bodies), expected)
            ask_in_every_way(world, *bodies)
            # Another shape for the first body: rows of a soup, as often as needed.
            shapes[0] = np.resize(moved[1], a[1].shape)
            world.set_positions(0, shapes[0])

    check()


def test_a_visitor_stops_where_it_says_so_and_what_it_raises_arrives() -> None:
    faces, positions = grid(4)
    world = pliant.World()
    bodies = [world.add(faces, positions), world.add(faces, positions)]
    shown: list[pliant.Pair] = []

    def third(pair: pliant.Pair) -> bool:
        shown.append(pair)
        return len(shown) == 3

    of_two = world.intersections(pliant.Selection.between(*bodies))
    assert world.intersections().visit(third)
    assert len(shown) == 3
    assert of_two.visit(lambda pair: True)
    assert not world.intersections(pliant.Selection.within(0)).visit(lambda pair: True)
    with pytest.raises(ZeroDivisionError):
        world.intersections().visit(lambda pair: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        of_two.visit(lambda pair: 1 / 0)
    # A visit that was broken off leaves the world in order.
    ask_in_every_way(world, *bodies)


def test_a_folding_sheet_of_ten_thousand_triangles() -> None:
    faces, flat = grid(70)
    world = pliant.World()
    cloth = world.add(faces, flat)
    counts = []
    for step in range(5):
        shape = fold(flat, step / 4)
        world.set_positions(cloth, shape)
        pairs = pairs_within(world, cloth)
        assert pairs.dtype == np.uint32 and pairs.shape[1] == 2
        np.testing.assert_array_equal(pairs, pliant.self_intersection_pairs(shape, faces))
        assert (np.diff(pairs.astype(np.int64) @ [1 << 32, 1]) > 0).all(), "sorted, each once"
        assert world.statistics().pairs == len(pairs)
        counts.append(len(pairs))
    assert counts[0] == 0 and counts[-1] > 300
    # All triangles take the reference minutes; those found, and some others, moments.
    others = np.random.default_rng(1).choice(len(faces), 400, replace=False)
    part = np.union1d(pairs, others)
    expected = pliant.reference.self_intersection_pairs(shape, faces[part])
    np.testing.assert_array_equal(part[expected], pairs)


def test_rebuild_and_prepare_do_their_work() -> None:
    """None changes an answer; trees and counters show that they were done."""
    faces, flat = grid(16)
    turned = flat[:, [1, 2, 0]] * [1.0, 1.0, 0.01]
    world = pliant.World()
    body = world.add(faces, flat)
    fresh = pliant.World()
    fresh.add(faces, turned)
    before = world.tree_cut(body, 1).tolist()
    world.set_positions(body, turned)
    assert world.tree_cut(body, 1).tolist() == before != fresh.tree_cut(0, 1).tolist()
    world.rebuild(body)
    assert world.tree_cut(body, 1).tolist() == fresh.tree_cut(0, 1).tolist()

    # A first pair that is still there is found without a box; those counted then were made early.
    world = pliant.World()
    shape = fold(flat, 1.0)
    bodies = [world.add(faces, shape), world.add(faces, shape)]
    for early in (False, True):
        of_world, itself = world.intersections(), world.intersections(pliant.Selection.within(bodies[0]))
        assert of_world.first() and itself.first()
        for body in bodies:
            world.set_positions(body, shape)
        if early:
            of_world.prepare()
        assert of_world.first()
        assert (world.statistics().boxes_bottom_up > 0) == early
        world.set_positions(bodies[0], shape)
        if early:
            itself.prepare()
        assert itself.first()
        assert (world.statistics().boxes_bottom_up > 0) == early


def test_the_order_of_vertices_is_one_that_a_body_can_be_stored_in() -> None:
    faces = np.array([[9, 1, 2], [2, 1, 3], [4, 8, 6]])
    vertices = np.arange(30, dtype=np.float32).reshape(10, 3) % 7
    world = pliant.World()
    order = world.vertex_order(world.add(faces, vertices))
    assert sorted(order) == list(range(10))
    new_number = np.argsort(order)
    stored = world.add(new_number[faces], vertices[order])
    assert list(world.vertex_order(stored)) == list(range(10))


def test_selections_are_values() -> None:
    world, everything = pliant.Selection.WORLD, pliant.Selection.EVERYTHING
    between, within = pliant.Selection.between, pliant.Selection.within
    selections = [world, everything, between(0, 1), between(1, 0), within(0), within(np.uint8(1))]
    assert len(set(selections)) == len(selections)
    assert [repr(of) for of in selections] == [
        "Selection.WORLD",
        "Selection.EVERYTHING",
        "Selection.between(0, 1)",
        "Selection.between(1, 0)",
        "Selection.within(0)",
        "Selection.within(1)",
    ]
    for of in selections:
        assert of == eval(repr(of), vars(pliant)) == pickle.loads(pickle.dumps(of)) == copy.deepcopy(of)
        assert hash(of) == hash(copy.copy(of)) and of != 0
    assert repr(pliant.World().intersections(between(0, 1))) == "<pliant.Query of Selection.between(0, 1)>"
    with pytest.raises(AttributeError):
        setattr(world, "of", everything)
    with pytest.raises(TypeError):
        pliant.World().intersections(0)  # type: ignore[arg-type]


def test_a_query_may_be_asked_again_and_answers_for_the_shapes_of_then() -> None:
    faces, flat = grid(12)
    world = pliant.World()
    body = world.add(faces, flat)
    itself = world.intersections(pliant.Selection.within(body))
    world.intersections().all()
    assert len(itself.all()) == 0 and itself.first() is None
    shape = fold(flat, 1.0)
    world.set_positions(body, shape)
    expected = pliant.reference.self_intersection_pairs(shape, faces)
    np.testing.assert_array_equal(itself.all()[:, [1, 3]], expected)
    assert len(expected) > 0
    world.remove(body)
    with pytest.raises(pliant.Error, match="body 0: not in this world"):
        itself.all()


def test_loose_boxes_can_be_read() -> None:
    world = pliant.World()
    body = world.add([[0, 1, 2]], np.eye(3, dtype=np.float32))
    assert world.loose_box(body) is None
    world.set_loose_box(body, ((-1, 0, 0), (2, 2, 2.5)))
    assert world.loose_box(body) == ([-1, 0, 0], [2, 2, 2.5])
    world.set_loose_box(body, None)
    assert world.loose_box(body) is None


def test_a_world_can_be_pickled() -> None:
    world = pliant.World(degree=4, level=2, threads=2)
    for step in range(4):
        world.add([[0, 1, 2]], (np.eye(3) + 0.1 * step).astype(np.float32))
    world.add([[0, 1, 2]], np.eye(3, dtype=np.float32))
    world.set_loose_box(1, ((-1, 0, 0), (2, 2, 0.1 + 1)))
    world.set_filter(2, 1, 6)
    world.set_environment(3, 9)
    world.ignore(1, 1)
    world.ignore(3, 1)
    world.remove(0)
    world.remove(4)
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        again = pickle.loads(pickle.dumps(world, protocol))
        assert again.options() == world.options() and again.dtype == world.dtype
        assert again.bodies() == world.bodies() == [1, 2, 3]
        for body in world.bodies():
            np.testing.assert_array_equal(again.positions(body), world.positions(body))
            np.testing.assert_array_equal(again.triangles(body), world.triangles(body))
            assert again.filter(body) == world.filter(body)
            assert again.environment(body) == world.environment(body) == (9 if body == 3 else 0)
            assert again.loose_box(body) == world.loose_box(body)
        assert again.ignored() == world.ignored() == [(1, 1), (1, 3)]
        assert again.add([[0, 1, 2]], np.eye(3, dtype=np.float32)) == 5
    # One whose type is fixed though its bodies are gone, and one that never had any.
    for body in world.bodies():
        world.remove(body)
    again = pickle.loads(pickle.dumps(world))
    assert again.dtype == np.float32 and again.add([[0, 1, 2]], np.eye(3, dtype=np.float32)) == 5
    never = pickle.loads(pickle.dumps(pliant.World(broad="tree")))
    assert never.dtype is None and never.options()["broad"] == "tree" and never.add([[0, 1, 2]], np.eye(3)) == 0


def test_what_pickle_did_not_write_is_refused() -> None:
    world = pliant.World()
    world.add([[0, 1, 2]], np.eye(3))
    world.add([[0, 1, 2]], np.eye(3))
    written: dict[str, Any] = world.__reduce__()[2]
    with pytest.raises(pliant.Error, match="this world has had bodies"):
        world.__setstate__(written)
    mistakes: list[dict[str, Any]] = [
        {"dtype": "int8"},
        {"dtype": "float32"},
        {"bodies": written["bodies"][::-1]},
        {"bodies": [written["bodies"][0] | {"faces": [[0, 1, 3]]}]},
        {"bodies": [written["bodies"][0] | {"loose_box": ((0, 0, 0), (0, 0, 0))}]},
        {"ignored": [(0, 2)]},
    ]
    for mistake in mistakes:
        fresh = pliant.World()
        with pytest.raises(pliant.Error):
            fresh.__setstate__(written | mistake)
        assert fresh.bodies() == [] and fresh.dtype is None
    for missing in written:
        with pytest.raises((KeyError, TypeError)):
            pliant.World().__setstate__({name: fact for name, fact in written.items() if name != missing})


def test_a_world_says_how_much_it_holds() -> None:
    faces, positions = grid(60)
    world = pliant.World()
    empty = world.memory_usage()
    body = world.add(faces, positions)
    added = world.memory_usage()
    assert 60 * len(faces) < added - empty < 200 * len(faces)
    world.set_positions(body, positions)
    assert world.memory_usage() - added >= 2 * positions.nbytes  # the copy of Python's, and that of the world
    world.remove(body)
    assert world.memory_usage() < empty + 2 * positions.nbytes
