#!/usr/bin/env python3
"""Compares candidates within a margin with ipc-toolkit: equal lists, and times, turn by turn.

    cargo build --release -p pliant-scenes --example write_obj
    python3 -m venv target/ipctk
    target/ipctk/bin/pip install ipctk==1.6.1 libigl==2.6.3 ./bindings/python
    target/ipctk/bin/python benchmarks/compare_with_ipctk.py

Both are asked for vertex-triangle and edge-edge candidates of all bodies and of each with itself,
with one thread, or `--threads N`, and 64-bit positions, in one process. ipctk's call is `Candidates.build` with its
LBVH, the fastest of its broad phases on a processor, which rebuilds its trees in every call. Ours
is the step of a simulator: positions, the end of the motion if there is one, both lists. Adding
the meshes is timed for neither.

    margin m      pairs within m mean edge lengths: r is half of that; shapes of two steps alternate
    swept f       r = 0, from a step the part f of the way to the next, and then back from there
    whole         swept 1

First the lists are compared. ipctk rounds boxes outward to 32 bits, so it may have more. Each pair
that it has alone must have a gap above 2 r, and at most 2 r + 2^-21 of the largest coordinate. A pair
that we have alone is an error, and the exit code is 1. Then rounds are played in turn: our lists
sorted, in job order and in rows, and ipctk's, which is not sorted. Figures are medians over rounds;
times faster are ipctk's time over ours, sorted and in job order.
"""

import argparse
import dataclasses
import importlib.metadata
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import igl
import ipctk
import numpy
import pliant

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent
# Scenes of ours: name, triangles a body, a step, the next step.
SCENES = [("spheres", 20480, 180), ("crowd", 5120, 175), ("cloth", 79202, 45)]
REAL = [("armadillo-rollers", 326), ("cloth-funnel", 227)]
CASES = [("margin", 0.1), ("margin", 0.5), ("swept", 0.1), ("swept", 1.0)]
# Each box may be rounded outward by one 32-bit step on either side, twice. A step is at most
# 2^-23 of a number.
ROUNDING = 2.0**-21


@dataclasses.dataclass
class Bodies:
    """Bodies at two steps, and their joint mesh, which ipctk takes."""

    name: str
    faces: list
    steps: list  # of two steps, the vertices of each body
    threads: int = 1  # that both use

    def __post_init__(self):
        counts = [len(vertices) for vertices in self.steps[0]]
        self.first_vertex = numpy.cumsum([0] + counts)
        self.first_face = numpy.cumsum([0] + [len(faces) for faces in self.faces])
        together = [faces + first for faces, first in zip(self.faces, self.first_vertex)]
        self.all_faces = numpy.asfortranarray(numpy.vstack(together), dtype=numpy.int32)
        self.all_edges = ipctk.edges(self.all_faces)
        ends = self.together(0)[self.all_edges]
        self.mean_edge = float(numpy.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).mean())

    def together(self, step):
        return numpy.asfortranarray(numpy.vstack(self.steps[step]))


def read(path):
    vertices, faces = igl.read_triangle_mesh(str(path))
    return numpy.ascontiguousarray(vertices, dtype=numpy.float64), numpy.ascontiguousarray(
        faces, dtype=numpy.int64
    )


def scene(exporter, folder, name, triangles, first):
    steps = []
    for step in (first, first + 1):
        place = folder / f"{name}-{triangles}-{step}"
        place.mkdir()
        subprocess.run([str(exporter), name, str(triangles), str(step), str(place)], check=True)
        paths = sorted(place.glob("*.obj"), key=lambda path: int(path.stem.rsplit("-", 1)[1]))
        steps.append([read(path) for path in paths])
    faces = [mesh[1] for mesh in steps[0]]
    return Bodies(f"{name} {triangles:,}", faces, [[mesh[0] for mesh in step] for step in steps])


def real(data, name, frame):
    meshes = [read(data / name / f"{number}.ply") for number in (frame, frame + 1)]
    return Bodies(f"{name} {frame}", [meshes[0][1]], [[mesh[0]] for mesh in meshes])


