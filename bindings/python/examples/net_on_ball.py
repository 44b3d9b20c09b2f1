"""A net falls on a ball and hangs over it: a body of edges alone that never goes through another.

    python examples/net_on_ball.py [STEPS]

Position-based dynamics (Müller et al. 2007), as in `cable.py`. The net has no face, so vertices of
the net meet faces of the ball, and its edges meet edges; `feature_pairs` has each contact once. All
then goes as far as nothing comes nearer than GAP (`free_step`). It says how near the net is to the
ball, and in how many contacts.
"""

from __future__ import annotations

import sys

import numpy as np
import pliant
from numpy.typing import NDArray
from pliant import FeatureKind, Selection

SIDE, MESH = 14, 0.14  # vertices of the net along a side, and length of an edge
RADIUS, RINGS = 0.5, 18
THICK, GAP = 0.02, 0.002  # the distance that all seek, and the least that there is
STEP, ROUNDS = 1 / 60, 20
FALL = np.array([0, 0, -9.81 * STEP**2])


def net() -> tuple[list[NDArray[np.int64]], NDArray[np.float64]]:
    """A square net above the ball: four groups of edges, in each of which none share a vertex; and the vertices."""
    at = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    pairs = [np.stack([it[:-1], it[1:]], axis=2) for it in (at, at.T)]
    y, x = np.divmod(at.ravel(), SIDE) - np.array((SIDE - 1) / 2)
    groups = [it[half::2].reshape(-1, 2) for it in pairs for half in (0, 1)]
    return groups, np.stack([MESH * x, MESH * y, np.full(len(x), RADIUS + 0.1)], axis=1)


def ball() -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """A ball of rings round two poles: faces and vertices."""
    row, column = np.divmod(np.arange((RINGS + 1) * 2 * RINGS), 2 * RINGS)
    up, turn = np.pi * row / RINGS, np.pi * column / RINGS
    points = RADIUS * np.stack([np.sin(up) * np.cos(turn), np.sin(up) * np.sin(turn), np.cos(up)], axis=1)
    at = np.where(row % RINGS == 0, row * 2 * RINGS, np.arange(len(row))).reshape(RINGS + 1, -1)  # a pole is one vertex
    (a, b), (c, d) = ((at[rows], np.roll(at[rows], -1, axis=1)) for rows in (slice(-1), slice(1, None)))
    return np.concatenate([np.dstack([a, c, d])[:-1], np.dstack([a, d, b])[1:]]).reshape(-1, 3), points


class Simulation:
    """The net, the ball, and the world that says where they are near."""

    def __init__(self) -> None:
        self.groups, self.x = net()
        self.before = self.x
        faces, self.still = ball()
        self.world = pliant.World()
        self.net = self.world.add(None, self.x, edges=np.concatenate(self.groups))
        self.ball = self.world.add(faces, self.still)
        self.world.ignore(self.ball, self.ball)

    def step(self) -> pliant.FeaturePairs:
        """One step of time. Returns what was near when it began."""
        near = pliant.feature_pairs(self.world, Selection.EVERYTHING, 2 * THICK)
        is_first = np.arange(4) < np.where(near.kind == FeatureKind.EDGE_EDGE, 2, 1)[:, None]
        of_net = np.where(is_first, near.bodies[:, :1], near.bodies[:, 1:]) == self.net
        corners = np.where(near.vertices == 0xFFFFFFFF, 0, near.vertices) + np.where(of_net, 0, len(self.x))
        shares = (np.where(is_first, 1, -1) * near.weights)[:, :, None]
        own = shares * of_net[:, :, None]  # the ball stands still
        points = np.concatenate([self.x + 0.99 * (self.x - self.before) + FALL, self.still])
        rub = np.zeros((len(points), 1))  # where there is contact
        for _ in range(ROUNDS):
            for a, b in (group.T for group in self.groups):
                apart = points[b] - points[a]
                half = (1 - MESH / np.linalg.norm(apart, axis=1, keepdims=True)) * apart / 2
                points[a] += half
                points[b] -= half
            depth = THICK - ((shares * points[corners]).sum(1) * near.direction).sum(1)
            push = (np.maximum(depth, 0) / (own**2).sum((1, 2)))[:, None] * near.direction
            total, moved = np.zeros_like(rub), np.zeros_like(points)
            np.add.at(total, corners, abs(own) * (depth > 0)[:, None, None])
            np.add.at(moved, corners, abs(own) * own * push[:, None])
            points += moved / np.maximum(total, 1)
            rub = np.maximum(rub, np.minimum(total, 1))
        goal = points[: len(self.x)]
        goal -= 0.5 * rub[: len(self.x)] * (goal - self.x)  # what is in contact slides less
        self.world.set_motion(self.net, goal)
        free = self.world.free_step(Selection.EVERYTHING, GAP)
        assert free.begins_in_contact is None  # it is through nothing
        self.world.advance_motion(free.t)
        self.before, self.x = self.x, self.world.positions(self.net)
        return near


def main() -> None:
    simulation = Simulation()
    for step in range(int(sys.argv[1]) if len(sys.argv) > 1 else 90):
        near = simulation.step()
        if step % 10 == 0:
            nearest = simulation.world.distance(simulation.net, simulation.ball)
            assert nearest is not None
            print(f"step {step}: {nearest.distance:.4f} from the ball, {len(near.kind)} contacts, lowest at {simulation.x[:, 2].min():.2f}")


if __name__ == "__main__":
    main()
