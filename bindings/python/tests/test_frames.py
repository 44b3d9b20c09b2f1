"""Many shapes in one call: Query.of_frames, inside, self_intersections, intersections."""

from __future__ import annotations

import copy
import signal
import threading
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import grid


def sheets(frames: int, dtype: Any = np.float64) -> tuple[Any, Any]:
    """A folded sheet of 8 x 8 squares, shaped at random on a lattice in each frame."""
    faces, positions = grid(8)
    random = np.random.default_rng(frames)
    moved = np.repeat(positions[None], frames, 0)
    moved += random.integers(-2, 3, moved.shape) / 8
    moved[::3] = positions
    return faces, moved.astype(dtype)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("threads", [1, 2, 5, "all"])
def test_each_frame_is_answered_as_alone(dtype: Any, threads: Any) -> None:
    faces, positions = sheets(13, dtype)
    alone = [pliant.self_intersection_pairs(shape, faces) for shape in positions]
    found = pliant.self_intersections(faces, positions, threads=threads)
    assert found.offsets.dtype == np.int64 and found.offsets[0] == 0
    assert found.counts.tolist() == [len(pairs) for pairs in alone]
    assert found.counts.max() > 10 and found.counts.min() == 0
    for number, pairs in enumerate(alone):
        assert found.frame(number).tolist() == pairs.tolist()
    assert found.frame(-1).tolist() == alone[-1].tolist()
    with pytest.raises(IndexError):
        found.frame(13)
    counts = pliant.self_intersections(faces, positions, answer="counts", threads=threads)
    assert counts.dtype == np.int64 and counts.tolist() == found.counts.tolist()
    some = pliant.self_intersections(faces, positions, answer="any", threads=threads)
    assert some.dtype == np.bool_ and some.tolist() == [bool(len(pairs)) for pairs in alone]
    first = pliant.self_intersections(faces, positions, answer="first", threads=threads)
    assert first.hits.tolist() == [pairs[0].tolist() for pairs in alone if len(pairs)]
    assert first.counts.tolist() == [min(len(pairs), 1) for pairs in alone]


def test_two_meshes_of_which_one_may_stay() -> None:
    faces, positions = sheets(7)
    other = positions[::-1] + np.array([0.25, 0, 0.125])
    for a, b in ((positions, other), (positions, other[2]), (positions[1], other), (positions, other.astype(np.float32)), (positions.astype(">f4"), other)):
        found = pliant.intersections(faces, a, faces, b, threads=2)
        for number in range(7):
            shapes = [shape[number] if shape.ndim == 3 else shape for shape in (a, b)]
            alone = pliant.intersection_pairs(shapes[0], faces, shapes[1], faces)
            assert found.frame(number).tolist() == alone.tolist()
    assert found.counts.any()
    with pytest.raises(pliant.Error, match=r"positions have shape \(81, 3\), \(81, 3\); they must be \(frames, n, 3\)"):
        pliant.intersections(faces, positions[0], faces, other[0])


def test_every_question_of_pairs_is_one_of_frames() -> None:
    faces, positions = sheets(6)
    world = pliant.World()
    sheet = world.add(faces, positions[0])
    still = world.add(faces, positions[0] + 0.125)
    alone = copy.copy(world)
    everything = pliant.Selection.EVERYTHING

    def questions(world: pliant.World) -> list[Any]:
        return [
            world.intersections(everything),
            world.crossing_edges(everything),
            world.vertex_triangle_candidates(everything, 0.0625),
            world.edge_edge_candidates(everything, 0.0625),
            world.close_vertex_triangle_pairs(everything, 0.0625),
            world.close_edge_edge_pairs(everything, 0.0625),
            world.close_triangle_pairs(pliant.Selection.between(sheet, still), 0.0625),
            world.contacts(everything),
            world.adjacent_intersections(everything),
        ]

    def columns(hits: Any) -> list[Any]:
        return [column.tolist() for column in ((hits,) if isinstance(hits, np.ndarray) else hits)]

    for question, same in zip(questions(world), questions(alone), strict=True):
        found = question.of_frames({sheet: positions}, threads=3)
        for number, shape in enumerate(positions):
            alone.set_positions(sheet, shape)
            assert columns(found.frame(number)) == columns(same.all())
        assert found.counts.sum() == found.offsets[-1] > 0
        assert question.of_frames([(sheet, positions)], answer="counts").tolist() == found.counts.tolist()
    # The world stays as it was.
    assert world.positions(sheet).tolist() == positions[0].tolist()


