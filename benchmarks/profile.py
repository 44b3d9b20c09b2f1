#!/usr/bin/env python3
"""Profiles a step: instructions and time, by phase and by unit of work.

    CARGO_PROFILE_RELEASE_DEBUG=line-tables-only cargo build --release -p pliant-bench --example windows
    python3 benchmarks/profile.py target/release/examples/windows hard [ROUNDS]

callgrind (valgrind) counts instructions; perf samples time, where it is installed. Both are
attributed to phases by the functions inlined at each address (addr2line). The example plays one
window, and prints its own time and work.
"""

import collections
import re
import shutil
import subprocess
import sys
import tempfile

# Phase, functions whose inlined code belongs to it (the first phase with one wins), unit of work.
PHASES = [
    ("planes of candidates", ["by_planes"], "candidate_pairs"),
    ("lines of candidates", ["by_lines", "narrow_phase::intersect"], "pairs"),
    ("triangle boxes compared", ["of_two", "of_itself", "Meet::meet"], "candidate_pairs"),
    ("node boxes compared", ["expand", "overlap_mask"], "node_pairs"),
    (
        "boxes made",
        [
            "make_block",
            "reach_leaves",
            "make_group_true",
            "make_groups",
            "merge_groups",
            "make_levels",
        ],
        "boxes",
    ),
    ("positions checked and copied", ["take_over"], "steps"),
    ("positions into tree order", ["bring_into_order", "gather"], "steps"),
    ("what is reached", ["reach", "Noted", "descend", "asks_for_untrue", "Branch"], "node_pairs"),
    ("pairs sorted and named", ["sort", "show_", "intersection_pairs", "name"], "pairs"),
]


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, window = sys.argv[1:3]
    rounds = sys.argv[3] if len(sys.argv) > 3 else "40"
    with tempfile.TemporaryDirectory() as folder:
        said = run([program, window, "--rounds", rounds])
        milliseconds = float(re.search(r"([0-9.]+) ms a step", said).group(1))
        work = {
            name: int(count)
            for name, count in re.findall(r"(\w+): (\d+)", said.split("a step: ")[1])
        }
        steps = int(re.search(r"/ (\d+)", said).group(1))
        work["steps"] = steps
        work["boxes"] = work["boxes_bottom_up"] + work["boxes_top_down"] + work["triangle_boxes"]
        instructions = by_phase(program, counted(program, window, folder))
        samples = (
            by_phase(program, sampled(program, window, rounds, folder))
            if shutil.which("perf")
            else {}
        )

    print(
        f"{window}: {milliseconds:.4f} ms a step, {sum(instructions.values()) / steps:,.0f}"
        " instructions"
    )
    print(f"{'phase':30}{'share':>8}{'unit':>18}{'units':>10}{'instructions':>14}{'ns a unit':>11}")
    for phase, _, unit in PHASES + [("other", [], "steps")]:
        units = work[unit]
        share = samples.get(phase, 0) / max(1, sum(samples.values()))
        nanoseconds = (
            f"{share * milliseconds * 1e6 * steps / max(1, units):.1f}" if samples else "-"
        )
        shown = f"{100 * share:.0f} %" if samples else "-"
        count = instructions.get(phase, 0) / max(1, units)
        print(
            f"{phase:30}{shown:>8}{unit:>18}{units // steps:>10,}{count:>14,.0f}{nanoseconds:>11}"
        )


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    return done.stdout


def counted(program, window, folder):
    """Instructions at every address of the program, between the positions and the answer."""
    file = f"{folder}/callgrind"
    run(
        [
            "valgrind",
            "--tool=callgrind",
            f"--callgrind-out-file={file}",
            "--dump-instr=yes",
            "--compress-pos=no",
            "--compress-strings=no",
            "--toggle-collect=windows::one_step",
            program,
            window,
            "--rounds",
            "1",
        ]
    )
    counts = collections.Counter()
    inherited = False
    with open(file, encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("calls="):
                inherited = True
            elif match := re.match(r"0x([0-9a-f]+) \d+ (\d+)", line):
                if not inherited:
                    counts[int(match.group(1), 16)] += int(match.group(2))
                inherited = False
    return counts


def sampled(program, window, rounds, folder):
    """Samples at every address of the program."""
    file = f"{folder}/perf"
    run(["perf", "record", "-q", "-F", "2999", "-o", file, program, window, "--rounds", rounds])
    said = run(["perf", "script", "-i", file, "-F", "ip", "--show-mmap-events"])
    segments = re.findall(r"LOAD\s+0x([0-9a-f]+) 0x([0-9a-f]+)", run(["readelf", "-lW", program]))
    segments = sorted((int(offset, 16), int(address, 16)) for offset, address in segments)
    counts = collections.Counter()
    base = None
    for line in said.splitlines():
        mapped = re.search(
            r"\[0x([0-9a-f]+)\(0x([0-9a-f]+)\) @ (?:0x)?([0-9a-f]+) .*r-xp (.*)", line
        )
        if mapped:
            if mapped.group(4).endswith(program.split("/")[-1]):
                start, size, offset = (int(mapped.group(place), 16) for place in (1, 2, 3))
                base = (start, size, offset)
        elif base and (match := re.match(r"\s*([0-9a-f]+)$", line)):
            address = int(match.group(1), 16) - base[0]
            if 0 <= address < base[1]:
                place = address + base[2]
                offset, virtual = max(segment for segment in segments if segment[0] <= place)
                counts[place - offset + virtual] += 1
    return counts


def by_phase(program, counts):
    """Counts by phase, without code of no phase (the scene, the example)."""
    addresses = list(counts)
    best = {}
    # Under valgrind a program has another base address; otherwise addresses are as in the file.
    for shift in (0, 0x108000, 0x400000):
        asked = "\n".join(hex(address - shift) for address in addresses if address >= shift)
        said = subprocess.run(
            ["addr2line", "-e", program, "-f", "-i", "-C", "-a"],
            input=asked,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        frames = re.split(r"^0x[0-9a-f]+$", said, flags=re.M)[1:]
        found = collections.Counter()
        for address, names in zip((address for address in addresses if address >= shift), frames):
            if "pliant_scenes" in names or "pliant_bench" in names:
                continue
            phase = next(
                (
                    phase
                    for phase, functions, _ in PHASES
                    if any(name in names for name in functions)
                ),
                None,
            )
            if phase or "pliant" in names:
                found[phase or "other"] += counts[address]
        if sum(found.values()) > sum(best.values()):
            best = found
    return best


if __name__ == "__main__":
    main()
