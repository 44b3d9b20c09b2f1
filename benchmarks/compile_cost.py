#!/usr/bin/env python3
"""Measures the cost of compiling the library, in processor time. Fails if an aim is missed.

Processor time is user and system time of all processes. It does not depend on other work of the
machine.

    benchmarks/compile_cost.py simulator                  a simulator's debug build, against release
    benchmarks/compile_cost.py rebuild                    a six-line program, after a changed line
    benchmarks/compile_cost.py tests [--before COMMIT]    `cargo test --workspace` from nothing
    benchmarks/compile_cost.py size [--before COMMIT]     the program, as built and stripped
    benchmarks/compile_cost.py table [--before COMMIT]    amount of code, and times to compile it
    benchmarks/compile_cost.py all [--before COMMIT]

`tests` and `size` have an aim only beside an earlier commit, which is taken out of git and
measured in the same way: minutes. `table` has no aim. It counts lines of code in crates/pliant/src
and, if it exists, crates/pliant-exact/src, without blank lines, comments and code for tests. Lines
of LLVM are counted as `cargo llvm-lines` does: of functions, before any optimisation.
`--exclude PACKAGE` leaves a package of the workspace out of both runs of the tests. All files are
made in a temporary folder, which is removed; the checkout's target folder is neither used nor
changed. Needs Python 3.10, cargo and git, on a system with getrusage.
"""

import argparse
import os
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parent.parent

# Aims: largest ratio to the compared figure, or largest number of seconds.
SIMULATOR_AT_MOST = 1.3
REBUILD_AT_MOST = 1.0
TESTS_AT_MOST = 0.4
SIZE_AT_MOST = 1.0

SIMULATOR = """\
use pliant::{Selection, World};

const SIDE: usize = 100;

/// Two triangles a square, SIDE x SIDE squares.
fn triangles() -> Vec<[u32; 3]> {
    let row = SIDE as u32 + 1;
    let squares = (0..SIDE as u32).flat_map(|y| (0..SIDE as u32).map(move |x| y * row + x));
    squares.flat_map(|at| [[at, at + 1, at + row], [at + row, at + 1, at + row + 1]]).collect()
}

/// Waves that run slantwise, in two sheets that are not exactly above each other.
/// So there is no exact contact, which few simulations have.
fn wave(positions: &mut [[f32; 3]], height: f32, phase: f32) {
    for (y, row) in positions.chunks_exact_mut(SIDE + 1).enumerate() {
        for (x, position) in row.iter_mut().enumerate() {
            let [x, y] = [x as f32, y as f32];
            let waves = (0.13 * x + 0.07 * y + phase).sin() + (0.05 * x - 0.11 * y - phase).sin();
            *position = [0.01 * x + 0.13 * height, 0.01 * y + 0.07 * height, height + 0.03 * waves];
        }
    }
}

fn main() {
    // With "alone" the simulator moves its sheets and asks nothing: the time without the library.
    let alone = std::env::args().any(|argument| argument == "alone");
    let mut world = World::<f32>::new();
    let mut positions = [(); 2].map(|()| vec![[0.0; 3]; (SIDE + 1) * (SIDE + 1)]);
    let bodies = [0, 1].map(|sheet| {
        wave(&mut positions[sheet], 0.03 * sheet as f32, sheet as f32);
        world.add(&triangles(), &positions[sheet]).unwrap()
    });
    let mut pairs = 0;
    for step in 0..60 {
        for sheet in 0..2 {
            let phase = 0.1 * step as f32 * (1.0 + sheet as f32) + sheet as f32;
            wave(&mut positions[sheet], 0.03 * sheet as f32, phase);
            std::hint::black_box(&positions[sheet]);
            if !alone {
                world.set_positions(bodies[sheet], &positions[sheet]).unwrap();
            }
        }
        if !alone {
            pairs += world.intersections(Selection::Everything).all().unwrap().len();
        }
    }
    println!("{pairs}");
}
"""

