#!/usr/bin/env python3
"""Writes RESULTS.md and the table of the README from records: no figure in them is written by hand.

The main record is of `pliant bench all`. The experiments `near`, `close`, `when` and `change`, and
comparisons with other libraries, have records of their own; the newest of each is taken. `DATE`
stands for the date in names of records:

    B="cargo run --release --features peers -- bench"
    cd benchmarks/records
    $B all --json DATE.json > DATE.txt
    $B near --json near-DATE.json > near-DATE.txt
    $B when --json when-DATE.json > when-DATE.txt
    $B close --json close-DATE.json > close-DATE.txt
    $B change --rounds 1 --json change-DATE.json > change-DATE.txt
    $B cores --json cores-DATE.json > cores-DATE.txt
    P=../../target/ipctk/bin/python
    $P ../compare_with_ipctk.py > ipctk-DATE.txt
    $P ../compare_impacts_with_ipctk.py > impacts-ipctk-DATE.txt
    $P ../compare_close_with_ipctk.py > close-ipctk-DATE.txt
    $P ../compare_codim_with_ipctk.py > codim-ipctk-DATE.txt
    $P ../compare_distance_with_fcl.py > close-fcl-DATE.txt
    cargo run --release -p pliant-bench --features peers --example edits > edits-DATE.txt
    $P ../compare_adapter_with_ipctk.py --program PROGRAM --rounds 9 > adapter-ipctk-DATE.txt
    cargo run --release -p pliant-c --example cost > c-DATE.txt
    ../../target/inside/bin/python ../compare_inside_with_peers.py --rounds 41 > inside-DATE.txt
    ../../target/frames/bin/python ../many_shapes.py --rounds 9 > frames-DATE.txt
    python3 ../results.py DATE
"""

import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).parent
VERDICTS = {
    "holds": "holds",
    "holds-weaker": "holds weaker",
    "does-not-hold-today": "does not hold today",
    "measured": "measured",
}
PLIANT, HYBRID, TOP_DOWN, BOTTOM_UP = (
    "pliant",
    "pliant, paper: hybrid",
    "pliant, paper: top-down",
    "pliant, paper: bottom-up",
)
LOCAL, WORLD = "van den Bergen, local frame", "van den Bergen, world frame"
PEERS = {
    "parry3d": "parry3d 0.31",
    "obvhs, 1 a leaf": "obvhs 0.4, 1 a leaf",
    "obvhs, 4 a leaf": "obvhs 0.4, 4 a leaf",
}
# Contest, window, name in the README.
LINES = [
    ("two spheres", "easy", "two spheres of 20,480 triangles, apart"),
    ("two spheres", "hard", "deep in each other, all pairs"),
    ("two spheres, first pair", "from contact", "from contact on, first pair"),
    ("27 spheres", "hard", "27 spheres of 5,120 triangles, deep in each other"),
    ("cloth with itself", "hard", "a folding cloth of 79,202 triangles with itself"),
    ("two spheres of 327,680", "hard", "two spheres of 327,680 triangles, deep in each other"),
    ("two spheres of 1,310,720", "hard", "two spheres of 1,310,720 triangles, deep in each other"),
]


class Record:
    def __init__(self, file):
        record = json.loads(file.read_text())
        self.machine = record["machine"]
        self.experiments = {
            experiment["experiment"]: experiment for experiment in record["experiments"]
        }
        self.rounds = record["experiments"][0]["rounds"]

    def contest(self, experiment, contest):
        contests = self.experiments[experiment]["contests"]
        if isinstance(contest, int):
            return contests[contest]
        return next(known for known in contests if known["name"] == contest)

    def ms(self, experiment, contest, method, window):
        """Mean time of a step, in milliseconds."""
        contest = self.contest(experiment, contest)
        place = [known["name"] for known in contest["windows"]].index(window)
        return next(known for known in contest["methods"] if known["name"] == method)["windows"][
            place
        ]["mean_ms"]

    def times(self, experiment, contest, fast, slow, window="all"):
        return self.ms(experiment, contest, slow, window) / self.ms(
            experiment, contest, fast, window
        )

    def claim(self, experiment, *words):
        found = [
            claim
            for claim in self.experiments[experiment]["claims"]
            if all(word in claim["claim"] for word in words)
        ]
        assert len(found) == 1, (experiment, words, [claim["claim"] for claim in found])
        return found[0]

    def claims(self, experiment):
        """All claims of an experiment, as rows of a table."""
        claims = self.experiments[experiment]["claims"]
        return "\n".join(
            f"| {claim['claim']} | {VERDICTS[claim['verdict']]} | {claim['figure']} |"
            for claim in claims
        )

    def figure(self, experiment, *words):
        return self.claim(experiment, *words)["figure"]

    def verdict(self, experiment, *words):
        return VERDICTS[self.claim(experiment, *words)["verdict"]]


