"""Signals while a query computes: what a handler raises in the main thread ends it soon, and the world stays usable."""

from __future__ import annotations

import _thread
import collections
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import pairs_between
from numpy.typing import NDArray

#: Seconds until the signal comes, and how many later a query has ended even on a busy machine. Those below take many more.
UNTIL, SOON = 0.3, 2.0

Mesh = tuple[NDArray[Any], NDArray[np.float64]]


class Stop(Exception):
    """What a handler of a test raises."""


def stop(*_: object) -> None:
    raise Stop


def separate(triangles: NDArray[np.float64]) -> Mesh:
    """A mesh of triangles (n, 3, 3) that share no vertex."""
    return np.arange(3 * len(triangles)).reshape(-1, 3), triangles.reshape(-1, 3)


def coplanar(n: int) -> Mesh:
    """The same triangle n times: every two intersect, which takes long to decide."""
    return separate(np.tile(np.eye(3), (n, 1, 1)))


def layers(n: int, first: float) -> Mesh:
    """Parallel triangles: their boxes all overlap, but no two intersect."""
    heights = (np.arange(n) + first) / (1000 * n)
    return separate(np.eye(3) + heights[:, None, None])


def world_of(*meshes: Mesh, **options: Any) -> pliant.World:
    world = pliant.World(**options)
    for mesh in meshes:
        world.add(*mesh)
    return world


@contextmanager
def signal_after(seconds: float, handler: Callable[..., object]) -> Iterator[None]:
    """Has the handler called as if Ctrl-C had been pressed after some time."""
    before = signal.signal(signal.SIGINT, handler)
    timer = threading.Timer(seconds, _thread.interrupt_main)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        signal.signal(signal.SIGINT, before)


def is_stopped(ask: Callable[[], object]) -> None:
    for handler, raised in ((stop, Stop), (signal.default_int_handler, KeyboardInterrupt)):
        began = time.perf_counter()
        with signal_after(UNTIL, handler), pytest.raises(raised):
            ask()
        assert UNTIL / 2 < time.perf_counter() - began < UNTIL + SOON


