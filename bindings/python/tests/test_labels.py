"""Labels of faces: what they leave out of a body's answers with itself."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pliant
import pytest
from pliant import Selection

# A strip of six triangles, folded to and fro onto itself.
STRIP = np.array([[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4], [4, 5, 6], [5, 7, 6]])
FOLDED = np.array([[x, y, 0.0] for x in (0.0, 1.0, 0.2, 0.8) for y in (0.0, 1.0)])
PARTS = np.array([0, 0, 7, 7, 2, 2])


@pytest.fixture
def world() -> pliant.World:
    world = pliant.World()
    world.add(STRIP, FOLDED)
    return world


def left_out(neighbours: list[list[int]] | None) -> set[tuple[int, int]]:
    """Pairs of faces that the parts leave out, by sets of vertices or of labels."""
    at = {label: set(STRIP[label == PARTS].flat) for label in PARTS.tolist()}
    given = [set(pair) for pair in neighbours or []]

    def are_near(a: int, b: int) -> bool:
        return a == b or (bool(at[a] & at[b]) if neighbours is None else {a, b} in given)

    labels = list(enumerate(PARTS.tolist()))
    return {(i, j) for i, a in labels for j, b in labels if are_near(a, b)}


def answers(world: pliant.World) -> list[set[tuple[int, int]]]:
    """Pairs of faces of every question that looks at labels."""
    itself = Selection.within(0)
    pairs = [
        world.intersections(itself).all(),
        world.contacts(itself).all().pairs,
        world.adjacent_intersections(itself).all().pairs,
        world.close_triangle_pairs(itself, 0.01).all().pairs,
    ]
    return [{(a, b) for _, a, _, b in rows.tolist()} for rows in pairs]


@pytest.mark.parametrize("dtype", [np.uint8, np.int64, np.uint32])
@pytest.mark.parametrize("neighbours", [None, [], [[7, 2]], [[9, 9], [2, 0]]])
def test_equal_and_neighbouring_labels_are_left_out(
    world: pliant.World, neighbours: list[list[int]] | None, dtype: type
) -> None:
    before = answers(world)
    given = None if neighbours is None else np.array(neighbours, np.int64).reshape(-1, 2)
    world.set_labels(0, PARTS.astype(dtype), given)
    out = left_out(neighbours)
    found = answers(world)
    assert found == [pairs - out for pairs in before]
    assert found != before or neighbours == []
    for known in (world, pickle.loads(pickle.dumps(world))):
        labels = known.labels(0)
        assert labels is not None and labels[0].dtype == np.uint32
        assert (labels[0] == PARTS).all()
        assert (labels[1] if labels[1] is None else labels[1].tolist()) == neighbours
        assert answers(known) == found
    world.set_labels(0, None)
    assert world.labels(0) is None
    assert answers(world) == before


def test_wrong_labels_are_refused(world: pliant.World) -> None:
    for labels, kind in [
        (PARTS[1:], "WrongLength"),
        (PARTS.astype(float), "BadArray"),
        (-PARTS, "BadArray"),
    ]:
        with pytest.raises(pliant.Error) as refused:
            world.set_labels(0, labels)
        assert refused.value.kind == kind
    with pytest.raises(pliant.Error, match="two labels a row"):
        world.set_labels(0, PARTS, np.zeros((2, 3), int))
    assert world.labels(0) is None


def test_files_have_labels(tmp_path: Path) -> None:
    np.savez(tmp_path / "arm.npz", vertices=FOLDED, faces=STRIP)
    np.save(tmp_path / "parts.npy", PARTS)
    arm = tmp_path / "arm.npz"
    for body in (str(arm), 0):
        (frame,) = pliant.check(arm, labels={body: tmp_path / "parts.npy"})
        assert frame.count == 4
    (frame,) = pliant.check(arm)
    assert frame.count == 6
    with pytest.raises(pliant.Error, match="labels="):
        list(pliant.check(arm, labels={0: tmp_path / "parts.npy"}, crossing=True))
    with pytest.raises(pliant.Error, match="0.npy"):
        list(pliant.check(arm, labels={0: tmp_path / "0.npy"}))