def claims_of_the_paper(record):
    """Rows of a table: statement, verdict, figure."""
    fig, ver, times = record.figure, record.verdict, record.times
    two = lambda x: f"{x:.2f}"
    both = lambda a, b: a if a == b else f"{a} / {b}"

    def three(contest, window):
        ms = lambda method: f"{record.ms('experiment-1', contest, method, window):.3f}"
        return f"bottom-up {ms(BOTTOM_UP)}, top-down {ms(TOP_DOWN)}, hybrid {ms(HYBRID)}"

    def over_bergen(experiment, contest):
        factor = lambda fast, slow: two(times(experiment, contest, fast, slow))
        return (
            f"the paper's configuration {factor(HYBRID, LOCAL)} times (local frame),"
            f" {factor(HYBRID, WORLD)} times (world frame); our default {factor(PLIANT, LOCAL)} and"
            f" {factor(PLIANT, WORLD)} times"
        )

    rows = []
    rows.append(
        (
            "the hybrid update performs best, in simple cases (figure 3a)",
            ver("experiment-1", "3a", "simple"),
            three(0, "easy"),
        )
    )
    rows.append(
        ("and in hard cases (3a)", ver("experiment-1", "3a", "hard cases"), three(0, "hard"))
    )
    rows.append(
        (
            "the same for the first pair, simple cases (3b)",
            ver("experiment-1", "3b", "simple"),
            three(1, "easy"),
        )
    )
    rows.append(
        (
            "the first pair, hard cases (3b)",
            ver("experiment-1", "3b", "hard cases"),
            three(1, "hard"),
        )
    )
    rows.append(
        (
            "four to five times faster than van den Bergen (experiment 1, all pairs)",
            both(
                ver("experiment-1", "3a", HYBRID + " is 4", LOCAL),
                ver("experiment-1", "3a", HYBRID + " is 4", WORLD),
            ),
            over_bergen("experiment-1", 0),
        )
    )
    rows.append(
        (
            "the same for the first pair",
            both(
                ver("experiment-1", "3b", HYBRID + " is 4", LOCAL),
                ver("experiment-1", "3b", HYBRID + " is 4", WORLD),
            ),
            over_bergen("experiment-1", 1),
        )
    )
    rows.append(
        (
            "5.6 times faster for 27 spheres (4a)",
            both(
                ver("experiment-3", "4a", HYBRID + " is", LOCAL),
                ver("experiment-3", "4a", HYBRID + " is", WORLD),
            ),
            over_bergen("experiment-3", 0),
        )
    )
    rows.append(
        (
            "4.5 times faster for 27 bodies with arms (4b)",
            both(
                ver("experiment-3", "4b", HYBRID + " is", LOCAL),
                ver("experiment-3", "4b", HYBRID + " is", WORLD),
            ),
            over_bergen("experiment-3", 1),
        )
    )
    rows.append(
        (
            "time grows roughly linearly with the faces (table 1)",
            ver("table-1", "linearly", HYBRID),
            fig("table-1", "linearly", HYBRID),
        )
    )
    rows.append(
        (
            "8-ary trees slightly better than binary",
            ver("degrees", "slightly better than binary"),
            fig("degrees", "slightly better than binary"),
        )
    )
    rows.append(
        (
            "8-ary trees slightly better than 4-ary",
            ver("degrees", "4-ary"),
            fig("degrees", "4-ary") + ": half of eight lanes are empty on a surface",
        )
    )
    for s in ("spheres", "arms", "cloth"):
        rows.append(
            (
                f"no significant difference between box centre and mean ({s})",
                ver("splits", "splits on " + s, "no significant"),
                fig("splits", "splits on " + s, "no significant"),
            )
        )
    for s in ("spheres", "arms", "cloth"):
        rows.append(
            (
                f"connectivity trees 0 to 10 % better ({s})",
                ver("splits", "splits on " + s, "0 to 10"),
                fig("splits", "splits on " + s, "0 to 10"),
            )
        )
    rows.append(("n / 2 is an efficient level", ver("levels", "n / 2"), fig("levels", "n / 2")))
    rows.append(
        (
            "the 8-ary van den Bergen is 10 to 20 % faster than the binary (local frame)",
            ver("degrees", "local frame: 8-ary"),
            fig("degrees", "local frame: 8-ary"),
        )
    )
    rows.append(
        (
            "the same (world frame)",
            ver("degrees", "world frame: 8-ary"),
            fig("degrees", "world frame: 8-ary"),
        )
    )
    rows.append(
        (
            "brute force over bodies is fine to about 100",
            ver("bodies", "approximately 100"),
            fig("bodies", "approximately 100")
            + "; at 10,000: "
            + fig("bodies", "10000 bodies")
            + " (brute force, sweep and prune)",
        )
    )
    for s in ("coplanar grids", "two spheres, at the origin", "two spheres, 10^4"):
        rows.append(
            (
                f"its triangle test, Möller 1997 ({s.replace('10^4','10^4 from the origin')})",
                ver("degenerate", s, "Möller"),
                fig("degenerate", s, "Möller"),
            )
        )
    return rows