SIX_LINES = """\
fn main() {
    let mut world = pliant::World::<f32>::new();
    world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]]).unwrap();
    world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.0, 1.0, 0.0]]).unwrap();
    println!("{:?}", world.intersections(pliant::Selection::Everything).all());
}
"""

failed = []


def check(what, found, most, unit):
    """Prints a figure beside its aim, and records a missed aim."""
    missed = found > most
    print(
        f"    {what}: {found:.3g}{unit}, aim at most {most:g}{unit}{': MISSED' if missed else ''}",
        flush=True,
    )
    if missed:
        failed.append(what)


def run(command, folder, target=None, with_errors=False):
    """Processor time of a command and all its children, and its output. Exits if it fails."""
    environment = dict(os.environ)
    if target:
        environment["CARGO_TARGET_DIR"] = str(target)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [str(part) for part in command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(
            f"{' '.join(map(str, command))} failed:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}"
        )
    seconds = (after.ru_utime - before.ru_utime) + (after.ru_stime - before.ru_stime)
    return seconds, done.stdout + (done.stderr if with_errors else "")


def make_crate(folder, name, main, profiles=""):
    """Makes a crate that uses the library of this checkout, with the checkout's locked versions."""
    (folder / "src").mkdir(parents=True)
    (folder / "src/main.rs").write_text(main)
    # A workspace of its own, in case the temporary folder is inside another.
    (folder / "Cargo.toml").write_text(
        f'[package]\nname = "{name}"\nversion = "0.0.0"\nedition ='
        ' "2024"\n\n[workspace]\n\n[dependencies]\npliant = { path ='
        f' "{(CHECKOUT / "crates/pliant").as_posix()}" }}\n{profiles}'
    )
    shutil.copy(CHECKOUT / "Cargo.lock", folder / "Cargo.lock")
    return folder


PROFILES = """
[profile.dev.package."*"]
opt-level = 3

[profile.unchecked]
inherits = "dev"

[profile.unchecked.package."*"]
opt-level = 3
debug-assertions = false
"""


def simulator(temporary, _):
    """Builds in turns. In debug, dependencies are optimised as in the Bevy book."""
    crate = make_crate(temporary / "simulator", "simulator", SIMULATOR, PROFILES)
    target = temporary / "simulator-target"
    # A crate from a path is compiled incrementally by default, a crate from a registry never.
    os.environ["CARGO_INCREMENTAL"] = "0"
    builds = {"release": "release", "dev": "debug", "unchecked": "unchecked"}
    compiled, times, alone, printed = {}, {}, {}, set()
    for profile in builds:
        compiled[profile] = run(["cargo", "build", "--quiet", "--profile", profile], crate, target)[
            0
        ]
    del os.environ["CARGO_INCREMENTAL"]
    for _ in range(15):
        for profile, folder in builds.items():
            program = target / folder / "simulator"
            time, pairs = run([program], crate)
            times.setdefault(profile, []).append(time)
            alone.setdefault(profile, []).append(run([program, "alone"], crate)[0])
            printed.add(pairs)
    if len(printed) != 1:
        sys.exit(f"the builds found different pairs: {printed}")
    print(f"simulator: two sheets of 20,000 triangles, 60 steps, {printed.pop().strip()} pairs")
    for profile in builds:
        print(
            f"    {profile}: {statistics.median(times[profile]):.3f} s, of which without a step's"
            f" positions and queries {statistics.median(alone[profile]):.3f} s; compiled in"
            f" {compiled[profile]:.1f} s"
        )
    medians = {profile: statistics.median(times[profile]) for profile in builds}
    without = medians["unchecked"] / medians["release"]
    print(f"    debug against release, no debug assertions in dependencies: {without:.3g}")
    check("debug against release", medians["dev"] / medians["release"], SIMULATOR_AT_MOST, "")


def rebuild(temporary, _):
    crate = make_crate(temporary / "six-lines", "six-lines", SIX_LINES)
    target = temporary / "six-lines-target"
    first, _ = run(["cargo", "build", "--quiet", "--release"], crate, target)
    times = []
    for change in range(5):
        (crate / "src/main.rs").write_text(SIX_LINES.replace("1.0, 0.5", f"1.0, 0.{change}"))
        times.append(run(["cargo", "build", "--quiet", "--release"], crate, target)[0])
    print(f"rebuild: a program of six lines, in release; at first, with the library, {first:.1f} s")
    check("after one changed line", statistics.median(times), REBUILD_AT_MOST, " s")


def taken_out(commit, temporary):
    """Checks a commit out into a folder of its own."""
    folder = temporary / "before"
    if not folder.exists():
        folder.mkdir()
        archive = temporary / "before.tar"
        run(["git", "archive", "--output", archive, commit], CHECKOUT)
        shutil.unpack_archive(archive, folder)
        # Data that tests read beside the checkout is also beside the earlier commit.
        if (CHECKOUT.parent / "shared").exists():
            (temporary / "shared").symlink_to(CHECKOUT.parent / "shared")
    return folder


def tests(temporary, arguments):
    def measure(name, folder):
        target = temporary / f"tests-target-{name}"
        command = ["cargo", "test", "--workspace"] + [
            part for package in arguments.exclude for part in ("--exclude", package)
        ]
        compiling, _ = run([*command, "--no-run"], folder, target)
        running, _ = run(command, folder, target)
        shutil.rmtree(target)
        print(
            f"    {name}: {compiling + running:.0f} s; compiling all but doctests"
            f" {compiling:.0f} s",
            flush=True,
        )
        return compiling + running

    print("tests: `cargo test --workspace` from nothing", flush=True)
    now = measure("now", CHECKOUT)
    if arguments.before:
        before = measure("before", taken_out(arguments.before, temporary))
        check(f"against {arguments.before}", now / before, TESTS_AT_MOST, "")


def size(temporary, arguments):
    def measure(name, folder):
        target = temporary / f"size-target-{name}"
        command = ["cargo", "build", "--quiet", "--release", "--package", "pliant-cli"]
        compiled, _ = run(command, folder, target)
        program = target / "release/pliant"
        sizes = [program.stat().st_size]
        if shutil.which("strip"):
            run(["strip", program], folder)
            sizes.append(program.stat().st_size)
        shutil.rmtree(target)
        stripped = f", stripped {sizes[1]:,} bytes" if len(sizes) == 2 else ""
        print(
            f"    {name}: as built {sizes[0]:,} bytes{stripped}; compiled in {compiled:.0f} s",
            flush=True,
        )
        return sizes

    print("size: the program `pliant`, in release", flush=True)
    now = measure("now", CHECKOUT)
    if arguments.before:
        before = measure("before", taken_out(arguments.before, temporary))
        for what, new, old in zip(("as built", "stripped"), now, before):
            check(f"{what} against {arguments.before}", new / old, SIZE_AT_MOST, "")


# Text that only looks like code: comments, strings, characters, also over several lines.
NO_CODE = re.compile(
    r"""//[^\n]* | /\*.*?\*/ | r(\#*)".*?"\1 | "(?:\\.|[^"\\])*" | '(?:\\[^']*'|[^'\\]') """,
    re.DOTALL | re.VERBOSE,
)


def only_code(text):
    """Code with blanks in place of comments, and underscores for strings and characters."""
    return NO_CODE.sub(
        lambda it: re.sub(r"[^\n]", " " if it[0].startswith(("//", "/*")) else "_", it[0]), text
    )


def end_of_item(code, at):
    """End of an item, a field or a variant: behind its braces, or the end of its line."""
    ends = (
        ";"
        if re.match(r"\s*(pub(\([^)]*\))?\s+)?(const|fn|mod|static|type|unsafe|use)\b", code[at:])
        else ";,"
    )
    depth = 0
    for place in range(at, len(code)):
        depth += (code[place] in "([{") - (code[place] in ")]}")
        if depth == 0 and (code[place] == "}" or code[place] in ends):
            return place + 1
    return len(code)


def sources(folder):
    """Code of every file below a folder, without code for tests."""
    found, for_tests = {}, set()
    for path in sorted(folder.rglob("*.rs")):
        code = only_code(path.read_text())
        while (at := code.find("#[cfg(test)]")) >= 0:
            end = end_of_item(code, at + len("#[cfg(test)]"))
            if module := re.search(r"\bmod\s+(\w+);$", code[at:end]):
                inside = path.parent if path.stem in ("lib", "mod") else path.with_suffix("")
                for_tests.add(inside / module[1])
            code = code[:at] + code[end:]
        found[path] = code
    is_for_tests = lambda path: any(
        module in [path.with_suffix(""), *path.parents] for module in for_tests
    )
    return [code for path, code in found.items() if not is_for_tests(path)]


def table(temporary, arguments):
    def measure(name, folder):
        target = temporary / f"table-target-{name}"
        engine = [
            code
            for crate in ("pliant", "pliant-exact")
            for code in sources(folder / "crates" / crate / "src")
        ]
        figures = {
            "code lines of the engine": sum(
                1 for code in engine for line in code.splitlines() if line.strip()
            )
        }
        functions = (
            code[it.start() : end_of_item(code, it.start())]
            for code in engine
            for it in re.finditer(r"\bfn \w", code)
        )
        figures["functions over 70 lines"] = sum(
            function.count("\n") >= 70 for function in functions
        )

        def build(what, *options):
            seconds, said = run(
                ["cargo", "build", "--release", *options], folder, target, with_errors=True
            )
            figures[f"{what}: seconds"] = round(seconds)
            figures[f"{what}: crates"] = len(re.findall(r"^ *Compiling ", said, re.MULTILINE))

        build("cargo build --release -p pliant", "-p", "pliant")
        llvm = [
            "--emit=llvm-ir",
            "-Cno-prepopulate-passes",
            "-Cpasses=name-anon-globals",
            "-Ccodegen-units=1",
        ]
        run(["cargo", "rustc", "-p", "pliant", "--lib", "--release", "--", *llvm], folder, target)
        lines = copies = 0
        is_inside = False
        for path in (target / "release/deps").glob("pliant-*.ll"):
            with path.open() as text:
                for line in text:
                    if is_inside := is_inside or line.startswith("define "):
                        lines += 1
                        copies += line.startswith("define ") and "7descend" in line
                        is_inside = line != "}\n"
        figures |= {"compiled copies of `descend`": copies, "lines of LLVM of the library": lines}
        shutil.rmtree(target)
        build(
            "cargo build --release",
            *(
                []
                if "default-members" in (folder / "Cargo.toml").read_text()
                else ["-p", "pliant-cli"]
            ),
        )
        program = target / "release/pliant"
        if shutil.which("strip"):
            run(["strip", program], folder)
            figures["the program, stripped: bytes"] = program.stat().st_size
        shutil.rmtree(target)
        return figures

    print(
        "table: what there is to compile; seconds are of processor time, from nothing", flush=True
    )
    now = measure("now", CHECKOUT)
    before = measure("before", taken_out(arguments.before, temporary)) if arguments.before else {}
    for what, figure in now.items():
        earlier = f"{before[what]:>12,}" if what in before else ""
        print(f"    {what:<45}{earlier}{figure:>12,}")


COSTS = {"simulator": simulator, "rebuild": rebuild, "tests": tests, "size": size, "table": table}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("cost", choices=[*COSTS, "all"])
    parser.add_argument("--before", metavar="COMMIT", help="measure this commit too, and compare")
    parser.add_argument(
        "--exclude", metavar="PACKAGE", action="append", default=[], help="not tested"
    )
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="pliant-compile-cost-") as temporary:
        for name, cost in COSTS.items():
            if arguments.cost in (name, "all"):
                cost(Path(temporary), arguments)
    if failed:
        sys.exit(f"missed: {'; '.join(failed)}")


main()
