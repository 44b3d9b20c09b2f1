"""Drapes tubes and panels on bodies, and counts exactly what of each garment intersects.

    python examples/garments.py OUT [COUNT [TRIANGLES]]

Position-based dynamics with compliance (Macklin et al. 2016): threads of the cloth keep their
length, and vertices stay out of the body. Nothing keeps the cloth from itself, nor its triangles
from the body, so that many drapes have faults, as in data sets of garments. Drape K has seed K.
OUT gets `garment_K.obj`, `body_K.obj`, `list.txt` for `pliant check --files-from`, and `truth.csv`
with the pairs of the garment with the body and with itself, and the edges that cross some triangle.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pliant
from numpy.typing import NDArray
from pliant import Selection

Array = NDArray[np.float64]
STEPS, GRAVITY, COMPLIANCE, DAMPING = 40, 9.8, 1e-7, 0.98
STEP = 1 / 60


def quads(rows: int, columns: int, closed: bool) -> NDArray[np.uint32]:
    """Triangles of a sheet of (rows + 1) x columns vertices, closed to a tube or not."""
    i, j = np.divmod(np.arange(rows * columns), columns)
    i, j = (i, j) if closed else (i[j < columns - 1], j[j < columns - 1])
    a, b = i * columns + j, i * columns + (j + 1) % columns
    return np.concatenate([np.stack([a, b, b + columns], 1), np.stack([a, b + columns, a + columns], 1)]).astype(np.uint32)


class Body:
    """A torso: its radius is a function of height and angle, so that depths are known."""

    def __init__(self, random: np.random.Generator) -> None:
        self.waist, self.hip, self.turn = random.uniform(0.1, 0.35), random.uniform(0, 0.3), random.uniform(0, 6.3)

    def radius(self, z: Array, angle: Array) -> Array:
        slim = 1 - self.waist * np.exp(-(((z - 0.1) / 0.3) ** 2)) + self.hip * np.exp(-(((z + 0.5) / 0.25) ** 2))
        return 0.35 * slim * (1 + 0.15 * np.cos(2 * angle + self.turn)) * np.sqrt(np.clip(1 - z**4, 0, 1))

    def mesh(self, rows: int, columns: int) -> tuple[NDArray[np.uint32], Array]:
        """A closed surface: rings from the lowest point to the highest, which are caps."""
        z = -np.cos(np.linspace(0, np.pi, rows + 1))[1:-1, None]
        angle = np.arange(columns) * 2 * np.pi / columns + 0 * z
        ring = self.radius(z, angle)
        points = np.stack([ring * np.cos(angle), ring * np.sin(angle), z + 0 * angle], -1).reshape(-1, 3)
        faces, last = quads(rows - 2, columns, closed=True), len(points)
        j = np.arange(columns)
        below = np.stack([(j + 1) % columns, j, 0 * j + last], 1)
        above = np.stack([last - columns + j, last - columns + (j + 1) % columns, 0 * j + last + 1], 1)
        return np.concatenate([faces, below, above]).astype(np.uint32), np.concatenate([points, [[0, 0, -1], [0, 0, 1]]])

    def push_out(self, x: Array) -> None:
        """Moves vertices inside to the side of the body, and slows nothing."""
        across = np.hypot(x[:, 0], x[:, 1])
        within = np.abs(x[:, 2]) < 1
        wanted = self.radius(x[:, 2], np.arctan2(x[:, 1], x[:, 0])) + 0.004
        inside = within & (across < wanted) & (across > 1e-9)
        x[inside, :2] *= (wanted[inside] / across[inside])[:, None]


class Garment:
    """A tube round the body, or a panel over it, of about this number of triangles."""

    def __init__(self, random: np.random.Generator, triangles: int) -> None:
        self.closed = bool(random.integers(2))
        rows = max(4, round((triangles / 2) ** 0.5))
        columns = rows
        i, j = np.divmod(np.arange((rows + 1) * columns), columns)
        u = i / rows
        if self.closed:
            size, angle = random.uniform(0.45, 0.6), 2 * np.pi * j / columns
            self.x = np.stack([size * np.cos(angle), size * np.sin(angle), 0.75 - random.uniform(0.8, 1.3) * u], 1)
        else:
            side = random.uniform(1.2, 2)
            flat = np.stack([side * (u - 0.5), side * (j / (columns - 1) - 0.5), 0 * u], 1)
            turn = random.uniform(-0.4, 0.4)
            self.x = flat @ np.array([[1, 0, np.sin(turn)], [0, 1, 0], [0, 0, 1]]) + [0, 0, 1.05]
        self.faces = quads(rows, columns, self.closed)
        self.threads = self.in_colours(rows, columns)
        # Cloth that is cut too small or too large is under tension, or in folds.
        ease = random.uniform(0.75, 1.1)
        self.lengths = [ease * np.linalg.norm(self.x[a] - self.x[b], axis=1) for a, b in self.threads]
        self.x += 1e-3 * random.standard_normal(self.x.shape)

    def in_colours(self, rows: int, columns: int) -> list[tuple[Any, Any]]:
        """Threads along, across and over two squares, in groups that share no vertex."""
        number = np.arange((rows + 1) * columns).reshape(rows + 1, columns)
        groups = []
        for step in (1, 2):
            for first in range(2 * step):
                start = np.flatnonzero(np.arange(rows + 1 - step) % (2 * step) == first)
                groups.append((number[start], number[start + step]))
                start = np.flatnonzero(np.arange(columns - (0 if self.closed and columns % (2 * step) == 0 else step)) % (2 * step) == first)
                groups.append((number[:, start], number[:, (start + step) % columns]))
        return [(a.ravel(), b.ravel()) for a, b in groups]

    def drape(self, body: Body, steps: int) -> None:
        velocity = np.zeros_like(self.x)
        slack = 2 + COMPLIANCE / STEP**2
        for _ in range(steps):
            velocity[:, 2] -= GRAVITY * STEP
            before = self.x.copy()
            self.x += STEP * velocity
            for _ in range(4):
                for (a, b), length in zip(self.threads, self.lengths, strict=True):
                    way = self.x[a] - self.x[b]
                    now = np.linalg.norm(way, axis=1)
                    way *= ((now - length) / (slack * np.maximum(now, 1e-12)))[:, None]
                    self.x[a] -= way
                    self.x[b] += way
                body.push_out(self.x)
            velocity = DAMPING * (self.x - before) / STEP


def write(path: Path, faces: NDArray[np.uint32], points: Array) -> None:
    with path.open("w") as out:
        np.savetxt(out, points, "v %.17g %.17g %.17g")
        np.savetxt(out, faces.astype(int) + 1, "f %d %d %d")


def main() -> None:
    out = Path(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    triangles = int(sys.argv[3]) if len(sys.argv) > 3 else 20_000
    out.mkdir(parents=True, exist_ok=True)
    rows, listed, spent = ["drape,with_body,with_itself,edges_with_body,edges_with_itself"], [], 0.0
    for seed in range(count):
        random = np.random.default_rng(seed)
        body, garment = Body(random), Garment(random, triangles)
        garment.drape(body, STEPS)
        faces, points = body.mesh(60, 80)
        begin = time.perf_counter()
        world = pliant.World()
        cloth, torso = world.add(garment.faces, garment.x), world.add(faces, points)
        both = (Selection.between(cloth, torso), Selection.within(cloth))
        found = [len(world.intersections(of).all()) for of in both]
        # An edge counts once, however many triangles it crosses.
        found += [len(np.unique(world.crossing_edges(of).all()[:, :2], axis=0)) for of in both]
        spent += time.perf_counter() - begin
        rows.append(",".join(map(str, (seed, *found))))
        write(out / f"garment_{seed}.obj", garment.faces, garment.x)
        write(out / f"body_{seed}.obj", faces, points)
        listed.append(f"{out / f'garment_{seed}.obj'}\t{out / f'body_{seed}.obj'}")
    (out / "list.txt").write_text("\n".join(listed) + "\n")
    (out / "truth.csv").write_text("\n".join(rows) + "\n")
    faulty = sum(any(int(number) for number in row.split(",")[1:]) for row in rows[1:])
    print(f"{faulty} of {count} drapes have faults; pliant took {1000 * spent / max(count, 1):.1f} ms each, trees included")


if __name__ == "__main__":
    main()
