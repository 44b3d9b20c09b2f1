"""Answers: against integers and another definition, and against the reference, for every option, precision and query."""

from __future__ import annotations

from typing import Any

import exact
import numpy as np
import pliant
import pytest
from conftest import fold, grid
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
    between = world.intersection_pairs_between(a, b).tolist()
    whole = world.intersection_pairs().tolist()
    assert whole == [[a, i, b, j] for i, j in between]
    assert [[j, i] for i, j in between] == sorted(world.intersection_pairs_between(b, a).tolist(), key=lambda p: p[::-1])
    itself = world.self_intersection_pairs(a).tolist()

    shown: list[Any] = []
    assert not world.visit_intersections(shown.append)
    assert sorted(list(pair) for pair in shown) == whole
    assert all(isinstance(pair, pliant.Pair) for pair in shown)
    shown.clear()
    assert not world.visit_intersections_between(a, b, shown.append)
    assert sorted(list(pair) for pair in shown) == between
    shown.clear()
    assert not world.visit_self_intersections(a, shown.append)
    assert sorted(list(pair) for pair in shown) == itself

    first = world.first_intersection()
    assert list(first) in whole if first is not None else whole == []
    one = world.first_intersection_between(a, b)
    assert list(one) in between if one is not None else between == []
    own = world.first_self_intersection(a)
    assert list(own) in itself if own is not None else itself == []
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
                np.testing.assert_array_equal(world.self_intersection_pairs(body), expected)
            expected = pliant.reference.intersection_pairs(shapes[0], a[0], shapes[1], b[0])
            np.testing.assert_array_equal(world.intersection_pairs_between(*bodies), expected)
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

    assert world.visit_intersections(third)
    assert len(shown) == 3
    assert world.visit_intersections_between(bodies[0], bodies[1], lambda pair: True)
    assert not world.visit_self_intersections(0, lambda pair: True)
    with pytest.raises(ZeroDivisionError):
        world.visit_intersections(lambda pair: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        world.visit_intersections_between(0, 1, lambda pair: 1 / 0)
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
        pairs = world.self_intersection_pairs(cloth)
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


def test_rebuild_and_updates_do_their_work() -> None:
    """None changes an answer; trees and counters show that they were done."""
    faces, flat = grid(16)
    turned = flat[:, [1, 2, 0]] * [1.0, 1.0, 0.01]
    world = pliant.World()
    body = world.add(faces, flat)
    fresh = pliant.World()
    fresh.add(faces, turned)
    before = world.tree_parts(body, 1).tolist()
    world.set_positions(body, turned)
    assert world.tree_parts(body, 1).tolist() == before != fresh.tree_parts(0, 1).tolist()
    world.rebuild(body)
    assert world.tree_parts(body, 1).tolist() == fresh.tree_parts(0, 1).tolist()

    # A first pair that is still there is found without a box; those counted then were made by the update before.
    world = pliant.World()
    shape = fold(flat, 1.0)
    bodies = [world.add(faces, shape), world.add(faces, shape)]
    for update in (False, True):
        assert world.first_intersection() and world.first_self_intersection(bodies[0])
        for body in bodies:
            world.set_positions(body, shape)
        if update:
            world.update()
        assert world.first_intersection()
        assert (world.statistics().boxes_bottom_up > 0) == update
        world.set_positions(bodies[0], shape)
        if update:
            world.update_body(bodies[0])
        assert world.first_self_intersection(bodies[0])
        assert (world.statistics().boxes_bottom_up > 0) == update


def test_the_order_of_vertices_is_one_that_a_body_can_be_stored_in() -> None:
    faces = np.array([[9, 1, 2], [2, 1, 3], [4, 8, 6]])
    vertices = np.arange(30, dtype=np.float32).reshape(10, 3) % 7
    world = pliant.World()
    order = world.vertex_order(world.add(faces, vertices))
    assert sorted(order) == list(range(10))
    new_number = np.argsort(order)
    stored = world.add(new_number[faces], vertices[order])
    assert list(world.vertex_order(stored)) == list(range(10))
