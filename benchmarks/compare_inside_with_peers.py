#!/usr/bin/env python3
"""Compares inside, outside and signed distances with Open3D, libigl and trimesh: answers and times.

    python3 -m venv target/inside
    target/inside/bin/pip install ./bindings/python open3d libigl trimesh embreex
    target/inside/bin/python benchmarks/compare_inside_with_peers.py --rounds 21

A sphere of 20,480 triangles is deformed at each step, and 10,242 points near it are asked about.
Every tool gets the new shape in each round and does what it needs for it, on one thread; rounds
alternate. Then points a hair off the centres of faces are asked about, rounded, and each answer is
compared with the exact side of the face, by fractions. Wrong answers of pliant are an error.
"""

import argparse
import importlib.metadata
import os
import sys
import time
from fractions import Fraction

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy
import pliant


def sphere(depth):
    """Faces and corners on a sphere: an icosahedron, its faces split in four `depth` times."""
    golden = (1 + 5**0.5) / 2
    corners = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0)]
    corners += [(z, x, y) for x, y, z in corners] + [(y, z, x) for x, y, z in corners]
    corners = [numpy.array(corner, float) / numpy.linalg.norm(corner) for corner in corners]
    near = 1.1 * min(numpy.linalg.norm(corners[0] - other) for other in corners[1:])
    linked = [
        {k for k, q in enumerate(corners) if 0 < numpy.linalg.norm(p - q) < near} for p in corners
    ]
    faces = []
    for a in range(12):
        for b in linked[a]:
            for c in linked[a] & linked[b]:
                outward = numpy.linalg.det([corners[a], corners[b], corners[c]]) > 0
                if a < b and a < c and outward:
                    faces.append((a, b, c))
    for _ in range(depth):
        middles, split = {}, []
        for face in faces:
            middle = []
            for a, b in zip(face, face[1:] + face[:1]):
                key = (min(a, b), max(a, b))
                if key not in middles:
                    middles[key] = len(corners)
                    corner = corners[a] + corners[b]
                    corners.append(corner / numpy.linalg.norm(corner))
                middle.append(middles[key])
            (a, b, c), (p, q, r) = face, middle
            split += [(a, p, r), (p, b, q), (r, q, c), (p, q, r)]
        faces = split
    return numpy.array(faces, numpy.uint32), numpy.array(corners)


def shape(corners, turn, lift=0.0):
    x, y, z = corners.T
    r = 1 + 0.1 * numpy.sin(3 * x + turn) * numpy.cos(4 * y)
    if lift:
        r = r + lift + 0.015 * numpy.sin(7 * z + 2 * turn) * numpy.cos(9 * x)
    return (corners * r[:, None]).astype(numpy.float32)


def tools(faces, corners):
    """Name and function of positions and points, which gives whether they are inside."""
    world = pliant.World()
    body = world.add(faces, shape(corners, 0))
    points_body = world.add(faces, shape(corners, 0))

    def points_inside(positions, points):
        world.set_positions(body, positions)
        return world.points_inside(points, body).is_inside

    def vertices_inside(positions, points):
        world.set_positions(body, positions)
        world.set_positions(points_body, points)
        return world.inside(points_body, body).is_inside

    def signed(positions, points):
        world.set_positions(body, positions)
        return world.signed_closest_points(points, body).distance < 0

    yield "pliant points_inside", points_inside
    yield "pliant inside, of vertices", vertices_inside
    yield "pliant signed_closest_points", signed
    try:
        import open3d

        def scene_of(positions):
            scene = open3d.t.geometry.RaycastingScene(nthreads=1)
            tensor = open3d.core.Tensor
            scene.add_triangles(tensor(positions), tensor(faces))
            return scene

        def occupancy(positions, points):
            found = scene_of(positions).compute_occupancy(open3d.core.Tensor(points), nthreads=1)
            return found.numpy() > 0

        def distance(positions, points):
            asked = open3d.core.Tensor(points)
            return scene_of(positions).compute_signed_distance(asked, nthreads=1).numpy() < 0

        yield "Open3D occupancy", occupancy
        yield "Open3D signed distance", distance
    except ImportError:
        print("open3d is not there", file=sys.stderr)
    try:
        import igl

        whole = faces.astype(numpy.int64)

        def winding(positions, points):
            return igl.fast_winding_number(positions.astype(float), whole, points.astype(float)) > 0.5

        def pseudonormal(positions, points):
            kind = igl.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
            found = igl.signed_distance(points.astype(float), positions.astype(float), whole, kind)
            return found[0] < 0

        yield "libigl fast winding number", winding
        yield "libigl signed distance, pseudonormal", pseudonormal
    except ImportError:
        print("igl is not there", file=sys.stderr)
    try:
        import trimesh

        def contains(positions, points):
            return trimesh.Trimesh(positions, faces, process=False).contains(points)

        yield "trimesh contains", contains
    except ImportError:
        print("trimesh is not there", file=sys.stderr)


