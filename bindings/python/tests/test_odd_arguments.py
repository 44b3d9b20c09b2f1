"""Whatever a call is given: an answer, or an exception that says what is wrong; never a panic, never a broken world."""

from __future__ import annotations

from typing import Any

import numpy as np
import pliant
from conftest import fold, grid
from hypothesis import given, settings
from hypothesis import strategies as st

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
    range(3),
    int,
    pliant,
]

#: Not a panic: that is no Exception at all. ValueError is also what numpy says of ragged lists.
SAID = (pliant.Error, TypeError, OverflowError, ValueError)

METHODS = sorted(name for name in vars(pliant.World) if name[0] != "_" and name != "dtype")
FUNCTIONS = [
    pliant.check,
    pliant.intersection_pairs,
    pliant.self_intersection_pairs,
    pliant.reference.intersection_pairs,
    pliant.reference.self_intersection_pairs,
    pliant.World,
]

arguments = st.lists(st.sampled_from(ODD), max_size=4)
keywords = st.dictionaries(
    st.sampled_from(["threads", "frames", "weld", "first", "itself", "degree", "partition", "level", "leaf_size", "update"]),
    st.sampled_from(ODD),
    max_size=2,
)


@settings(max_examples=400, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(METHODS), arguments), min_size=1, max_size=6))
def test_methods(calls: list[tuple[str, list[Any]]]) -> None:
    world = pliant.World()
    for shape in (FLAT, SHAPE, FLAT):
        world.add(FACES, shape)
    for name, given_arguments in calls:
        try:
            getattr(world, name)(*given_arguments)
        except SAID as error:
            assert str(error)
            assert getattr(error, "kind", None) not in ("Broken", "Busy")
    world.validate()
    for body in world.bodies():
        world.self_intersection_pairs(body)
    world.intersection_pairs()


@settings(max_examples=300, deadline=None)
@given(st.sampled_from(FUNCTIONS), arguments, keywords)
def test_functions(function: Any, given_arguments: list[Any], given_keywords: dict[str, Any]) -> None:
    try:
        function(*given_arguments, **given_keywords)
    except SAID as error:
        assert str(error)