def page(record, date):
    times, ms, figure = record.times, record.ms, record.figure
    two = lambda x: f"{x:.2f}"
    bergen = lambda fast, slow: two(times("experiment-1", 0, fast, slow))
    update = lambda contest, window: two(times("experiment-1", contest, HYBRID, BOTTOM_UP, window))
    table = "\n".join(
        f"| {statement} | {verdict} | {found} |"
        for statement, verdict, found in claims_of_the_paper(record)
    )
    aims = record.claims("peers")
    near = newest("near-*.json")
    near_record = Record(near)
    near_aims = near_record.claims("near")
    ipctk, header, beside = beside_ipctk()
    codim, codim_header, codim_found = beside_ipctk_codimensional()
    adapter, adapter_header, adapter_found = beside_ipctk_adapter()
    from_c, from_c_header, from_c_rows = beside_rust()
    close = newest("close-*.json")
    close_record = Record(close)
    close_aims = close_record.claims("close")
    close_ipctk, close_header, close_beside = beside_ipctk_close()
    fcl, fcl_header, fcl_beside = beside_fcl()
    when = newest("when-*.json")
    when_record = Record(when)
    when_aims = when_record.claims("when")
    impacts_ipctk, impacts_header, impacts_beside = beside_ipctk_impacts()
    change = newest("change-*.json")
    change_record = Record(change)
    change_found = change_record.claims("change")
    edits = newest("edits-*.txt")
    inside = newest("inside-*.txt")
    frames = newest("frames-*.txt")
    processor = record.machine["processor"]
    cores = record.machine["cores"]
    cores_file = newest("cores-*.json")
    cores_of, wait, threads = more_threads(cores_file)
    shapes = newest("shapes-*.json")
    shapes_record = Record(shapes)
    shapes_found = shapes_record.claims("shapes")
    return f"""# What the paper claims, what we aim at, and what we find

From the full run of {date} ([text](records/{date}.txt), [JSON](records/{date}.json)): one thread \
of an {processor} ({cores} cores, a
virtual machine), `pliant bench all --rounds {record.rounds}`. All methods use the same exact \
triangle decision and returned equal pair
lists; how it is measured is in [METHOD.md](METHOD.md). Times are means of update and query a \
step, in milliseconds. On this machine
ratios below 1.3 are ties. What was tried on the way is in [NOTES.md](NOTES.md) and \
[TRIED.md](TRIED.md). This page is \
written by `benchmarks/results.py`.

| the paper says | verdict | our figure |
|---|---|---|
{table}

## Where the factor over van den Bergen comes from

The paper's factor of five had three parts: world-space boxes instead of oriented ones, wide \
trees, and the update. Today, in
experiment 1, all pairs, over all 200 steps:

- **The paper's configuration over the faithful van den Bergen: {bergen(HYBRID, LOCAL)} times \
(local frame), {bergen(HYBRID, WORLD)} times (world frame). Our
  default: {bergen(PLIANT, LOCAL)} and {bergen(PLIANT, WORLD)} times.** Its kernels are eight \
lanes wide, van den Bergen's here are not.
- **World frame.** Van den Bergen's own method gains {bergen(WORLD, LOCAL)} times from it, with \
nothing else changed.
- **The update.** With everything else equal (our tree, traversal and code; hybrid against \
complete refit) it is worth {update(0, 'all')} times
  over all steps for all pairs, {update(0, 'easy')} times in easy steps, {update(0, 'hard')} \
times in hard ones; and {update(1, 'all')} times for the first pair, where a
  complete refit is made only if the last pair is none any more.
- **What has changed since 2001.** A complete refit of both bodies \
costs {ms('experiment-1', 0, WORLD, 'easy'):.2f} ms today (van den Bergen, easy steps), and
  all methods with tight world boxes decide the same candidates, which no update saves.

## Our aims, against the libraries of today and the floor

Aims and what became of them (`pliant bench peers`). The floor is one pass over all vertices with \
the widest registers; and, where
pairs are asked for, the decision of the true pairs as it stood when the project began, and \
sorting them.

| aim | | our figure |
|---|---|---|
{aims}

## What is near

Vertices near triangles and edges near edges (`pliant bench near --rounds {near_record.rounds}`, \
[text](records/{near.stem}.txt),
[JSON](records/{near.name}); one thread, and two where it says so, of \
an {near_record.machine['processor']}):

| aim | | our figure |
|---|---|---|
{near_aims}

Beside ipc-toolkit's `Candidates.build` with its LBVH ([record](records/{ipctk}), the same \
machine; {header}). *More* are
candidates that it has alone, all within its rounding; none is ours alone. Ours are sorted, in job \
order, or in compressed rows; its are in
no order. Milliseconds; times faster are medians of rounds, with the least and the most. The aims \
were 8 at margin 0.1 and swept 0.1, and 4
where output dominates (margin 0.5, and armadillo-rollers swept 1).

| | | candidates | more | sorted | job order | rows | its | times faster, sorted | in job order |
|---|---|---|---|---|---|---|---|---|---|
{beside}

Bodies of edges and points beside its four lists ([record](records/{codim}); {codim_header}; \
random cables, nets, clouds and sheets):
{codim_found["ee"]} pairs of edges, {codim_found["fv"]} of faces and vertices, {codim_found["ev"]} \
of edges and vertices, {codim_found["vv"]} of vertices. All are ours, too; \
{codim_found["its_alone"]} are its alone. Distances of
{codim_found["close"]} close pairs agree.

The broad phase for ipc-toolkit, from C++ ([record](records/{adapter}); {adapter_header}; `benchmarks/compare_adapter_with_ipctk.py`): {adapter_found}

## From C

Calls of C on single pairs over calls of Rust (`cargo run --release -p pliant-c --example cost`, \
[record](records/{from_c}); {from_c_header}).
Points lie in rows, or in columns as Eigen has them. The aims were 1.05 and 1.3.

| | ns a pair in Rust | rows | columns |
|---|---|---|---|
{from_c_rows}

## What is close

Vertices and triangles, and edges and edges, that are at most so far apart, measured; and how far \
two bodies are apart (`pliant bench close
--rounds {close_record.rounds}`, [text](records/{close.stem}.txt), [JSON](records/{close.name}); \
one thread of an
{close_record.machine['processor']}):

| aim | | our figure |
|---|---|---|
{close_aims}

Beside ipc-toolkit's `NormalCollisions.build` with its LBVH \
([record](records/{close_ipctk}); {close_header}). It keeps closest *features*,
each once; *ties* are left to rounding, and nothing else differs. Milliseconds; times faster are \
medians of rounds, with the least and the
most. The aim was 4.

| | | pairs | features | ties | ours | its | times faster |
|---|---|---|---|---|---|---|---|
{close_beside}

The distance of two spheres beside FCL's, from Python ([record](records/{fcl}); {fcl_header}). It \
makes its models anew at every step, for
want of another way in Python. Milliseconds a step; the aim was 10.

| | ours | its making | its asking | times faster | than asking alone |
|---|---|---|---|---|---|
{fcl_beside}

## When

What meets on its way to the next step, or on a tenth of it, and what meets first (`pliant bench \
when --rounds {when_record.rounds}`,
[text](records/{when.stem}.txt), [JSON](records/{when.name}); one thread of \
an {when_record.machine['processor']}). What a candidate costs is
the time of all impacts less that of showing all candidates to a visitor who counts them:

| aim | | our figure |
|---|---|---|
{when_aims}

Beside ipc-toolkit, with its Tight-Inclusion and its additive CCD \
([record](records/{impacts_ipctk}); {impacts_header}). The *step* is how far
everything may go: ours from `set_motion` to `collision_free_step`, its building of candidates \
and its step. Milliseconds; *misses* are steps
of its that go beyond the first contact, none of ours does.

| | part | candidates | impacts | misses | step, ours | Tight-Inclusion | additive | a candidate, \
ns, ours | Tight-Inclusion | additive |
|---|---|---|---|---|---|---|---|---|---|---|
{impacts_beside}

## Change

Meshes that change, a step with everything that an edit costs (`pliant bench change \
--rounds {change_record.rounds}`, [text](records/{change.stem}.txt),
[JSON](records/{change.name}); one thread of an {change_record.machine['processor']}). Trees mend \
themselves only where it
says so:

| | | |
|---|---|---|
{change_found}

Single edits, and the step after many ([record](records/{edits.name}), `cargo run --release -p \
pliant-bench --features peers --example edits`). The aims were 1 ms for
a cut, faster than obvhs and 100 times faster than building anew; and 1.15 for the step after ten \
thousand edits:

```text
{edits.read_text().strip()}
```

## Inside

Points against a closed body that has a new shape at each step, beside tools that build anew for \
each ([record](records/{inside.name}), `benchmarks/compare_inside_with_peers.py`). Below are \
wrong answers for
points that are rounded, 1e-3, 1e-5, 1e-6, 1e-7, 1e-8 and 1e-9 off the centres of faces. The aims \
were 1.5 ms for
vertices, 3 ms for points, and 4 ms for closest points with signs, which is missed:

```text
{inside.read_text().strip()}
```

## Many shapes

One mesh in many shapes, from Python ([record](records/{frames.name}), \
`benchmarks/many_shapes.py`): milliseconds a frame, and times one call on one thread.
The aims were 3 times faster than one-line calls, 0.95 of a kept world, and 1.7 times faster on two threads:

```text
{frames.read_text().strip()}
```

## More threads

A step with positions and lists, `pliant bench cores` ([text](records/{cores_file.stem}.txt), \
[JSON](records/{cores_file.name}), {cores_of['cores']} cores of an {cores_of['processor']}). Jobs \
of one thread are replayed on many; an empty part costs two threads {wait:.1f} us. The columns \
before the last say what holds 16 workers back, in shares of their time:

| | question | ms on 1 | by replay: x2 | x4 | x8 | x16 | x64 | serial | uneven | waits | measured |
|---|---|---|---|---|---|---|---|---|---|---|---|
{threads}

## Exact contact

A candidate of coplanar grids: {figure('degenerate', 'coplanar grids', 'the cost')}. Of two spheres:
{figure('degenerate', 'two spheres, at the origin', 'the cost')}. That \
is {figure('degenerate', 'at most ten times')} as much.

## Shapes that are hard

By `pliant bench shapes --rounds {shapes_record.rounds}` ([text](records/{shapes.stem}.txt), \
[JSON](records/{shapes.name}); one thread of
an {shapes_record.machine['processor']}). Surfaces of 12,000 long thin triangles turn on a waving \
sheet of 180,000, beside a disc of
good triangles. Two sheets of 2,048 slide over each other in one plane. Lids of 5,000 and 20,000 \
turn: candidates of
elements at margin 0.

| | | found |
|---|---|---|
{shapes_found}

## Triangles that share a vertex, crossing edges, curves

By `cargo run --release -p pliant-bench --example windows -- NAME ... --rounds 300`; one thread, f32
unless said, over the query beside it.

| what | aim, at most | found | windows |
|---|--:|--:|---|
| triangles that share a vertex, flat cloth of 79,202 | 1.5 times | 2.1: missed | `flat`, `flatstar` |
| the same, two spheres of 20,480 | 1.5 times | 1.7: missed | `sphere`, `star` |
| the same, the cloth folded | 1.5 times | 1.5 | `cloth`, `foldstar` |
| the same, f64 | 1.2 times | 1.4: missed | `double`, `doubstar` |
| crossing edges of two spheres, 3,742 pairs | no aim | 1.4 more | `deepest`, `edges` |
| segments and curves of these | 0.5 more | 2.7 more: missed | `deepest`, `curves` |
"""


