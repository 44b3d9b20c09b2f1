"""Hits that began, persist and ended, against sets of rows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pliant
import pytest
from conftest import fold, grid

FACES, FLAT = grid(12)
EVERYTHING = pliant.Selection.EVERYTHING


def rows_of(rows: Any) -> list[tuple[int, ...]]:
    return [tuple(row) for row in rows.tolist()]


def test_changes_sum_to_the_lists() -> None:
    world = pliant.World()
    body = world.add(FACES, FLAT)
    pairs, near = pliant.Changes(), pliant.Changes("vertex-triangle")
    edges, contacts = pliant.Changes("edge-edge"), pliant.Changes()
    numbers: dict[int, dict[tuple[int, ...], int]] = {}
    began_in_all = persisting = 0
    for step in range(12):
        world.set_positions(body, fold(FLAT, 1.0 + 0.05 * step))
        for which, (changes, rows) in enumerate(
            [
                (pairs, world.intersections(EVERYTHING).all()),
                (near, world.vertex_triangle_candidates(EVERYTHING, 0.02).all()),
                (edges, world.edge_edge_candidates(EVERYTHING, 0.02).all()),
                (contacts, world.contacts(EVERYTHING).all().pairs),
            ]
        ):
            known = numbers.setdefault(which, {})
            listed = rows_of(rows)
            changed = changes.update(rows)
            assert changed.numbers.dtype == np.uint64 and changed.ended.dtype == np.uint32
            assert [listed[place] for place in changed.began] == [row for row in listed if row not in known]
            gone = {row: number for row, number in known.items() if row not in listed}
            assert dict(zip(rows_of(changed.ended), changed.ended_numbers.tolist())) == gone
            assert rows_of(changed.ended) == sorted(gone)
            for row, number in zip(listed, changed.numbers.tolist()):
                assert known.get(row, number) == number
            numbers[which] = dict(zip(listed, changed.numbers.tolist()))
            began_in_all += len(changed.began)
            persisting += len(listed) - len(changed.began)
    assert began_in_all > 100 and persisting > 100


def test_numbers_are_carried_through_edits() -> None:
    world = pliant.World()
    floor = world.add([[0, 1, 2]], [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])
    up = np.array([[0.0, 0, -1], [1, 0, 1], [0, 1, 1]])
    body = world.add([[0, 1, 2], [3, 4, 5]], np.concatenate([up, up + [2.0, 0.0, 0.0]]))
    changes = pliant.Changes()
    assert changes.update(world.intersections().all()).numbers.tolist() == [0, 1]

    pieces = world.split(body)
    changes.split(body, pieces)
    changed = changes.update(world.intersections().all())
    assert changed.numbers.tolist() == [0, 1] and not len(changed.began) and not len(changed.ended)

    fused = world.fuse(body, pieces[0].body)
    changes.fused(body, pieces[0].body, fused)
    changed = changes.update(world.intersections().all())
    assert changed.numbers.tolist() == [0, 1] and not len(changed.began)

    edit = world.edit(body)
    edit.remove_triangles([0])
    edited = world.apply(edit)
    edit = world.edit(body)
    edit.set_triangle(0, edit.add_vertices(up))
    changes.edited(body, edited)
    changes.edited(body, world.apply(edit))
    changed = changes.update(world.intersections().all())
    assert changed.ended_numbers.tolist() == [0] and changed.ended.tolist() == [[floor, 0, body, 0]]
    assert sorted(changed.numbers.tolist()) == [1, 2]


def test_edges_that_were_edited_are_others() -> None:
    edges = pliant.Changes("edge-edge")
    rows = np.array([[0, 0, 1, 7], [0, 1, 1, 7]], dtype=np.uint32)
    edges.update(rows)
    before, after = (np.array(ends, dtype=np.uint32) for ends in ([[0, 1], [1, 2]], [[0, 1], [2, 3]]))
    edges.edges_edited(0, before, after)
    assert edges.update(rows).numbers.tolist() == [0, 2]


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (np.zeros((3, 4)), r"an array of shape \(3, 4\)"),
        (np.zeros((3, 2), dtype=np.uint32), r"an array of shape \(3, 2\)"),
        ([[0, 0, 1, 1]], "list"),
    ],
    ids=str,
)
def test_rows_of_another_kind(rows: Any, message: str) -> None:
    with pytest.raises(pliant.Error, match=message) as refused:
        pliant.Changes().update(rows)
    assert refused.value.kind == "BadArray"


def test_a_kind_that_there_is_not() -> None:
    wrong: Any = "faces"
    with pytest.raises(pliant.Error, match="kind is \"faces\"; it can be one of"):
        pliant.Changes(wrong)