def exact_sides(positions, faces, points):
    """Whether points are behind, before or in the planes of their faces: 1, -1 or 0."""
    sides = []
    for (a, b, c), p in zip(faces, points):
        a, b, c, p = ([Fraction(float(x)) for x in q] for q in (*positions[[a, b, c]], p))
        e, f, t = ([x - y for x, y in zip(q, a)] for q in (b, c, p))
        n = [e[i - 2] * f[i - 1] - e[i - 1] * f[i - 2] for i in range(3)]
        volume = sum(x * y for x, y in zip(n, t))
        sides.append((volume < 0) - (volume > 0))
    return numpy.array(sides)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=21, help="rounds of which the median is taken")
    rounds = parser.parse_args().rounds
    faces, corners = sphere(5)
    all_tools = list(tools(faces, corners))
    packages = ("pliant", "open3d", "open3d-cpu", "libigl", "trimesh")
    there = {it.metadata["Name"]: it.version for it in importlib.metadata.distributions()}
    print("# " + ", ".join(f"{name} {there[name]}" for name in packages if name in there))
    print(f"# {len(faces):,} triangles, {len(corners):,} points near them, one thread, {rounds} rounds")
    times = {name: [] for name, _ in all_tools}
    for turn in range(rounds):
        positions, points = shape(corners, 0.05 * turn), shape(corners, 0.05 * turn, 0.01)
        expected = None
        for name, tool in all_tools:
            begin = time.perf_counter()
            found = tool(positions, points)
            times[name].append(1000 * (time.perf_counter() - begin))
            expected = found if expected is None else expected
            differ = int((found != expected).sum())
            if differ and turn == 0:
                print(f"# {name}: {differ} points are elsewhere than for {all_tools[0][0]}")
    for name, _ in all_tools:
        print(f"{numpy.median(times[name]):8.2f} ms   {name}")
    errors = 0
    faces, corners = sphere(3)
    positions = shape(corners, 0.3)
    a, b, c = (positions[faces[:, k]].astype(float) for k in range(3))
    normals = numpy.cross(b - a, c - a)
    normals /= numpy.linalg.norm(normals, axis=1)[:, None]
    print(f"# wrong of {2 * len(faces):,} points, h off the centres of faces; points on them left out")
    for name, tool in tools(faces, corners):
        if name.endswith("of vertices"):
            continue  # asked about other points, a body would need other vertices
        wrong = []
        for h in (1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9):
            count = 0
            for side in (1, -1):
                points = ((a + b + c) / 3 + side * h * normals).astype(numpy.float32)
                exact = exact_sides(positions, faces, points)
                count += int(((tool(positions, points) != (exact > 0)) & (exact != 0)).sum())
            wrong.append(count)
        errors += sum(wrong) if name.startswith("pliant") else 0
        print("  ".join(f"{count:5}" for count in wrong) + f"   {name}")
    sys.exit(errors > 0)


if __name__ == "__main__":
    main()