def test_inside_with_frames() -> None:
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    world = pliant.World()
    large = world.add(faces, 8 * corners)
    small = world.add(faces, corners)
    shifts = np.array([[1.0, 1, 1], [-0.5, -0.5, -0.5], [0, 0, 0], [9, 9, 9]])
    frames = corners[None] + shifts[:, None]
    found = world.inside(small, large, frames={small: frames}, threads=2)
    assert found.sides.shape == found.windings.shape == (4, 4)
    for number, shape in enumerate(frames):
        world.set_positions(small, shape)
        assert found.sides[number].tolist() == world.inside(small, large).sides.tolist()
    assert found.is_inside.sum() == 4 + 0 and (found.sides[2] == 0).all()
    assert world.inside(small, large, frames={small: frames[:0]}).sides.shape == (0, 4)
    with pytest.raises(pliant.Error, match="rule"):
        world.inside(small, large, "odd", frames={small: frames})  # type: ignore[arg-type]


def test_no_frames_are_no_hits() -> None:
    faces, positions = sheets(3)
    found = pliant.self_intersections(faces, positions[:0])
    assert found.hits.shape == (0, 2) and found.offsets.tolist() == [0] and found.counts.tolist() == []
    assert pliant.self_intersections(faces, positions[:0], answer="any").shape == (0,)


def test_refusals_name_the_frame_and_change_nothing() -> None:
    faces, positions = sheets(5)
    bad = positions.copy()
    bad[3, 7, 1] = np.nan
    bad[4, 0, 0] = np.inf
    for threads in (1, 2, 4):
        with pytest.raises(pliant.Error, match="frame 3: body 0: .*vertex 7") as refused:
            pliant.self_intersections(faces, bad, threads=threads)
        assert (refused.value.kind, refused.value.frame, refused.value.vertex, refused.value.body) == ("BadPosition", 3, 7, 0)
    bad[0, 5, 2] = 1e39
    with pytest.raises(pliant.Error, match="frame 0: body 0: .*vertex 5"):
        pliant.self_intersections(faces, bad)
    world = pliant.World()
    body = world.add(faces, positions[0])
    query = world.intersections(pliant.Selection.within(body))
    for frames, kind, said in (
        ({body: positions[0]}, "BadArray", r"shape \(81, 3\); they must be \(frames, n, 3\): one frame"),
        ({body: positions[:, :, :2]}, "BadArray", "must be"),
        ({body: positions[:, :80]}, "WrongLength", "frame 0"),
        ({body: positions.astype(int)}, "BadArray", "float32 or float64"),
        ({7: positions}, "NoSuchBody", "7"),
        ([(body, positions), (body, positions)], "SameBody", "twice"),
        ({}, "BadArray", "no body has frames"),
    ):
        with pytest.raises(pliant.Error, match=said) as refused:
            query.of_frames(frames)
        assert refused.value.kind == kind
    other = world.add(faces, positions[1])
    with pytest.raises(pliant.Error, match="4 frames, but the first body has 5"):
        query.of_frames({body: positions, other: positions[:4]})
    with pytest.raises(pliant.Error, match='answer is "some"; it can be one of'):
        query.of_frames({body: positions}, answer="some")  # type: ignore[call-overload]
    with pytest.raises(pliant.Error, match="threads"):
        query.of_frames({body: positions}, threads=0)
    masked = np.ma.masked_equal(positions, positions[2, 2, 2])
    with pytest.raises(pliant.Error, match="masked"):
        query.of_frames({body: masked})
    with pytest.raises(pliant.Error, match="threads=2 of its own"):
        wide = pliant.World(threads=2)
        only = wide.add(faces, positions[0])
        wide.intersections(pliant.Selection.within(only)).of_frames({only: positions}, threads=2)
    assert world.positions(body).tolist() == positions[0].tolist()


def test_hits_stay_by_themselves() -> None:
    faces, positions = sheets(3)
    hits = pliant.self_intersections(faces, positions).hits
    assert hits.flags.c_contiguous and hits.flags.owndata


def test_arrays_in_other_layouts_are_read() -> None:
    faces, positions = sheets(4, np.float32)
    expected = pliant.self_intersections(faces, positions).hits.tolist()
    layouts = [
        np.asfortranarray(positions),
        np.repeat(positions, 2, 0)[::2],
        positions.astype(">f4"),
        list(positions),
        positions.astype(np.float64),
    ]
    for layout in layouts:
        assert pliant.self_intersections(faces, layout).hits.tolist() == expected


def test_an_interrupt_ends_all_threads() -> None:
    if threading.current_thread() is not threading.main_thread():
        pytest.skip("signals come in the main thread")
    faces, positions = sheets(4)
    many = np.repeat(positions, 100_000 // 4, 0)

    def raised(*_: object) -> None:
        raise InterruptedError("now")

    before = signal.signal(signal.SIGALRM, raised)
    signal.setitimer(signal.ITIMER_REAL, 0.05)
    try:
        with pytest.raises(InterruptedError, match="now"):
            pliant.self_intersections(faces, many, threads=2)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
