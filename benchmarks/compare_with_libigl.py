#!/usr/bin/env python3
"""Compares pairs with libigl's exact predicates on the same meshes: an independent second opinion.

    cargo build --release && cargo build --release -p pliant-scenes --example write_obj
    python3 -m venv target/libigl && target/libigl/bin/pip install libigl==2.6.3
    target/libigl/bin/python benchmarks/compare_with_libigl.py

Every mesh goes through `pliant check --format json --no-weld`, and through
`igl.predicates.find_intersections` or `find_self_intersections`, from the same file. libigl uses
its own reader. The two sets of pairs are compared. The two promise different things, so each pair
that only one of them reports is decided alone, in rational arithmetic. It must fall under one of
these rules:

    neighbours   Only libigl; the triangles share a vertex of the mesh. pliant leaves such pairs
                 out, as documented. libigl reports pairs that meet beyond the shared vertices.
    degenerate   Only libigl; one triangle is a segment or a point, and the two do NOT meet.
                 libigl takes a triangle without a plane for coplanar with any other.

Any other pair is unexplained, in particular one that only pliant reports: it is printed, and the
exit code is 1. The rational decision clips one triangle by the half-spaces of the other: no
orientation signs, no case analysis, nothing in common with either library.

Meshes are the real ones of ../shared/data, if that exists (otherwise the script says that they are
skipped), and scenes of pliant-scenes. Soups on a small lattice are full of touching, coplanar,
identical and degenerate triangles.
"""

import argparse
import collections
import fractions
import importlib.metadata
import json
import pathlib
import random
import subprocess
import sys
import tempfile

import igl
import igl.predicates
import numpy

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent


# --- The judge -----------------------------------------------------------------------------------


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def is_zero(a):
    return not any(a)


def is_degenerate(triangle):
    a, b, c = triangle
    return is_zero(cross(minus(b, a), minus(c, a)))


def half_spaces(triangle):
    """Hull of three points as half-spaces (normal, offset): all p with normal . p <= offset."""

    def slab(direction, points):
        along = [dot(direction, point) for point in points]
        return [(direction, max(along)), (tuple(-x for x in direction), -min(along))]

    a, b, c = triangle
    normal = cross(minus(b, a), minus(c, a))
    if not is_zero(normal):
        found = slab(normal, [a])
        for p, q, opposite in [(a, b, c), (b, c, a), (c, a, b)]:
            outward = cross(minus(q, p), normal)
            if dot(outward, opposite) > dot(outward, p):
                outward = tuple(-x for x in outward)
            found.append((outward, dot(outward, p)))
        return found
    # A segment or a point: a slab along each axis and, for a segment, two planes through it.
    found = []
    for axis in range(3):
        found += slab(tuple(fractions.Fraction(int(i == axis)) for i in range(3)), [a, b, c])
    longest = max([minus(b, a), minus(c, a), minus(c, b)], key=lambda edge: dot(edge, edge))
    for axis in range(3):
        across = cross(longest, tuple(fractions.Fraction(int(i == axis)) for i in range(3)))
        if not is_zero(across):
            found += slab(across, [a])
    return found


def meet(a, b):
    """Whether two closed triangles intersect, by clipping the first by the hull of the second."""
    polygon = list(a)
    for normal, offset in half_spaces(b):
        clipped = []
        for p, q in zip(polygon, polygon[1:] + polygon[:1]):
            over_p, over_q = dot(normal, p) - offset, dot(normal, q) - offset
            if over_p <= 0:
                clipped.append(p)
            if over_p * over_q < 0:
                t = over_p / (over_p - over_q)
                clipped.append(tuple(x + t * (y - x) for x, y in zip(p, q)))
        if not clipped:
            return False
        polygon = clipped
    return True


def the_judge_knows_what_is_plain():
    """Tests the judge on plain cases: a wrong judge would explain anything."""
    F = fractions.Fraction
    exact = lambda points: [tuple(F(x) for x in point) for point in points]
    flat = exact([(0, 0, 0), (4, 0, 0), (0, 4, 0)])
    for other, expected in [
        ([(1, 1, -1), (1, 1, 1), (1, 2, 1)], True),  # pierces
        ([(1, 1, 1), (1, 2, 1), (2, 1, 2)], False),  # above
        ([(0, 0, 0), (-1, 0, 1), (0, -1, 1)], True),  # touches in a corner
        ([(2, 2, 0), (5, 5, 1), (5, 5, -1)], True),  # touches the slanted edge
        ([(3, 2, 0), (5, 5, 1), (5, 5, -1)], False),  # just beyond it
        ([(1, 1, 0), (9, 9, 0), (9, 8, 0)], True),  # coplanar, overlapping
        ([(3, 3, 0), (9, 9, 0), (9, 8, 0)], False),  # coplanar, apart
        ([(1, 1, -1), (1, 1, 1), (1, 1, 0)], True),  # a segment through it
        ([(4, 4, -1), (4, 4, 1), (4, 4, 0)], False),  # a segment beside it
        ([(1, 1, 0), (1, 1, 0), (1, 1, 0)], True),  # a point on it
        ([(1, 1, 1), (1, 1, 1), (1, 1, 1)], False),  # a point above it
    ]:
        other = exact(other)
        assert meet(flat, other) == expected == meet(other, flat), other
    x, y = exact([(-1, 0, 0), (1, 0, 0), (0, 0, 0)]), exact([(0, -1, 0), (0, 1, 0), (0, 0, 0)])
    assert meet(x, y) and not meet(x, exact([(0, -1, 1), (0, 1, 1), (0, 0, 1)]))


