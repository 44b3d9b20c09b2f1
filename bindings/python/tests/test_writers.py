"""Arrays that somebody else writes while a call reads them: what is checked is what is kept.

Each number of an array is looked at once: it is copied to where nobody else can write, and only the copy is checked and used.
Which of the numbers that were there meanwhile is copied, or of which bytes of two of them a mixture, nobody can say; but never one that was
not checked.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import fold, grid
from numpy.typing import NDArray

FACES, FLAT = grid(120)
SHAPE = fold(FLAT, 0.2)
#: Without the copy one try in four kept a number that it had not checked.
TRIES = 200
#: A refusal takes microseconds, so that all tries may be over before a busy machine lets the other thread write once. So long only if it
#: never does.
PATIENCE_S = 600.0


@contextmanager
def written_meanwhile(array: NDArray[Any], place: tuple[int, int], values: tuple[Any, Any]) -> Iterator[None]:
    """Another thread writes one value and the other, again and again, to a place of the array."""
    ended = threading.Event()

    def write() -> None:
        while not ended.is_set():
            # A thread of Python's is stopped at the end of a round: with either value.
            for value in values * 500:
                array[place] = value

    interval = sys.getswitchinterval()
    # Both threads get many turns in each try.
    sys.setswitchinterval(1e-5)
    thread = threading.Thread(target=write)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
        sys.setswitchinterval(interval)


def outcomes(call: Callable[[], object], kind: str) -> tuple[int, int]:
    """How often the call took the array, and how often it refused it for what is wrong with it at times.

    At least `TRIES` times, and on until both were seen. Some machines copy byte by byte, so that a mixture of two numbers may be too large.
    """
    taken = refused = 0
    until = time.monotonic() + PATIENCE_S
    while taken + refused < TRIES or (min(taken, refused) == 0 and time.monotonic() < until):
        try:
            call()
            taken += 1
        except pliant.Error as error:
            assert error.kind in (kind, "BadPosition")
            refused += 1
    return taken, refused


@pytest.mark.parametrize("dtype", ["f4", "f8"])
@pytest.mark.parametrize("body_was_seen", [True, False])
def test_positions_that_are_written_meanwhile_never_put_a_nan_into_a_world(dtype: str, body_was_seen: bool) -> None:
    world = pliant.World()
    body = world.add(FACES, SHAPE.astype(dtype))
    shape = SHAPE.astype(dtype)
    last = (len(shape) - 1, 2)

    def move() -> None:
        if body_was_seen:
            world.intersections(pliant.Selection.within(body)).first()
        try:
            world.set_positions(body, shape)
        finally:
            assert np.isfinite(world.positions(body)).all()

    with written_meanwhile(shape, last, (np.nan, shape[last])):
        taken, refused = outcomes(move, "BadPosition")
    assert taken > 0 and refused > 0, "the array was written meanwhile"
    world.validate()


def test_positions_that_are_written_meanwhile_never_leave_a_loose_box() -> None:
    world = pliant.World()
    body = world.add(FACES, SHAPE)
    lower, upper = SHAPE.min(axis=0), SHAPE.max(axis=0)
    world.set_loose_box(body, (tuple(lower), tuple(upper)))
    shape = SHAPE.copy()
    first = (0, 1)

    def move() -> None:
        world.intersections(pliant.Selection.within(body)).first()
        try:
            world.set_positions(body, shape)
        finally:
            positions = world.positions(body)
            assert ((lower <= positions) & (positions <= upper)).all()

    with written_meanwhile(shape, first, (upper[1] + 1, shape[first])):
        taken, refused = outcomes(move, "OutsideLooseBox")
    assert taken > 0 and refused > 0, "the array was written meanwhile"
    world.validate()


@pytest.mark.parametrize("dtype", ["u4", "i8"])
def test_faces_that_are_written_meanwhile_name_vertices_that_there_are(dtype: str) -> None:
    faces, positions = grid(40)
    faces = faces.astype(dtype)
    last = (len(faces) - 1, 0)

    def add() -> None:
        world = pliant.World()
        body = world.add(faces, positions)
        assert (world.triangles(body) < len(positions)).all()

    with written_meanwhile(faces, last, (len(positions) + 7, int(faces[last]))):
        taken, refused = outcomes(add, "VertexOutOfRange")
    assert taken > 0 and refused > 0, "the array was written meanwhile"


def test_new_bodies_whose_positions_are_written_meanwhile_have_no_nan() -> None:
    faces, positions = grid(40)
    last = (len(positions) - 1, 0)
    values = (np.nan, positions[last])

    def add() -> None:
        world = pliant.World()
        body = world.add(faces, positions)
        assert np.isfinite(world.positions(body)).all()
        world.validate()

    with written_meanwhile(positions, last, values):
        taken, refused = outcomes(add, "BadPosition")
    assert taken > 0 and refused > 0, "the array was written meanwhile"
    # The same without a world; a panic would be no pliant.Error.
    with written_meanwhile(positions, last, values):
        outcomes(lambda: pliant.self_intersection_pairs(positions, faces), "BadPosition")


def test_an_array_that_write_positions_lent_may_be_written_afterwards() -> None:
    world = pliant.World()
    body = world.add(FACES, SHAPE)
    last = (len(SHAPE) - 1, 2)
    threads: list[Any] = []

    def move() -> None:
        def write(out: NDArray[Any]) -> None:
            out[:] = SHAPE
            meanwhile = written_meanwhile(out, last, (np.nan, SHAPE[last]))
            meanwhile.__enter__()
            threads.append(meanwhile)

        try:
            world.write_positions(body, write)
        finally:
            threads.pop().__exit__(None, None, None)
            assert np.isfinite(world.positions(body)).all()

    taken, refused = outcomes(move, "NotWritten")
    assert taken > 0 and refused > 0, "the array was written meanwhile"
