"""The interpreter lock is released while a call computes; one world answers one call at a time."""

from __future__ import annotations

import copy
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Literal

import numpy as np
import pliant
import pytest
from conftest import fold, grid, pairs_between, pairs_within

FACES, FLAT = grid(60)
SHAPE = fold(FLAT, 1.0)


def lets_others_run(call: Callable[[], object], tries: int) -> bool:
    """Whether another thread of Python's gets to run during one of so many calls."""
    turns, done = 0, threading.Event()

    def count() -> None:
        nonlocal turns
        while not done.is_set():
            turns += 1
            time.sleep(0)

    interval = sys.getswitchinterval()
    # A thread runs until it lets go of the lock by itself: longer than any of these calls takes, however busy the machine is.
    sys.setswitchinterval(1000)
    other = threading.Thread(target=count)
    other.start()
    try:
        for _ in range(tries):
            before = turns
            call()
            if turns > before:
                return True
        return False
    finally:
        sys.setswitchinterval(interval)
        done.set()
        other.join()


def test_others_run_while_a_call_computes() -> None:
    faces, flat = grid(200)
    shape = fold(flat, 1.0)
    world = pliant.World()
    body = world.add(faces, shape)
    other = world.add(faces, shape)

    of_world, itself = world.intersections(), world.intersections(pliant.Selection.within(body))

    def ask_anew(ask: Callable[[], object]) -> Callable[[], object]:
        def call() -> None:
            world.set_positions(body, shape)
            ask()

        return call

    calls: dict[str, Callable[[], object]] = {
        "add": lambda: pliant.World().add(faces, shape),
        "set_positions": lambda: world.set_positions(body, shape),
        "rebuild": lambda: world.rebuild(body),
        "prepare": ask_anew(itself.prepare),
        "all": of_world.all,
        "all between": lambda: pairs_between(world, body, other),
        "all within": itself.all,
        "first": ask_anew(itself.first),
        "visit": lambda: itself.visit(lambda pair: True),
        "validate": world.validate,
        "pliant.self_intersection_pairs": lambda: pliant.self_intersection_pairs(shape, faces),
        "pliant.intersection_pairs": lambda: pliant.intersection_pairs(shape, faces, flat, faces),
        "pliant.reference": lambda: pliant.reference.self_intersection_pairs(shape, faces[:1000]),
    }
    for name, call in calls.items():
        assert lets_others_run(call, 200), name
    # The same measure sees a lock that is held, for longer than any of these calls.
    assert not lets_others_run(lambda: sum(range(20_000_000)), 1)


def test_worlds_side_by_side() -> None:
    def run(seed: int) -> Any:
        world = pliant.World()
        body = world.add(FACES, FLAT)
        counts = []
        for step in range(4):
            world.set_positions(body, fold(FLAT, (step + seed) / 6))
            counts.append(len(pairs_within(world, body)))
        return counts

    serial = [run(seed) for seed in range(4)]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(run, range(4))) == serial
    assert serial[3][-1] > 0


def test_a_visitor_may_not_ask_its_world() -> None:
    world = pliant.World()
    body = world.add(FACES, SHAPE)
    errors = []

    def visit(pair: pliant.Pair) -> bool:
        for call in (world.bodies, lambda: world.set_positions(body, FLAT), lambda: pairs_within(world, body)):
            with pytest.raises(pliant.Error, match="one call at a time") as refused:
                call()
            errors.append(refused.value.kind)
        # Another world is free.
        return bool(len(pliant.self_intersection_pairs(SHAPE, FACES)))

    assert world.intersections(pliant.Selection.within(body)).visit(visit)
    assert errors == ["Busy"] * 3
    assert len(pairs_within(world, body)) > 0


def test_a_writer_of_positions_may_not_ask_its_world() -> None:
    """Nor another thread: what is written is for the body that was asked about."""
    world = pliant.World()
    body = world.add(FACES, FLAT)
    edit = world.edit(body)
    edit.remove_triangles([0])
    calls: list[Callable[[], object]] = [
        world.bodies,
        lambda: world.remove(body),
        lambda: world.apply(edit),
        lambda: world.set_mesh(body, FACES[1:], FLAT),
        lambda: world.set_positions(body, FLAT),
        lambda: world.write_positions(body, lambda out: None),
        lambda: copy.copy(world),
        world.intersections().all,
    ]
    errors = []

    def write(out: Any) -> None:
        def ask() -> None:
            for call in calls:
                with pytest.raises(pliant.Error, match="one call at a time") as refused:
                    call()
                errors.append(refused.value.kind)

        ask()
        thread = threading.Thread(target=ask)
        thread.start()
        thread.join()
        out[:] = SHAPE

    world.write_positions(body, write)
    assert errors == ["Busy"] * 2 * len(calls)
    assert (world.positions(body) == SHAPE).all()
    assert len(pairs_within(world, body)) > 0

    def raises(out: Any) -> None:
        raise ZeroDivisionError

    # Whatever becomes of it, the world is free again.
    with pytest.raises(ZeroDivisionError):
        world.write_positions(body, raises)
    assert (world.positions(body) == SHAPE).all()


def test_a_second_thread_is_refused_not_left_waiting() -> None:
    world = pliant.World()
    body = world.add(FACES, SHAPE)
    outcomes = []

    def visit(pair: pliant.Pair) -> bool:
        def ask() -> None:
            try:
                world.intersections().all()
            except pliant.Error as error:
                outcomes.append(error.kind)

        thread = threading.Thread(target=ask)
        thread.start()
        thread.join(10)
        assert not thread.is_alive()
        return True

    assert world.intersections(pliant.Selection.within(body)).visit(visit)
    assert outcomes == ["Busy"]


def test_threads_is_an_argument_that_changes_no_answer() -> None:
    expected = pliant.self_intersection_pairs(SHAPE, FACES)
    counts: list[int | Literal["all"]] = [1, 2, 7, "all"]
    for threads in counts:
        np.testing.assert_array_equal(pliant.self_intersection_pairs(SHAPE, FACES, threads=threads), expected)
    with pytest.raises(pliant.Error, match="threads is 0"):
        pliant.self_intersection_pairs(SHAPE, FACES, threads=0)
