#!/usr/bin/env python3
"""Compares pairs with libigl's exact predicates on the same meshes: an independent second opinion.

    cargo build --release && cargo build --release -p pliant-scenes --example write_obj
    python3 -m venv target/libigl && target/libigl/bin/pip install libigl==2.6.3
    target/libigl/bin/python benchmarks/compare_with_libigl.py

Every mesh goes through `pliant check --format json --no-weld`, and through
`igl.predicates.find_intersections` or `find_self_intersections`, from the same file. libigl uses
its own reader. The two sets of pairs are compared.

Triangles that share a vertex of the mesh are *adjacent*. Both programs report them if they meet
beyond what they share: pliant apart, as `adjacent_pairs`, and libigl among all others. libigl's
predicates are exact, but it decides adjacent triangles in floating point, with tolerances.

Each pair that only one of them reports is decided alone, in rational arithmetic. pliant must be
right, and libigl must be wrong for one of these reasons:

    degenerate   Only libigl, not adjacent. One triangle is a segment or a point, and the two do
                 NOT meet. libigl takes a triangle without a plane for coplanar with any other.

    turned       Adjacent; both triangles pass the edge that they share in one direction. libigl
                 expects two directions. So it reports such triangles where they lie flat side by
                 side. It leaves them out where they lie on each other, or are there twice.
    thin         Adjacent; one triangle is a segment or a point, or almost. libigl needs its plane.
    parallel     Adjacent with one vertex. libigl takes the edge opposite it for parallel to the
                 other triangle if a determinant is below 1e-14, whatever the unit. Here it takes
                 both for parallel, and at least one is not.
    first end    Only pliant, adjacent with one vertex. They touch: drawn in a little, they would
                 not meet. libigl leaves out an edge of which only the first end touches.
    nearly       Only libigl, adjacent. They would meet beyond what they share if one were thicker
                 by 1e-8 of their size, which is libigl's larger tolerance.

Any other pair is unexplained, and so is any about which pliant is wrong: it is printed, and the
exit code is 1. The rational decision clips one triangle by the half-spaces of the other: no
orientation signs, no case analysis, nothing in common with either library. Adjacent triangles meet
beyond what they share if a corner of what is left lies outside the hull of the common corners. A
triangle that is there twice always counts, as pliant documents.

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

# Tolerances of libigl, for the reasons above. The judge itself has none.
PARALLEL = fractions.Fraction(1, 10**14)
TINY = fractions.Fraction(1, 10**8)  # of the size of both triangles


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


def moved_out(half_space, distance):
    normal, offset = half_space
    return normal, offset + distance * sum(abs(x) for x in normal)


def clip(a, b, slack=0):
    """Corners of what two closed triangles have in common; none if they do not intersect.

    Clips the first by the hull of the second. With `slack`, this is thicker by that on all sides.
    """
    polygon = list(a)
    for half_space in half_spaces(b):
        normal, offset = moved_out(half_space, slack)
        clipped = []
        for p, q in zip(polygon, polygon[1:] + polygon[:1]):
            over_p, over_q = dot(normal, p) - offset, dot(normal, q) - offset
            if over_p <= 0:
                clipped.append(p)
            if over_p * over_q < 0:
                t = over_p / (over_p - over_q)
                clipped.append(tuple(x + t * (y - x) for x, y in zip(p, q)))
        polygon = clipped
    return polygon


def meet(a, b):
    """Whether two closed triangles intersect."""
    return bool(clip(a, b))


def meet_beyond(a, b, common, slack=0):
    """Whether two triangles meet outside the hull of the corners that they have in common.

    `common` are one to three corners, of different vertices. With `slack`, whether they would if
    the second were thicker by that. Then what is near the hull does not count.
    """
    if len(common) == 3:
        return True
    hull = [moved_out(space, 10000 * slack) for space in half_spaces((common * 3)[:3])]
    return any(
        dot(normal, point) > offset for point in clip(a, b, slack) for normal, offset in hull
    )


# --- libigl's reasons ----------------------------------------------------------------------------


def size(*triangles):
    """Largest difference of coordinates."""
    return max(max(along) - min(along) for along in zip(*(p for t in triangles for p in t)))


def is_thin(triangle):
    """Whether a triangle is a segment or a point, or almost."""
    a, b, c = triangle
    normal = cross(minus(b, a), minus(c, a))
    return max(abs(x) for x in normal) <= TINY * size(triangle) ** 2


def nearly_meet_beyond(a, b, common):
    return meet_beyond(a, b, common, TINY * size(a, b))


def turned_over(triangle, common):
    """The triangle on the other side of the edge between two common corners, in its plane."""
    p, q = common
    return [
        corner if corner in common else tuple(x + y - z for x, y, z in zip(p, q, corner))
        for corner in triangle
    ]


def drawn_in(triangle, common):
    """The triangle with its other corners a little nearer to its middle."""
    middle = [sum(along) / 3 for along in zip(*triangle)]
    return [
        corner
        if corner in common
        else tuple(x + (y - x) / 10**6 for x, y in zip(corner, middle))
        for corner in triangle
    ]


def do_touch(a, b, common):
    """Whether triangles that meet beyond a common corner would not if they were drawn in."""
    return not meet_beyond(drawn_in(a, common), drawn_in(b, common), common)


def determinant(edge, triangle):
    """Zero if an edge is parallel to a triangle; libigl asks whether it is below `PARALLEL`."""
    a, b, c = triangle
    return abs(dot(minus(*edge), cross(minus(b, a), minus(c, a))))


def is_nearly_on(point, triangle):
    return bool(clip([point] * 3, triangle, TINY * size(triangle)))


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


def the_judge_knows_what_is_plain_of_adjacent_triangles():
    F = fractions.Fraction
    exact = lambda points: [tuple(F(x) for x in point) for point in points]
    p, q, r = flat = exact([(0, 0, 0), (4, 0, 0), (0, 4, 0)])
    for rest, expected, touching in [
        ([(1, 1, -1), (1, 1, 1)], True, False),  # its opposite edge pierces
        ([(3, 3, -1), (3, 3, 1)], True, False),  # the slanted edge pierces it
        ([(-1, -1, -1), (-1, -1, 1)], False, None),  # on the other side of the corner
        ([(-1, 0, 1), (0, -1, 1)], False, None),  # above
        ([(1, 1, 0), (1, 1, 1)], True, True),  # stands on it
        ([(3, 3, 0), (3, 3, 1)], True, True),  # stands on it and beyond
        ([(1, 0, 0), (1, 0, 1)], True, True),  # stands on its edge
        ([(2, -1, -1), (2, 1, 1)], True, True),  # its opposite edge crosses an edge
        ([(5, 1, 0), (1, 5, 0)], True, False),  # coplanar, overlapping
        ([(5, 0, 0), (5, -1, 0)], True, True),  # coplanar, along an edge
        ([(-1, 0, 0), (0, -1, 0)], False, None),  # coplanar, apart
        ([(1, 1, 0), (2, 2, 0)], True, None),  # a segment on it
        ([(1, 1, 1), (2, 2, 2)], False, None),  # a segment that leaves it
        ([(-1, -1, 0), (2, 2, 0)], True, None),  # a segment through the corner
        ([(0, 0, 0), (0, 0, 0)], False, None),  # a point
    ]:
        other = [p] + exact(rest)
        assert meet_beyond(flat, other, [p]) == expected == meet_beyond(other, flat, [p]), rest
        if touching is not None:
            assert do_touch(flat, other, [p]) == touching == do_touch(other, flat, [p]), rest
    for corner, expected in [
        ((1, 1, 1), False),  # an angle
        ((1, -1, 0), False),  # flat
        ((1, 1, 0), True),  # folded onto it
        ((-3, 1, 0), True),  # folded, beside it for the most part
        ((2, 0, 0), False),  # the segment between
        ((6, 0, 0), False),  # a segment that goes on
    ]:
        other = [p, q] + exact([corner])
        assert meet_beyond(flat, other, [p, q]) == expected == meet_beyond(other, flat, [p, q])
        unlike = meet_beyond(flat, turned_over(other, [p, q]), [p, q])
        assert unlike == (corner == (1, -1, 0)), corner
    far, near, back = [[p, q] + exact([(x, 0, 0)]) for x in (7, 5, -1)]
    assert meet_beyond(far, near, [p, q]) and not meet_beyond(far, back, [p, q])
    assert meet_beyond(flat, [r, p, q], [p, q, r])
    hair = F(1, 10**12)
    for rest, expected in [
        ([(1, 1, hair), (1, 1, 1)], True),
        ([(1, 1, hair), (1, 2, hair)], True),
        ([(1, 1, F(1, 100)), (1, 1, 1)], False),
    ]:
        other = [p] + exact(rest)
        assert not meet_beyond(flat, other, [p])
        assert nearly_meet_beyond(flat, other, [p]) == expected, rest
    folded, angle = [[p, q] + exact([(1, 1, height)]) for height in (hair, F(1, 100))]
    assert nearly_meet_beyond(flat, folded, [p, q]) and not meet_beyond(flat, folded, [p, q])
    assert not nearly_meet_beyond(flat, angle, [p, q])
    assert is_thin(exact([(0, 0, 0), (1, 1, 0), (3, 3, hair)])) and not is_thin(flat)


# --- The two opinions ----------------------------------------------------------------------------


class Mesh:
    def __init__(self, path):
        self.path = path
        vertices, faces = igl.read_triangle_mesh(str(path))
        self.vertices = numpy.ascontiguousarray(vertices, dtype=numpy.float64)
        self.faces = numpy.ascontiguousarray(faces, dtype=numpy.int64)

    def points(self, vertices):
        """Places of vertices, as rational numbers."""
        return [tuple(fractions.Fraction(float(x)) for x in self.vertices[v]) for v in vertices]

    def corners(self, triangle):
        return self.points(self.faces[triangle])

    def edges(self, triangle):
        """Edges of a triangle, in its direction."""
        a, b, c = (int(v) for v in self.faces[triangle])
        return {(a, b), (b, c), (c, a)}

    def opposite(self, triangle, vertex):
        """First and last end of the edge opposite a vertex, in the triangle's direction."""
        face = self.faces[triangle].tolist()
        at = face.index(vertex)
        return self.points([face[(at + 1) % 3], face[(at + 2) % 3]])


