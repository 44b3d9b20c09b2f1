#!/usr/bin/env python3
"""Times many shapes of one mesh: one call, against a kept world, and one-line calls.

    python3 -m venv target/frames
    target/frames/bin/pip install ./bindings/python
    target/frames/bin/python benchmarks/many_shapes.py --rounds 5

A closed surface of 6,890 vertices, as bodies of people have, bends and folds in 1,000 frames. Each
way answers the same, which is checked. Rounds alternate; medians and ratios are printed.
"""

import argparse
import time

import numpy
import pliant

FRAMES = 1000


def sphere():
    rows, columns = 82, 84
    z = -numpy.cos(numpy.linspace(0, numpy.pi, rows + 2))[1:-1, None]
    angle = numpy.arange(columns) * 2 * numpy.pi / columns + 0 * z
    ring = numpy.sqrt(1 - z**2)
    points = numpy.stack([ring * numpy.cos(angle), ring * numpy.sin(angle), z + 0 * angle], -1)
    points = numpy.concatenate([points.reshape(-1, 3), [[0, 0, -1], [0, 0, 1]]])
    i, j = numpy.divmod(numpy.arange((rows - 1) * columns), columns)
    a, b = i * columns + j, i * columns + (j + 1) % columns
    j, last = numpy.arange(columns), rows * columns
    caps = [[(j + 1) % columns, j, 0 * j + last]]
    caps += [[last - columns + j, last - columns + (j + 1) % columns, 0 * j + last + 1]]
    sides = [[a, b, b + columns], [a, b + columns, a + columns]]
    faces = numpy.concatenate([numpy.stack(corners, 1) for corners in sides + caps])
    return faces.astype(numpy.uint32), points


def shapes(points):
    """Limbs that bend into each other and out again."""
    x, y, z = points.T
    for frame in range(FRAMES):
        turn = 2 * numpy.pi * frame / 200
        long = 4 * z
        bend = 0.9 * (1 - numpy.cos(turn)) * long / 4
        thick = 0.35 + 0.1 * numpy.sin(5 * z + turn)
        yield numpy.stack([thick * x + numpy.sin(bend) * long, thick * y, numpy.cos(bend) * long], 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5, help="rounds of which the median is taken")
    rounds = parser.parse_args().rounds
    faces, points = sphere()
    frames = numpy.array(list(shapes(points)), numpy.float32)

    def one_line():
        return [len(pliant.self_intersection_pairs(shape, faces)) for shape in frames]

    def kept():
        world = pliant.World()
        body = world.add(faces, frames[0])
        query = world.intersections(pliant.Selection.within(body))
        counts = []
        for shape in frames:
            world.set_positions(body, shape)
            counts.append(len(query.all()))
        return counts

    def one_call(threads):
        return lambda: pliant.self_intersections(faces, frames, threads=threads).counts.tolist()

    def counts():
        return pliant.self_intersections(faces, frames, answer="counts").tolist()

    def any_at_all():
        return pliant.self_intersections(faces, frames, answer="any").tolist()

    ways = {
        "one-line calls": one_line,
        "a kept world": kept,
        "one call, 1 thread": one_call(1),
        "one call, 2 threads": one_call(2),
        "one call, counts": counts,
        "one call, whether there is any": any_at_all,
    }
    times = {name: [] for name in ways}
    expected = None
    for _ in range(rounds):
        for name, way in ways.items():
            begin = time.perf_counter()
            found = way()
            times[name].append(time.perf_counter() - begin)
            expected = found if expected is None else expected
            assert found == expected or found == [it > 0 for it in expected], name
    some = sum(count > 0 for count in expected)
    print(f"# {len(frames):,} frames of {len(points):,} vertices, {some} with pairs, {sum(expected):,} in all; {rounds} rounds")
    base = numpy.median(times["one call, 1 thread"])
    for name, its in times.items():
        median = numpy.median(its)
        print(f"{1000 * median / len(frames):7.3f} ms a frame   {median / base:5.2f}   {name}")


if __name__ == "__main__":
    main()
