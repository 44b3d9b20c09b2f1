"""A world in the child of a fork: its threads stayed behind, and are made anew."""

from __future__ import annotations

import os
import signal
import sys
import time

import numpy as np
import pytest

import pliant

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")


def sheet(height: float, side: int = 60) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(np.arange(side + 1.0), np.arange(side + 1.0), indexing="ij")
    z = height + 2.0 * np.sin(0.7 * x + 0.3 * y)
    at = np.arange(side * (side + 1)).reshape(side, side + 1)[:, :-1].ravel()
    triangles = np.stack([[at, at + 1, at + side + 1], [at + 1, at + side + 2, at + side + 1]], axis=2)
    positions = np.stack([x, y, z], axis=2).reshape(-1, 3)
    return np.ascontiguousarray(triangles.transpose(1, 2, 0).reshape(3, -1).T), positions


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.parametrize("delay", [0.0, 0.01])
def test_a_forked_child_answers_as_its_parent_does(delay: float) -> None:
    world = pliant.World(threads=3)
    triangles, positions = sheet(0.0)
    bodies = [world.add(triangles, positions), world.add(triangles, sheet(0.5)[1])]
    expected = world.intersections().all().copy()
    assert len(expected) > 1000
    # Threads are awake just after a query, and asleep some time later; the answer is the same in either case.
    time.sleep(delay)
    child = os.fork()
    if child == 0:
        # Whatever happens, the child ends here, and soon: it is killed if it hangs.
        code = 1
        try:
            signal.alarm(600)
            for _ in range(3):
                world.set_positions(bodies[0], positions)
                assert np.array_equal(world.intersections().all(), expected)
            del world
            code = 0
        finally:
            os._exit(code)
    _, status = os.waitpid(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0, f"on {sys.platform}"
    assert np.array_equal(world.intersections().all(), expected)
