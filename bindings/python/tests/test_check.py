"""pliant.check: what `pliant check --format json` says."""

from __future__ import annotations

import json
import os
import struct
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import data, fold, grid

FACES, FLAT = grid(20)
FRAMES = np.stack([fold(FLAT, step / 5) for step in range(6)]).astype(np.float32)


def obj(path: Path, positions: Any, faces: Any) -> None:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in positions.tolist()]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces.tolist()]
    path.write_text("\n".join(lines))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A sequence in one file, the same as a file a frame, and a body that stands still."""
    np.savez(tmp_path / "cloth.npz", vertices=FRAMES, faces=FACES)
    for number, frame in enumerate(FRAMES):
        obj(tmp_path / f"cloth_{number + 5}.obj", frame, FACES)
    obj(tmp_path / "still.obj", FLAT, FACES)
    return tmp_path


def by_hand(frame: int, *, itself: bool, still: bool) -> list[list[int]]:
    pairs = []
    if itself:
        pairs += [[0, i, 0, j] for i, j in pliant.reference.self_intersection_pairs(FRAMES[frame], FACES)]
    if still:
        pairs += [[0, i, 1, j] for i, j in pliant.reference.intersection_pairs(FRAMES[frame], FACES, FLAT, FACES)]
    return sorted(pairs)


def test_frames_are_those_of_the_reference(folder: Path) -> None:
    checked = pliant.check(folder / "cloth.npz")
    assert repr(checked) == "<pliant.Check of 1 body, 6 frames>" and checked.frame_count == 6
    (body,) = checked.bodies
    assert (body.name, body.vertices, body.triangles) == (str(folder / "cloth.npz"), 441, 800)
    assert body.faces is None and body.welded == 0
    frames = list(checked)
    assert [frame.frame for frame in frames] == list(range(6))
    for frame in frames:
        assert frame.pairs.tolist() == by_hand(frame.frame, itself=True, still=False)
        assert frame.count == len(frame.pairs) and frame.complete
        assert frame.pairs.dtype == np.uint32 and frame.pairs.shape[1:] == (4,)
    assert frames[0].count == 0 < frames[5].count
    assert list(checked) == [], "an iterator is read once"

    # A file a frame, and text of the same numbers, in natural order.
    again = [frame.pairs.tolist() for frame in pliant.check(str(folder / "cloth_*.obj"))]
    assert again == [frame.pairs.tolist() for frame in frames]


def test_several_bodies_and_only_the_first_pair(folder: Path) -> None:
    paths = (folder / "cloth.npz", folder / "still.obj")
    for itself in (False, True):
        frames = list(pliant.check(*paths, itself=itself))
        expected = [by_hand(frame, itself=itself, still=True) for frame in range(6)]
        for pairs in expected if itself else []:
            # Body 1, the sheet that lies flat, does not meet itself.
            assert all(pair[0] == 0 for pair in pairs)
        assert [frame.pairs.tolist() for frame in frames] == expected
        for frame, pairs in zip(pliant.check(*paths, itself=itself, first=True), expected):
            assert not frame.complete and frame.count == min(1, len(pairs))
            assert all(pair in pairs for pair in frame.pairs.tolist())


def said_apart(frame: pliant.Frame) -> dict[str, Any]:
    """What the program says of pairs that share a vertex, and of crossing edges."""
    edges = frame.crossing_edges
    said: dict[str, Any] = {} if edges is None else {"crossing_edges": [list(two) for two in edges]}
    adjacent = frame.adjacent
    if adjacent is None:
        return said
    said |= {"adjacent": adjacent.count, "adjacent_pairs": adjacent.pairs.tolist()}
    some = {
        "adjacent_kinds": adjacent.kinds._asdict() if adjacent.count else None,
        "twice": adjacent.twice or None,
        "adjacent_left_out": adjacent.left_out,
        "adjacent_only_touching": adjacent.only_touching,
        "adjacent_degenerate": adjacent.degenerate or None,
    }
    return said | {name: value for name, value in some.items() if value is not None}


def said_inside(frames: list[pliant.Frame]) -> list[dict[str, Any]]:
    """What the program says of each frame: what lies inside, and which bodies are open, where that changes."""
    said: list[dict[str, Any]] = []
    before: tuple[int, ...] = ()
    for frame in frames:
        said.append({"inside": [list(it) for it in frame.inside]} | ({"not_closed": list(frame.not_closed)} if frame.not_closed != before else {}))
        before = frame.not_closed
    return said


def test_places(folder: Path) -> None:
    paths = (folder / "cloth.npz", folder / "still.obj")
    assert all(frame.places is None for frame in pliant.check(*paths, itself=True))
    checked = pliant.check(*paths, itself=True, places=True)
    assert list(checked.places) == []
    lives: dict[int, list[int]] = {}
    for frame in checked:
        assert frame.places is not None
        assert frame.adjacent is not None
        assert sum(place.count for place in frame.places) == frame.count + frame.adjacent.count
        counts = [place.count for place in frame.places]
        assert counts == sorted(counts, reverse=True)
        for place in frame.places:
            lives.setdefault(place.number, []).append(frame.frame)
            assert list(place.first_pair) in frame.pairs.tolist() + frame.adjacent.pairs.tolist()
            assert all(low <= high for low, high in zip(place.lower, place.upper))
            assert {place.first_pair[0], place.first_pair[2]} <= {there.body for there in place.bodies}
    assert lives
    said = {life.worst.number: (life.first_frame, life.last_frame) for life in checked.places}
    assert said == {number: (frames[0], frames[-1]) for number, frames in lives.items()}
    (first, *_) = pliant.check(*paths, itself=True, places=True, first=True)
    assert first.places is None


@pytest.mark.parametrize("frames", [range(0), range(2), range(2, 5), range(1, 6, 2), range(5, 6), range(0, 6, 5)])
def test_ranges_of_frames(folder: Path, frames: range) -> None:
    paths = (folder / "cloth.npz", folder / "still.obj")
    every = {frame.frame: frame.pairs.tolist() for frame in pliant.check(*paths, itself=True)}
    some = {frame.frame: frame.pairs.tolist() for frame in pliant.check(*paths, itself=True, frames=frames)}
    assert some == {number: every[number] for number in frames}


@pytest.mark.parametrize("frames", [range(7), range(6, 7), range(-1, 2), range(5, 0, -1)])
def test_frames_that_are_not_there(folder: Path, frames: range) -> None:
    with pytest.raises(pliant.Error, match="frames") as refused:
        pliant.check(folder / "cloth.npz", frames=frames)
    assert refused.value.kind == "BadOption"


def test_groups_of_an_obj_file(tmp_path: Path) -> None:
    path = tmp_path / "scan.obj"
    corners = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 4 4 0\nv 1 1 -1\nv 1 1 1\nv 1 2 1\n"
    path.write_text(corners + "o flat\nf 1 2 3\no next\nf 2 4 3\no up\ng skin\nf 5 6 7\n")
    whole = pliant.check(path)
    assert [body.name for body in whole.bodies] == [str(path)]
    assert [frame.pairs.tolist() for frame in whole] == [[[0, 0, 0, 2]]]

    split = pliant.check(path, split="groups")
    assert [body.name for body in split.bodies] == [f"{path}#flat", f"{path}#next", f"{path}#up/skin"]
    assert [(body.source, body.first_triangle, body.vertices) for body in split.bodies] == [(0, n, 3) for n in range(3)]
    assert [frame.pairs.tolist() for frame in split] == [[[0, 0, 2, 2]]]
    (frame,) = pliant.check(path, split="groups", ignore=[(f"{path}#up", f"{path}#flat")])
    assert frame.count == 0

    # Triangles that share a vertex of the file are left out across arguments too.
    for names, pairs in [(("flat", "next"), []), (("up", "flat"), [[0, 2, 1, 0]])]:
        named = pliant.check(*(f"{path}#{name}" for name in names))
        assert [body.name for body in named.bodies] == [f"{path}#{name}" for name in names]
        assert [frame.pairs.tolist() for frame in named] == [pairs]

    with pytest.raises(pliant.Error, match='no body "arm"; it has: flat, next, up/skin'):
        pliant.check(f"{path}#arm")
    with pytest.raises(pliant.Error, match="not split into connected pieces; name the whole file$"):
        pliant.check(f"{path}#up", split="components")
    with pytest.raises(pliant.Error, match='named by two arguments, ".*#up" and ".*#up/skin"; leave out one of the two$'):
        pliant.check(f"{path}#up", f"{path}#up/skin")


def test_seams_are_welded_unless_told_otherwise(tmp_path: Path) -> None:
    faces, positions = grid(4)
    left, right = positions[faces[: len(faces) // 2].ravel()], positions[faces[len(faces) // 2 :].ravel()]
    corners = np.concatenate([left, right])
    obj(tmp_path / "split.obj", corners, np.arange(len(corners)).reshape(-1, 3))
    welded = pliant.check(tmp_path / "split.obj")
    assert welded.bodies[0].welded == len(corners) - len(positions)
    assert next(welded).count == 0
    apart = pliant.check(tmp_path / "split.obj", weld=False)
    assert apart.bodies[0].welded == 0 and next(apart).count > 0


def test_a_seam_that_parts_is_open_there_and_said_once(tmp_path: Path) -> None:
    # Two triangles whose edges coincide, then differ by a rounding, then are far apart.
    closed = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 0], [0, -1, 0]], np.float32)
    frames = np.stack([closed] * 4)
    frames[1, 4, 1] = 1e-7
    frames[2, 3:, 1] -= 5
    np.savez(tmp_path / "seam.npz", vertices=frames, faces=np.arange(6).reshape(-1, 3))
    checked = pliant.check(tmp_path / "seam.npz", swept=True)
    words = "open in 2 frames, 1 to 2, and widest in frame 2: 2 vertices part there, .*weld_tolerance=1e-6 keeps"
    with pytest.warns(UserWarning, match=words) as warned:
        found = list(checked)
    assert [frame.count for frame in found] == [0, 1, 0, 0]
    assert all(frame.changed == {} and (frame.interval is None or frame.interval.changed == ()) for frame in found)
    assert len([it for it in warned if "seams that are closed" in str(it.message)]) == 1
    with pytest.warns(UserWarning, match="open in frame 2: .* the sides of an open seam may intersect$"):
        assert [frame.count for frame in pliant.check(tmp_path / "seam.npz", weld_tolerance=1e-6)] == [0] * 4
    frame_alone = tmp_path / "one.npz"
    np.savez(frame_alone, vertices=frames[1], faces=np.arange(6).reshape(-1, 3))
    with pytest.warns(UserWarning, match="nearly coincide"):
        assert [frame.count for frame in pliant.check(frame_alone)] == [1]


def test_arrays_and_files_that_people_have_are_read_and_that_is_said(tmp_path: Path) -> None:
    faces, positions = grid(3)
    frames = np.stack([positions, positions + 1])
    cases: list[tuple[dict[str, Any], str]] = [
        ({"verts": frames, "faces": faces}, "is called `verts`, not `vertices`"),
        ({"v": frames, "f": faces}, "is called `f`, not `faces`"),
        ({"vertices": np.asfortranarray(frames), "faces": faces}, "Fortran order"),
        ({"vertices": frames, "faces": np.asfortranarray(faces)}, "the array of faces is in Fortran order"),
        ({"vertices": frames.astype(np.float16), "faces": faces}, "float32"),
        ({"vertices": (frames * 9).astype(np.int64), "faces": faces}, "float64"),
    ]
    for written, words in cases:
        np.savez(tmp_path / "a.npz", **written)
        with pytest.warns(UserWarning, match=words):
            checked = pliant.check(tmp_path / "a.npz")
        assert [frame.count for frame in checked] == [0, 0], words
    obj(tmp_path / "mesh.obj", positions, faces)
    np.save(tmp_path / "walk.npy", frames)
    assert [frame.count for frame in pliant.check(f"{tmp_path / 'mesh.obj'}+{tmp_path / 'walk.npy'}")] == [0, 0]
    (tmp_path / "lfs.ply").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n")
    with pytest.raises(pliant.Error, match="Git LFS pointer"):
        pliant.check(tmp_path / "lfs.ply")
    (tmp_path / "a.fbx").write_text("x")
    with pytest.raises(pliant.Error, match="export glTF"):
        pliant.check(tmp_path / "a.fbx")
    facet = "facet\nouter loop\nvertex {0} 0 0\nvertex 1 0 {0}\nvertex 0 1 0\nendloop\nendfacet\n"
    (tmp_path / "two.stl").write_text(f"solid a\n{facet.format(0)}end solid\nsolid a\n{facet.format(9)}")
    with pytest.warns(UserWarning, match="end solid"):
        checked = pliant.check(tmp_path / "two.stl", split="groups")
    assert [body.name.split("#")[1] for body in checked.bodies] == ["a", "a (solid 2)"]
    np.savez(tmp_path / "a.npz", vertices=frames, faces=faces)
    with pytest.raises(pliant.Error, match='names no groups of its faces; give split="components"'):
        pliant.check(tmp_path / "a.npz", split="groups")


def test_bodies_of_other_units_are_said_if_nothing_is_found(tmp_path: Path) -> None:
    faces, positions = grid(2)
    obj(tmp_path / "a.obj", positions, faces)
    obj(tmp_path / "b.obj", positions * 1000 + [0, 0, 5], faces)
    with pytest.warns(UserWarning, match="b.obj is .* that of .*a.obj .*: are they of one unit"):
        assert [frame.count for frame in pliant.check(tmp_path / "a.obj", tmp_path / "b.obj")] == [0]


def test_advice_is_in_keywords_of_python(tmp_path: Path) -> None:
    closed = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 0], [0, -1, 0]], np.float32)
    np.savez(tmp_path / "seam.npz", vertices=np.stack([closed, closed]), faces=np.arange(6).reshape(-1, 3))

    # A mesh of two frames beside positions of one.
    (tmp_path / "one.mdd").write_bytes(struct.pack(">iif", 1, 6, 0) + closed.astype(">f4").tobytes())
    message = "has 2 frames; the mesh beside positions must have one; write one frame of it to a file, and name that$"
    with pytest.raises(pliant.Error, match=message):
        pliant.check(f"{tmp_path / 'seam.npz'}+{tmp_path / 'one.mdd'}")

    # A header of more than a frame may take.
    rows = 2**32 - 1
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {rows}\nproperty double x\nproperty double y\nproperty double z\n"
    header += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "large.ply").write_text(header)
    with pytest.raises(pliant.Error, match="a frame needs at least .* of memory, 4 GiB are allowed; split the mesh$"):
        pliant.check(tmp_path / "large.ply")


def test_polygons_are_named(tmp_path: Path) -> None:
    (tmp_path / "square.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    faces = pliant.check(tmp_path / "square.obj").bodies[0].faces
    assert faces is not None and faces.tolist() == [0, 0]


def test_errors_name_file_place_and_frame(folder: Path) -> None:
    with pytest.raises(pliant.Error, match="absent.obj: no such file") as refused:
        pliant.check(folder / "absent.obj")
    assert (refused.value.kind, refused.value.file, refused.value.place) == ("CannotRead", str(folder / "absent.obj"), None)

    (folder / "cloth_7.obj").write_text("v 0 0 0\nv 1 0 zero\n")
    checked = pliant.check(folder / "cloth_*.obj")
    assert [next(checked).frame, next(checked).frame] == [0, 1], "the frames before can be checked"
    for _ in range(2):
        with pytest.raises(pliant.Error) as refused:
            next(checked)
    with pytest.raises(pliant.Error) as refused:
        list(pliant.check(folder / "cloth_*.obj"))
    assert (refused.value.file, refused.value.place) == (str(folder / "cloth_7.obj"), "line 2")

    np.savez(folder / "three.npz", vertices=FRAMES[:3], faces=FACES)
    with pytest.raises(pliant.Error, match="cloth.npz has 6 frames and .*three.npz has 3; a body must have"):
        pliant.check(folder / "cloth.npz", folder / "three.npz")
    with pytest.raises(pliant.Error, match="no file was given to check"):
        pliant.check()


def test_a_pattern_that_was_expanded_too_early_is_a_warning(folder: Path) -> None:
    paths = [folder / "cloth_5.obj", folder / "cloth_6.obj"]
    with pytest.warns(UserWarning, match=r"give the pattern: .*cloth_\*.obj"):
        pliant.check(*paths)


def test_counts_of_real_meshes() -> None:
    """Counted in rational arithmetic: shared/data/SOURCES.md."""
    counts = {
        "cloth-funnel/227.ply": 261,
        "cloth-funnel/228.ply": 332,
        "armadillo-rollers/327.ply": 0,
        "ipc-toolkit/two-cubes-intersecting.ply": 96,
    }
    for name, count in counts.items():
        assert [frame.count for frame in pliant.check(data(name))] == [count]


def test_the_program_says_the_same(folder: Path) -> None:
    """Where PLIANT names the program."""
    program = os.environ.get("PLIANT")
    if program is None:
        pytest.skip("the environment variable PLIANT names no program `pliant` to compare with")
    paths = [str(folder / "cloth_*.obj"), str(folder / "still.obj")]
    for flags, options in (([], {}), (["--self"], {"itself": True}), (["--no-weld"], {"weld": False}), (["--first"], {"first": True})):
        said = json.loads(subprocess.run([program, "check", "--format", "json", *flags, *paths], capture_output=True).stdout)
        checked = pliant.check(*paths, crossing_edges=True, **options)  # type: ignore[arg-type]
        bodies = [
            {"name": body.name, "vertices": body.vertices, "triangles": body.triangles}
            | ({} if body.faces is None else {"faces": body.faces.tolist()})
            | ({"welded": body.welded} if body.welded else {})
            for body in checked.bodies
        ]
        all_frames = list(checked)
        frames = [
            {"frame": frame.frame, "count": frame.count, "pairs": frame.pairs.tolist()}
            | said_apart(frame)
            | inside
            | ({} if frame.complete else {"complete": False})
            | ({} if frame.kinds is None or not frame.count else {"kinds": frame.kinds._asdict()})
            for frame, inside in zip(all_frames, said_inside(all_frames), strict=True)
        ]
        # The program says where, too.
        there = [frame.pop("places", []) for frame in said["frames"]]
        said.pop("places", None)
        for body in said["bodies"]:
            lower, upper = body.pop("box")
            assert lower <= upper
        assert said == {"format": 1, "bodies": bodies, "frames": frames}
        if "--first" not in flags:
            found = [frame.places or () for frame in pliant.check(*paths, places=True, **options)]  # type: ignore[arg-type]
            assert [[(place["number"], place["count"]) for place in places] for places in there] == [
                [(place.number, place.count) for place in places] for places in found
            ]


def test_frames_before_are_not_read(folder: Path) -> None:
    (folder / "cloth_6.obj").write_text("nonsense")
    some = pliant.check(folder / "cloth_*.obj", folder / "still.obj", itself=True, frames=range(3, 6, 2))
    assert {frame.frame: frame.pairs.tolist() for frame in some} == {
        number: by_hand(number, itself=True, still=True) + self_pairs_of_still() for number in (3, 5)
    }
    with pytest.raises(pliant.Error, match="cloth_6.obj"):
        list(pliant.check(folder / "cloth_*.obj"))


def self_pairs_of_still() -> list[list[int]]:
    return [[1, i, 1, j] for i, j in pliant.reference.self_intersection_pairs(FLAT, FACES)]


def test_gltf_is_evaluated() -> None:
    fixtures = Path(__file__).parents[3] / "crates/pliant-io/tests/fixtures"
    checked = pliant.check(fixtures / "hierarchy.gltf", clip="steps", fps=10)
    names = [body.name.rpartition("#")[2] for body in checked.bodies]
    assert names == ["mirrored", "arm (node 3)", "arm (node 4)", "ground"]
    # 0.7 seconds at 10 a second, both ends.
    assert [frame.frame for frame in checked] == list(range(8)) and checked.frame_count == 8
    assert pliant.check(f"{fixtures / 'hierarchy.gltf'}#ground").bodies[0].vertices == 4
    with pytest.raises(pliant.Error, match='has no clip "fly"; it has: turn, steps, .*; choose one of these with clip=$'):
        pliant.check(fixtures / "hierarchy.gltf", clip="fly")
    with pytest.raises(pliant.Error, match="0 frames a second cannot be evaluated; .*above 0; give another fps=$"):
        pliant.check(fixtures / "hierarchy.gltf", fps=0)
    with pytest.raises(pliant.Error, match="more than 16777216 frames at 1.* a second; ask for fewer with fps=$"):
        pliant.check(fixtures / "hierarchy.gltf", fps=1e300)


def test_a_clip_of_what_has_none(folder: Path) -> None:
    with pytest.raises(pliant.Error, match="none of the files has one; leave out clip=$") as refused:
        pliant.check(folder / "cloth.npz", clip="walk")
    assert refused.value.kind == "BadOption"


@pytest.fixture
def pieces(tmp_path: Path) -> Path:
    """Two sheets that fold through each other as one file, their triangles mixed; three frames."""
    faces = np.concatenate([FACES, FACES + len(FLAT)])
    order = np.random.default_rng(7).permutation(len(faces))
    both = [np.concatenate([fold(FLAT, step / 2), fold(FLAT, step / 3) + [0, 0, 0.01]]) for step in range(3)]
    np.savez(tmp_path / "both.npz", vertices=np.stack(both), faces=faces[order])
    np.savez(tmp_path / "still.npz", vertices=FLAT, faces=FACES)
    return tmp_path


def test_pieces_are_bodies(pieces: Path) -> None:
    path = pieces / "both.npz"
    whole = {frame.frame: frame.pairs.tolist() for frame in pliant.check(path)}
    split = pliant.check(path, split="components", itself=True)
    assert [body.name for body in split.bodies] == [f"{path}#1", f"{path}#2"]
    assert [(body.source, body.vertices, body.triangles) for body in split.bodies] == [(0, 441, 800)] * 2
    assert split.bodies[0].first_triangle == 0 < split.bodies[1].first_triangle
    faces = np.load(path)["faces"]
    first_has = set(np.unique(faces[0] // 441).tolist())
    piece = [0 if {int(face[0]) // 441} == first_has else 1 for face in faces]
    assert split.bodies[1].first_triangle == piece.index(1)
    for frame in split:
        # The same triangles meet, with the names of their pieces.
        named = [sorted([[piece[i], i], [piece[j], j]]) for _, i, _, j in whole[frame.frame]]
        assert frame.pairs.tolist() == sorted(a + b for a, b in named)
    between = [frame.pairs.tolist() for frame in pliant.check(path, split="components")]
    assert any(between) and all(pair[0] == 0 and pair[2] == 1 for pairs in between for pair in pairs)
    with pytest.raises(pliant.Error, match="split is 'halves'|split is \"halves\"") as refused:
        pliant.check(path, split="halves")  # type: ignore[arg-type]
    assert refused.value.kind == "BadOption"


def test_groups_and_pairs_that_are_ignored(pieces: Path) -> None:
    paths = (pieces / "both.npz", pieces / "still.npz")

    def bodies_that_meet(**options: Any) -> set[tuple[int, int]]:
        checked = pliant.check(*paths, split="components", **options)
        return {(pair[0], pair[2]) for frame in checked for pair in frame.pairs.tolist()}

    assert bodies_that_meet() == {(0, 1), (0, 2), (1, 2)}
    assert bodies_that_meet(ignore=[(0, 1)]) == {(0, 2), (1, 2)}
    assert bodies_that_meet(ignore=[(paths[1], f"{paths[0]}#1")]) == {(0, 1), (1, 2)}
    assert bodies_that_meet(ignore=[(str(paths[0]), paths[0])]) == {(0, 2), (1, 2)}
    assert bodies_that_meet(groups={"soft": [0, paths[1]]}, ignore=[("soft", 1)]) == {(0, 2)}
    assert bodies_that_meet(groups={"all": [0, 1, 2]}, ignore=[("all", "all")], itself=True) == set()
    bad: list[dict[str, Any]] = [{"ignore": [("hat", 0)]}, {"groups": {"g": [9]}}, {"groups": {"0": [1]}}, {"groups": {"g": []}}]
    for options in bad:
        with pytest.raises(pliant.Error) as refused:
            pliant.check(*paths, **options)
        assert refused.value.kind == "BadOption"
    with pytest.raises(pliant.Error, match='the group "g" has no bodies; give each group a list of its bodies$'):
        pliant.check(*paths, groups={"g": []})
    with pytest.raises(pliant.Error, match='no body or group is called "hat"; bodies: 0 = '):
        pliant.check(*paths, ignore=[("hat", 0)])


@pytest.mark.parametrize("baseline", range(3))
def test_only_what_is_new(pieces: Path, baseline: int) -> None:
    path = pieces / "both.npz"
    every = {frame.frame: frame.pairs.tolist() for frame in pliant.check(path)}
    known = every[baseline]
    assert known or baseline == 0
    for frames in (None, range(1, 3), range(0, 3, 2)):
        for frame in pliant.check(path, baseline=baseline, frames=frames):
            new = [pair for pair in every[frame.frame] if pair not in known]
            assert frame.pairs.tolist() == new and frame.count == len(new)
            assert frame.left_out == len(every[frame.frame]) - len(new)
    for frame in pliant.check(path, baseline=baseline, first=True):
        new = [pair for pair in every[frame.frame] if pair not in known]
        assert frame.count == min(1, len(new)) and all(pair in new for pair in frame.pairs.tolist())
        assert (frame.left_out is None) == bool(new)
    assert all(frame.left_out is None for frame in pliant.check(path))


@pytest.mark.parametrize("baseline", [-1, 3])
def test_baselines_that_are_not_there(pieces: Path, baseline: int) -> None:
    with pytest.raises(pliant.Error, match="baseline") as refused:
        pliant.check(pieces / "both.npz", baseline=baseline)
    assert refused.value.kind == "BadOption"


def test_the_program_says_the_same_of_pieces(pieces: Path) -> None:
    """Where PLIANT names the program."""
    program = os.environ.get("PLIANT")
    if program is None:
        pytest.skip("the environment variable PLIANT names no program `pliant` to compare with")
    paths = [str(pieces / "both.npz"), str(pieces / "still.npz")]
    flags = ["--split", "components", "--baseline", "1", "--group", "g=0,2", "--ignore", "g,g"]
    said = json.loads(subprocess.run([program, "check", "--format", "json", *flags, *paths], capture_output=True).stdout)
    checked = pliant.check(*paths, split="components", baseline=1, groups={"g": [0, 2]}, ignore=[("g", "g")], crossing_edges=True)
    fields = ("name", "vertices", "triangles", "source", "first_triangle")
    assert all(body.pop("box") for body in said["bodies"])
    assert said["bodies"] == [{field: getattr(body, field) for field in fields} for body in checked.bodies]
    for said_of_frame in said["frames"]:
        said_of_frame.pop("places", None)
    found = list(checked)
    assert said["frames"] == [
        {"frame": frame.frame, "count": frame.count, "left_out": frame.left_out, "pairs": frame.pairs.tolist()}
        | said_apart(frame)
        | inside
        | ({} if frame.kinds is None or not frame.count else {"kinds": frame.kinds._asdict()})
        for frame, inside in zip(found, said_inside(found), strict=True)
    ]


def soup(triangles: Any, by: float) -> tuple[Any, Any]:
    """Every triangle with corners of its own, moved a little."""
    positions = np.asarray(triangles, dtype=float).reshape(-1, 3)
    positions = positions + np.random.default_rng(1).uniform(-by, by, positions.shape)
    return positions, np.arange(len(positions)).reshape(-1, 3)


def test_near_seams_are_joined_if_asked_for_and_named_otherwise(tmp_path: Path) -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    obj(tmp_path / "part.obj", *soup(corners[[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]], 1e-9))
    checked = pliant.check(tmp_path / "part.obj")
    with pytest.warns(UserWarning, match=r"nearly coincide.*weld_tolerance=\S+ joins them"):
        (frame,) = checked
    assert frame.count > 0
    with pytest.warns(UserWarning, match="8 vertices were merged"):
        checked = pliant.check(tmp_path / "part.obj", weld_tolerance=1e-6)
    assert [frame.count for frame in checked] == [0] and checked.bodies[0].welded == 8
    with pytest.raises(pliant.Error, match="weld_tolerance="):
        pliant.check(tmp_path / "part.obj", weld_tolerance=2.0)
    with pytest.raises(pliant.Error, match="weld is False"):
        pliant.check(tmp_path / "part.obj", weld=False, weld_tolerance=1e-6)


def test_degenerate_triangles_may_be_left_out(tmp_path: Path) -> None:
    positions = np.array([[0, 0, -1], [0, 0, 1], [0, 0, 0.5], [-1, -1, 0.3], [2, -1, 0.3], [-1, 2, 0.3]], dtype=float)
    obj(tmp_path / "pole.obj", positions, np.array([[0, 1, 2], [3, 4, 5]]))
    (frame,) = pliant.check(tmp_path / "pole.obj")
    assert (frame.count, frame.degenerate) == (1, 1)
    (frame,) = pliant.check(tmp_path / "pole.obj", skip_degenerate=True)
    assert (frame.count, frame.degenerate) == (0, 1)


def test_an_earlier_check_is_a_baseline(folder: Path) -> None:
    last = list(pliant.check(folder / "cloth.npz"))[5]
    body = {"name": str(folder / "cloth.npz"), "triangles": len(FACES)}
    written = {"format": 1, "bodies": [body], "frames": [{"count": last.count, "pairs": last.pairs.tolist()}]}
    (folder / "old.json").write_text(json.dumps(written))
    by_file = list(pliant.check(folder / "cloth.npz", baseline=folder / "old.json"))
    by_frame = list(pliant.check(folder / "cloth.npz", baseline=5))
    assert [frame.pairs.tolist() for frame in by_file] == [frame.pairs.tolist() for frame in by_frame]
    assert by_file[5].left_out == last.count
    with pytest.raises(pliant.Error, match="name a file that"):
        pliant.check(folder / "cloth.npz", baseline=folder / "still.obj")


def test_files_in_memory_are_as_on_disk(folder: Path) -> None:
    files = {file.name: file.read_bytes() for file in folder.iterdir()}
    # The order of arguments, and names that are nowhere on disk.
    asked: list[tuple[str, ...]] = [("cloth.npz", "still.obj"), ("cloth_*.obj", "still.obj"), ("still.obj",)]
    for paths in asked:
        on_disk = list(pliant.check(*(folder / path for path in paths), itself=True))
        in_memory = list(pliant.check(*paths, files=files, itself=True))
        assert [frame.pairs.tolist() for frame in in_memory] == [frame.pairs.tolist() for frame in on_disk]
    assert [body.name for body in pliant.check("cloth.npz", files=files).bodies] == ["cloth.npz"]
    for path in ("nowhere.obj", str(folder / "still.obj"), "cloth.usda"):
        with pytest.raises(pliant.Error) as error:
            pliant.check(path, files=files)
        assert error.value.kind == "CannotRead"


def test_counts_are_the_sums_of_frames(folder: Path) -> None:
    paths = folder / "cloth.npz", folder / "still.obj"
    frames = list(pliant.check(*paths, itself=True, crossing_edges=True))
    counts = pliant.check(*paths, itself=True, crossing_edges=True).counts()
    assert counts.frames == len(frames) == 6
    assert counts.pairs == sum(frame.count for frame in frames) > 0
    assert counts.adjacent == sum(frame.adjacent.count for frame in frames if frame.adjacent)
    assert counts.touching == sum(frame.kinds.touching for frame in frames if frame.kinds)
    edges = [edges.edges for frame in frames for edges in frame.crossing_edges or ()]
    assert counts.crossing_edges == sum(edges) > 0
    assert counts.degenerate == counts.inside == 0
    # The frames that are left.
    check = pliant.check(*paths, itself=True)
    some = [next(check).count, next(check).count]
    rest = check.counts()
    assert (rest.frames, rest.crossing_edges) == (4, None) and sum(some) + rest.pairs == counts.pairs
    assert check.counts().frames == 0
    first = pliant.check(*paths, itself=True, first=True).counts()
    assert first.pairs == sum(frame.count > 0 for frame in frames)


def test_memory_has_a_limit(folder: Path) -> None:
    with pytest.raises(pliant.Error, match="memory"):
        pliant.check(folder / "still.obj", max_memory=1000)
    # 200 upright triangles in one place, 200 flat ones through them all: a list of 640 kB.
    height = np.linspace(0, 1, 200)
    upright = np.stack([np.stack([x * np.ones(200), y + 1e-3 * height, z * np.ones(200)], 1) for x, y, z in [(0, 0, -1), (0, 0, 3), (9, 0, -1)]], 1)
    flat = np.stack([np.stack([x * np.ones(200), y * np.ones(200), height], 1) for x, y in [(0.5, -5), (0.5, 5), (1, 5)]], 1)
    for name, corners in [("upright.npz", upright), ("flat.npz", flat)]:
        np.savez(folder / name, vertices=corners.reshape(-1, 3), faces=np.arange(600).reshape(200, 3))
    paths = folder / "upright.npz", folder / "flat.npz"
    assert pliant.check(*paths).counts().pairs == 40_000
    assert pliant.check(*paths, max_memory=100_000).counts().pairs == 40_000
    with pytest.raises(pliant.Error, match="40000|pairs") as error:
        list(pliant.check(*paths, max_memory=100_000))
    assert error.value.kind == "TooLarge"


def test_arrays_have_names() -> None:
    world = pliant.World()
    assert world.add(faces=FACES, positions=FLAT) == 0
    world.set_positions(body=0, positions=FLAT)


def test_without_usd_core_it_is_said_how_to_install_it(tmp_path: Path) -> None:
    (tmp_path / "walk.usd").write_text("")
    program = "import sys; sys.modules['pxr'] = None\nimport pliant\npliant.check(sys.argv[1])"
    said = subprocess.run([sys.executable, "-c", program, tmp_path / "walk.usd"], capture_output=True, text=True)
    assert "pliant.Error" in said.stderr and "pip install 'pliant[usd]'" in said.stderr.splitlines()[-1]


def test_a_mesh_may_change_from_file_to_file(tmp_path: Path) -> None:
    flat = "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n"
    spike = "v 0.5 0.5 -1\nv 0.5 0.5 1\nv 0.6 0.6 1\nv 0 0 9\nf 4 5 6\n"
    for frame, text in enumerate([flat, flat + spike, flat + spike, flat]):
        (tmp_path / f"cut_{frame}.obj").write_text(text)
    pattern = str(tmp_path / "cut_*.obj")
    check = pliant.check(pattern)
    assert [body.triangles for body in check.bodies] == [1]
    frames = list(check)
    assert [frame.count for frame in frames] == [0, 1, 1, 0]
    assert [sorted(frame.changed) for frame in frames] == [[], [0], [], [0]]
    changed = frames[1].changed[0]
    assert (changed.name, changed.vertices, changed.triangles, changed.faces) == (pattern, 7, 2, None)
    with pytest.raises(pliant.Error, match="frame 1: the mesh is another than in the first frame.*split="):
        list(pliant.check(pattern, split="components"))


@pytest.fixture
def jumping(tmp_path: Path) -> tuple[Path, Path]:
    """A triangle that is above a floor, below it, and touches it with a corner."""
    corners = np.array([[0, 0, 0], [1, 0, 5], [0, 1, 5]], np.float64)
    heights = np.array([3, -7, 0, 0])
    frames = corners + heights[:, None, None] * np.array([0, 0, 1])
    np.savez(tmp_path / "leaf.npz", vertices=frames, faces=[[0, 1, 2]])
    obj(tmp_path / "floor.obj", np.array([[-9.0, -9, 0], [9, -9, 0], [0, 9, 0]]), np.array([[0, 1, 2]]))
    return tmp_path / "leaf.npz", tmp_path / "floor.obj"


def test_what_comes_close(jumping: tuple[Path, Path]) -> None:
    """The leaf's corner is 3 above the floor, 7 below it, which its other corners are 2 below, and on it."""
    near = list(pliant.check(*jumping, within=2.0))
    assert [(frame.count, frame.distance) for frame in near] == [(0, None), (1, 2.0), (1, 0.0), (1, 0.0)]
    assert near[1].pairs.tolist() == [[0, 0, 1, 0]] and near[1].kinds is None and near[1].complete
    assert [frame.distance for frame in pliant.check(*jumping, within=3.0, first=True)] == [3.0, 2.0, 0.0, 0.0]
    plain = list(pliant.check(*jumping))
    assert [frame.distance for frame in plain] == [None] * 4
    assert [frame.kinds for frame in plain] == [pliant.Kinds(0, 0, 0)] * 2 + [pliant.Kinds(crossing=0, overlapping=0, touching=1)] * 2
    assert [frame.kinds for frame in pliant.check(*jumping, first=True)] == [None] * 4
    assert [frame.only_touching for frame in plain] == [None] * 4
    crossing = list(pliant.check(*jumping, crossing=True))
    assert [(frame.count, frame.only_touching) for frame in crossing] == [(0, 0)] * 2 + [(0, 1)] * 2