def pliant_says(program, meshes):
    """Pairs, and pairs of adjacent triangles."""
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
    return [
        {tuple(pair) for pair in frame.get(member, [])} for member in ("pairs", "adjacent_pairs")
    ]


def libigl_says(meshes):
    """Pairs, and pairs of adjacent triangles."""
    if len(meshes) == 1:
        (mesh,) = meshes
        _, found, _ = igl.predicates.find_self_intersections(mesh.vertices, mesh.faces)
        found = numpy.sort(numpy.asarray(found, dtype=numpy.int64).reshape(-1, 2), axis=1)
        one, other = mesh.faces[found[:, 0], :, None], mesh.faces[found[:, 1], None, :]
        are_adjacent = (one == other).any(axis=(1, 2))
        return [
            {(0, i, 0, j) for i, j in found[chosen].tolist()}
            for chosen in (~are_adjacent, are_adjacent)
        ]
    pairs = set()
    for a, mesh_a in enumerate(meshes):
        for b, mesh_b in enumerate(meshes[a + 1 :], a + 1):
            arrays = mesh_a.vertices, mesh_a.faces, mesh_b.vertices, mesh_b.faces
            _, found, _ = igl.predicates.find_intersections(*arrays)
            pairs |= {(a, int(i), b, int(j)) for i, j in found}
    return [pairs, set()]