def more_threads(file):
    """Machine, cost of a part in microseconds, and rows of the table of many threads."""
    record = json.loads(file.read_text())
    rows = []
    for one in record["measured"]:
        back = one["held_back"]
        shares = [f"{100 * back[name]:.0f} %" for name in ("serial", "uneven", "waits")]
        cells = [one["scene"], one["question"], f"{one['one_thread_ms']:.3f}"]
        cells += [f"{times:.1f}" for times in one["predicted"]] + shares
        cells.append(", ".join(f"x{count} {times:.2f}" for count, times in one["measured"]))
        rows.append("| " + " | ".join(cells) + " |")
    return record["cores_of"], 1e3 * record["wait_ms"], "\n".join(rows)


def newest(pattern):
    return sorted((HERE / "records").glob(pattern))[-1]


def beside_ipctk():
    """Newest comparison of candidates with ipctk: its name, its header, rows of its table."""
    file = newest("ipctk-*.txt")
    lines = file.read_text().splitlines()
    rows = []
    for line in lines:
        words = re.split(r"\s{2,}", line.strip())
        if len(words) == 11 and words[4] == "0":
            rows.append(f"| {' | '.join(words[:4] + words[5:])} |")
    assert rows and lines[-1].endswith("errors, of any kind: 0"), file
    return file.name, lines[0], "\n".join(rows)


