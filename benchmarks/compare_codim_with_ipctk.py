#!/usr/bin/env python3
"""Compares bodies of edges and points with ipc-toolkit: candidates, distances, contacts.

    python3 -m venv target/ipctk
    target/ipctk/bin/pip install ipctk==1.6.1 libigl==2.6.3 ./bindings/python
    target/ipctk/bin/python benchmarks/compare_codim_with_ipctk.py [--scenes 60]

Scenes are random: sheets, cables, nets, clouds of points, bodies of all; some on a coarse lattice.
ipctk has four lists of candidates, which are rows of our two:

    ee    two edges, of faces or loose    edges and edges
    fv    a vertex and a face             vertices and triangles
    ev    a point and a loose edge        vertices and triangles [i, j, j]
    vv    two points                      vertices and triangles [i, i, i], both ways

Its lists, now and swept, must be in ours; *its alone* are pairs within the rounding of its boxes.
Ours have each vertex with each loose edge and point, too. Such a pair is *covered* if ipctk has an
edge or a face at the vertex with the other. Else they are *neighbours*, which ipctk never looks at:
all edges at the vertex end on the loose edge, as at the end of a cable and the next edge but one.

Distances of close pairs must be ipctk's, to 1e-9 of themselves or 1e-15. Its normal collisions must
be our contacts, each once. *Ties* are both features of a pair at its distance. Contacts that only
pairs of ours alone have are *more*: a point above a face is near its corners, too. Every other
difference is an error, and the exit code is 1.
"""

import argparse
import importlib.metadata
import sys

import ipctk
import numpy
import pliant

from compare_close_with_ipctk import TIE, Features, Ours, apart, parts
from compare_with_ipctk import ROUNDING, numbers

EVERY = pliant.Selection.EVERYTHING
COUNTS = "ee fv ev vv covered neighb. its_alone close contacts ties more errors".split()
NUMBERS = {"ee": "edge0 edge1", "fv": "face vertex", "ev": "edge vertex", "vv": "vertex0 vertex1"}