# --- The two opinions ----------------------------------------------------------------------------


class Mesh:
    def __init__(self, path):
        self.path = path
        vertices, faces = igl.read_triangle_mesh(str(path))
        self.vertices = numpy.ascontiguousarray(vertices, dtype=numpy.float64)
        self.faces = numpy.ascontiguousarray(faces, dtype=numpy.int64)

    def corners(self, triangle):
        """Corners of a triangle, as rational numbers."""
        return [
            tuple(fractions.Fraction(float(x)) for x in self.vertices[v])
            for v in self.faces[triangle]
        ]


def pliant_says(program, meshes):
    command = [str(program), "check", "--format", "json", "--no-weld"] + [
        str(mesh.path) for mesh in meshes
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"pliant check: {done.stderr.strip()}")
    answer = json.loads(done.stdout)
    read = [(body["vertices"], body["triangles"]) for body in answer["bodies"]]
    if read != [(len(mesh.vertices), len(mesh.faces)) for mesh in meshes]:
        sys.exit(f"the readers disagree about {[mesh.path.name for mesh in meshes]}: {read}")
    (frame,) = answer["frames"]
    return {tuple(pair) for pair in frame["pairs"]}


def libigl_says(meshes):
    def rows(answer):
        _, pairs, _ = answer
        return [(int(a), int(b)) for a, b in pairs]

    if len(meshes) == 1:
        found = rows(igl.predicates.find_self_intersections(meshes[0].vertices, meshes[0].faces))
        return {(0, min(pair), 0, max(pair)) for pair in found}
    found = set()
    for a, mesh_a in enumerate(meshes):
        for b, mesh_b in enumerate(meshes[a + 1 :], a + 1):
            arrays = mesh_a.vertices, mesh_a.faces, mesh_b.vertices, mesh_b.faces
            found |= {(a, i, b, j) for i, j in rows(igl.predicates.find_intersections(*arrays))}
    return found


def explain(meshes, pair, only_pliant):
    """Rule that explains a difference, or None."""
    a, i, b, j = pair
    if only_pliant:
        return None
    if a == b and set(meshes[a].faces[i]) & set(meshes[a].faces[j]):
        return "neighbours"
    triangles = meshes[a].corners(i), meshes[b].corners(j)
    if any(is_degenerate(triangle) for triangle in triangles) and not meet(*triangles):
        return "degenerate"
    return None


class Comparison:
    def __init__(self, program):
        self.program = program
        self.rules = collections.Counter()
        self.compared = self.agreed = self.unexplained = 0
        print(
            f"{'meshes':<62} {'triangles':>9} {'pliant':>7} {'libigl':>7} {'both':>7}   differences"
        )

    def of(self, name, paths):
        meshes = [Mesh(path) for path in paths]
        ours, theirs = pliant_says(self.program, meshes), libigl_says(meshes)
        rules = collections.Counter()
        for pair in sorted(ours ^ theirs):
            rule = explain(meshes, pair, pair in ours)
            rules[rule or "UNEXPLAINED"] += 1
            if rule is None:
                who = "pliant" if pair in ours else "libigl"
                corners = [
                    meshes[body].vertices[meshes[body].faces[t]].tolist()
                    for body, t in (pair[:2], pair[2:])
                ]
                print(f"  only {who}: {pair}", *corners)
        told = ", ".join(f"{count:,} {rule}" for rule, count in sorted(rules.items())) or "none"
        triangles = sum(len(mesh.faces) for mesh in meshes)
        print(
            f"{name:<62} {triangles:>9,} {len(ours):>7,} {len(theirs):>7,} {len(ours & theirs):>7,}"
            f"   {told}",
            flush=True,
        )
        self.unexplained += rules.pop("UNEXPLAINED", 0)
        self.rules += rules
        self.compared += 1
        self.agreed += len(ours & theirs)


# --- The meshes ----------------------------------------------------------------------------------