def beside_rust():
    """Newest cost of calls from C, in the form of `beside_ipctk`."""
    file = newest("c-*.txt")
    lines = file.read_text().splitlines()
    rows = [line.split() for line in lines if line.startswith("pliant_")]
    assert rows, file
    header = f"{lines[0].split(':')[0]}; {lines[-1]}"
    return file.name, header, "\n".join(f"| {' | '.join(row)} |" for row in rows)


def beside_ipctk_codimensional():
    """Newest comparison of edges and points with ipctk: its name, header, and totals in words."""
    file = newest("codim-ipctk-*.txt")
    lines = file.read_text().splitlines()
    names = lines[2].split()
    # The last row is of all scenes.
    found = dict(zip(names, lines[-1].split()[1:]))
    assert found["its_alone"] == found["errors"] == "0", file
    return file.name, lines[0], found


def beside_ipctk_adapter():
    """Newest comparison of the adapter with ipctk: its name, header, and totals in words."""
    file = newest("adapter-ipctk-*.txt")
    lines = file.read_text().splitlines()
    rows, more, factors = 0, 0, []
    for line in lines:
        words = re.search(r"([\d,]+) +([\d,]+) +0   adapter ([\d.]+) ms, .* ([\d.]+) ms", line)
        if words:
            _, alone, adapter, own = words.groups()
            rows += 1
            more += int(alone.replace(",", ""))
            factors.append(float(adapter) / float(own))
    assert rows and lines[-1].endswith("errors: 0"), file
    found = (
        f"on the {rows} rows above no pair is its alone, and {more:,} are ipctk's, within its "
        f"rounding.\nIt takes {min(factors):.2f} to {max(factors):.2f} times as long as the lists "
        "themselves, with the toolkit's objects made of them."
    )
    return file.name, lines[0], found