def explain(meshes, pair, only_pliant):
    """Reason of libigl's for a difference; None if there is none, or pliant is wrong."""
    a, i, b, j = pair
    if only_pliant:
        return None
    triangles = meshes[a].corners(i), meshes[b].corners(j)
    if any(is_degenerate(triangle) for triangle in triangles) and not meet(*triangles):
        return "degenerate"
    return None


def explain_adjacent(meshes, pair, only_pliant):
    """The same of triangles of one mesh that share a vertex."""
    body, i, other, j = pair
    if body != other:
        return None
    mesh = meshes[body]
    a, b = mesh.corners(i), mesh.corners(j)
    shared = sorted(set(mesh.faces[i].tolist()) & set(mesh.faces[j].tolist()))
    common = mesh.points(shared)
    if not common or meet_beyond(a, b, common) != only_pliant:
        return None
    if len(common) > 1 and mesh.edges(i) & mesh.edges(j):
        is_turned = only_pliant or nearly_meet_beyond(turned_over(a, common), b, common)
        return "turned" if is_turned else None
    if is_thin(a) or is_thin(b):
        return "thin"
    if len(common) == 1:
        edges = [(mesh.opposite(i, *shared), b), (mesh.opposite(j, *shared), a)]
        determinants = [determinant(edge, other) for edge, other in edges]
        if any(determinants) and max(determinants) < PARALLEL:
            return "parallel"
        starts_on = any(is_nearly_on(edge[0], other) for edge, other in edges)
        if only_pliant and starts_on and do_touch(a, b, common):
            return "first end"
    if not only_pliant and nearly_meet_beyond(a, b, common):
        return "nearly"
    return None