class Ours:
    def __init__(self, bodies):
        self.world = pliant.World(threads=bodies.threads)
        self.ids = [
            self.world.add(faces, vertices)
            for faces, vertices in zip(bodies.faces, bodies.steps[0])
        ]

    def ask(self, starts, ends, radius, how="sorted"):
        """Both lists: sorted, in job order, or in compressed rows by their first element."""
        self.world.set_positions_of(zip(self.ids, starts))
        if ends is not None:
            for body, end in zip(self.ids, ends):
                self.world.set_motion(body, end)
        every = pliant.Selection.EVERYTHING
        queries = (
            self.world.vertex_triangle_candidates(every, radius),
            self.world.edge_edge_candidates(every, radius),
        )
        if how == "rows":
            return [query.rows() for query in queries]
        return [query.all(sort=how == "sorted") for query in queries]

    def pairs(self, bodies, found):
        """Pairs numbered in the joint mesh: vertex and face; edge and edge, by sorted vertices."""
        places = {int(body): place for place, body in enumerate(self.ids)}
        place = numpy.zeros(max(places) + 1, dtype=numpy.int64)
        for body, at in places.items():
            place[body] = at
        edge_of = {
            tuple(sorted(ends)): number for number, ends in enumerate(bodies.all_edges.tolist())
        }
        numbers = []
        for body, at in places.items():
            ends = self.world.edges(body).astype(numpy.int64) + bodies.first_vertex[at]
            numbers.append(
                numpy.array(
                    [edge_of[tuple(sorted(pair))] for pair in ends.tolist()], dtype=numpy.int64
                )
            )
        first = numpy.cumsum([0] + [len(of_body) for of_body in numbers])
        number = numpy.concatenate(numbers)
        vertex_face, edge_edge = (rows.astype(numpy.int64) for rows in found)
        vertices = bodies.first_vertex[place[vertex_face[:, 0]]] + vertex_face[:, 1]
        faces = bodies.first_face[place[vertex_face[:, 2]]] + vertex_face[:, 3]
        a = number[first[place[edge_edge[:, 0]]] + edge_edge[:, 1]]
        b = number[first[place[edge_edge[:, 2]]] + edge_edge[:, 3]]
        return keys(vertices, faces), keys(numpy.minimum(a, b), numpy.maximum(a, b))


class Theirs:
    def __init__(self, bodies):
        self.mesh = ipctk.CollisionMesh(bodies.together(0), bodies.all_edges, bodies.all_faces)
        self.candidates = None

    def ask(self, start, end, radius):
        self.candidates = ipctk.Candidates()
        self.candidates.build(self.mesh, start, start if end is None else end, radius, ipctk.LBVH())

    def pairs(self):
        vertex_face = numbers((row.vertex_id, row.face_id) for row in self.candidates.fv_candidates)
        edge_edge = numbers((row.edge0_id, row.edge1_id) for row in self.candidates.ee_candidates)
        return keys(vertex_face[:, 0], vertex_face[:, 1]), keys(
            edge_edge.min(axis=1), edge_edge.max(axis=1)
        )


def numbers(rows):
    flat = numpy.fromiter((number for row in rows for number in row), dtype=numpy.int64)
    return flat.reshape(-1, 2)


def keys(first, second):
    return numpy.unique(first << 32 | second)


def gaps(bodies, start, end, keys, are_edges):
    """Gaps of the boxes of pairs of elements."""
    shapes = [start] if end is None else [start, end]

    def boxes(corners):
        points = numpy.concatenate([shape[corners] for shape in shapes], axis=1)
        return points.min(axis=1), points.max(axis=1)

    first, second = keys >> 32, keys & 0xFFFFFFFF
    low_a, high_a = boxes(bodies.all_edges[first] if are_edges else first[:, None])
    low_b, high_b = boxes((bodies.all_edges if are_edges else bodies.all_faces)[second])
    return numpy.maximum(low_a - high_b, low_b - high_a).max(axis=1)


def shapes_of(bodies, kind, amount, turn):
    """Positions now and at the end of the motion: body by body, and joint."""
    here, there = bodies.steps[turn % 2], bodies.steps[1 - turn % 2]
    ends = None
    if kind == "swept":
        ends = there if amount == 1 else [a + amount * (b - a) for a, b in zip(here, there)]
    together = [
        None if shape is None else numpy.asfortranarray(numpy.vstack(shape))
        for shape in (here, ends)
    ]
    return (here, ends), together


def radius_of(bodies, kind, amount):
    return amount / 2 * bodies.mean_edge if kind == "margin" else 0.0


def differences(bodies, together, radius, mine, other, are_edges):
    """Errors, and how many pairs ipctk has alone."""
    errors = len(numpy.setdiff1d(mine, other, assume_unique=True))
    alone = numpy.setdiff1d(other, mine, assume_unique=True)
    largest = max(numpy.abs(shape).max() for shape in together if shape is not None)
    allowed = 2 * radius + ROUNDING * largest
    gap = gaps(bodies, *together, alone, are_edges) if len(alone) else numpy.zeros(0)
    # What is nearer is ours, too. A gap is rounded once, so none below 2 r rounds to above.
    is_ours = (gap < 2 * radius) | ((gap == 0) & (radius == 0))
    return errors + int(((gap > allowed) | is_ours).sum()), len(alone)


