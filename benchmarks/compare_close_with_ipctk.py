#!/usr/bin/env python3
"""Compares close pairs with ipc-toolkit: equal sets, and times, in one process, turn by turn.

    cargo build --release -p pliant-scenes --example write_obj
    python3 -m venv target/ipctk
    target/ipctk/bin/pip install ipctk==1.6.1 libigl==2.6.3 ./bindings/python
    target/ipctk/bin/python benchmarks/compare_close_with_ipctk.py

Both are asked for vertex-triangle and edge-edge pairs at most m mean edge lengths apart, of all
bodies and of each with itself, with one thread and 64-bit positions. ipctk's call is
`NormalCollisions.build` with its LBVH and the activation distance. Ours is the step of a
simulator: positions, and both lists with distance, direction and closest points. Shapes of two
steps alternate. Adding the meshes is timed for neither.

First the answers are compared. ipctk keeps the closest features of each pair, each once: two
vertices, a vertex and an edge, a vertex and a face, two edges. Edges that are nearly parallel stay
edges, whatever is closest. So the features of each of our pairs must be among ipctk's, or the pair
itself if it is of edges; and each of ipctk's must come from one of our pairs. Differences that
rounding explains are counted as *ties*:

- pairs within 1e-9 of the limit (ipctk takes pairs nearer than that, we take pairs up to it);
- pairs for which ipctk has other features at an equal distance, within 1e-9.

Then the contacts of `pliant.feature_pairs`, each once, must be ipctk's features. Differences are
explained by a pair of which both have features at its distance, and counted as *others*: edges that
are nearly parallel stay edges in ipctk, and rounding decides ties there.

Every other difference is an error, and the exit code is 1. Then rounds are played in turn. The
figure is the median, over rounds, of ipctk's time over ours. Our lists are sorted, ipctk's are not.
"""

import statistics
import sys
import time

import ipctk
import numpy
import pliant

from compare_with_ipctk import all_bodies, arguments_of, numbers

MARGINS = [0.1, 0.5]
# Relative difference up to which its distances and ours count as equal.
TIE = 1e-9


class Ours:
    def __init__(self, bodies):
        self.world = pliant.World(threads=bodies.threads)
        self.ids = [
            self.world.add(faces, vertices)
            for faces, vertices in zip(bodies.faces, bodies.steps[0])
        ]

    def ask(self, shapes, distance):
        self.world.set_positions_of(zip(self.ids, shapes))
        every = pliant.Selection.EVERYTHING
        return (
            self.world.close_vertex_triangle_pairs(every, distance).all(),
            self.world.close_edge_edge_pairs(every, distance).all(),
        )

    def places(self):
        """The place of each body, by its number."""
        place = numpy.zeros(int(max(self.ids)) + 1, dtype=numpy.int64)
        for at, body in enumerate(self.ids):
            place[int(body)] = at
        return place

    def contacts(self, bodies, distance):
        """Names of the contacts, with vertices numbered in the joint mesh."""
        every = pliant.Selection.EVERYTHING
        found = pliant.feature_pairs(self.world, every, distance)
        first = bodies.first_vertex[self.places()[found.bodies.astype(numpy.int64)]]
        # How many of the vertices are of the first feature, by kind.
        of_first = numpy.array([1, 1, 2, 1])[found.kind]
        for kinds, rows, (a, b) in zip(of_first.tolist(), found.vertices.tolist(), first.tolist()):
            rest = [vertex for vertex in rows[kinds:] if vertex != 0xFFFFFFFF]
            yield Features.name([a + it for it in rows[:kinds]], [b + it for it in rest])

    def pairs(self, bodies, found):
        """Vertices of both elements of each pair, numbered in the joint mesh, and their weights."""
        place = self.places()
        edges = [
            self.world.edges(body).astype(numpy.int64) + bodies.first_vertex[at]
            for at, body in enumerate(self.ids)
        ]
        first_edge = numpy.cumsum([0] + [len(of_body) for of_body in edges])
        edges = numpy.concatenate(edges)
        rows = found[0].pairs.astype(numpy.int64)
        vertices = bodies.first_vertex[place[rows[:, 0]]] + rows[:, 1]
        faces = bodies.all_faces[bodies.first_face[place[rows[:, 2]]] + rows[:, 3]].astype(
            numpy.int64
        )
        of_vertices = (
            vertices[:, None],
            faces,
            numpy.ones((len(rows), 1)),
            found[0].barycentric,
            found[0].distance,
        )
        rows = found[1].pairs.astype(numpy.int64)
        ends = [edges[first_edge[place[rows[:, side]]] + rows[:, side + 1]] for side in (0, 2)]
        counts = found[1].barycentric
        of_edges = (ends[0], ends[1], counts[:, :2], counts[:, 2:], found[1].distance)
        return of_vertices, of_edges