def beside_ipctk_close():
    """Newest comparison of close pairs with ipctk, in the form of `beside_ipctk`."""
    file = newest("close-ipctk-*.txt")
    lines = file.read_text().splitlines()
    rows = []
    for line in lines:
        words = re.split(r"\s{2,}", line.strip())
        if len(words) == 9 and words[5] == "0":
            name, what, pairs, features, ties, _, own, other, factor = words
            rows.append(
                f"| {name} | {what} | {pairs} | {features} | {ties} | {own} | {other} | {factor} |"
            )
    assert rows and lines[-1].endswith("errors, of any kind: 0"), file
    return file.name, lines[0], "\n".join(rows)


def beside_ipctk_impacts():
    """Newest comparison of impacts with ipctk, in the form of `beside_ipctk`."""
    file = newest("impacts-ipctk-*.txt")
    lines = file.read_text().splitlines()
    rows = []
    for line in lines:
        words = re.fullmatch(
            r"(.+?)\s+(0\.1|1)"
            + r"\s+([\d,]+)" * 2
            + r"\s+[\d.]+" * 3
            + r"\s+(\d+)"
            + r"\s+([\d.]+)" * 6,
            line.rstrip(),
        )
        if words:
            rows.append("| " + " | ".join(words.groups()) + " |")
    assert rows and lines[-1].endswith("that are: 0"), file
    return file.name, lines[0], "\n".join(rows)


