#!/usr/bin/env python3
"""Compares the distance of two deforming spheres with FCL: equal distances, and times.

    cargo build --release -p pliant-scenes --example write_obj
    python3 -m venv target/ipctk
    target/ipctk/bin/pip install python-fcl==0.7.0.11 libigl==2.6.3 ./bindings/python
    target/ipctk/bin/python benchmarks/compare_distance_with_fcl.py

Scenes are as in `pliant bench close`: steps 1 to 50 of the spheres, in which they are apart, with
one thread and 64-bit positions. Ours sets the positions of both and calls `distance`, as a program
does in a step. FCL has a `BVHModel` of each. Its Python package cannot give a model new vertices,
so models are made anew at every step, which is timed as *making*. *Asking* is its `distance`
alone, which returns the nearest points as ours does.

First the distances are compared at every step: they are equal if they differ by at most 1e-6,
relative. Any other difference is an error, and the exit code is 1. Then rounds are played in turn,
all steps of a round in a row. Figures are medians over rounds, for one step.
"""

import argparse
import importlib.metadata
import pathlib
import statistics
import sys
import tempfile
import time

import fcl
import numpy
import pliant

from compare_with_ipctk import CHECKOUT, scene

SIZES = [1280, 20480]
STEPS = range(1, 51)


class Ours:
    def __init__(self, faces, shapes):
        self.world = pliant.World()
        self.ids = [self.world.add(of_body, shape) for of_body, shape in zip(faces, shapes)]

    def ask(self, shapes):
        for body, shape in zip(self.ids, shapes):
            self.world.set_positions(body, shape)
        return self.world.distance(*self.ids).distance


class Theirs:
    def __init__(self, faces):
        self.faces = faces
        self.making = self.asking = 0.0

    def ask(self, shapes):
        begin = time.perf_counter()
        objects = []
        for faces, shape in zip(self.faces, shapes):
            model = fcl.BVHModel()
            model.beginModel(len(shape), len(faces))
            model.addSubModel(shape, faces)
            model.endModel()
            objects.append(fcl.CollisionObject(model, fcl.Transform()))
        made = time.perf_counter()
        result = fcl.DistanceResult()
        distance = fcl.distance(*objects, fcl.DistanceRequest(enable_nearest_points=True), result)
        self.making += made - begin
        self.asking += time.perf_counter() - made
        return distance


def shapes_of(exporter, folder, triangles):
    faces, steps = None, []
    for first in STEPS[::2]:
        bodies = scene(exporter, folder, "spheres", triangles, first)
        faces = bodies.faces
        steps += bodies.steps
        for place in folder.iterdir():
            for file in place.iterdir():
                file.unlink()
            place.rmdir()
    return faces, steps


def compare(exporter, folder, triangles, rounds):
    faces, steps = shapes_of(exporter, folder, triangles)
    ours, theirs = Ours(faces, steps[0]), Theirs(faces)
    errors = 0
    for shapes in steps:
        own, other = ours.ask(shapes), theirs.ask(shapes)
        errors += abs(own - other) > 1e-6 * own
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        for shapes in steps:
            ours.ask(shapes)
        own = time.perf_counter() - begin
        theirs.making = theirs.asking = 0.0
        for shapes in steps:
            theirs.ask(shapes)
        times.append([time * 1e3 / len(steps) for time in (own, theirs.making, theirs.asking)])
    own, making, asking = (
        statistics.median(of_round[which] for of_round in times) for which in range(3)
    )

    def factor(its):
        ratios = [its(of_round) / of_round[0] for of_round in times]
        return f"{statistics.median(ratios):6.1f} ({min(ratios):.1f} to {max(ratios):.1f})"

    whole, alone = factor(lambda of_round: of_round[1] + of_round[2]), factor(
        lambda of_round: of_round[2]
    )
    name = f"two spheres of {triangles:,}"
    print(
        f"{name:<24} {errors:>7} {own:>9.3f} {making:>9.3f} {asking:>9.3f}   {whole:<24}   {alone}",
        flush=True,
    )
    return errors


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "--exporter", type=pathlib.Path, default=CHECKOUT / "target/release/examples/write_obj"
    )
    parser.add_argument("--rounds", type=int, default=9)
    arguments = parser.parse_args()

    versions = (
        f"pliant {pliant.__version__} and python-fcl {importlib.metadata.version('python-fcl')}"
    )
    print(f"{versions}, one thread, {len(STEPS)} steps, {arguments.rounds} rounds\n")
    print(
        f"{'':<24} {'errors':>7} {'ours, ms':>9} {'making':>9} {'asking':>9}   {'times faster':<24}"
        "   than asking alone"
    )
    with tempfile.TemporaryDirectory() as folder:
        errors = sum(
            compare(arguments.exporter, pathlib.Path(folder), size, arguments.rounds)
            for size in SIZES
        )
    print(f"\nerrors, distances that differ by more than 1e-6 of themselves: {errors}")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
