#!/usr/bin/env python3
"""Compares the adapter for ipc-toolkit with ipctk: equal lists of candidates, and its own times.

    cargo build --release -p pliant-c && cargo build --release -p pliant-scenes --example write_obj
    c++ -std=c++17 -O2 -isystem /usr/include/eigen3 -I bindings/c/tests/stand_in \\
        -I bindings/c/include bindings/c/examples/ipc_lists.cpp -o target/ipc_lists \\
        -L target/release -lpliant_c -Wl,-rpath,$PWD/target/release
    target/ipctk/bin/python benchmarks/compare_adapter_with_ipctk.py --program target/ipc_lists

The program asks pliant::BroadPhase for edge-edge and face-vertex candidates of the joint mesh, as
ipctk is asked. Scenes, steps and margins are those of `compare_with_ipctk.py`, and so is what
ipctk may have alone. Every other difference is an error, and the exit code is 1. With --rounds the
program times itself; its head says what, and how it is compiled against the toolkit for that.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy

from compare_with_ipctk import (
    CASES,
    Theirs,
    all_bodies,
    arguments_of,
    differences,
    keys,
    radius_of,
    shapes_of,
)


def write(folder, bodies, start, end):
    arrays = {"V0.f64": start, "V1.f64": end, "E.i32": bodies.all_edges, "F.i32": bodies.all_faces}
    for name, array in arrays.items():
        rows = numpy.zeros(0) if array is None else numpy.ascontiguousarray(array)
        rows.astype(numpy.float64 if name.endswith("f64") else numpy.int32).tofile(folder / name)


def compare(program, folder, bodies, kind, amount, rounds):
    radius, theirs = radius_of(bodies, kind, amount), Theirs(bodies)
    errors, more, count, said = 0, 0, 0, ""
    for turn in (0, 1):
        together = shapes_of(bodies, kind, amount, turn)[1]
        write(folder, bodies, *together)
        command = [str(program), str(folder), repr(radius), str(rounds if turn == 0 else 0)]
        said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout or said
        theirs.ask(*together, radius)
        for are_edges, other in enumerate(theirs.pairs()):
            file = folder / ("ee.i32" if are_edges else "fv.i32")
            pairs = numpy.fromfile(file, dtype=numpy.int32).reshape(-1, 2).astype(numpy.int64)
            a, b = pairs[:, 0], pairs[:, 1]
            mine = keys(a, b) if are_edges else keys(b, a)
            wrong, alone = differences(bodies, together, radius, mine, other, are_edges)
            errors += wrong + int((are_edges & (a >= b)).sum()) + len(pairs) - len(mine)
            more += alone
            count += len(pairs)
    times = ", ".join(" ".join(line.split()) for line in said.splitlines()[1:])
    name = f"{bodies.name:<24} {kind + f' {amount:g}':<11}"
    print(f"{name} {count // 2:>10,} {more:>7,} {errors:>7}   {times}", flush=True)
    return errors


def main():
    arguments = arguments_of(__doc__, 0, ("--program", "ipc_lists, compiled"))
    print(f"{'':<24} {'':<11} {'candidates':>10} {'more':>7} {'errors':>7}")
    errors = 0
    with tempfile.TemporaryDirectory() as folder:
        for bodies in all_bodies(arguments):
            for case in CASES:
                at = pathlib.Path(folder)
                errors += compare(arguments.program, at, bodies, *case, arguments.rounds)
    print(f"\nmore: candidates that ipctk has alone, within its rounding; errors: {errors}")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