def beside_fcl():
    """Newest comparison of distances with FCL, in the form of `beside_ipctk`."""
    file = newest("close-fcl-*.txt")
    lines = file.read_text().splitlines()
    rows = []
    for line in lines:
        words = re.split(r"\s{2,}", line.strip())
        if len(words) == 7 and words[1] == "0":
            name, _, own, making, asking, whole, alone = words
            rows.append(f"| {name} | {own} | {making} | {asking} | {whole} | {alone} |")
    assert rows and lines[-1].endswith(": 0"), file
    return file.name, lines[0], "\n".join(rows)


def table_of_the_readme(record, date):
    lines = [
        (
            "Milliseconds a step, update and query, one thread of an"
            f" {record.machine['processor']}, {date}; all methods with the same exact decision and"
            " equal"
        ),
        "pair lists (`cargo run --release --features peers -- bench peers`).",
        "",
        "| | pliant | " + " | ".join(PEERS.values()) + " | times faster than the fastest of them |",
        "|---|---|---|---|---|---|",
    ]
    for contest, window, name in LINES:
        own = record.ms("peers", contest, PLIANT, window)
        peers = [record.ms("peers", contest, peer, window) for peer in PEERS]
        shown = " | ".join(f"{time:.3f}" for time in peers)
        lines.append(f"| {name} | **{own:.3f}** | {shown} | {min(peers) / own:.1f} |")
    bergen = record.times("experiment-1", 0, PLIANT, LOCAL)
    lines += [
        "",
        (
            f"Over the faithful van den Bergen (1997), in the paper's experiment 1: {bergen:.1f}"
            " times."
        ),
    ]
    return "\n".join(lines)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    date = sys.argv[1]
    record = Record(HERE / "records" / f"{date}.json")
    (HERE / "RESULTS.md").write_text(page(record, date))
    readme = HERE.parent / "README.md"
    text = readme.read_text()
    begin, end = "<!-- benchmarks/results.py writes this -->\n", "<!-- to here -->\n"
    before, rest = text.split(begin)
    readme.write_text(
        before + begin + table_of_the_readme(record, date) + "\n" + end + rest.split(end)[1]
    )


if __name__ == "__main__":
    main()