class Theirs:
    def __init__(self, bodies):
        self.mesh = ipctk.CollisionMesh(bodies.together(0), bodies.all_edges, bodies.all_faces)
        self.collisions = None

    def ask(self, shape, distance):
        self.collisions = ipctk.NormalCollisions()
        self.collisions.build(self.mesh, shape, distance, 0.0, ipctk.LBVH())

    def features(self):
        """Features by kind (VV, EV, FV, EE), as numbers of its mesh."""
        of = self.collisions
        return {
            "vv": numbers((it.vertex0_id, it.vertex1_id) for it in of.vv_collisions),
            "ev": numbers((it.edge_id, it.vertex_id) for it in of.ev_collisions),
            "fv": numbers((it.face_id, it.vertex_id) for it in of.fv_collisions),
            "ee": numbers((it.edge0_id, it.edge1_id) for it in of.ee_collisions),
        }


class Features:
    """Names of features: sets of the vertices of both elements."""

    def __init__(self, bodies):
        self.edges = bodies.all_edges.astype(numpy.int64)
        self.faces = bodies.all_faces.astype(numpy.int64)

    @staticmethod
    def name(first, second):
        """Name of two elements: their sets of vertices, in no order."""
        return frozenset((frozenset(first), frozenset(second)))

    def theirs(self, found):
        corners = {
            "vv": lambda a, b: ((a,), (b,)),
            "ev": lambda edge, vertex: (self.edges[edge].tolist(), (vertex,)),
            "fv": lambda face, vertex: (self.faces[face].tolist(), (vertex,)),
            "ee": lambda a, b: (self.edges[a].tolist(), self.edges[b].tolist()),
        }
        return {
            self.name(*corners[kind](int(a), int(b)))
            for kind, rows in found.items()
            for a, b in rows
        }

    def ours(self, pairs):
        """Whole elements, closest features and distance of each pair."""
        first, second, count_first, count_second, distance = pairs
        for a, b, x, y, apart in zip(
            first.tolist(), second.tolist(), count_first > 0, count_second > 0, distance.tolist()
        ):
            near_a = [vertex for vertex, counts in zip(a, x) if counts]
            near_b = [vertex for vertex, counts in zip(b, y) if counts]
            yield self.name(a, b), self.name(near_a, near_b), apart


def apart(shape, name):
    """Distance of two features, measured by ipctk."""
    first, second = sorted(name, key=len, reverse=True) if len(name) == 2 else 2 * list(name)
    p, q = ([shape[vertex] for vertex in sorted(feature)] for feature in (first, second))
    if len(p) == 3:
        square = ipctk.point_triangle_distance(q[0], *p)
    elif len(p) == 2 and len(q) == 2:
        square = ipctk.edge_edge_distance(*p, *q)
    elif len(p) == 2:
        square = ipctk.point_edge_distance(q[0], *p)
    else:
        square = ipctk.point_point_distance(p[0], q[0])
    return square**0.5


def parts(name):
    """All features that can be the closest of two elements."""
    first, second = (sorted(feature) for feature in (name if len(name) == 2 else 2 * list(name)))

    def of(corners):
        pairs = [(a, b) for i, a in enumerate(corners) for b in corners[i + 1 :]]
        return (
            [(corner,) for corner in corners]
            + pairs
            + ([tuple(corners)] if len(corners) == 3 else [])
        )

    return [Features.name(a, b) for a in of(first) for b in of(second)]