def told(reasons):
    """Numbers of differences by who alone reports the pair, and why."""
    by_who = collections.defaultdict(list)
    for (who, reason), count in sorted(reasons.items()):
        by_who[who].append(f"{count:,} {reason}")
    return "; ".join(f"only {who}: {', '.join(of)}" for who, of in by_who.items()) or "none"


class Comparison:
    def __init__(self, program):
        self.program = program
        self.reasons = collections.Counter()
        self.compared = self.agreed = self.agreed_adjacent = self.unexplained = 0
        print("adjacent: pairs of both programs with a vertex in common; both: without\n")
        print(
            f"{'meshes':<62} {'triangles':>9} {'pliant':>7} {'libigl':>7}"
            f" {'both':>7} {'adjacent':>8}   differences"
        )

    def of(self, name, paths):
        meshes = [Mesh(path) for path in paths]
        (ours, our_adjacent), (theirs, their_adjacent) = (
            pliant_says(self.program, meshes),
            libigl_says(meshes),
        )
        reasons = collections.Counter()
        for mine, other, reason_of in [
            (ours, theirs, explain),
            (our_adjacent, their_adjacent, explain_adjacent),
        ]:
            for pair in sorted(mine ^ other):
                who = "pliant" if pair in mine else "libigl"
                reason = reason_of(meshes, pair, pair in mine)
                reasons[who, reason or "UNEXPLAINED"] += 1
                if reason is None:
                    self.unexplained += 1
                    corners = [
                        meshes[body].vertices[meshes[body].faces[t]].tolist()
                        for body, t in (pair[:2], pair[2:])
                    ]
                    print(f"  only {who}: {pair}", *corners)
        triangles = sum(len(mesh.faces) for mesh in meshes)
        both, adjacent = len(ours & theirs), len(our_adjacent & their_adjacent)
        print(
            f"{name:<62} {triangles:>9,} {len(ours | our_adjacent):>7,}"
            f" {len(theirs | their_adjacent):>7,} {both:>7,} {adjacent:>8,}   {told(reasons)}",
            flush=True,
        )
        self.reasons += reasons
        self.compared += 1
        self.agreed += both
        self.agreed_adjacent += adjacent


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
    the_judge_knows_what_is_plain_of_adjacent_triangles()
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
    print(f"\n{compare.compared} comparisons; pairs reported by both: {compare.agreed:,}", end="")
    print(f", and adjacent: {compare.agreed_adjacent:,}")
    print(f"differences: {told(compare.reasons)}")
    print(f"unexplained: {compare.unexplained:,}")
    return 1 if compare.unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
