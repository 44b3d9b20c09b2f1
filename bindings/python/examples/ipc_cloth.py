"""A cloth that falls on a ball and never intersects anything: implicit steps with a barrier.

    python examples/ipc_cloth.py [STEPS]

As in *Incremental Potential Contact* (Li et al. 2020), without friction. A step is the least of an
energy: inertia, springs, and a barrier that grows without bound as features come near. Newton's
method looks for it. pliant answers three questions in each iteration: which features are near
(`feature_pairs`, each contact once), how the squared distances change (`derivatives`), and how far
the cloth may go before anything touches (`collision_free_step`). It says after each step how near
the cloth is to the ball and to itself. Needs scipy.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pliant
from numpy.typing import NDArray
from pliant import Selection, derivatives
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

Points = NDArray[np.float64]

SIDE = 16  # vertices of the cloth along a side; it is two units wide
REACH = 0.05  # distance at which the barrier begins
STIFFNESS, BARRIER = 500.0, 1e5
MASS = 1.0 / SIDE**2
STEP = 0.02
GRAVITY = np.array([0.0, 0.0, -9.81])


def sheet(side: int) -> tuple[NDArray[np.int64], Points]:
    """A square of triangles in the plane z = 0, its faces and vertices."""
    y, x = np.divmod(np.arange(side * side), side)
    at = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.r_[np.c_[at, at + 1, at + side], np.c_[at + 1, at + side + 1, at + side]]
    return faces, np.c_[2 * x / (side - 1) - 1, 2 * y / (side - 1) - 1, np.zeros(side * side)]


def ball(rings: int) -> tuple[NDArray[np.int64], Points]:
    """A ball of radius 0.6 below the cloth: a grid of angles, with a vertex for each pole."""
    faces, flat = sheet(rings)
    up, round_ = np.pi / 2 * flat[:, 1], np.pi * flat[:, 0]
    vertices = 0.6 * np.c_[np.cos(up) * np.cos(round_), np.cos(up) * np.sin(round_), np.sin(up)]
    _, first, one = np.unique(vertices.round(9), axis=0, return_index=True, return_inverse=True)
    faces = one.reshape(-1)[faces]
    proper = (faces != np.roll(faces, 1, axis=1)).all(1)
    return faces[proper], vertices[first] - [0, 0, 0.7]


def barrier(square: Points) -> tuple[Points, Points, Points]:
    """Barrier of squared distances, and its first and second derivative."""
    most = REACH**2
    ratio = square / most
    value = -((square - most) ** 2) * np.log(ratio)
    first = (most - square) * (2 * np.log(ratio) - 1 / ratio + 1)
    return value, first, (1 / ratio + 2) / ratio - 2 * np.log(ratio) - 3


class Cloth:
    """The cloth, the ball, and the energy of a step."""

    def __init__(self) -> None:
        faces, self.x = sheet(SIDE)
        self.world = pliant.World()
        self.cloth = self.world.add(faces, self.x)
        ball_faces, self.still = ball(12)
        self.ball = self.world.add(ball_faces, self.still)
        self.edges = self.world.edges(self.cloth).astype(np.int64)
        self.lengths = np.linalg.norm(np.subtract(*self.x[self.edges].swapaxes(0, 1)), axis=1)
        self.velocity = np.zeros_like(self.x)

    def contacts(self, of: Selection, x: Points) -> tuple[pliant.FeaturePairs, Points]:
        found = pliant.feature_pairs(self.world, of, REACH)
        return found, derivatives.corners(found, {self.cloth: x, self.ball: self.still})

    def energy(self, x: Points, goal: Points, full: bool = True) -> tuple[float, Any, Any]:
        """The energy of a shape, and where asked its gradient (n, 3) and a positive Hessian."""
        self.world.set_positions(self.cloth, x)
        value = MASS / 2 * ((x - goal) ** 2).sum()
        gradient = MASS * (x - goal)
        way = np.subtract(*x[self.edges].swapaxes(0, 1))
        length = np.linalg.norm(way, axis=1)
        scale = STEP**2 * STIFFNESS / self.lengths
        value += (scale / 2 * (length - self.lengths) ** 2).sum()
        unit = way / length[:, None]
        pull = (scale * (length - self.lengths))[:, None] * unit
        np.add.at(gradient, self.edges[:, 0], pull)
        np.add.at(gradient, self.edges[:, 1], -pull)
        # Of a spring that is pressed together only the part along it is kept.
        across = np.maximum(1 - self.lengths / length, 0)[:, None, None]
        along = unit[:, :, None] * unit[:, None, :]
        block = scale[:, None, None] * (along + across * (np.eye(3) - along))
        blocks = [(self.edges, np.block([[block, -block], [-block, block]]).reshape(-1, 6, 6))]
        for of in (Selection.between(self.cloth, self.ball), Selection.within(self.cloth)):
            found, corners = self.contacts(of, x)
            square, first, second = derivatives.squared_distance(found.kind, corners)
            # Weighted by the close pairs that a contact stands for, the sum is continuous.
            weight = BARRIER * STEP**2 * found.multiplicity
            energy, slope, bend = (weight * it for it in barrier(square))
            value += energy.sum()
            if not full:
                continue
            # Only corners of the cloth move; others get number -1.
            two = np.where(found.kind == pliant.FeatureKind.EDGE_EDGE, 2, 1)[:, None]
            bodies = np.where(np.arange(4) >= two, found.bodies[:, 1:], found.bodies[:, :1])
            moves = (bodies == self.cloth) & (found.vertices != 0xFFFFFFFF)
            numbers = np.where(moves, found.vertices.astype(np.int64), -1)
            np.add.at(gradient, numbers[moves], (slope[:, None, None] * first)[moves])
            flat = first.reshape(-1, 12)
            hessian = bend[:, None, None] * flat[:, :, None] * flat[:, None, :]
            hessian += slope[:, None, None] * second
            blocks.append((numbers, derivatives.positive_part(hessian)))
        return value, gradient, self.assembled(blocks) if full else None

    def assembled(self, blocks: list[tuple[NDArray[np.int64], Points]]) -> Any:
        """Sum of blocks over the coordinates of their vertices, and inertia, as a sparse matrix."""
        size = 3 * len(self.x)
        rows, columns, entries = [np.arange(size)], [np.arange(size)], [np.full(size, MASS)]
        for numbers, block in blocks:
            at = (3 * numbers[:, :, None] + np.arange(3)).reshape(len(numbers), 3 * numbers.shape[1])
            is_used = np.repeat(numbers >= 0, 3, axis=1)
            both = is_used[:, :, None] & is_used[:, None, :]
            rows.append(np.broadcast_to(at[:, :, None], both.shape)[both])
            columns.append(np.broadcast_to(at[:, None, :], both.shape)[both])
            entries.append(block[both])
        where = (np.concatenate(rows), np.concatenate(columns))
        return coo_matrix((np.concatenate(entries), where), shape=(size, size)).tocsc()

    def step(self) -> int:
        """Goes a step on. Returns the number of iterations."""
        before = self.x.copy()
        goal = self.x + STEP * self.velocity + STEP**2 * GRAVITY
        for iteration in range(60):
            value, gradient, hessian = self.energy(self.x, goal)
            way = -spsolve(hessian, gradient.ravel()).reshape(-1, 3)
            if abs(way).max() < 1e-3 * STEP:
                break
            # As far as nothing touches, and as the energy falls.
            self.world.set_motion(self.cloth, self.x + way)
            part = 0.9 * self.world.collision_free_step(Selection.EVERYTHING)
            while part > 1e-9 and self.energy(self.x + part * way, goal, full=False)[0] > value:
                part /= 2
            self.x = self.x + part * way
        self.world.set_positions(self.cloth, self.x)
        self.velocity = (self.x - before) / STEP
        return iteration


def main() -> None:
    cloth = Cloth()
    for step in range(int(sys.argv[1]) if len(sys.argv) > 1 else 60):
        iterations = cloth.step()
        near = cloth.world.distance(cloth.cloth, cloth.ball)
        hits = len(cloth.world.intersections(Selection.EVERYTHING).all())
        assert near is not None
        print(f"step {step}: {iterations} iterations, {near.distance:.5f} from the ball, {hits} intersections")


if __name__ == "__main__":
    main()