def compare_sets(bodies, ours, found, theirs, shape, limit):
    """Number of ties and number of errors."""
    names = Features(bodies)
    its = names.theirs(theirs.features())
    ties, errors = 0, 0
    covered, at = set(), {}
    for pairs in ours.pairs(bodies, found):
        for whole, nearest, distance in names.ours(pairs):
            covered.update((whole, nearest))
            if nearest in its or whole in its:
                continue
            same = [
                part
                for part in parts(whole)
                if part in its and abs(apart(shape, part) - distance) <= TIE * limit
            ]
            covered.update(same)
            is_tie = bool(same) or abs(distance - limit) <= TIE * limit
            ties, errors = ties + is_tie, errors + (not is_tie)
    for name in its - covered:
        # Of something that we have with other features at the same distance, or at the limit.
        if not at:
            for pairs in ours.pairs(bodies, found):
                for whole, _, distance in names.ours(pairs):
                    for part in parts(whole):
                        at.setdefault(part, []).append(distance)
        distance = apart(shape, name)
        known = any(abs(distance - other) <= TIE * limit for other in at.get(name, []))
        is_tie = known or abs(distance - limit) <= TIE * limit
        ties, errors = ties + is_tie, errors + (not is_tie)
    return ties, errors, len(its)


def compare_contacts(bodies, ours, found, theirs, shape, limit):
    """Number of our contacts, of differences that are explained, and of others."""
    names = Features(bodies)
    its, own = names.theirs(theirs.features()), set(ours.contacts(bodies, limit))
    different, every = own ^ its, own | its
    left = set(different)
    for pairs in ours.pairs(bodies, found):
        for whole, _, distance in names.ours(pairs):
            some = set(parts(whole)) | {whole}
            if not left & some:
                continue
            near = {
                part
                for part in some & every
                if abs(apart(shape, part) - distance) <= TIE * limit
            }
            if near & own and near & its or abs(distance - limit) <= TIE * limit:
                left -= near
    return len(own), len(different) - len(left), len(left)


def compare(bodies, margin, rounds):
    distance = margin * bodies.mean_edge
    turns = [(bodies.steps[turn], bodies.together(turn)) for turn in (0, 1)]
    ours, theirs = Ours(bodies), Theirs(bodies)
    ties, errors, pairs, kept, once, others = 0, 0, 0, 0, 0, 0
    for separate, together in turns:
        found = ours.ask(separate, distance)
        theirs.ask(together, distance)
        pairs += sum(len(of_kind.pairs) for of_kind in found)
        counts = compare_sets(bodies, ours, found, theirs, together, distance)
        ties, errors, kept = ties + counts[0], errors + counts[1], kept + counts[2]
        counts = compare_contacts(bodies, ours, found, theirs, together, distance)
        once, others, errors = once + counts[0], others + counts[1], errors + counts[2]
    times = []
    for _ in range(rounds):
        pair = [0.0, 0.0]
        for separate, together in turns:
            for which, ask in enumerate(
                [lambda: ours.ask(separate, distance), lambda: theirs.ask(together, distance)]
            ):
                begin = time.perf_counter()
                found = ask()
                pair[which] += (time.perf_counter() - begin) / 2
                del found
        times.append(pair)
    own, other = (statistics.median(pair[which] for pair in times) * 1e3 for which in (0, 1))
    ratios = [b / a for a, b in times]
    factor = f"{statistics.median(ratios):5.2f} ({min(ratios):.2f} to {max(ratios):.2f})"
    what = f"margin {margin:g}"
    line = (
        f"{bodies.name:<24} {what:<11} {pairs // 2:>10,} {kept // 2:>10,} {ties:>7,} {once // 2:>10,} {others:>7,}"
        f" {errors:>7}"
        f" {own:>9.2f} {other:>9.2f}   {factor}"
    )
    print(line, flush=True)
    return errors


def main():
    arguments = arguments_of(__doc__, 9)
    head = (
        f"{'':<24} {'':<11} {'pairs':>10} {'features':>10} {'ties':>7} {'contacts':>10} {'others':>7}"
        f" {'errors':>7}"
        f" {'ours, ms':>9} {'its, ms':>9}   times faster"
    )
    print(head)
    errors = 0
    for bodies in all_bodies(arguments):
        errors += sum(compare(bodies, margin, arguments.rounds) for margin in MARGINS)
    print(
        "\nfeatures: what ipctk keeps; ties: left to rounding, in either; errors, of any kind:"
        f" {errors}"
    )
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