def body(random, kind):
    """Vertices, faces, loose edges and points of a body."""
    of = numpy.arange(36).reshape(6, 6)
    flat = numpy.c_[of.ravel() // 6, of.ravel() % 6, 0 * of.ravel()] / 6
    flat = flat + 0.03 * random.normal(size=(36, 3))
    a, b, c, d = of[:-1, :-1], of[1:, :-1], of[1:, 1:], of[:-1, 1:]
    faces = numpy.dstack([a, b, c, a, c, d]).reshape(-1, 3)
    lines = [numpy.dstack([it[1:], it[:-1]]).reshape(-1, 2) for it in (of, of.T)]
    way = random.normal(size=(30, 3)).cumsum(axis=0)
    way = (way / numpy.linalg.norm(way, axis=1, keepdims=True)).cumsum(axis=0) / 12
    cloud, steps = random.random((40, 3)) * [1, 1, 0.2], numpy.arange(29)[:, None] + [0, 1]
    at_corner = numpy.r_[[[0, 36]], 36 + steps]  # the cable begins at a corner of the sheet
    return {
        "sheet": (flat, faces, None, None),
        "net": (flat, None, numpy.concatenate(lines), None),
        "cable": (way - way.mean(axis=0) + 0.5, None, steps, None),
        "cloud": (cloud, None, None, numpy.arange(40)),
        "all": (numpy.r_[flat, flat[0] + way, cloud], faces, at_corner, numpy.arange(66, 106)),
    }[kind]


class Scene(Ours):
    """Bodies, in a world of ours and as one mesh of ipctk, in which vertices are numbered."""

    def __init__(self, seed):
        random = numpy.random.default_rng(seed)
        kinds = random.choice(["sheet", "cable", "net", "cloud", "all"], size=1 + seed % 3)
        self.name = " + ".join(kinds) + (", lattice" if seed % 4 == 3 else "")
        self.world, self.ids, self.triangles, self.edges = pliant.World(), [], [], []
        self.first_vertex, rows = numpy.zeros(1, int), []
        for at, faces, edges, points in (body(random, kind) for kind in kinds):
            at = at + 0.1 * random.random(3)
            rows.append(numpy.round(16 * at) / 16 if seed % 4 == 3 else at)
            self.ids.append(self.world.add(faces, rows[-1], edges=edges, points=points))
            own = self.world.triangles(self.ids[-1]), self.world.edges(self.ids[-1])
            for whole, it in zip((self.triangles, self.edges), own):
                whole.append((it.astype(int) + self.first_vertex[-1]).tolist())
            self.first_vertex = numpy.r_[self.first_vertex, self.first_vertex[-1] + len(at)]
        self.at = numpy.concatenate(rows)
        self.end = self.at + 0.1 * random.normal(size=self.at.shape)
        self.all_edges = numpy.array(sum(self.edges, []), int).reshape(-1, 2)
        proper = [row for row in sum(self.triangles, []) if len(set(row)) == 3]
        self.all_faces = numpy.array(proper, int).reshape(-1, 3)
        self.mesh = ipctk.CollisionMesh(self.at, self.all_edges, self.all_faces)
        every = [set(row) for row in proper + sum(self.edges, [])]
        self.around = [[it for it in every if vertex in it] for vertex in range(len(self.at))]

    def ours(self, vertices, edges):
        """Names of pairs: the sets of vertices of both elements."""
        for a, vertex, b, triangle in vertices.tolist():
            yield Features.name({self.first_vertex[a] + vertex}, self.triangles[b][triangle])
        for a, edge, b, other in edges.tolist():
            yield Features.name(self.edges[a][edge], self.edges[b][other])

    def theirs(self, found, of):
        rows = {kind: getattr(found, f"{kind}_{of}") for kind in NUMBERS}
        for kind, names in NUMBERS.items():
            pairs = ([getattr(it, f"{name}_id") for name in names.split()] for it in rows[kind])
            rows[kind] = numbers(pairs)
        return Features(self).theirs(rows)

    def why_alone(self, name, its):
        for one, other in (tuple(name), tuple(name)[::-1]):
            around = self.around[min(one)] if len(one) == 1 else []
            if any(Features.name(element, other) in its for element in around):
                return "covered"
            if around and all(element & other for element in around):
                return "neighbour"
        return "error"


def compare_candidates(scene, limit, *shapes):
    found = ipctk.Candidates()
    found.build(scene.mesh, shapes[0], shapes[-1], limit / 2, ipctk.LBVH())
    its = scene.theirs(found, "candidates")
    vertices = scene.world.vertex_triangle_candidates(EVERY, limit / 2).all()
    own = set(scene.ours(vertices, scene.world.edge_edge_candidates(EVERY, limit / 2).all()))
    why = [scene.why_alone(name, its) for name in own - its]
    errors = why.count("error")
    for name in its - own:
        p, q = (numpy.concatenate([shape[sorted(it)] for shape in shapes]) for it in name)
        gap = numpy.maximum(p.min(axis=0) - q.max(axis=0), q.min(axis=0) - p.max(axis=0)).max()
        errors += not limit <= gap <= limit + ROUNDING * max(abs(it).max() for it in shapes)
    sizes = [sorted(map(len, name)) for name in its & own]
    equal = [sizes.count(of) for of in ([2, 2], [1, 3], [1, 2], [1, 1])]
    alone = [why.count("covered"), why.count("neighbour"), len(its - own)]
    return its, numpy.array([*equal, *alone, 0, 0, 0, 0, errors])


def compare_close(scene, limit, its):
    """Distances of close pairs, then contacts."""
    questions = scene.world.close_vertex_triangle_pairs, scene.world.close_edge_edge_pairs
    found = [question(EVERY, limit).all() for question in questions]
    distances = [distance for of_kind in found for distance in of_kind.distance.tolist()]
    close = dict(zip(scene.ours(*(of_kind.pairs for of_kind in found)), distances))
    measured = {name: apart(scene.at, name) for name in its | set(close)}
    errors = sum(abs(measured[name] - it) > TIE * it + 1e-15 for name, it in close.items())
    far = [name for name, it in measured.items() if abs(it - limit) > TIE * limit]
    errors += sum((measured[name] < limit) != (name in close) for name in far)
    collisions = ipctk.NormalCollisions()
    collisions.build(scene.mesh, scene.at, limit, 0.0, ipctk.LBVH())
    theirs, own = scene.theirs(collisions, "collisions"), set(scene.contacts(scene, limit))
    why = {name: set() for name in own ^ theirs}
    for whole, distance in close.items():
        some = parts(whole) if why.keys() & set(parts(whole)) else []
        near = {it for it in some if abs(apart(scene.at, it) - distance) <= TIE * limit}
        for part in why.keys() & near:
            is_tie, is_more = near & own and near & theirs, part in own and whole not in its
            why[part].add("tie" if is_tie else "more" if is_more else "")
    ties = sum("tie" in of for of in why.values())
    more = sum(of == {"more"} for of in why.values())
    counts = [len(close), len(own & theirs), ties, more, errors + len(why) - ties - more]
    return numpy.array([0] * 7 + counts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--scenes", type=int, default=60)
    print(f"pliant {pliant.__version__} and ipctk {importlib.metadata.version('ipctk')}\n")
    print(f"{'':<26}", *(f"{what:>9}" for what in COUNTS))
    total = numpy.zeros(len(COUNTS), int)
    for seed in range(parser.parse_args().scenes):
        scene, limit = Scene(seed), 0.05 if seed % 2 else 0.15
        its, counts = compare_candidates(scene, limit, scene.at)
        counts += compare_close(scene, limit, its)
        for number, end in zip(scene.ids, numpy.split(scene.end, scene.first_vertex[1:-1])):
            scene.world.set_motion(number, end)
        counts += compare_candidates(scene, limit, scene.at, scene.end)[1]
        print(f"{scene.name:<26}", *(f"{count:>9,}" for count in counts), flush=True)
        total += counts
    print(f"{'all':<26}", *(f"{count:>9,}" for count in total))
    return 1 if total[-1] else 0


if __name__ == "__main__":
    sys.exit(main())