def compare(bodies, kind, amount, rounds):
    radius = radius_of(bodies, kind, amount)
    turns = [shapes_of(bodies, kind, amount, turn) for turn in (0, 1)]
    ours, theirs = Ours(bodies), Theirs(bodies)
    errors, more, counts = 0, 0, []
    for separate, together in turns:
        found = ours.ask(*separate, radius)
        theirs.ask(*together, radius)
        counts.append(sum(map(len, found)))
        lists = zip(ours.pairs(bodies, found), theirs.pairs())
        for are_edges, (mine, other) in enumerate(lists):
            wrong, alone = differences(bodies, together, radius, mine, other, are_edges)
            errors += wrong
            more += alone
    forms = ("sorted", "job order", "rows")
    times = []
    for _ in range(rounds):
        round_of = [0.0] * 4
        for separate, together in turns:
            asks = [lambda how=how: ours.ask(*separate, radius, how) for how in forms]
            asks.append(lambda: theirs.ask(*together, radius))
            for which, ask in enumerate(asks):
                begin = time.perf_counter()
                found = ask()
                round_of[which] += (time.perf_counter() - begin) / 2
                del found
        times.append(round_of)
    medians = [statistics.median(each) * 1e3 for each in zip(*times)]
    what = f"{kind} {amount:g}"
    factors = []
    for which in (0, 1):
        ratios = [round_of[3] / round_of[which] for round_of in times]
        middle = statistics.median(ratios)
        factors.append(f"{middle:5.2f} ({min(ratios):.2f} to {max(ratios):.2f})")
    count = sum(counts) // 2
    figures = "".join(f" {median:>9.2f}" for median in medians)
    line = (
        f"{bodies.name:<24} {what:<11} {count:>10,} {more:>7,} {errors:>7}{figures}"
        f"   {factors[0]:<22} {factors[1]}"
    )
    print(line, flush=True)
    return errors


def arguments_of(what, rounds, *more):
    """Arguments that all comparisons have, and `more` that must be given."""
    parser = argparse.ArgumentParser(description=what.split("\n")[0])
    parser.add_argument(
        "--exporter", type=pathlib.Path, default=CHECKOUT / "target/release/examples/write_obj"
    )
    parser.add_argument("--data", type=pathlib.Path, default=CHECKOUT.parent / "shared" / "data")
    parser.add_argument("--rounds", type=int, default=rounds)
    parser.add_argument("--only", default="", help="of what is compared, what has this in its name")
    parser.add_argument("--threads", type=int, default=1, help="that both use")
    for name, text in more:
        parser.add_argument(name, type=pathlib.Path, required=True, help=text)
    arguments = parser.parse_args()
    ipctk.set_num_threads(arguments.threads)
    threads = "one thread" if arguments.threads == 1 else f"{arguments.threads} threads"
    print(
        f"pliant {pliant.__version__} and ipctk {importlib.metadata.version('ipctk')}, {threads},"
        f" {arguments.rounds} rounds\n"
    )
    return arguments


def all_bodies(arguments):
    """All bodies of our scenes and the real meshes, one after the other."""
    with tempfile.TemporaryDirectory() as folder:
        makers = [
            (
                f"{name} {triangles:,}",
                lambda of=(name, triangles, step): scene(
                    arguments.exporter, pathlib.Path(folder), *of
                ),
            )
            for name, triangles, step in SCENES
        ]
        if arguments.data.is_dir():
            makers += [
                (name, lambda of=(name, frame): real(arguments.data, *of)) for name, frame in REAL
            ]
        else:
            print("no ../shared/data beside the checkout: real meshes skipped")
        for name, make in makers:
            if arguments.only in name:
                yield dataclasses.replace(make(), threads=arguments.threads)


def main():
    arguments = arguments_of(__doc__, 9)
    print(
        f"{'':<24} {'':<11} {'candidates':>10} {'more':>7} {'errors':>7} {'sorted':>9}"
        f" {'job order':>9} {'rows':>9} {'its':>9}   {'times faster, sorted':<22} in job order"
    )
    errors = 0
    for bodies in all_bodies(arguments):
        errors += sum(compare(bodies, kind, amount, arguments.rounds) for kind, amount in CASES)
    print(
        "\nmilliseconds; more: candidates that ipctk has alone, within its rounding; errors, of any kind:"
        f" {errors}"
    )
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