def test_what_is_close_at_rest_is_left_out(tmp_path: Path) -> None:
    """A strip of four triangles, flat and then folded."""
    faces = np.array([[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]])
    flat = np.array([[x, y, 0] for x in (0.0, 1, 2) for y in (0.0, 1)])
    folded = flat.copy()
    folded[4:] = [[0, 0, 0.1], [0, 1, 0.1]]
    strip = tmp_path / "strip.npz"
    np.savez(strip, vertices=np.array([flat, folded]), faces=faces)
    obj(tmp_path / "flat.obj", flat, faces)
    for rest in (0, tmp_path / "flat.obj"):
        assert [frame.count > 0 for frame in pliant.check(strip, within=0.2, rest=rest)] == [False, True]
    with pytest.raises(pliant.Error, match="rest is -1; frames are counted from 0"):
        pliant.check(strip, within=0.2, rest=-1)
    with pytest.raises(pliant.Error, match="no distance was asked for; give within="):
        pliant.check(strip, rest=0)


def test_what_cannot_be_close_is_refused(jumping: tuple[Path, Path]) -> None:
    refused: list[tuple[tuple[Path, ...], dict[str, object], str]] = [
        (jumping, {"within": -1.0}, "a distance must be finite and at least 0; give within= in the unit of the files"),
        (jumping, {"within": float("nan")}, "a distance must be finite"),
        (jumping[:1], {"within": 1.0}, "neighbouring triangles .*; name two bodies or more and leave out itself="),
        (jumping, {"within": 1.0, "itself": True}, "neighbouring triangles"),
        (jumping, {"within": 1.0, "crossing": True}, "cannot be asked for in one check: .*; run two checks, one with within= and one with crossing="),
        (jumping, {"within": 1.0, "swept": True}, "cannot be asked for in one check: .*; run two checks, one with within= and one with swept="),
    ]
    for paths, more, message in refused:
        with pytest.raises(pliant.Error, match=message):
            pliant.check(*paths, **more)  # type: ignore[arg-type]


