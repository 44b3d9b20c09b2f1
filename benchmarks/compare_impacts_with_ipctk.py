#!/usr/bin/env python3
"""Compares continuous collision detection with ipc-toolkit: decisions, and times, turn by turn.

    cargo build --release -p pliant-scenes --example write_obj
    python3 -m venv target/ipctk
    target/ipctk/bin/pip install ipctk==1.6.1 libigl==2.6.3 ./bindings/python
    target/ipctk/bin/python benchmarks/compare_impacts_with_ipctk.py

Bodies move from a step to the next, or the stated part of the way there. All are compared with
each other and each with itself, with one thread and 64-bit positions, in one process.

    step          The largest step free of collision.
                  Ours: `collision_free_step(EVERYTHING)`, after positions and motions are set.
                  Its: `Candidates.build` with LBVH and `compute_collision_free_stepsize`, with
                  Tight-Inclusion and with additive CCD.
    a candidate   The time to decide one candidate.
                  Ours: the time of all impacts, minus the time of a visitor who counts all
                  candidates, over their number.
                  Its: the time of `compute_collision_free_stepsize` over the number of its
                  candidates. It may skip candidates later than the earliest so far, so this is
                  less than the time that one takes.

The first contact is compared: ours is in [low, high], 10^-6 wide. A step of ipctk larger than
`high` counts as a miss. A step of ours larger than `high` is an error, and the exit code is 1.
"""

import statistics
import sys
import time

import ipctk
import numpy
import pliant
from compare_with_ipctk import Ours, Theirs, all_bodies, arguments_of, shapes_of

PARTS = [0.1, 1.0]
EVERY = pliant.Selection.EVERYTHING


def timed(ask):
    begin = time.perf_counter()
    found = ask()
    return (time.perf_counter() - begin) * 1e3, found


def counted(query):
    count = 0

    def visit(rows):
        nonlocal count
        count += len(rows)

    query.visit_some(visit)
    return count


def compare(bodies, part, rounds):
    (start, end), (start_together, end_together) = shapes_of(bodies, "swept", part, 0)
    ours, theirs = Ours(bodies), Theirs(bodies)

    def move():
        ours.world.set_positions_of(zip(ours.ids, start))
        for body, shape in zip(ours.ids, end):
            ours.world.set_motion(body, shape)

    def step():
        move()
        return ours.world.collision_free_step(EVERY)

    def impacts():
        move()
        asked = (ours.world.vertex_triangle_impacts(EVERY), ours.world.edge_edge_impacts(EVERY))
        return sum(len(query.all().low) for query in asked)

    def candidates():
        move()
        asked = (
            ours.world.vertex_triangle_candidates(EVERY, 0.0),
            ours.world.edge_edge_candidates(EVERY, 0.0),
        )
        return sum(counted(query) for query in asked)

    def build():
        theirs.ask(start_together, end_together, 0.0)

    def stepsize(method):
        return theirs.candidates.compute_collision_free_stepsize(
            theirs.mesh, start_together, end_together, 0.0, method
        )

    times = {name: [] for name in ("step", "impacts", "candidates", "build", "tight", "additive")}
    for _ in range(rounds):
        for name, ask in (
            ("step", step),
            ("impacts", impacts),
            ("candidates", candidates),
            ("build", build),
        ):
            taken, found = timed(ask)
            times[name].append(taken)
            if name == "step":
                mine = found
            elif name == "impacts":
                hits = found
            elif name == "candidates":
                count = found
        if len(times["tight"]) < 2:
            taken, tight = timed(lambda: stepsize(ipctk.TightInclusionCCD()))
            times["tight"].append(taken)
            taken, additive = timed(lambda: stepsize(ipctk.AdditiveCCD()))
            times["additive"].append(taken)
    move()
    first = ours.world.first_impact(EVERY)
    high = 1.0 if first is None else first.high
    error = mine > high
    misses = sum(step > high + 1e-6 for step in (tight, additive))
    median = {name: statistics.median(taken) for name, taken in times.items()}
    each = (median["impacts"] - median["candidates"]) / count * 1e6
    its = [median[name] / len(theirs.candidates) * 1e6 for name in ("tight", "additive")]
    whole = [median["build"] + median[name] for name in ("tight", "additive")]
    print(
        f"{bodies.name:<24} {part:<4g} {count:>10,} {hits:>7,} {mine:>9.6f} {tight:>9.6f}"
        f" {additive:>9.6f} {misses:>6} {median['step']:>8.2f} {whole[0]:>9.1f} {whole[1]:>9.1f}  "
        f" {each:>6.1f} {its[0]:>8.1f} {its[1]:>7.1f}",
        flush=True,
    )
    return error


def main():
    arguments = arguments_of(__doc__, 7)
    print(
        f"{'':<24} {'':<4} {'':>10} {'':>7} {'step':>9} {'':>9} {'':>9} {'':>6}"
        f" {'whole step, ms':>28}   {'a candidate, ns':>23}"
    )
    print(
        f"{'':<24} {'part':<4} {'candidates':>10} {'impacts':>7} {'ours':>9} {'Tight-I.':>9}"
        f" {'additive':>9} {'misses':>6} {'ours':>8} {'Tight-I.':>9} {'additive':>9}   {'ours':>6}"
        f" {'Tight-I.':>8} {'add.':>7}"
    )
    errors = 0
    for bodies in all_bodies(arguments):
        errors += sum(compare(bodies, part, arguments.rounds) for part in PARTS)
    print(
        "\nmisses: steps of ipctk's beyond the first contact; errors, steps of ours that are:"
        f" {errors}"
    )
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
