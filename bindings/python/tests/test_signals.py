"""Signals while a query computes: what a handler raises in the main thread ends it, and the world stays usable.

Whether a handler is called in the middle of a call is seen in the handler: the world is in use then. How soon is not measured here, for that
depends on what else the machine does; queries look every few milliseconds (crates/pliant/tests/queries.rs).
"""

from __future__ import annotations

import _thread
import collections
import signal
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import pairs_between
from numpy.typing import NDArray

#: Seconds between signals. They come until one has come in the middle of a query, which takes many more.
BETWEEN = 0.05
#: So many queries are asked at most, one of which a signal ends. One that hears of none takes long each time.
TRIES = 5

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
def signals(handler: Callable[..., object]) -> Iterator[None]:
    """Has the handler called as if Ctrl-C were pressed again and again."""
    before = signal.signal(signal.SIGINT, handler)
    ended = threading.Event()

    def press() -> None:
        while not ended.wait(BETWEEN):
            _thread.interrupt_main()

    thread = threading.Thread(target=press)
    thread.start()
    try:
        yield
    finally:
        # What comes from now on is no longer of interest.
        signal.signal(signal.SIGINT, lambda *_: None)
        ended.set()
        thread.join()
        signal.signal(signal.SIGINT, before)


def is_in_use(call: Callable[[], object]) -> bool:
    try:
        call()
    except pliant.Error as error:
        return error.kind == "Busy"
    return False


def is_stopped(ask: Callable[[], object], is_asked: Callable[[], bool]) -> None:
    """What a handler raises in the middle of a call, which it can tell, ends it."""
    is_stopped_by(stop, Stop, ask, is_asked)
    is_stopped_by(signal.default_int_handler, KeyboardInterrupt, ask, is_asked)


def is_stopped_by(
    stopping: Callable[..., object], raised: type[BaseException], ask: Callable[[], object], is_asked: Callable[[], bool]
) -> None:
    # Once: the next signals come when it has been stopped.
    handlers = [stopping]

    def handle(number: int, frame: FrameType | None) -> None:
        if handlers and is_asked():
            handlers.pop()(number, frame)

    with signals(handle), pytest.raises(raised):
        for _ in range(TRIES):
            ask()


def world_is_stopped(world: pliant.World, ask: Callable[[], object]) -> None:
    is_stopped(ask, lambda: is_in_use(world.bodies))


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
    world_is_stopped(world, lambda: world.intersections(of).all(at_most=50_000_000))
    answers_rightly(world)


@pytest.mark.parametrize("threads", [1, 2])
def test_first(threads: int) -> None:
    world = world_of(layers(20_000, 0.0), layers(20_000, 0.5), threads=threads)
    world_is_stopped(world, world.intersections().first)
    answers_rightly(world)


def test_check(tmp_path: Path) -> None:
    faces, positions = coplanar(9000)
    lines = [*("v {} {} {}".format(*vertex) for vertex in positions), *("f {} {} {}".format(*face) for face in faces + 1)]
    (tmp_path / "many.obj").write_text("\n".join(lines))
    # The frame that was interrupted is the next one; and where a frame before it is looked for.
    for baseline in (None, 0):
        frames_are_stopped(pliant.check(tmp_path / "many.obj", weld=False, baseline=baseline))


def frames_are_stopped(frames: pliant.Check) -> None:
    is_stopped(lambda: next(frames), lambda: is_in_use(lambda: frames.places))


def test_counts_that_are_stopped_leave_lists_as_they_were(tmp_path: Path) -> None:
    faces, positions = coplanar(3000)
    np.savez(tmp_path / "many.npz", vertices=positions, faces=faces)
    check = pliant.check(tmp_path / "many.npz", weld=False)
    is_stopped_by(stop, Stop, check.counts, lambda: is_in_use(lambda: check.places))
    (frame,) = check
    assert frame.count == len(frame.pairs) == 3000 * 2999 // 2


def test_check_while_files_are_read(tmp_path: Path) -> None:
    """Frames in which nothing is found for long: Python looks for signals between them."""
    faces, positions = layers(2000, 0.0)
    np.savez(tmp_path / "still.npz", vertices=np.tile(positions, (20, 1, 1)) * [1, 1, 2000], faces=faces)

    def again_and_again() -> None:
        while True:
            for _ in pliant.check(tmp_path / "still.npz", itself=True):
                pass

    # It has no other end.
    is_stopped(again_and_again, lambda: True)


def test_visit() -> None:
    world = world_of(coplanar(6000), coplanar(6000))
    hits = world.intersections()
    # In a visitor of Python's, and in one that is none.
    world_is_stopped(world, lambda: hits.visit(lambda pair: False))
    world_is_stopped(world, lambda: hits.visit(collections.deque[object](maxlen=1).append))
    # And where there is nothing to show.
    layered = world_of(layers(20_000, 0.0), layers(20_000, 0.5))
    world_is_stopped(layered, lambda: layered.intersections().visit(lambda pair: False))
    for stopped in (world, layered):
        answers_rightly(stopped)


def test_prepare() -> None:
    world = pliant.World(broad="brute")
    for place in range(80_000):
        world.add([[0, 1, 2]], np.eye(3) + [2.0 * (place % 40_000), 0, 0])
    world_is_stopped(world, world.intersections().prepare)
    world.validate()
    for body in range(5, 80_000):
        world.remove(body)
    world.set_positions(4, np.eye(3) + [2.0, 0, 0])
    assert world.intersections().all().tolist() == [[1, 0, 4, 0]]