def test_what_meets_on_the_way(jumping: tuple[Path, Path]) -> None:
    frames = list(pliant.check(*jumping, swept=True))
    assert [frame.count for frame in frames] == [0, 0, 1, 1]
    intervals = [frame.interval for frame in frames]
    assert intervals[3] is None
    facts = [(way.frame, way.until, way.count, way.at_start, way.changed, way.complete) for way in intervals if way]
    assert facts == [(0, 1, 3, 0, (), True), (1, 2, 3, 0, (), True), (2, 3, 0, 1, (), True)]
    way = intervals[0]
    assert way is not None and way.first is not None
    low, high = way.vertex_triangle_times[0]
    assert low < 0.3 < high <= low + 1e-6
    assert (way.first.time, way.first.kind, way.first.pair) == (high, "vertex_triangle", (0, 0, 1, 0))
    assert way.vertex_triangle.tolist() == [[0, vertex, 1, 0] for vertex in range(3)]
    assert way.vertex_triangle.dtype == np.uint32 and way.vertex_triangle_times.dtype == np.float64
    assert (way.edge_edge.shape, way.edge_edge_times.shape) == ((0, 6), (0, 2))

    for frame, full in zip(pliant.check(*jumping, swept=True, first=True), intervals):
        if full:
            assert frame.interval is not None
            assert (frame.interval.count, frame.interval.complete) == (min(1, full.count), False)
            assert frame.interval.first == full.first
    assert [frame.interval for frame in pliant.check(*jumping)] == [None] * 4