def answers_rightly(world: pliant.World) -> None:
    """For the shapes of now, and for others."""
    world.validate()
    faces, positions = (world.triangles(0), world.positions(0))
    needle = separate(np.array([[[0, 0, 0], [1, 1, 1], [1, 1, 1]]]) / 3.0 + 1e-4)
    body = world.add(*needle)
    expected = pliant.reference.intersection_pairs(positions, faces, needle[1], needle[0])
    np.testing.assert_array_equal(pairs_between(world, 0, body), expected)

    # Few of their triangles meet when they stand side by side, and it is said which.
    fresh = pliant.World()
    for body in world.bodies():
        faces, positions = (world.triangles(body), world.positions(body))
        positions[:, 0] += np.repeat(2.0 * (np.arange(len(faces)) // 3), 3)
        world.set_positions(body, positions)
        fresh.add(faces, positions)
    hits = world.intersections(pliant.Selection.EVERYTHING).all()
    np.testing.assert_array_equal(hits, fresh.intersections(pliant.Selection.EVERYTHING).all())
    assert len(hits) > 0
    world.validate()


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("of", [pliant.Selection.WORLD, pliant.Selection.within(1)], ids=repr)
def test_all(of: pliant.Selection, threads: int) -> None:
    world = world_of(coplanar(6000), coplanar(9000), threads=threads)
    # Should it not be stopped, it does not fill the memory.
    is_stopped(lambda: world.intersections(of).all(at_most=50_000_000))
    answers_rightly(world)


@pytest.mark.parametrize("threads", [1, 2])
def test_first(threads: int) -> None:
    world = world_of(layers(20_000, 0.0), layers(20_000, 0.5), threads=threads)
    is_stopped(world.intersections().first)
    answers_rightly(world)


def test_check(tmp_path: Path) -> None:
    faces, positions = coplanar(9000)
    lines = [*("v {} {} {}".format(*vertex) for vertex in positions), *("f {} {} {}".format(*face) for face in faces + 1)]
    (tmp_path / "many.obj").write_text("\n".join(lines))
    frames = pliant.check(tmp_path / "many.obj", weld=False)
    # The frame that was interrupted is the next one.
    is_stopped(lambda: next(frames))
    # And where a frame before it is looked for.
    is_stopped(lambda: next(pliant.check(tmp_path / "many.obj", weld=False, baseline=0)))


def test_check_while_files_are_read(tmp_path: Path) -> None:
    """Frames in which nothing is found for long: Python looks for signals between them."""
    faces, positions = layers(2000, 0.0)
    np.savez(tmp_path / "still.npz", vertices=np.tile(positions, (20, 1, 1)) * [1, 1, 2000], faces=faces)

    def again_and_again() -> None:
        while True:
            for _ in pliant.check(tmp_path / "still.npz", itself=True):
                pass

    is_stopped(again_and_again)


def test_visit() -> None:
    world = world_of(coplanar(6000), coplanar(6000))
    hits = world.intersections()
    # In a visitor of Python's, and in one that is none.
    is_stopped(lambda: hits.visit(lambda pair: False))
    is_stopped(lambda: hits.visit(collections.deque[object](maxlen=1).append))
    # And where there is nothing to show.
    layered = world_of(layers(20_000, 0.0), layers(20_000, 0.5))
    is_stopped(lambda: layered.intersections().visit(lambda pair: False))
    for stopped in (world, layered):
        answers_rightly(stopped)


def test_prepare() -> None:
    world = pliant.World(broad="brute")
    for place in range(80_000):
        world.add([[0, 1, 2]], np.eye(3) + [2.0 * (place % 40_000), 0, 0])
    is_stopped(world.intersections().prepare)
    world.validate()
    for body in range(5, 80_000):
        world.remove(body)
    world.set_positions(4, np.eye(3) + [2.0, 0, 0])
    assert world.intersections().all().tolist() == [[1, 0, 4, 0]]


@pytest.mark.parametrize("threads", [1, 2])
def test_one_liners(threads: int) -> None:
    (faces, positions), (more_faces, more_positions) = coplanar(6000), coplanar(9000)
    is_stopped(lambda: pliant.intersection_pairs(positions, faces, more_positions, more_faces, threads=threads))
    is_stopped(lambda: pliant.self_intersection_pairs(more_positions, more_faces, threads=threads))


def test_a_handler_that_returns_lets_a_query_go_on() -> None:
    world = world_of(coplanar(1500), coplanar(1500))
    refused = []

    def handle(*_: object) -> None:
        # In the middle of the query: the world is in use.
        try:
            world.bodies()
        except pliant.Error as error:
            refused.append(error.kind)

    with signal_after(0.1, handle):
        assert len(world.intersections().all()) == 1500**2
    assert refused == ["Busy"]


def test_other_threads_are_not_interrupted() -> None:
    world = world_of(coplanar(1500), coplanar(1500))
    with ThreadPoolExecutor(1) as pool, signal_after(0.1, stop):
        hits = pool.submit(world.intersections().all)
        with pytest.raises(Stop):
            while not hits.done():
                time.sleep(0.001)
        assert not hits.done()
        assert len(hits.result()) == 1500**2


PROGRAM = """
import signal
import numpy as np, pliant
# A shell that runs these tests in the background has it ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
world = pliant.World()
for _ in range(2):
    world.add(np.arange(18_000).reshape(-1, 3), np.tile(np.eye(3), (6000, 1)))
print("asks", flush=True)
try:
    world.intersections().all(at_most=50_000_000)
except KeyboardInterrupt:
    world.set_positions(0, np.repeat(10.0 * np.arange(1, 6001), 3)[:, None] + np.tile(np.eye(3), (6000, 1)))
    world.set_positions(1, np.repeat(10.0 * np.arange(6000), 3)[:, None] + np.tile(np.eye(3), (6000, 1)))
    print(len(world.intersections().all()))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a process cannot be sent a Ctrl-C of its own")
def test_ctrl_c() -> None:
    with subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None and program.stdout.readline() == "asks\n"
        time.sleep(UNTIL)
        began = time.perf_counter()
        program.send_signal(signal.SIGINT)
        assert program.stdout.read() == "5999\n"
        assert program.wait() == 0 and time.perf_counter() - began < SOON
