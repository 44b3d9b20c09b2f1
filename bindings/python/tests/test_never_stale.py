"""Worlds that are added to, moved, filtered, refused and rebuilt at random equal the reference for the shapes of that moment."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from itertools import combinations
from types import SimpleNamespace
from typing import Any

import numpy as np
import pliant
from conftest import pairs_between, pairs_within
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

coordinates = st.integers(-6, 6)


class World(RuleBasedStateMachine):
    """A world, and what it should hold, in plain dictionaries."""

    @initialize(
        dtype=st.sampled_from([np.float32, np.float64]),
        degree=st.sampled_from([2, 4, 8]),
        partition=st.sampled_from(["balanced", "centre", "connectivity"]),
    )
    def begin(self, dtype: Any, degree: Any, partition: Any) -> None:
        self.dtype = dtype
        self.world = pliant.World(degree=degree, partition=partition, leaf_size=2)
        self.faces: dict[int, Any] = {}
        self.shapes: dict[int, Any] = {}
        self.filters: dict[int, tuple[int, int]] = {}
        self.ignored: set[tuple[int, int]] = set()
        self.added = 0

    def shape(self, rows: int, data: st.DataObject) -> Any:
        numbers = data.draw(st.lists(coordinates, min_size=3 * rows, max_size=3 * rows))
        return np.array(numbers, self.dtype).reshape(rows, 3)

    def body(self, data: st.DataObject) -> int:
        return data.draw(st.sampled_from(sorted(self.shapes)))

    @rule(data=st.data(), triangles=st.integers(1, 12))
    @precondition(lambda self: len(self.shapes) < 5)
    def add(self, data: st.DataObject, triangles: int) -> None:
        faces = np.array([[i, i + 1, i + 2] for i in range(triangles)], np.int32)
        shape = self.shape(triangles + 2, data)
        body = self.world.add(faces, shape)
        assert body == self.added
        self.added += 1
        self.faces[body], self.shapes[body], self.filters[body] = faces, shape.copy(), (~0, ~0)
        shape[:] = 99  # the world keeps its own copy

    @rule(data=st.data(), triangles=st.integers(1, 12), by_object=st.booleans())
    @precondition(lambda self: self.shapes)
    def set_mesh(self, data: st.DataObject, triangles: int, by_object: bool) -> None:
        body = self.body(data)
        faces = np.array([[i, i + 2, i + 1] for i in range(triangles)], np.int64)
        shape = self.shape(triangles + 2, data)
        if by_object:
            self.world.set_mesh(body, SimpleNamespace(faces=faces, vertices=shape))
        else:
            self.world.set_mesh(body, faces, shape)
        self.faces[body], self.shapes[body] = faces, shape.copy()
        shape[:] = 99

    @rule(data=st.data(), how=st.sampled_from(["set", "write", "strided"]))
    @precondition(lambda self: self.shapes)
    def move(self, data: st.DataObject, how: str) -> None:
        body = self.body(data)
        shape = self.shape(len(self.shapes[body]), data)
        if how == "set":
            self.world.set_positions(body, shape)
        elif how == "write":
            self.world.write_positions(body, lambda out: np.copyto(out, shape))
        else:
            self.world.set_positions(body, np.asfortranarray(shape))
        self.shapes[body] = shape.copy()
        shape[:] = 99

    @rule(data=st.data())
    @precondition(lambda self: self.shapes)
    def refuse(self, data: st.DataObject) -> None:
        body = self.body(data)
        shape = self.shape(len(self.shapes[body]), data)
        shape[-1, 2] = np.nan
        calls: list[Callable[[], None]] = [
            lambda: self.world.set_positions(body, shape),
            lambda: self.world.set_positions(body, shape[1:]),
            lambda: self.world.set_motion(body, shape),
            lambda: self.world.set_mesh(body, [[0, 1, 1]], shape),
        ]
        for call in calls:
            try:
                call()
            except pliant.Error as error:
                assert error.body == body
            else:
                raise AssertionError("was not refused")

    @rule(data=st.data())
    @precondition(lambda self: self.shapes)
    def remove(self, data: st.DataObject) -> None:
        body = self.body(data)
        self.world.remove(body)
        del self.faces[body], self.shapes[body], self.filters[body]
        self.ignored = {pair for pair in self.ignored if body not in pair}

    @rule(data=st.data())
    @precondition(lambda self: self.shapes)
    def rebuild(self, data: st.DataObject) -> None:
        self.world.rebuild(self.body(data))

    @rule(data=st.data(), membership=st.integers(0, 3), mask=st.integers(0, 3))
    @precondition(lambda self: self.shapes)
    def set_filter(self, data: st.DataObject, membership: int, mask: int) -> None:
        body = self.body(data)
        self.world.set_filter(body, membership, mask)
        self.filters[body] = (membership, mask)

    @rule(data=st.data(), back=st.booleans())
    @precondition(lambda self: self.shapes)
    def ignore(self, data: st.DataObject, back: bool) -> None:
        a, b = self.body(data), self.body(data)
        if back:
            self.world.unignore(a, b)
            self.ignored.discard((min(a, b), max(a, b)))
        else:
            self.world.ignore(a, b)
            self.ignored.add((min(a, b), max(a, b)))

    @rule(how=st.sampled_from(["copy", "deepcopy", *range(pickle.HIGHEST_PROTOCOL + 1)]))
    def copy(self, how: str | int) -> None:
        """The world goes on as its copy; what becomes of the one is nothing to the other."""
        before = self.world
        if isinstance(how, int):
            self.world = pickle.loads(pickle.dumps(before, how))
        else:
            self.world = copy.deepcopy(before) if how == "deepcopy" else copy.copy(before)
        assert self.world.dtype == before.dtype
        assert self.world.options() == before.options()
        for body in before.bodies():
            before.remove(body)

    @rule(of=st.sampled_from([pliant.Selection.WORLD, pliant.Selection.EVERYTHING]))
    def prepare(self, of: pliant.Selection) -> None:
        self.world.intersections(of).prepare()

    @rule(data=st.data())
    @precondition(lambda self: self.shapes)
    def prepare_a_body(self, data: st.DataObject) -> None:
        self.world.intersections(pliant.Selection.within(self.body(data))).prepare()

    def meet(self, a: int, b: int) -> bool:
        (in_a, of_a), (in_b, of_b) = self.filters[a], self.filters[b]
        return (a, b) not in self.ignored and bool(in_a & of_b) and bool(in_b & of_a)

    @invariant()
    def answers_are_those_of_this_moment(self) -> None:
        if not hasattr(self, "world"):
            return
        assert self.world.ignored() == sorted(self.ignored)
        everybody = 2**32 - 1
        for body, (membership, mask) in self.filters.items():
            assert self.world.filter(body) == (membership & everybody, mask & everybody)
        assert self.world.bodies() == sorted(self.shapes)
        of_world, of_itself = [], []
        for a, b in combinations(sorted(self.shapes), 2):
            pairs = pliant.reference.intersection_pairs(self.shapes[a], self.faces[a], self.shapes[b], self.faces[b])
            np.testing.assert_array_equal(pairs_between(self.world, a, b), pairs)
            if self.meet(a, b):
                of_world += [[a, i, b, j] for i, j in pairs.tolist()]
        for body, shape in self.shapes.items():
            itself = pliant.reference.self_intersection_pairs(shape, self.faces[body])
            np.testing.assert_array_equal(pairs_within(self.world, body), itself)
            if self.meet(body, body):
                of_itself += [[body, i, body, j] for i, j in itself.tolist()]
        for of, expected in ((pliant.Selection.WORLD, of_world), (pliant.Selection.EVERYTHING, of_world + of_itself)):
            query = self.world.intersections(of)
            first = query.first()
            assert list(first) in expected if first is not None else expected == []
            assert query.all().tolist() == sorted(expected)
        self.world.validate()


TestNeverStale = World.TestCase
TestNeverStale.settings = settings(max_examples=40, stateful_step_count=25, deadline=None)