def test_what_has_no_way_is_refused(jumping: tuple[Path, Path]) -> None:
    refused: list[tuple[tuple[Path, ...], dict[str, object], str]] = [
        (jumping[1:], {}, "only one is to be checked; name a sequence, .*, or leave out swept=$"),
        (jumping, {"frames": range(1, 2)}, "only one is to be checked"),
        (jumping, {"baseline": 0}, "a baseline cannot be used .*; run two checks, one with baseline= and one with swept=$"),
    ]
    for paths, more, message in refused:
        with pytest.raises(pliant.Error, match=message):
            pliant.check(*paths, swept=True, **more)  # type: ignore[arg-type]


def test_the_program_says_the_same_of_the_way(jumping: tuple[Path, Path]) -> None:
    """Where PLIANT names the program."""
    program = os.environ.get("PLIANT")
    if program is None:
        pytest.skip("the environment variable PLIANT names no program `pliant` to compare with")
    said = subprocess.run([program, "check", *jumping, "--swept", "--format", "json"], capture_output=True, check=False)
    written = [frame for frame in json.loads(said.stdout)["frames"] if "until" in frame]
    for frame, way in zip(pliant.check(*jumping, swept=True), written):
        assert frame.interval is not None
        rows = [[*pair, *times] for pair, times in zip(frame.interval.vertex_triangle.tolist(), frame.interval.vertex_triangle_times.tolist())]
        assert rows == way["vertex_triangle"]
        first = frame.interval.first
        expected = None if first is None else {"time": first.time, "kind": first.kind, "pair": list(first.pair)}
        assert (expected, frame.interval.count, frame.interval.at_start) == (way["first"], way["count"], way["at_start"])
