"""Whatever a call is given: an answer, or an exception that says what is wrong; never a panic, never a broken world."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import chain, product
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import fold, grid

FACES, FLAT = grid(4)
SHAPE = fold(FLAT, 1.0)

ODD: list[Any] = [
    *(0, 1, 2, 3, -1, 2**31, 2**32 - 1, 2**32, 2**70, True, None, 0.0, 1.5, float("nan"), "", "x", b"1", (), [], {}, object()),
    *([[0, 1, 2]], [[0.0, 1.0, 2.0]], [[0, 1], [2]], (1, 2), ([0, 0, 0], [1, 1, 1]), ([-9] * 3, [9] * 3), [None]),
    *(FACES, FACES[:0], FACES[:, :2], FACES.astype(object), FACES.astype("M8[s]"), FACES.astype("V4"), FACES[::-2]),
    *(FLAT, SHAPE, SHAPE.astype("f4"), SHAPE.astype(">f8"), SHAPE[::-1], FLAT[:0], FLAT[0], SHAPE.T, np.float64(3), np.uint8(1)),
    np.broadcast_to(np.float64(0.5), FLAT.shape),
    np.full(FLAT.shape, 1e308),
    np.ma.masked_array(SHAPE),
    np.array(["a"]),
    lambda *_: None,
    lambda *_: True,
    lambda out: np.copyto(out, SHAPE),
    pliant.World(),
    *(pliant.Selection.WORLD, pliant.Selection.EVERYTHING, pliant.Selection.between(0, 1), pliant.Selection.between(1, 1)),
    *(pliant.Selection.within(2), pliant.Selection.within(2**32 - 1), pliant.Selection, pliant.World().intersections()),
    range(3),
    int,
    pliant,
]

#: Not a panic: that is no Exception at all. ValueError is also what numpy says of ragged lists.
SAID = (pliant.Error, TypeError, OverflowError, ValueError)

METHODS = sorted(name for name in vars(pliant.World) if name[0] != "_" and name != "dtype")
ASKED = sorted(name for name in vars(pliant.Query) if name[0] != "_")
FUNCTIONS = [
    pliant.Selection.between,
    pliant.Selection.within,
    pliant.Selection,
    pliant.Query,
    pliant.check,
    pliant.intersection_pairs,
    pliant.self_intersection_pairs,
    pliant.reference.intersection_pairs,
    pliant.reference.self_intersection_pairs,
    pliant.World,
]

KEYWORDS = ["threads", "frames", "split", "groups", "ignore", "baseline", "weld", "first", "itself", "degree", "partition", "level", "leaf_size", "update", "broad"]


def three_bodies() -> pliant.World:
    world = pliant.World()
    for shape in (FLAT, SHAPE, FLAT):
        world.add(FACES, shape)
    return world


def is_in_order(world: pliant.World) -> None:
    world.validate()
    for body in world.bodies():
        world.intersections(pliant.Selection.within(body)).all()
    world.intersections().all()


def is_answered(call: Callable[..., Any], arguments: Iterable[Any], **keywords: Any) -> None:
    try:
        call(*arguments, **keywords)
    except SAID as error:
        assert str(error)
        assert getattr(error, "kind", None) not in ("Broken", "Busy")


@pytest.mark.parametrize("name", METHODS)
def test_methods(name: str) -> None:
    world = three_bodies()
    for arguments in chain([()], product(ODD), product(ODD, ODD), product([0], [1], ODD), product([0], ODD, ODD)):
        is_answered(getattr(world, name), arguments)
        if world.bodies() != [0, 1, 2]:
            is_in_order(world)
            world = three_bodies()
    is_in_order(world)


@pytest.mark.parametrize("name", ASKED)
def test_queries(name: str) -> None:
    world = three_bodies()
    for of in (odd for odd in ODD if isinstance(odd, pliant.Selection)):
        for arguments in chain([()], product(ODD), product(ODD[:9], ODD[:9])):
            is_answered(getattr(world.intersections(of), name), arguments)
    for odd in ODD:
        is_answered(world.intersections().all, (), at_most=odd)
    is_in_order(world)


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_functions(function: Callable[..., Any]) -> None:
    for arguments in chain([()], product(ODD), product(ODD, ODD), product([SHAPE], [FACES], ODD, ODD)):
        is_answered(function, arguments)
    for keyword in KEYWORDS:
        for odd in ODD:
            is_answered(function, (), **{keyword: odd})
            is_answered(function, (SHAPE, FACES), **{keyword: odd})
