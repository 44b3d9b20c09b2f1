"""A cloth falls on a ball that swings to and fro: the Rust example of the same name, in numpy.

Position-based dynamics (Müller et al. 2007): points keep their velocity, fall, and are then put where edges have their length
again. Contacts come from the pairs alone: where a triangle of the cloth meets one of the ball, its corners are pushed out along the
ball triangle's normal, and rub. In one small step nothing moves further than a triangle is wide.

What a loop does one after the other is done at once here where it is about different points: edges of one colour share none, so
all of them take their length together; and of every point the first contact comes at once, then the second, and so on.

With `apart` the cloth keeps a thickness: contacts are the vertices and triangles, and edges and edges, that are closer than that, and
each is put as far apart along the direction in which it is closest, again and again until all are.

    python cloth_on_ball.py 10        # ten seconds of it
    python cloth_on_ball.py 10 apart
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

import numpy as np
import pliant
from numpy.typing import NDArray

Array = NDArray[np.float32]
Integers = NDArray[np.int64]

STEPS_A_SECOND = 240
STEP = 1.0 / STEPS_A_SECOND
RADIUS = 0.5
SIDE = 1.6
THICKNESS = 0.0005  # so high above the ball do contacts put points
THICK = 0.02  # so far from the ball `step_apart` keeps the cloth
ROUNDS = 100  # at most, to put everything apart
FRICTION = 0.9  # how much of its sliding a point in contact loses in a step
FALL = np.array([0.0, 0.0, -9.81 * STEP * STEP], np.float32)


def square(squares: int) -> tuple[Integers, NDArray[np.float64]]:
    """A surface over the unit square: so many squares on a side, each cut in two; and where its points are there."""
    v, u = np.divmod(np.arange((squares + 1) ** 2), squares + 1)
    row, column = np.divmod(np.arange(squares**2), squares)
    low = row * (squares + 1) + column
    high = low + squares + 1
    faces = np.stack([low, low + 1, high + 1, low, high + 1, high], axis=1).reshape(-1, 3)
    return faces, np.stack([u, v], axis=1) / squares


def sphere(uv: NDArray[np.float64]) -> Array:
    """The upper half of an octahedron, and the lower one folded out of its sides, blown up."""
    xy = 2.0 * uv - 1.0
    out = np.abs(xy).sum(axis=1, keepdims=True)
    folded = xy - np.copysign(np.maximum(out - 1.0, 0.0), xy)
    points = np.concatenate([folded, 1.0 - out], axis=1)
    ball: Array = (RADIUS * points / np.linalg.norm(points, axis=1, keepdims=True)).astype(np.float32)
    return ball


def coloured(edges: Integers) -> list[Integers]:
    """The edges in groups, none of which has two edges at one point."""
    groups: list[list[int]] = []
    taken: list[set[int]] = []
    for number, (a, b) in enumerate(edges.tolist()):
        colour = next((colour for colour, points in enumerate(taken) if a not in points and b not in points), len(groups))
        if colour == len(groups):
            groups.append([])
            taken.append(set())
        groups[colour].append(number)
        taken[colour].update((a, b))
    return [np.array(group) for group in groups]


def in_turn(points: Integers) -> Iterator[Integers]:
    """The places in a list at which each point is for the first time, those at which one is for the second time, and so on."""
    order = np.argsort(points, kind="stable")
    _, first, counts = np.unique(points[order], return_index=True, return_counts=True)
    for turn in range(counts.max(initial=0)):
        yield order[first[counts > turn] + turn]


def dot(a: Array, b: Array) -> Array:
    """For each row."""
    products: Array = (a * b).sum(axis=-1, keepdims=True)
    return products


def unit(vectors: Array) -> Array:
    """Each row, one long; zeros where it is zero."""
    long = np.sqrt(dot(vectors, vectors))
    return np.divide(vectors, long, out=np.zeros_like(vectors), where=long > 0)


def centre(steps: int) -> Array:
    """Where the ball is after so many steps."""
    time = steps * STEP
    return np.array([0.15 * (1.0 - np.cos(3.0 * time)), 0.15 * np.sin(2.0 * time), 0.0], np.float32)


class Simulation:
    """The cloth, the ball, and the world that says where they meet."""

    def __init__(self) -> None:
        self.steps = 0
        self.cloth_faces, uv = square(24)
        height = np.full((len(uv), 1), 0.4)
        self.cloth: Array = (SIDE * np.concatenate([uv - 0.5, height], axis=1)).astype(np.float32)
        self.before = self.cloth.copy()
        self.ball_faces, uv = square(40)
        self.ball_at_first = sphere(uv)
        self.ball = self.ball_at_first.copy()
        self.world = pliant.World()
        self.bodies = (
            self.world.add(faces=self.cloth_faces, positions=self.cloth),
            self.world.add(faces=self.ball_faces, positions=self.ball),
        )
        self.numbered = [self.world.edges(body).astype(np.int64) for body in self.bodies]
        sides = np.sort(self.cloth_faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges = np.unique(sides, axis=0)
        self.edges = [edges[group] for group in coloured(edges)]
        self.rests = [np.linalg.norm(self.cloth[a] - self.cloth[b], axis=1, keepdims=True) for a, b in (group.T for group in self.edges)]

    def move_bodies(self) -> None:
        """The application moves the bodies."""
        velocity = np.float32(0.999) * (self.cloth - self.before)
        self.before = self.cloth.copy()
        self.cloth += velocity + FALL
        for _ in range(10):
            for group, rest in zip(self.edges, self.rests):
                a, b = group.T
                apart = self.cloth[b] - self.cloth[a]
                half = np.float32(0.5) * (apart - rest * unit(apart))
                self.cloth[a] += half
                self.cloth[b] -= half
        self.steps += 1
        self.ball = self.ball_at_first + centre(self.steps)
        cloth, ball = self.bodies
        self.world.set_positions(cloth, self.cloth)
        self.world.set_positions(ball, self.ball)

    def step(self) -> int:
        """One time step; returns how many pairs of triangles met."""
        # The application moves the bodies ...
        self.move_bodies()
        # ... the library answers ...
        cloth, ball = self.bodies
        pairs = self.world.intersections(pliant.Selection.between(cloth, ball)).all()
        # ... and the application reacts.
        self.push(self.cloth_faces[pairs[:, 1]], self.ball_faces[pairs[:, 3]])
        return len(pairs)

    def push(self, of_cloth: Integers, of_ball: Integers) -> None:
        """Pushes the corners of triangles of the cloth out of those of the ball that they meet."""
        a, b, c = self.ball[of_ball].swapaxes(0, 1)
        normals = np.repeat(unit(np.cross(b - a, c - a)), 3, axis=0)
        places = np.repeat(a, 3, axis=0)
        swing = centre(self.steps) - centre(self.steps - 1)
        for contacts in in_turn(of_cloth.ravel()):
            points, normal = of_cloth.ravel()[contacts], normals[contacts]
            depth = np.float32(THICKNESS) - dot(self.cloth[points] - places[contacts], normal)
            inside = depth[:, 0] > 0
            points, depth, normal = points[inside], depth[inside], normal[inside]
            # From now on they go with the ball, but for some of their sliding.
            moved = self.cloth[points] - self.before[points] - swing
            sliding = moved - dot(moved, normal) * normal
            self.cloth[points] += depth * normal - np.float32(FRICTION) * sliding
            self.before[points] = self.cloth[points] - swing - np.float32(1.0 - FRICTION) * sliding

    def step_apart(self) -> int:
        """One time step after which the cloth is THICK away from the ball; returns how many elements were too close."""
        self.move_bodies()
        normals = np.zeros_like(self.cloth)
        met = 0
        for _ in range(ROUNDS):
            # The library says what is close, and how ...
            corners, shares, there, normal = self.contacts()
            met = max(met, len(corners))
            points = (shares[:, :, None] * self.cloth[corners]).sum(axis=1)
            depth = np.float32(THICK) - dot(points - there, normal)
            if not len(depth) or depth.max() < 0.02 * THICK:
                break
            # ... and the application puts it apart: what several contacts ask of a corner, by their mean, weighed with its shares.
            weight = dot(shares, shares)
            moves = (depth / weight * shares)[:, :, None] * normal[:, None]
            total = np.zeros((len(self.cloth), 1), np.float32)
            moved = np.zeros_like(self.cloth)
            np.add.at(total, corners.ravel(), shares.reshape(-1, 1))
            np.add.at(moved, corners.ravel(), (shares[:, :, None] * moves).reshape(-1, 3))
            touched = total[:, 0] > 0
            self.cloth[touched] += moved[touched] / total[touched]
            normals[touched] = unit(moved[touched])
            self.world.set_positions(self.bodies[0], self.cloth)
        # What was put apart goes with the ball from now on, but for some of its sliding.
        touched = dot(normals, normals)[:, 0] > 0
        normal = normals[touched]
        swing = centre(self.steps) - centre(self.steps - 1)
        moved = self.cloth[touched] - self.before[touched] - swing
        sliding = moved - dot(moved, normal) * normal
        self.before[touched] = self.cloth[touched] - swing - np.float32(1.0 - FRICTION) * sliding
        return met

    def contacts(self) -> tuple[Integers, Array, Array, Array]:
        """What is too close: the corners of the cloth's element and their shares in its point, the ball's point, and the way out."""
        cloth, ball = self.bodies
        between = pliant.Selection.between(cloth, ball)
        # A vertex and a triangle: the vertex comes first, of whichever body it is.
        close = self.world.close_vertex_triangle_pairs(between, THICK).all()
        pairs, shares, out = close.pairs.astype(np.int64), close.barycentric.astype(np.float32), close.direction.astype(np.float32)
        of_cloth = pairs[:, 0] == int(cloth)
        vertices, triangles = pairs[of_cloth, 1], pairs[of_cloth, 3]
        above = (
            np.repeat(vertices[:, None], 3, axis=1),
            np.repeat(np.array([[1, 0, 0]], np.float32), len(vertices), axis=0),
            (shares[of_cloth, :, None] * self.ball[self.ball_faces[triangles]]).sum(axis=1),
            out[of_cloth],
        )
        vertices, triangles = pairs[~of_cloth, 1], pairs[~of_cloth, 3]
        below = (self.cloth_faces[triangles], shares[~of_cloth], self.ball[vertices], -out[~of_cloth])
        # An edge and an edge: the body with the lower number comes first, the cloth.
        close = self.world.close_edge_edge_pairs(between, THICK).all()
        shares, out = close.barycentric.astype(np.float32), close.direction.astype(np.float32)
        of_cloth_ends = self.numbered[0][close.pairs[:, 1]]
        of_ball_ends = self.numbered[1][close.pairs[:, 3]]
        across = (
            np.concatenate([of_cloth_ends, of_cloth_ends[:, 1:]], axis=1),
            np.concatenate([shares[:, :2], np.zeros_like(shares[:, :1])], axis=1),
            (shares[:, 2:, None] * self.ball[of_ball_ends]).sum(axis=1),
            out,
        )
        corners, shares, there, normal = (np.concatenate(parts) for parts in zip(above, below, across))
        return corners, shares, there, np.nan_to_num(normal)

    def gap(self) -> float:
        """How far the cloth is from the ball."""
        nearest = self.world.distance(*self.bodies, SIDE)
        return np.inf if nearest is None else nearest.distance

    def depth(self) -> float:
        """How deep the deepest point of the cloth is inside the ball; negative: how far the nearest is outside."""
        return float(RADIUS - np.linalg.norm(self.cloth - centre(self.steps), axis=1).min())

    def height(self) -> float:
        """How far the middle of the cloth is above the middle of the ball."""
        return float(self.cloth[len(self.cloth) // 2, 2])


def main(arguments: list[str]) -> None:
    seconds = int(arguments[0]) if arguments else 10
    apart = "apart" in arguments[1:]
    simulation = Simulation()
    for step in range(1, seconds * STEPS_A_SECOND + 1):
        pairs = simulation.step_apart() if apart else simulation.step()
        if step % (STEPS_A_SECOND // 4) == 0 and apart:
            print(f"{step * STEP:5.2f} s: cloth at {simulation.height():.3f} m, {1e3 * simulation.gap():.3f} mm apart")
        elif step % (STEPS_A_SECOND // 4) == 0:
            height, depth = simulation.height(), 1e3 * simulation.depth()
            print(f"{step * STEP:5.2f} s: {pairs:3} pairs, cloth at {height:.3f} m, {depth:6.1f} mm inside")


if __name__ == "__main__":
    main(sys.argv[1:])
