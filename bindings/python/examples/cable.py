"""A knot in a cable is pulled tight: a body of edges alone that never goes through itself.

    python examples/cable.py [STEPS]

Position-based dynamics (Müller et al. 2007). Features of the cable that are near each other
(`feature_pairs`, each contact once) are kept THICK apart, along the direction that they have when a
step is planned. The cable then goes as far as nothing comes nearer than GAP (`free_step`). It says
how near the cable is to itself, how far apart its ends are, and its longest edge.
"""

from __future__ import annotations

import sys

import numpy as np
import pliant
from numpy.typing import NDArray
from pliant import FeatureKind, Selection

EDGES = 200  # each of length 1
THICK, GAP = 0.6, 0.1  # less than an edge is long, as an edge and the next but one are that near
ROUNDS = 60
PULL = 0.25  # way of each end in a step


def knot() -> NDArray[np.float64]:
    """Vertices of an overhand knot with long ends, along Shastri's polynomials."""
    t = np.linspace(-2.3, 2.3, 20001)
    curve = np.stack([t**3 - 3 * t, t**4 - 4 * t**2, 0.12 * (t**5 - 10 * t)], axis=1)
    along = np.r_[0, np.linalg.norm(np.diff(curve, axis=0), axis=1).cumsum()]
    places = np.linspace(0, along[-1], EDGES + 1)
    vertices: NDArray[np.float64] = np.stack([np.interp(places, along, axis) for axis in curve.T], axis=1) * EDGES / along[-1]
    return vertices


class Cable:
    """The cable, where it was before, and the world that says where it is near itself."""

    def __init__(self) -> None:
        self.x = self.before = knot()
        self.edges = np.arange(EDGES)[:, None] + [0, 1]
        self.world = pliant.World()
        self.body = self.world.add(None, self.x, edges=self.edges)
        self.moves = np.ones((EDGES + 1, 1))
        self.moves[[0, -1]] = 0  # the ends go where they are pulled

    def step(self) -> float:
        """Pulls the ends a little further. Returns the part of the step that was free."""
        near = pliant.feature_pairs(self.world, Selection.within(self.body), 2 * THICK)
        # A contact is between two means of vertices: shares of the one are above 0, of the other below.
        is_first = np.arange(4) < np.where(near.kind == FeatureKind.EDGE_EDGE, 2, 1)[:, None]
        shares = (np.where(is_first, 1, -1) * near.weights)[:, :, None]
        corners = np.where(near.vertices == 0xFFFFFFFF, 0, near.vertices)  # with a share of 0
        way = self.x[-1] - self.x[0]
        goal = self.x + 0.9 * self.moves * (self.x - self.before)
        goal[[0, -1]] += PULL * np.array([[-1], [1]]) * way / np.linalg.norm(way)
        for _ in range(ROUNDS):
            for a, b in (self.edges[::2].T, self.edges[1::2].T):  # of each half, none share an end
                apart = goal[b] - goal[a]
                move = (1 - 1 / np.linalg.norm(apart, axis=1, keepdims=True)) * apart / (self.moves[a] + self.moves[b])
                goal[a] += self.moves[a] * move
                goal[b] -= self.moves[b] * move
            depth = THICK - ((shares * goal[corners]).sum(1) * near.direction).sum(1)
            push = (np.maximum(depth, 0) / (shares**2).sum((1, 2)))[:, None] * near.direction
            total, moved = np.zeros((EDGES + 1, 1)), np.zeros_like(goal)
            np.add.at(total, corners, abs(shares) * (depth > 0)[:, None, None])
            np.add.at(moved, corners, abs(shares) * shares * push[:, None])
            goal += self.moves * moved / np.maximum(total, 1)
        self.world.set_motion(self.body, goal)
        free = self.world.free_step(Selection.EVERYTHING, GAP)
        assert free.begins_in_contact is None  # it never went through itself
        self.world.advance_motion(free.t)
        self.before, self.x = self.x, self.world.positions(self.body)
        return free.t

    def nearest(self) -> float:
        """Least distance of two edges that share no end; at most 1 or so, as next but one are that near."""
        return float(self.world.close_edge_edge_pairs(Selection.within(self.body), 2.0).all().distance.min())


def main() -> None:
    cable = Cable()
    for step in range(int(sys.argv[1]) if len(sys.argv) > 1 else 280):
        free = cable.step()
        if step % 20 == 0:
            ends, longest = np.linalg.norm(cable.x[-1] - cable.x[0]), np.linalg.norm(np.diff(cable.x, axis=0), axis=1).max()
            print(f"step {step}: {cable.nearest():.3f} from itself, ends {ends:.1f} apart, edges to {longest:.2f}, {free:.2f} free")


if __name__ == "__main__":
    main()
