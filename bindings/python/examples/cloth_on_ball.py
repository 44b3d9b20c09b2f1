"""A cloth falls on a ball that swings to and fro: the Rust example of the same name, in numpy.

Position-based dynamics (Müller et al. 2007): points keep their velocity, fall, and are then put where edges have their length
again. Contacts come from the pairs alone: where a triangle of the cloth meets one of the ball, its corners are pushed out along the
ball triangle's normal, and rub. In one small step nothing moves further than a triangle is wide.

What a loop does one after the other is done at once here where it is about different points: edges of one colour share none, so
all of them take their length together; and of every point the first contact comes at once, then the second, and so on.

With `apart` the cloth keeps a thickness: contacts are the vertices and triangles, and edges and edges, that are closer than that, and
each is put as far apart along the direction in which it is closest, again and again until all are.

With `free` nothing gets through however fast it is, and the cloth does not meet itself either: a step is eight times as long, and goes only
as far as is proven to be free of contact. What is left of it is planned anew from there.

    python cloth_on_ball.py 10        # ten seconds of it
    python cloth_on_ball.py 10 apart
    python cloth_on_ball.py 10 free
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

import numpy as np
import pliant
from numpy.typing import NDArray

Array = NDArray[np.float32]
Integers = NDArray[np.int64]
# Two points that are close, each a mean of corners: (k, 4) corners, the ball's behind the cloth's; their shares, of the one point above
# zero and of the other below; and the way from the other to the one.
Contacts = tuple[Integers, Array, Array]

STEPS_A_SECOND = 240
STEP = 1.0 / STEPS_A_SECOND
RADIUS = 0.5
SIDE = 1.6
THICKNESS = 0.0005  # so high above the ball do contacts put points
THICK = 0.02  # so far from the ball `step_apart` keeps the cloth, and `step_free` seeks to
ROUNDS = 100  # at most, to put everything apart
FREE_STEPS_A_SECOND = 30
FREE_STEP = 1.0 / FREE_STEPS_A_SECOND
GAP = 0.1 * THICK  # nothing comes nearer than this, ever, in `step_free`
PLANS = 20  # at most so often a step is planned anew; what is left then is left out: all wait
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


def folded(faces: Integers, squares: int) -> Integers:
    """The same where each side of the square is folded in its middle and closed: of two points that come together one is left."""
    row, column = np.divmod(faces, squares + 1)
    column = np.where((row == 0) | (row == squares), np.minimum(column, squares - column), column)
    row = np.where((column == 0) | (column == squares), np.minimum(row, squares - row), row)
    return row * (squares + 1) + column


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
    products: Array = np.einsum("...i,...i->...", a, b)[..., None]
    return products


def unit(vectors: Array) -> Array:
    """Each row, one long; zeros where it is zero."""
    long = np.sqrt(dot(vectors, vectors))
    return np.divide(vectors, long, out=np.zeros_like(vectors), where=long > 0)


def centre(time: float) -> Array:
    """Where the ball is after so many seconds."""
    return np.array([0.15 * (1.0 - np.cos(3.0 * time)), 0.15 * np.sin(2.0 * time), 0.0], np.float32)


def push_apart(cloth: Array, ball: Array, contacts: Contacts, normals: Array) -> float:
    """Puts points of the cloth where contacts are as far apart as it is thick: what several ask of a corner, by their mean, weighed with
    its shares. Notes their ways as normals; returns how much the deepest lacked."""
    corners, shares, normal = contacts
    points = np.concatenate([cloth, ball])
    depth = np.float32(THICK) - dot(np.einsum("kc,kci->ki", shares, points[corners]), normal)
    own = np.where(corners < len(cloth), shares, np.float32(0))
    weight = dot(own, own)
    is_deep = ((depth > 0) & (weight > 0))[:, 0]
    corners, own, weight, depth, normal = corners[is_deep], own[is_deep], weight[is_deep], depth[is_deep], normal[is_deep]
    moves = (depth / weight * own)[:, :, None] * normal[:, None]
    total = np.zeros((len(points), 1), np.float32)
    moved = np.zeros_like(points)
    np.add.at(total, corners.ravel(), np.abs(own).reshape(-1, 1))
    np.add.at(moved, corners.ravel(), (np.abs(own)[:, :, None] * moves).reshape(-1, 3))
    touched = total[: len(cloth), 0] > 0
    cloth[touched] += moved[: len(cloth)][touched] / total[: len(cloth)][touched]
    normals[touched] = unit(moved[: len(cloth)][touched])
    return float(depth.max(initial=0.0))


class Simulation:
    """The cloth, the ball, and the world that says where they meet."""

    def __init__(self) -> None:
        self.steps, self.time = 0, 0.0
        self.cloth_faces, uv = square(24)
        height = np.full((len(uv), 1), 0.4)
        self.cloth: Array = (SIDE * np.concatenate([uv - 0.5, height], axis=1)).astype(np.float32)
        self.before = self.cloth.copy()
        faces, uv = square(40)
        self.ball_faces = folded(faces, 40)
        self.ball_at_first = sphere(uv)
        self.ball = self.ball_at_first.copy()
        self.world = pliant.World()
        self.bodies = (
            self.world.add(faces=self.cloth_faces, positions=self.cloth),
            self.world.add(faces=self.ball_faces, positions=self.ball),
        )
        of_cloth, of_ball = (self.world.edges(body).astype(np.int64) for body in self.bodies)
        self.cloth_edges = len(of_cloth)
        self.all_edges = np.concatenate([of_cloth, of_ball + len(self.cloth)])
        self.all_faces = np.concatenate([self.cloth_faces, self.ball_faces + len(self.cloth)])
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
            self.give_length(self.cloth)
        self.steps += 1
        self.time = self.steps * STEP
        self.ball = self.ball_at_first + centre(self.time)
        cloth, ball = self.bodies
        self.world.set_positions(cloth, self.cloth)
        self.world.set_positions(ball, self.ball)

    def give_length(self, points: Array) -> None:
        """Puts the ends of each edge of the cloth where it has its length."""
        for group, rest in zip(self.edges, self.rests):
            a, b = group.T
            apart = points[b] - points[a]
            half = np.float32(0.5) * (apart - rest * unit(apart))
            points[a] += half
            points[b] -= half

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
        swing = centre(self.time) - centre(self.time - STEP)
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
            contacts = self.contacts(pliant.Selection.between(*self.bodies), THICK)
            met = max(met, len(contacts[0]))
            # ... and the application puts it apart.
            if push_apart(self.cloth, self.ball, contacts, normals) < 0.02 * THICK:
                break
            self.world.set_positions(self.bodies[0], self.cloth)
        # What was put apart goes with the ball from now on, but for some of its sliding.
        touched = dot(normals, normals)[:, 0] > 0
        normal = normals[touched]
        swing = centre(self.time) - centre(self.time - STEP)
        moved = self.cloth[touched] - self.before[touched] - swing
        sliding = moved - dot(moved, normal) * normal
        self.before[touched] = self.cloth[touched] - swing - np.float32(1.0 - FRICTION) * sliding
        return met

    def step_free(self) -> int:
        """One time step in which nothing gets through; returns how often it was planned."""
        begin = self.cloth
        ways = np.float32(0.99) * (begin - self.before) + np.float32((FREE_STEP / STEP) ** 2) * FALL
        self.steps += 1
        self.time = self.steps * FREE_STEP
        ball_at_end = self.ball_at_first + centre(self.time)
        cloth, ball = self.bodies
        left, plans = 1.0, 0
        while left > 1e-3 and plans < PLANS:
            plans += 1
            # The application says where everything is to be ...
            between = self.contacts(pliant.Selection.between(cloth, ball), 2.0 * THICK)
            within = self.contacts(pliant.Selection.within(cloth), 2.0 * THICK)
            wanted: Array = (self.cloth + np.float32(left) * ways).astype(np.float32)
            normals, unused = np.zeros_like(wanted), np.zeros_like(wanted)
            for _ in range(20):
                self.give_length(wanted)
                push_apart(wanted, ball_at_end, within, unused)
                push_apart(wanted, ball_at_end, between, normals)
            swing = ball_at_end[0] - self.ball[0]
            touched = dot(normals, normals)[:, 0] > 0
            moved = wanted[touched] - self.cloth[touched] - swing
            wanted[touched] -= np.float32(FRICTION) * (moved - dot(moved, normals[touched]) * normals[touched])
            self.world.set_motion(cloth, wanted)
            self.world.set_motion(ball, ball_at_end)
            # ... and the library how far on the way everything may go.
            step = self.world.free_step(pliant.Selection.EVERYTHING, GAP)
            # At the poles of the ball its own elements are nearer to each other than that, always.
            assert not isinstance(step.begins_in_contact, pliant.Pair), step
            self.world.advance_motion(step.t)
            self.cloth, self.ball = self.world.positions(cloth), self.world.positions(ball)
            left *= 1.0 - step.t
        self.before = begin
        return plans

    def contacts(self, of: pliant.Selection, distance: float) -> Contacts:
        """What is so close, of the cloth and the ball or of the cloth with itself."""

        def numbers(bodies: NDArray[np.uint32], elements: NDArray[np.uint32], of_cloth: int) -> Integers:
            """Among those of the cloth and then the ball's."""
            among: Integers = elements.astype(np.int64) + of_cloth * (bodies != int(self.bodies[0])).astype(np.int64)
            return among

        # A vertex and a triangle: the vertex comes first, of whichever body it is.
        close = self.world.close_vertex_triangle_pairs(of, distance).all()
        body, vertex, other, triangle = close.pairs.T
        vertex = numbers(body, vertex, len(self.cloth))
        triangle = numbers(other, triangle, len(self.cloth_faces))
        corners = [np.concatenate([vertex[:, None], self.all_faces[triangle]], axis=1)]
        shares = [np.concatenate([np.ones((len(vertex), 1)), -close.barycentric], axis=1)]
        normals = [close.direction]
        close = self.world.close_edge_edge_pairs(of, distance).all()
        body, edge, other, second = close.pairs.T
        edge, second = (numbers(body, edge, self.cloth_edges) for body, edge in ((body, edge), (other, second)))
        corners.append(np.concatenate([self.all_edges[edge], self.all_edges[second]], axis=1))
        shares.append(close.barycentric * [1.0, 1.0, -1.0, -1.0])
        normals.append(close.direction)
        normal = np.nan_to_num(np.concatenate(normals)).astype(np.float32)
        return np.concatenate(corners), np.concatenate(shares).astype(np.float32), normal

    def gap(self) -> float:
        """How far the cloth is from the ball."""
        nearest = self.world.distance(*self.bodies, SIDE)
        return np.inf if nearest is None else nearest.distance

    def depth(self) -> float:
        """How deep the deepest point of the cloth is inside the ball; negative: how far the nearest is outside."""
        return float(RADIUS - np.linalg.norm(self.cloth - centre(self.time), axis=1).min())

    def height(self) -> float:
        """How far the middle of the cloth is above the middle of the ball."""
        return float(self.cloth[len(self.cloth) // 2, 2])


def main(arguments: list[str]) -> None:
    seconds = int(arguments[0]) if arguments else 10
    way = arguments[1] if len(arguments) > 1 else ""
    a_second = FREE_STEPS_A_SECOND if way == "free" else STEPS_A_SECOND
    simulation = Simulation()
    step_of = {"apart": simulation.step_apart, "free": simulation.step_free}.get(way, simulation.step)
    for step in range(1, seconds * a_second + 1):
        met = step_of()
        if step % (a_second // 4) == 0:
            found = f"{1e3 * simulation.gap():.3f} mm apart" if way else f"{met:3} pairs, {1e3 * simulation.depth():6.1f} mm inside"
            plans = f", {met} plans" if way == "free" else ""
            print(f"{step / a_second:5.2f} s: cloth at {simulation.height():.3f} m, {found}{plans}")


if __name__ == "__main__":
    main(sys.argv[1:])