def write_obj(path, vertices, faces):
    lines = ["v " + " ".join(repr(float(x)) for x in vertex) for vertex in vertices]
    lines += ["f " + " ".join(str(int(v) + 1) for v in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def real_meshes(compare, data, folder):
    for path in sorted(data.glob("**/*.ply")):
        compare.of(f"{path.relative_to(data)}, itself", [path])
    ipc = data / "ipc-toolkit"
    compare.of(
        "two-cubes-intersecting and cube", [ipc / "two-cubes-intersecting.ply", ipc / "cube.ply"]
    )
    for pair in [
        "cloth-funnel/227 228",
        "armadillo-rollers/326 327",
        "ipc-toolkit/thick-cloth/t0 t1",
    ]:
        place, frames = pair.rsplit("/", 1)
        compare.of(
            f"{place}, a frame and the next",
            [data / place / f"{frame}.ply" for frame in frames.split()],
        )
    morph = numpy.load(data / "human-morph.npz")
    paths = []
    for frame in (0, 15, 30, 45, 50, 59):
        paths.append(
            write_obj(folder / f"human-{frame}.obj", morph["vertices"][frame], morph["faces"])
        )
        compare.of(f"human-morph frame {frame}, itself", paths[-1:])
    compare.of("human-morph, frames 0 and 30", [paths[0], paths[2]])


def scenes(compare, exporter, folder):
    for name, triangles, step in [
        ("spheres", 20480, 60),
        ("spheres", 20480, 120),
        ("spheres", 20480, 200),
        ("arms", 1280, 100),
        ("crowd", 320, 100),
        ("gather", 80, 200),
        ("cloth", 19602, 20),
        ("cloth", 19602, 50),
        ("cloth", 79202, 50),
    ]:
        place = folder / f"{name}-{triangles}-{step}"
        place.mkdir()
        subprocess.run([str(exporter), name, str(triangles), str(step), str(place)], check=True)
        bodies = sorted(place.glob("*.obj"), key=lambda path: int(path.stem.rsplit("-", 1)[1]))
        what = "itself" if len(bodies) == 1 else f"{len(bodies)} bodies"
        compare.of(f"{name} of {triangles} at step {step}, {what}", bodies)


def soups(compare, folder):
    """Triangle soups on few places: coincidences of every kind."""
    for seed, side, count, proper, scale in [
        (1, 3, 300, True, 1.0),
        (2, 3, 300, False, 1.0),
        (3, 5, 600, True, 1.0),
        (4, 5, 600, False, 1.0),
        (5, 9, 1000, True, 2.0**-40),
        (6, 5, 600, True, 0.1),
        (7, 5, 600, False, 0.1),
    ]:
        choose = random.Random(seed)
        faces, vertices = [], []
        while len(faces) < count:
            corners = [tuple(choose.randrange(side) for _ in range(3)) for _ in range(3)]
            if proper and is_degenerate(corners):
                continue
            faces.append(range(len(vertices), len(vertices) + 3))
            vertices += [[x * scale for x in corner] for corner in corners]
        soup = write_obj(folder / f"soup-{seed}.obj", vertices, faces)
        kind = "proper triangles" if proper else "some degenerate"
        where = f"{side}^3 lattice of {scale:g}"
        compare.of(f"soup, {where}, {kind}, itself", [soup])
        # One mesh on the same places, with shared vertices.
        places = sorted({tuple(vertex) for vertex in vertices})
        number = {place: i for i, place in enumerate(places)}
        shared = [[number[tuple(vertices[v])] for v in face] for face in faces]
        shared = [face for face in shared if len(set(face)) == 3]
        mesh = write_obj(folder / f"shared-{seed}.obj", places, shared)
        compare.of("    with shared vertices, itself", [mesh])
        compare.of("    the two", [soup, mesh])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    built = CHECKOUT / "target" / "release"
    parser.add_argument("--program", type=pathlib.Path, default=built / "pliant")
    parser.add_argument("--exporter", type=pathlib.Path, default=built / "examples" / "write_obj")
    parser.add_argument("--data", type=pathlib.Path, default=CHECKOUT.parent / "shared" / "data")
    arguments = parser.parse_args()

    the_judge_knows_what_is_plain()
    version = subprocess.run(
        [str(arguments.program), "--version"], capture_output=True, text=True, check=True
    ).stdout.strip()
    print(f"{version} and libigl {importlib.metadata.version('libigl')}\n")
    compare = Comparison(arguments.program)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        if arguments.data.is_dir():
            real_meshes(compare, arguments.data, folder)
        else:
            print("no ../shared/data beside the checkout: real meshes skipped")
        scenes(compare, arguments.exporter, folder)
        soups(compare, folder)
    rules = ", ".join(f"{count:,} {rule}" for rule, count in sorted(compare.rules.items()))
    print(f"\n{compare.compared} comparisons; {compare.agreed:,} pairs reported by both")
    print(f"differences explained: {rules or 'none'}; unexplained: {compare.unexplained:,}")
    return 1 if compare.unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
