"""The examples, run."""

from __future__ import annotations

import json
import os
import runpy
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import HERE, data, fold, grid

EXAMPLES = HERE.parent / "examples"


@pytest.fixture(autouse=True)
def examples(monkeypatch: pytest.MonkeyPatch) -> None:
    """Makes them modules."""
    monkeypatch.syspath_prepend(EXAMPLES)


def run(name: str, *arguments: object, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> str:
    monkeypatch.setattr(sys, "argv", [name, *map(str, arguments)])
    runpy.run_path(str(EXAMPLES / name), run_name="__main__")
    return capsys.readouterr().out


@pytest.mark.parametrize("readme", [HERE.parent / "README.md", HERE.parents[2] / "README.md"], ids=["package", "repository"])
def test_readme(readme: Path) -> None:
    """Its block of Python, on a sheet that meets itself in the end."""
    faces, flat = grid(20)
    frames = [fold(flat, amount) for amount in (0, 0.5, 1)]
    names: dict[str, Any] = {"faces": faces, "vertices": flat, "frames": frames}
    exec(readme.read_text().split("```python\n")[1].split("```")[0], names)
    np.testing.assert_array_equal(names["hits"][:, [1, 3]], pliant.reference.self_intersection_pairs(frames[-1], faces))
    assert len(names["hits"]) > 0


def test_examples_of_the_readme(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """All its blocks of Python behind the first, one after the other; they assert what they say."""
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    blocks = (HERE.parent / "README.md").read_text().split("```python\n")[2:]
    for block in blocks:
        exec(block.split("```")[0], names)
    assert len(blocks) == 8 and capsys.readouterr().out.startswith("0 0 (0, 4)\n1 ")


def test_commands_of_the_readme(tmp_path: Path) -> None:
    """Those that install nothing, beside a sheet that meets itself in one of two frames."""
    faces, flat = grid(20)
    np.savez(tmp_path / "cloth.npz", vertices=np.stack([flat, fold(flat, 1)]), faces=faces)
    blocks = (HERE.parent / "README.md").read_text().split("```sh\n")[1:]
    lines = [line for block in blocks for line in block.split("```")[0].splitlines()]
    commands = [shlex.split(line, comments=True)[1:] for line in lines if line.startswith("python -")]
    said = [subprocess.run([sys.executable, *words], cwd=tmp_path, check=True, capture_output=True, text=True).stdout for words in commands]
    assert len(said) == 2 and "intersections(" in said[0]
    assert [int(line.split()[1]) > 0 for line in said[1].splitlines()] == [False, True]


def test_tearing_cloth_of_the_guide() -> None:
    """Its block of Python: along the middle a cloth of 128 triangles comes to have two edges that part."""
    names: dict[str, Any] = {}
    guide = (HERE.parents[2] / "crates/pliant/guide/change.md").read_text()
    (block,) = guide.split("```python\n")[1:]
    exec(block.split("```")[0], names)
    world, cloth = names["world"], names["cloth"]
    assert world.bodies() == [cloth, cloth + 1]
    assert sum(int(world.live_triangles(body).sum()) for body in world.bodies()) == 128
    assert len(names["positions"]) == 81 + 9


def test_human_morph(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Frames 0, 30 and 59 were counted in rational arithmetic: shared/data/SOURCES.md."""
    file = data("human-morph.npz")
    said = run("human_morph.py", file, monkeypatch=monkeypatch, capsys=capsys).splitlines()
    counts = [int(line.split()[1]) for line in said[:60]]
    assert (counts[0], counts[30], counts[59]) == (88, 30, 88)
    assert said[-1] == "59 of 60 frames intersect; most pairs: 536 in frame 50"
    # Reading the file ourselves, or pliant.check: the same.
    assert [frame.count for frame in pliant.check(file)] == counts


def test_human_morph_on_a_sheet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    faces, flat = grid(20)
    frames = np.stack([fold(flat, amount) for amount in (0, 1, 0.5)])
    np.savez(tmp_path / "sheet.npz", vertices=frames, faces=faces)
    said = run("human_morph.py", tmp_path / "sheet.npz", monkeypatch=monkeypatch, capsys=capsys)
    expected = [len(pliant.reference.self_intersection_pairs(frame, faces)) for frame in frames]
    assert expected[1] > 0
    assert [int(line.split()[1]) for line in said.splitlines()[:3]] == expected


def test_cloth_on_ball() -> None:
    """What the Rust test of the same name checks of the Rust example: the cloth stays on the ball and outside it."""
    from cloth_on_ball import RADIUS, STEPS_A_SECOND, Simulation

    simulation, met = Simulation(), 0
    for step in range(2 * STEPS_A_SECOND):
        met += simulation.step() > 0
        assert simulation.depth() < 0.02, step
    assert met > STEPS_A_SECOND
    assert abs(simulation.height() - RADIUS) < 0.02


def test_cloth_on_ball_keeps_its_thickness() -> None:
    """What the Rust test says of the Rust example: nothing comes nearer than 0.9 of the thickness."""
    from cloth_on_ball import RADIUS, STEPS_A_SECOND, THICK, Simulation

    simulation, met = Simulation(), 0
    for step in range(2 * STEPS_A_SECOND):
        met += simulation.step_apart() > 0
        assert simulation.gap() >= 0.9 * THICK, step
    assert met > STEPS_A_SECOND
    # It rubs, and so slides down slowly: its middle is somewhat lower than at first.
    assert abs(simulation.height() - RADIUS - THICK) < 0.03


def test_nothing_gets_through_in_free_steps() -> None:
    """What the Rust test says of the Rust example: no frame intersects, and nothing ever comes nearer than the gap."""
    import pliant
    from cloth_on_ball import FREE_STEPS_A_SECOND, GAP, RADIUS, THICK, Simulation

    simulation, most = Simulation(), 0
    for step in range(2 * FREE_STEPS_A_SECOND):
        most = max(most, simulation.step_free())
        assert simulation.world.intersections(pliant.Selection.EVERYTHING).first() is None, step
        assert simulation.gap() > GAP, step
    assert most > 1  # some steps were too long to be free at once
    assert abs(simulation.height() - RADIUS - THICK) < 0.02


def test_cloth_on_ball_prints(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    said = run("cloth_on_ball.py", 1, monkeypatch=monkeypatch, capsys=capsys).splitlines()
    assert len(said) == 4 and said[-1].startswith(" 1.00 s: ")
    said = run("cloth_on_ball.py", 1, "apart", monkeypatch=monkeypatch, capsys=capsys).splitlines()
    assert len(said) == 4 and said[-1].endswith(" mm apart")
    said = run("cloth_on_ball.py", 1, "free", monkeypatch=monkeypatch, capsys=capsys).splitlines()
    assert len(said) == 4 and said[-1].endswith(" plans")


class TestTrimeshManager:
    """The manager beside trimesh's own."""

    @pytest.fixture(autouse=True)
    def needs(self) -> None:
        pytest.importorskip("trimesh")

    def test_it_falls(self, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
        said = run("trimesh_manager.py", monkeypatch=monkeypatch, capsys=capsys).splitlines()
        assert said[0] == "step 0: 0 pairs of triangles"
        assert said[-1].endswith("pairs of triangles ('falling', 'standing')")

    def test_it_says_what_fcl_says(self) -> None:
        pytest.importorskip("fcl")
        pytest.importorskip("scipy")  # which trimesh's own asks for
        import trimesh
        from trimesh.collision import CollisionManager as OfTrimesh
        from trimesh_manager import CollisionManager

        random = np.random.default_rng(7)
        meshes = [trimesh.creation.icosphere(subdivisions=2), trimesh.creation.box(), trimesh.creation.torus(1.0, 0.25)]
        managers: list[Any] = [CollisionManager(), OfTrimesh()]

        def somewhere() -> Any:
            matrix = trimesh.transformations.random_rotation_matrix(random.random(3))
            matrix[:3, 3] = random.uniform(-4, 4, 3)
            return matrix

        for number in range(24):
            matrix = somewhere()
            for manager in managers:
                manager.add_object(f"object {number}", meshes[number % 3], matrix)
        hits = 0
        for _ in range(6):
            answers = [manager.in_collision_internal(return_names=True) for manager in managers]
            ours, theirs = ((hit, {tuple(sorted(pair)) for pair in names}) for hit, names in answers)
            assert ours == theirs
            hits += len(ours[1])
            assert managers[0].in_collision_internal() == ours[0]
            single = somewhere()
            singles = [manager.in_collision_single(meshes[0], single, return_names=True) for manager in managers]
            assert singles[0] == singles[1]
            moved, matrix = f"object {random.integers(1, 24)}", somewhere()
            for manager in managers:
                manager.set_transform(moved, matrix)
        for manager in managers:
            manager.remove_object("object 0")
        names = [manager.in_collision_internal(return_names=True)[1] for manager in managers]
        assert {tuple(sorted(pair)) for pair in names[0]} == {tuple(sorted(pair)) for pair in names[1]}
        assert hits > 50

    def test_contacts_are_all_pairs_of_triangles(self) -> None:
        import trimesh
        from trimesh_manager import CollisionManager

        ball = trimesh.creation.icosphere(subdivisions=2)
        moved = ball.copy()
        moved.vertices = ball.vertices * [1.0, 0.5, 1.5]
        manager = CollisionManager()
        manager.add_object("a", ball)
        manager.add_object("b", ball, trimesh.transformations.translation_matrix([5, 0, 0]))
        assert manager.in_collision_internal() is False
        manager.set_transform("b", np.eye(4))
        manager.set_vertices("b", moved.vertices)
        hit, contacts = manager.in_collision_internal(return_data=True)
        expected = pliant.reference.intersection_pairs(ball, moved).tolist()
        assert hit and [[contact.index("a"), contact.index("b")] for contact in contacts] == expected
        hit, names, contacts = manager.in_collision_single(moved, return_names=True, return_data=True)
        assert hit and names == {"a", "b"}
        of_a = [contact for contact in contacts if "a" in contact.names]
        assert [[contact.index("a"), contact.index("__external")] for contact in of_a] == expected


def test_folder_with_dask(tmp_path: Path) -> None:
    pytest.importorskip("dask.distributed")
    from dask.distributed import Client, LocalCluster
    from folder_with_dask import check_folder, tasks

    faces, flat = grid(16)
    for name, count in (("a.npz", 7), ("b.npz", 3), ("c.npz", 1)):
        shapes = [fold(flat, 0.2 + 0.1 * step).astype(np.float32) for step in range(count)]
        np.savez(tmp_path / name, vertices=np.stack(shapes), faces=faces)
    cut = tasks(tmp_path, 3)
    assert [task.frames for task in cut] == [range(3), range(3, 6), range(6, 7), range(3), range(1)]

    serial = {str(file): list(pliant.check(file)) for file in sorted(tmp_path.glob("*.npz"))}
    assert sum(frame.count for frame in serial[str(tmp_path / "a.npz")]) > 0
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        workers = set(client.run(os.getpid).values())
        assert len(workers) == 2 and os.getpid() not in workers
        for frames_per_task in (3, 100):
            checked = check_folder(client, tmp_path, frames_per_task)
            assert list(checked) == list(serial)
            for file, frames in checked.items():
                assert [frame.frame for frame in frames] == [frame.frame for frame in serial[file]]
                for frame, expected in zip(frames, serial[file]):
                    np.testing.assert_array_equal(frame.pairs, expected.pairs)


def test_cloth_with_a_barrier_never_intersects(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("scipy")
    said = run("ipc_cloth.py", 8, monkeypatch=monkeypatch, capsys=capsys).splitlines()
    assert len(said) == 8 and all(line.endswith(", 0 intersections") for line in said)
    # It has come near the ball, and stays away from it.
    near = [float(line.split(" iterations, ")[1].split()[0]) for line in said]
    assert near[0] > 0.08 and 0 < near[-1] < 0.05


def test_knot_in_a_cable_holds(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Pulled until nothing goes any further, it is still there: without it the ends would be as far apart as the cable is long."""
    import cable as example

    said = run("cable.py", 41, monkeypatch=monkeypatch, capsys=capsys).splitlines()
    assert len(said) == 3 and said[0].startswith("step 0: 0.999 from itself, ends 74.1 apart")
    monkeypatch.setattr(example, "PULL", 1.0)
    cable = example.Cable()
    for step in range(100):
        free = cable.step()
        assert cable.nearest() > example.GAP, step
        if free < 1e-3:
            break
    assert free < 1e-3 and step > 50
    length = np.linalg.norm(np.diff(cable.x, axis=0), axis=1).sum()
    assert np.linalg.norm(cable.x[-1] - cable.x[0]) < length - 10 < 1.2 * example.EDGES


def test_net_hangs_over_a_ball(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from net_on_ball import GAP, RADIUS, THICK, Simulation

    simulation = Simulation()
    for step in range(35):
        near = simulation.step()
        nearest = simulation.world.distance(simulation.net, simulation.ball)
        assert nearest and nearest.distance > GAP, step
        assert simulation.world.intersections(pliant.Selection.EVERYTHING).first() is None, step
    # Faces of the ball are up to one per cent inside of it.
    assert np.linalg.norm(simulation.x, axis=1).min() > 0.98 * RADIUS + 0.9 * THICK
    assert simulation.x[:, 2].min() < -0.5 and nearest and nearest.distance > 0.8 * THICK
    # The net meets the ball in all kinds of contacts, and itself where it folds.
    assert set(near.kind.tolist()) == set(pliant.FeatureKind)
    assert (near.bodies == simulation.net).all(axis=1).any() and (near.bodies[:, 1] == simulation.ball).any()
    said = run("net_on_ball.py", 11, monkeypatch=monkeypatch, capsys=capsys).splitlines()
    assert len(said) == 2 and said[0] == "step 0: 0.1030 from the ball, 0 contacts, lowest at 0.60"


def test_garments(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Their counts are those of brute force, and of the program where PLIANT names it."""
    folder = tmp_path / "set"
    assert "of 6 drapes have faults" in run("garments.py", folder, 6, 300, monkeypatch=monkeypatch, capsys=capsys)
    truth = [list(map(int, row.split(","))) for row in (folder / "truth.csv").read_text().splitlines()[1:]]
    lines = (folder / "list.txt").read_text().splitlines()
    for number, line in enumerate(lines):
        meshes = [read_obj(Path(name)) for name in line.split("\t")]
        (faces, points), (others, where) = meshes
        pairs = pliant.reference.intersection_pairs(points, faces, where, others)
        own = pliant.reference.self_intersection_pairs(points, faces)
        assert truth[number][:3] == [number, len(pairs), len(own)]
    assert any(row[1] for row in truth) and any(row[2] for row in truth) and not all(row[2] for row in truth)
    program = os.environ.get("PLIANT")
    if program is not None:
        subprocess.run([program, "check", "--self", "--files-from", folder / "list.txt", "--out", tmp_path / "rows", "--ignore-adjacent"], check=False)
        rows = sorted(map(json.loads, (tmp_path / "rows").read_text().splitlines()), key=lambda row: int(row["line"]))
        assert [[row["pairs"], row["crossing_edges"]] for row in rows] == [[row[1] + row[2], row[3] + row[4]] for row in truth]


def read_obj(path: Path) -> tuple[Any, Any]:
    rows = [line.split() for line in path.read_text().splitlines()]
    faces = np.array([[int(corner) - 1 for corner in row[1:]] for row in rows if row[0] == "f"], np.uint32)
    return faces, np.array([list(map(float, row[1:])) for row in rows if row[0] == "v"])