@pytest.mark.parametrize("threads", [1, 2])
def test_one_liners(threads: int) -> None:
    (faces, positions), (more_faces, more_positions) = coplanar(6000), coplanar(9000)
    # There is no world to ask: but what only the call holds is there as long as it goes on.
    given: list[weakref.ref[NDArray[np.float64]]] = []

    def give(array: NDArray[np.float64]) -> NDArray[np.float64]:
        given[:] = [weakref.ref(array)]
        return array

    def is_asked() -> bool:
        return bool(given) and given[0]() is not None

    is_stopped(
        lambda: pliant.intersection_pairs(give(positions.copy()), faces, more_positions, more_faces, threads=threads),
        is_asked,
    )
    is_stopped(
        lambda: pliant.self_intersection_pairs(give(more_positions.copy()), more_faces, threads=threads),
        is_asked,
    )


def test_weld() -> None:
    # Long edges between random places: few coincide, but every place has many within the tolerance.
    world = pliant.World()
    body = world.add(*separate(np.random.default_rng(4).random((200_000, 3, 3))))
    before = world.triangles(body)
    world_is_stopped(world, lambda: world.weld(body, 0.05))
    assert np.array_equal(world.triangles(body), before)
    world.validate()


def test_points() -> None:
    # A closed body of the same tetrahedron again and again.
    count, corners = 5_000, np.concatenate([np.zeros((1, 3)), np.eye(3)])
    sides = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    faces = (sides + 4 * np.arange(count)[:, None, None]).reshape(-1, 3)
    world = world_of((faces, np.tile(corners, (count, 1))))
    points = np.random.default_rng(3).uniform(0.1, 0.2, (40_000, 3))
    world_is_stopped(world, lambda: world.points_inside(points, 0))
    world_is_stopped(world, lambda: world.closest_points(points))
    world.validate()
    assert world.points_inside(points[:2], 0).windings.tolist() == [count] * 2
    assert (world.closest_points(points[:2]).distance == points[:2].min(axis=1)).all()


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="signals that come again and again are not there")
@pytest.mark.parametrize("ask", [pliant.vertex_triangle_impacts, pliant.edge_edge_impacts])
def test_single_pairs(ask: Callable[..., object]) -> None:
    """Handled in the middle of the call: at its end all that have come are handled as one."""
    corners = np.random.default_rng(0).integers(-3, 4, (2, 200_000, 4, 3)) * [1.0, 1.0, 0.0]
    handled = 0

    def handle(*_: object) -> None:
        nonlocal handled
        handled += 1
        if handled == 3:
            raise Stop

    before = signal.signal(signal.SIGALRM, handle)
    signal.setitimer(signal.ITIMER_REAL, 0.01, 0.01)
    try:
        with pytest.raises(Stop):
            try:
                ask(*corners)
            finally:
                signal.setitimer(signal.ITIMER_REAL, 0.0)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_a_handler_that_returns_lets_a_query_go_on() -> None:
    world = world_of(coplanar(1500), coplanar(1500))
    in_use = []

    def handle(*_: object) -> None:
        in_use.append(is_in_use(world.bodies))

    with signals(handle):
        for _ in range(100):
            assert len(world.intersections().all()) == 1500**2
            if any(in_use):
                break
    assert any(in_use)


def test_other_threads_are_not_interrupted() -> None:
    world = world_of(coplanar(1500), coplanar(1500))
    stopped = False

    def handle(*_: object) -> None:
        if is_in_use(world.bodies):
            raise Stop

    with ThreadPoolExecutor(1) as pool:
        for _ in range(100):
            hits = pool.submit(world.intersections().all)
            try:
                with signals(handle):
                    while not hits.done():
                        time.sleep(0.001)
            except Stop:
                stopped = True
            assert len(hits.result()) == 1500**2
            if stopped:
                break
    assert stopped


PROGRAM = """
import signal, threading, time
import numpy as np, pliant
# A shell that runs these tests in the background has it ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
world = pliant.World()
N = 60_000
# Parallel triangles, whose boxes all overlap, but no two of which intersect.
for first in (0.0, 0.5):
    heights = (np.arange(N) + first) / (1000 * N)
    world.add(np.arange(3 * N).reshape(-1, 3), (np.eye(3) + heights[:, None, None]).reshape(-1, 3))

def watch():
    # It is asked as soon as the world is in use.
    try:
        while True:
            world.bodies()
            time.sleep(0.001)
    except pliant.Error:
        print("asks", flush=True)

threading.Thread(target=watch).start()
try:
    while True:
        try:
            world.intersections().first()
            break
        except pliant.Error as error:
            assert error.kind == "Busy"
    print("came to its end")
except KeyboardInterrupt:
    print("ended early", world.statistics().candidate_pairs < N * N)
    world.set_positions(0, np.eye(3)[[0, 1, 2] * N])
    world.set_positions(1, np.eye(3)[[0, 1, 2] * N])
    print(world.intersections().first() is not None)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a process cannot be sent a Ctrl-C of its own")
def test_ctrl_c() -> None:
    with subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None and program.stdout.readline() == "asks\n"
        program.send_signal(signal.SIGINT)
        assert program.stdout.read() == "ended early True\nTrue\n"
        assert program.wait() == 0
