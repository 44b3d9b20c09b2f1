"""Edits of meshes, against worlds that are made anew; and bodies from one and one from bodies."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import fold, grid, pairs_within
from numpy.typing import NDArray
from pliant import Selection

EMPTY = 0xFFFFFFFF


def fresh_pairs(world: pliant.World, body: int) -> NDArray[np.uint32]:
    """The pairs of a body with itself that a world made of its triangles finds, as the body numbers them."""
    live = world.live_triangles(body)
    numbers = np.flatnonzero(live).astype(np.uint32)
    faces = world.triangles(body)
    positions = np.nan_to_num(world.positions(body))
    fresh = pliant.World()
    return numbers[pairs_within(fresh, fresh.add(faces[live], positions))]


def folded(n: int = 12) -> tuple[pliant.World, int, NDArray[np.uint32], NDArray[np.float64]]:
    faces, flat = grid(n)
    positions = fold(flat, 1.5)
    world = pliant.World()
    return world, world.add(faces, positions), faces, positions


def test_a_random_life_finds_what_a_fresh_world_finds() -> None:
    rng = np.random.default_rng(24)
    world, body, faces, _ = folded()
    assert len(pairs_within(world, body)) > 50
    for _ in range(60):
        edit = world.edit(body)
        live = np.flatnonzero(world.live_triangles(body)).astype(np.uint32)
        some = rng.choice(live, 3, replace=False)
        triangles = world.triangles(body)
        match rng.integers(4):
            case 0:
                edit.remove_triangles(some)
            case 1:
                at = np.nanmean(world.positions(body), axis=0)
                new = edit.add_vertices(at[None])[0]
                a, b, c = triangles[some[0]]
                edit.set_triangle(int(some[0]), [a, b, int(new)])
                assert (edit.add_triangles([[b, c, new], [c, a, new]]) == [len(triangles), len(triangles) + 1]).all()
            case 2:
                assert edit.split_vertex(triangles[some[0]][0], some[:1]) == world.vertex_count(body)
            case _:
                a, b, _ = triangles[some[0]]
                edit.merge_vertices(a, b)
        edited = world.apply(edit)
        assert all(numbers.dtype == np.uint32 for numbers in edited)
        after = world.triangles(body)
        assert (after[edited.removed_triangles] == EMPTY).all()
        assert (world.live_triangles(body) == (after != EMPTY).all(axis=1)).all()
        assert (np.isnan(world.positions(body)).all(axis=1) == ~world.live_vertices(body)).all()
        assert (pairs_within(world, body) == fresh_pairs(world, body)).all()
        world.validate()
    shape = world.positions(body)
    world.set_positions(body, shape * [1, 1, 0.5])
    assert (pairs_within(world, body) == fresh_pairs(world, body)).all()


def test_an_edited_world_is_pickled_and_copied() -> None:
    world, body, faces, _ = folded()
    edit = world.edit(body)
    edit.remove_triangles(np.flatnonzero((faces == 0).any(axis=1)))
    edit.split_vertex(20, np.flatnonzero((faces == 20).any(axis=1))[:1])
    world.apply(edit)
    assert not world.live_vertices(body)[0]
    for again in (copy.copy(world), pickle.loads(pickle.dumps(world))):
        for of in (pliant.World.triangles, pliant.World.live_triangles, pliant.World.live_vertices):
            assert (of(again, body) == of(world, body)).all()
        assert np.array_equal(again.positions(body), world.positions(body), equal_nan=True)
        assert (pairs_within(again, body) == pairs_within(world, body)).all()
        again.validate()


def test_trees_that_mend_themselves_answer_like_others() -> None:
    faces, flat = grid(1)
    pieces = np.concatenate([faces + 4 * piece for piece in range(2000)])
    rng = np.random.default_rng(3)
    from_, to = rng.random((2, 2000, 1, 3)) * 20
    worlds = [pliant.World(mending=mending) for mending in (False, True)]
    for world in worlds:
        world.add(pieces, (from_ + flat).reshape(-1, 3))
    for step in range(40):
        shape = (from_ + (to - from_) * step / 40 + flat * [1, 1, 1]).reshape(-1, 3)
        for world in worlds:
            world.set_positions(0, shape)
        assert (pairs_within(worlds[0], 0) == pairs_within(worlds[1], 0)).all()
    assert worlds[0].tree_quality(0) > 2 * worlds[1].tree_quality(0)
    assert worlds[0].mesh_revision(0) == 0 < worlds[1].mesh_revision(0)


def test_float32() -> None:
    faces, flat = grid(4)
    world = pliant.World()
    body = world.add(faces, flat.astype(np.float32))
    edit = world.edit(body)
    with pytest.raises(pliant.Error, match="float32") as refused:
        edit.add_vertices([[0.5, 0.5, 0.1]])
    assert (refused.value.kind, refused.value.body) == ("Precision", body)
    new = edit.add_vertices(np.array([[0.5, 0.5, 0.1]], np.float32))
    edit.add_triangles([[0, 1, new[0]]])
    assert (world.apply(edit).new_vertices == new).all()
    assert world.positions(body).dtype == np.float32


def test_sets_of_meshes_that_differ_a_little_are_edits() -> None:
    world, body, faces, positions = folded()
    edges = world.edges(body)
    world.set_mesh(body, faces[:-1], positions)
    assert (world.triangles(body) == faces[:-1]).all()
    now = world.edges(body)
    still = (now != EMPTY).all(axis=1)
    # The last triangle has one edge at the border of the sheet.
    assert (now[still] == edges[still]).all() and (~still).sum() == 1
    world.set_mesh(body, np.delete(faces, 100, axis=0), positions)
    assert (pairs_within(world, body) == fresh_pairs(world, body)).all()


def test_split_fuse_and_weld() -> None:
    faces, flat = grid(6)
    upper = fold(flat, 0.0)
    world = pliant.World()
    body = world.add(np.concatenate([faces[:50], faces + len(flat)]), np.concatenate([flat, upper]))
    world.ignore(body, world.add(faces, flat))
    components = world.components(body)
    assert components.dtype == np.uint32 and (components == [0] * 50 + [1] * len(faces)).all()
    before = set(map(tuple, pairs_within(world, body)))
    (piece,) = world.split(body)
    assert piece.body == 2 and (piece.triangles == np.arange(50)).all()
    assert (piece.vertices == np.unique(faces[:50])).all()
    assert world.ignored() == [(0, 1), (1, 2)]
    hits = world.intersections(Selection.between(piece.body, body)).all()
    assert {(int(piece.triangles[a]), int(b)) for a, b in hits[:, [1, 3]]} == before
    fused = world.fuse(body, piece.body)
    assert (fused.triangles == np.arange(50) + 50 + len(faces)).all() and len(fused.vertices) == len(piece.vertices)
    assert len(pairs_within(world, body)) == len(before)
    # A sheet that is cut along its middle, and welded.
    sheet = world.add(faces, flat)
    right = flat[faces].mean(axis=1)[:, 0] > 0.5
    edit = world.edit(sheet)
    for vertex in np.intersect1d(faces[right], faces[~right]):
        edit.split_vertex(vertex, np.flatnonzero(right & (faces == vertex).any(axis=1)))
    cut = world.apply(edit)
    assert world.components(sheet).max() == 1 and len(cut.new_vertices) == 7
    assert (world.weld(sheet, 1e-9).removed_vertices == cut.new_vertices).all()
    assert (world.triangles(sheet) == faces).all()


@pytest.mark.parametrize(
    ("step", "kind", "facts"),
    [
        (lambda edit: edit.remove_triangles([288]), "NoSuchTriangle", {"triangle": 288, "triangles": 288}),
        (lambda edit: edit.remove_triangles([5, 5]), "EmptyTriangle", {"triangle": 5}),
        (lambda edit: edit.remove_triangles(range(288)), "NoTriangles", {}),
        (lambda edit: edit.split_vertex(169, []), "NoSuchVertex", {"vertex": 169, "vertices": 169}),
        (lambda edit: edit.split_vertex(0, [287]), "NotACorner", {"triangle": 287, "vertex": 0}),
        (lambda edit: edit.place_vertex(0, [0, 0, 0.5]), "VertexInUse", {"vertex": 0}),
        (lambda edit: edit.add_triangles([[0, 1, 169]]), "VertexOutOfRange", {"triangle": 288, "vertex": 169, "vertices": 169}),
        (lambda edit: edit.add_vertices([[0.0, np.nan, 0.0]]), "BadPosition", {"vertex": 169}),
        (lambda edit: (edit.merge_vertices(0, 1), edit.set_triangle(3, [1, 2, 3])), "EmptyVertex", {"vertex": 1}),
    ],
)
def test_what_cannot_be_edited(step: Callable[[pliant.Edit], Any], kind: str, facts: dict[str, Any]) -> None:
    world, body, faces, _ = folded()
    edit = world.edit(body)
    assert edit.body() == body
    step(edit)
    with pytest.raises(pliant.Error) as refused:
        world.apply(edit)
    assert refused.value.kind == kind and refused.value.body == body
    assert {name: getattr(refused.value, name) for name in facts} == facts
    assert (world.triangles(body) == faces).all()


def test_what_is_no_edit() -> None:
    world, body, _, _ = folded()
    edit = world.edit(body)
    for bad in ([0.5], [[1]], [-1], [2**32], ["a"]):
        with pytest.raises(pliant.Error, match="triangles") as refused:
            edit.remove_triangles(bad)
        assert refused.value.kind == "BadArray"
    with pytest.raises(pliant.Error, match="vertex -1"):
        edit.add_triangles([[0, 1, -1]])
    world.set_mesh(body, world.triangles(body)[1:], world.positions(body))
    with pytest.raises(pliant.Error, match="begin another"):
        world.apply(edit)
    edit = world.edit(body)
    other = pliant.World()
    other.add(np.array([[0, 1, 2]]), np.zeros((3, 3), np.float32))
    with pytest.raises(pliant.Error) as refused:
        other.apply(edit)
    assert refused.value.kind == "OutdatedEdit"
    # Where ids, meshes and precision agree, and of a world that was made from it.
    same = pliant.World()
    same.add(world.triangles(body), world.positions(body))
    for other in (same, copy.copy(world), pickle.loads(pickle.dumps(world))):
        before = other.triangles(body)
        with pytest.raises(pliant.Error, match="another world") as refused:
            other.apply(edit)
        assert refused.value.kind == "OutdatedEdit"
        assert np.array_equal(other.triangles(body), before)
        other.apply(other.edit(body))
    for call in (world.edit, world.components, world.split, world.live_triangles, world.live_vertices, world.mesh_revision):
        with pytest.raises(pliant.Error) as refused:
            call(7)
        assert refused.value.kind == "NoSuchBody"
    with pytest.raises(pliant.Error) as refused:
        world.fuse(body, body)
    assert refused.value.kind == "SameBody"
    with pytest.raises(pliant.Error) as refused:
        world.weld(body, -1)
    assert refused.value.kind == "BadDistance"


def test_a_vertex_is_placed_after_it_was_merged_away() -> None:
    world, body, faces, _ = folded()
    kept, gone, other = (int(corner) for corner in faces[0])
    edit = world.edit(body)
    edit.merge_vertices(kept, gone)
    edit.place_vertex(gone, [0.25, 0.5, 4.0])
    edited = world.apply(edit)
    assert (edited.new_vertices.tolist(), edited.removed_vertices.tolist()) == ([gone], [])
    assert world.live_vertices(body)[gone]
    assert world.positions(body)[gone].tolist() == [0.25, 0.5, 4.0]
    edit = world.edit(body)
    edit.merge_vertices(kept, other)
    edit.add_triangles([[kept, gone, other]])
    with pytest.raises(pliant.Error, match=f"vertex {other}") as refused:
        world.apply(edit)
    assert refused.value.kind == "EmptyVertex"


def test_a_loose_box_is_round_what_is_there() -> None:
    world = pliant.World()
    body = world.add([[0, 1, 2], [0, 1, 3]], np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [9, 9, 9]]))
    box = ([-1.0, -1.0, -1.0], [2.0, 2.0, 2.0])
    with pytest.raises(pliant.Error, match="vertex 3"):
        world.set_loose_box(body, box)
    edit = world.edit(body)
    edit.remove_triangles([1])
    world.apply(edit)
    world.set_loose_box(body, box)


def test_the_tolerance_of_a_weld_is_exact() -> None:
    world = pliant.World()
    tiny = 1.5e-162
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]]) * 1e-160
    square[3:5, 0] += tiny
    body = world.add([[0, 1, 2], [3, 4, 5]], square)
    assert len(world.weld(body, 0.0).removed_vertices) == 0
    assert len(world.weld(body, 0.99 * tiny).removed_vertices) == 0
    assert world.weld(body, 1.01 * tiny).removed_vertices.tolist() == [3, 4]


def test_many_vertices_in_one_place_are_welded() -> None:
    world = pliant.World()
    body = world.add(np.arange(60_000).reshape(-1, 3), np.zeros((60_000, 3)))
    assert len(world.weld(body, 0.0).removed_vertices) == 59_997
    assert (np.sort(world.triangles(body), axis=1) == [0, 1, 2]).all()


def some_edit(worlds: list[pliant.World], rng: np.random.Generator) -> None:
    """The same one of all."""
    live = np.flatnonzero(worlds[0].live_triangles(0))
    triangle, kind = int(rng.choice(live)), rng.integers(3)
    a, b, _ = worlds[0].triangles(0)[triangle].tolist()
    for world in worlds:
        edit = world.edit(0)
        if kind == 0:
            edit.remove_triangles([triangle])
        elif kind == 1:
            edit.split_vertex(a, [triangle])
        else:
            new = edit.add_vertices(np.array([[0.1 * (triangle % 10), 0.5, 0.3]]))
            edit.set_triangle(triangle, [a, b, int(new[0])])
        world.apply(edit)


@pytest.mark.parametrize("asked", ["before", "amid", "after"])
def test_pickled_and_copied_worlds_keep_the_numbers_of_edges(asked: str) -> None:
    """Whenever edges were asked for first, and whatever is edited afterwards."""
    rng = np.random.default_rng(6)
    for _ in range(15):
        faces, flat = grid(5)
        world = pliant.World()
        world.add(faces, fold(flat, 0.4))
        if asked == "before":
            world.edges(0)
        for step in range(int(rng.integers(1, 9))):
            some_edit([world], rng)
            if asked == "amid" and step == 1:
                world.edges(0)
        worlds = [world, copy.copy(world), copy.deepcopy(world), pickle.loads(pickle.dumps(world))]
        worlds.append(pickle.loads(pickle.dumps(worlds[-1])))
        for _ in range(3):
            if asked != "after":
                some_edit(worlds, rng)
            edges = [world.edges(0) for world in worlds]
            of = Selection.within(0)
            near = [world.edge_edge_candidates(of, 0.2).all() for world in worlds]
            close = [world.close_edge_edge_pairs(of, 0.3).all().pairs for world in worlds]
            for answers in (edges, near, close):
                assert len(answers[0]) > 0 and all(np.array_equal(answer, answers[0]) for answer in answers)
            some_edit(worlds, rng)
        for again in worlds:
            again.validate()


def test_pickles_without_numbers_of_edges_are_read_and_wrong_ones_refused() -> None:
    world, body, faces, _ = folded(4)
    world.edges(body)
    edit = world.edit(body)
    edit.remove_triangles([0, 1])
    world.apply(edit)
    make, _, written = world.__reduce__()
    edges = written["bodies"][0]["edges"]
    assert edges.dtype == np.uint32 and (edges == world.edges(body)).all()

    def read(**changed: Any) -> pliant.World:
        again = make()
        again.__setstate__(written | {"bodies": [written["bodies"][0] | changed]})
        return again

    assert (read().edges(body) == edges).all()
    # Written by the version before: its edges are numbered anew.
    del written["bodies"][0]["edges"]
    live = edges[(edges != EMPTY).any(axis=1)]
    assert (read().edges(body) == np.unique(live, axis=0)).all()
    for bad in (edges[1:], np.concatenate([edges, edges[:1]]), edges[:, ::-1].copy(), edges[:0]):
        with pytest.raises(pliant.Error, match="not a world that pickle wrote down: the edges of body 0") as refused:
            read(edges=bad)
        assert refused.value.kind == "BadOption"
    with pytest.raises(TypeError):
        read(edges=edges.astype(np.int64))
