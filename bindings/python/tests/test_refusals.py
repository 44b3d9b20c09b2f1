"""Every refusal is a pliant.Error with the facts of the Rust library's, and changes nothing."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import grid, pairs_between

FACES, FLAT = grid(3)
MAX = float(np.finfo(np.float32).max)


def changed(vertex: int, value: float) -> Any:
    shape = FLAT.copy()
    shape[vertex, 1] = value
    return shape


def two_sheets() -> pliant.World:
    world = pliant.World()
    world.add(FACES, FLAT)
    world.add(FACES, FLAT)
    world.set_loose_box(1, ([-1, -1, -1], [2, 2, 2]))
    return world


REFUSALS: list[tuple[Callable[[pliant.World], Any], dict[str, Any]]] = [
    (lambda w: w.add(FACES[:0], FLAT), {"kind": "NoTriangles", "body": None}),
    (lambda w: w.set_positions(0, FLAT[1:]), {"kind": "WrongLength", "body": 0, "expected": 16, "found": 15}),
    (lambda w: w.set_positions(0, changed(7, np.inf)), {"kind": "BadPosition", "body": 0, "vertex": 7}),
    (lambda w: w.set_positions(0, changed(7, 2 * MAX)), {"kind": "BadPosition", "vertex": 7}),
    (lambda w: w.add(FACES, changed(2, np.nan)), {"kind": "BadPosition", "body": None, "vertex": 2}),
    (lambda w: w.write_positions(0, lambda out: None), {"kind": "NotWritten", "body": 0, "vertex": 0}),
    (lambda w: w.write_positions(0, lambda out: np.copyto(out[:9], FLAT[:9])), {"kind": "NotWritten", "vertex": 9}),
    (lambda w: w.set_positions(1, FLAT + 5), {"kind": "OutsideLooseBox", "body": 1, "position": (5.0, 5.0, 5.0)}),
    (lambda w: w.set_loose_box(0, ([1, 1, 1], [0, 0, 0])), {"kind": "BadLooseBox", "body": 0}),
    (lambda w: w.set_loose_box(0, ([-np.inf] * 3, [1, 1, 1])), {"kind": "BadLooseBox", "body": 0}),
    (lambda w: w.set_loose_box(0, ([0.5] * 3, [2] * 3)), {"kind": "OutsideLooseBox", "body": 0, "vertex": 0}),
    (lambda w: w.remove(7), {"kind": "NoSuchBody", "body": 7}),
    (lambda w: w.remove(-1), {"kind": "NoSuchBody", "body": None}),
    (lambda w: w.triangle_count(2**32), {"kind": "NoSuchBody", "body": None}),
    (lambda w: w.ignore(0, 2), {"kind": "NoSuchBody", "body": 2}),
    (lambda w: w.intersections(pliant.Selection.between(1, 1)).all(), {"kind": "SameBody", "body": 1}),
    (lambda w: w.intersections(pliant.Selection.between(1, 1)).prepare(), {"kind": "SameBody", "body": 1}),
    (lambda w: w.intersections(pliant.Selection.between(0, -1)), {"kind": "NoSuchBody", "body": None}),
    (lambda w: w.intersections(pliant.Selection.within(2**32)), {"kind": "NoSuchBody", "body": None}),
    (lambda w: w.intersections().all(at_most=0), {"kind": "TooManyHits", "body": None, "limit": 0}),
    (lambda w: w.intersections().all(at_most=7), {"kind": "TooManyHits", "limit": 7}),
]


@pytest.mark.parametrize(("call", "facts"), REFUSALS, ids=range(len(REFUSALS)))
def test_refusals_have_facts_and_change_nothing(call: Callable[[pliant.World], Any], facts: dict[str, Any]) -> None:
    world = two_sheets()
    before = world.intersections().all().tolist()
    with pytest.raises(pliant.Error) as refused:
        call(world)
    error = refused.value
    assert isinstance(error, ValueError)
    assert {name: getattr(error, name) for name in facts} == facts
    assert str(error)
    assert world.bodies() == [0, 1]
    assert world.intersections().all().tolist() == before
    world.validate()
    # Facts travel between processes.
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), repr(vars(again))) == (pliant.Error, str(error), repr(vars(error)))


def test_every_method_that_names_a_body_refuses_one_that_is_not_there() -> None:
    world = two_sheets()
    world.remove(0)
    selections = [pliant.Selection.between(1, 0), pliant.Selection.between(0, 1), pliant.Selection.within(0)]
    queries = [world.intersections(of) for of in selections]
    calls: list[Callable[[], Any]] = [
        lambda: world.remove(0),
        lambda: world.set_positions(0, FLAT),
        lambda: world.write_positions(0, lambda out: None),
        lambda: world.rebuild(0),
        lambda: world.set_filter(0, 1, 1),
        lambda: world.set_environment(0, 1),
        lambda: world.ignore(0, 1),
        lambda: world.unignore(1, 0),
        lambda: world.set_loose_box(0, None),
        lambda: world.triangle_count(0),
        lambda: world.vertex_count(0),
        lambda: world.tree_shape(0),
        lambda: world.tree_cut(0, 0),
        lambda: world.vertex_order(0),
        lambda: world.triangles(0),
        lambda: world.positions(0),
        lambda: world.tree_boxes(0, 0),
        lambda: world.watertight(0),
        lambda: world.points_inside(FLAT, 0),
        lambda: world.closest_points(FLAT, 0),
        lambda: world.signed_closest_points(FLAT, 0),
        lambda: world.contained(pliant.Selection.between(0, 1)),
        lambda: world.inside(1, 0),
        lambda: world.depth(1, 0),
        *(query.all for query in queries),
        *(query.first for query in queries),
        *(partial(query.visit, lambda pair: True) for query in queries),
        *(query.prepare for query in queries),
    ]
    for call in calls:
        with pytest.raises(pliant.Error, match="body 0: not in this world") as refused:
            call()
        assert (refused.value.kind, refused.value.body) == ("NoSuchBody", 0)


def test_the_message_names_the_vertex_and_where_it_is() -> None:
    with pytest.raises(pliant.Error, match=r"^body 0: vertex 7 is at \[.*NaN.*\]; coordinates must be finite") as refused:
        two_sheets().set_positions(0, changed(7, np.nan))
    assert refused.value.position is not None and np.isnan(refused.value.position[1])


WORLD = pliant.Selection.WORLD

#: What to do, at the end of a message, in words of Python.
ADVICE: list[tuple[Callable[[pliant.World], Any], str]] = [
    (lambda w: w.add(FACES + 1, FLAT), "if the faces are counted from 1, give faces - 1"),
    (lambda w: w.set_positions(0, FLAT[1:]), "give one for each vertex, empty ones included"),
    (lambda w: w.write_positions(0, lambda out: None), "fill every row of the buffer"),
    (lambda w: w.set_positions(1, FLAT + 5), "World.set_loose_box does either"),
    (lambda w: w.remove(7), "bodies() lists all that are there"),
    (lambda w: w.remove(-1), "bodies() lists all that are there"),
    (lambda w: w.fuse(0, 0), "for that, give Selection.within(body) where a selection is taken"),
    (
        lambda w: w.intersections().all(at_most=0),
        "this is at_most=, and visit_some(...) makes no list",
    ),
    (lambda w: w.edge_edge_candidates(WORLD, -1).all(), "this is the argument radius"),
    (lambda w: w.close_edge_edge_pairs(WORLD, -1).all(), "this is the argument distance"),
    (lambda w: w.distance(0, 1, -1), "this is the argument cut_off"),
    (lambda w: w.nearest_body(0, -1), "this is the argument cut_off"),
    (lambda w: w.clearance(WORLD, np.inf), "this is the argument cut_off"),
    (lambda w: w.free_step(WORLD, -1), "this is the argument min_distance"),
    (lambda w: w.collision_free_step(WORLD, -1), "this is the argument min_distance"),
    (lambda w: w.weld(0, -1), "this is the argument tolerance"),
    (
        lambda w: pliant.edge_edge_impacts(np.zeros((1, 4, 3)), np.zeros((2, 4, 3))),
        "start and end have one row for each pair",
    ),
    (lambda w: pliant.check(), 'name files, as in pliant.check("cloth_*.obj")'),
    (lambda w: pliant.check("absent.obj"), "it is taken from the current folder, os.getcwd(), or is a key of files="),
    (
        lambda w: pliant.check("absent_*.obj"),
        "it is taken from the current folder, os.getcwd(), or is of keys of files=",
    ),
]


@pytest.mark.parametrize(("call", "advice"), ADVICE, ids=range(len(ADVICE)))
def test_a_refusal_says_what_to_do_in_words_of_python(
    call: Callable[[pliant.World], Any], advice: str
) -> None:
    with pytest.raises(pliant.Error) as refused:
        call(two_sheets())
    assert str(refused.value).endswith(advice)


@pytest.mark.parametrize(
    ("step", "advice"),
    [
        (
            lambda e: (e.remove_triangles([1]), e.remove_triangles([1])),
            "Edit.set_triangle does that",
        ),
        (lambda e: (e.merge_vertices(0, 1), e.merge_vertices(0, 1)), "Edit.place_vertex does that"),
        (lambda e: e.place_vertex(0, [0.0, 0, 0]), "World.set_positions does that"),
        (lambda e: e.split_vertex(15, [0]), "give triangles that have it for a corner"),
    ],
    ids=range(4),
)
def test_a_refused_step_says_which_call_helps(
    step: Callable[[pliant.Edit], Any], advice: str
) -> None:
    world = two_sheets()
    edit = world.edit(0)
    step(edit)
    with pytest.raises(pliant.Error, match=f"; {advice}$"):
        world.apply(edit)


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda w: w.set_filter(0, -1, 1), OverflowError, "-1 is not an integer from 0 to 4294"),
        (lambda w: w.tree_cut(0, 2**32), OverflowError, "4294967296 is not an integer"),
        (lambda w: w.set_loose_box(0, 5), TypeError, r"5 is not a tuple \(lower, upper\), three"),
        (lambda w: w.set_loose_box(0, ([1, 2], [3, 4])), ValueError, r"is not a tuple \(lower, upper\)"),
        (lambda w: w.edit(0).set_triangle(0, [1, 2]), ValueError, r"\[1, 2\] is not three vertex"),
        (lambda w: w.edit(0).place_vertex(0, [1.0]), pliant.Error, r"shape \(1,\); it must be \(3,"),
        (lambda w: w.contacts(only="crossing"), TypeError, "'crossing' is not a pliant.ContactKind"),
    ],
    ids=range(7),
)
def test_arguments_of_a_wrong_form_are_told_the_right_one(
    call: Callable[[Any], Any], kind: type[Exception], message: str
) -> None:
    with pytest.raises(kind, match=message):
        call(two_sheets())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"degree": 3}, "degree is 3; it can be 2, 4 or 8"),
        ({"partition": "octree"}, 'partition is "octree"; it can be one of "centre", "mean", "balanced", "connectivity"'),
        ({"update": "none"}, 'update is "none"; it can be one of "bottom-up", "top-down", "hybrid"'),
        ({"broad": ""}, 'broad is ""; it can be one of "brute", "sweep", "tree", "auto"'),
        ({"leaf_size": 0}, "leaf_size is 0; it must be at least 1"),
        ({"leaf_size": 2**32}, "leaf_size is 4294967296; it must be at least 1, and below"),
        ({"threads": 0}, "threads is 0; it must be at least 1"),
        ({"threads": "both"}, 'threads is "both"; it can be a number or "all"'),
        ({"level": -1}, "level is -1; the root is 0"),
        ({"level": 1, "update": "top-down"}, "level is the hybrid update's"),
    ],
    ids=str,
)
def test_options_that_are_none(options: dict[str, Any], message: str) -> None:
    with pytest.raises(pliant.Error, match=message) as refused:
        pliant.World(**options)
    assert refused.value.kind == "BadOption"


def test_options_make_another_world_like_it() -> None:
    given: Any = dict(degree=4, partition="mean", leaf_size=3, update="hybrid", level=2, broad="sweep", threads=2, mending=True)
    world = pliant.World(**given)
    assert world.options() == given
    assert pliant.World(**world.options()).options() == given
    assert pliant.World(threads="all").options()["threads"] == "all"


def test_options_reach_the_library() -> None:
    """Depth, leaves and work of the trees are those that the options ask for."""
    faces, flat = grid(16)  # 512 triangles
    worlds = {degree: pliant.World(degree=degree, leaf_size=1) for degree in (2, 4, 8)}
    shapes = [world.tree_shape(world.add(faces, flat)) for world in worlds.values()]
    assert [shape.leaves for shape in shapes] == [512] * 3
    assert shapes[0].nodes == 1023 and shapes[0].depth > shapes[1].depth > shapes[2].depth == 3
    assert pliant.World().options()["leaf_size"] == 8

    work = {}
    every: list[dict[str, Any]] = [{"update": "bottom-up"}, {"update": "top-down"}, {}, {"level": 0}, {"level": 1}]
    for options in every:
        world = pliant.World(leaf_size=1, **options)
        world.add(faces, flat)
        world.add(faces, flat)
        world.intersections(pliant.Selection.between(0, 1)).all()
        statistics = world.statistics()
        work[str(options)] = (statistics.boxes_bottom_up, statistics.boxes_top_down)
    bottom_up, top_down, hybrid, level_0, level_1 = work.values()
    assert bottom_up[1] == 0 and top_down[0] == 0 < top_down[1]
    assert level_0[0] < level_1[0] < bottom_up[0] and level_1 == hybrid
    # A body that meets itself is refitted as a whole, unless a level is asked for; also if it met another before, and was in part.
    world = pliant.World(leaf_size=1)
    world.add(faces, flat)
    world.add(faces, flat)
    world.intersections(pliant.Selection.between(0, 1)).prepare()
    world.intersections(pliant.Selection.within(0)).all()
    statistics = world.statistics()
    assert (statistics.boxes_bottom_up, statistics.boxes_top_down) == (level_1[0] + bottom_up[0] // 2, 0)
    world = pliant.World(leaf_size=1)
    world.add(faces, flat)
    world.intersections(pliant.Selection.within(0)).prepare()
    world.intersections(pliant.Selection.within(0)).all()
    assert (2 * world.statistics().boxes_bottom_up, world.statistics().boxes_top_down) == bottom_up
    centre, mean, connectivity = (pliant.World(partition=p, leaf_size=1) for p in ("centre", "mean", "connectivity"))
    skewed = flat**3
    parts = [w.tree_cut(w.add(faces, skewed), 1).tolist() for w in (centre, mean, connectivity, pliant.World())]
    assert all(a != b for i, a in enumerate(parts) for b in parts[:i])


def test_filters_boxes_and_small_questions() -> None:
    world = two_sheets()
    of_world, everything = world.intersections(), world.intersections(pliant.Selection.EVERYTHING)
    every = of_world.all()
    assert every.shape == (len(every), 4) and len(every) > 0
    assert (world.triangle_count(0), world.vertex_count(np.uint32(1))) == (18, 16)
    world.ignore(0, 1)
    assert len(of_world.all()) == 0 and of_world.first() is None
    assert len(pairs_between(world, 0, 1)) == len(every)
    world.unignore(1, 0)
    world.set_filter(0, 1, 0xFFFFFFFF)
    world.set_filter(1, 2, 2)
    assert len(of_world.all()) == 0
    world.set_filter(1, 2, 1)
    assert len(of_world.all()) == len(every)
    world.set_environment(0, 2**32 - 1)
    assert len(of_world.all()) == 0 and world.environment(0) == 2**32 - 1
    world.set_environment(1, 2**32 - 1)
    assert len(of_world.all()) == len(every)
    world.set_loose_box(1, None)
    # A sheet that is folded onto itself: bodies meet themselves unless their filter or ignore says no.
    world.set_positions(1, np.abs(FLAT - 0.4) + 5)
    assert len(of_world.all()) == 0
    world.set_filter(1, 2, 3)
    itself = world.intersections(pliant.Selection.within(1)).all().tolist()
    assert everything.all().tolist() == itself and itself
    world.ignore(1, 1)
    assert len(everything.all()) == 0 and everything.first() is None
    world.unignore(1, 1)
    world.set_filter(1, 2, 1)
    assert len(everything.all()) == 0
    world.set_filter(1, 2, 2)
    assert everything.all().tolist() == itself
    assert world.intersections(pliant.Selection.within(1)).all().tolist() == itself
    world.set_positions(1, FLAT + 5)
    assert len(everything.all()) == 0
    parts = world.tree_cut(0, 1)
    assert parts.dtype == np.uint32 and parts.shape == (18,)
    assert world.statistics()._fields[-1] == "pairs" and world.statistics().pairs == 0


def test_corners_of_a_loose_box_are_rounded_like_positions() -> None:
    world = pliant.World()
    world.add([[0, 0, 0]], np.full((1, 3), 0.7, np.float32))
    world.set_loose_box(0, ([0.7] * 3, [0.7] * 3))
    with pytest.raises(pliant.Error) as refused:
        world.set_loose_box(0, ([-1e300] * 3, [1] * 3))
    assert refused.value.kind == "BadLooseBox"


@pytest.mark.parametrize("call", [lambda w: w.remove("0"), lambda w: w.remove(0.0), lambda w: w.set_filter(0, -1, 1)])
def test_arguments_of_a_wrong_type(call: Callable[[pliant.World], Any]) -> None:
    with pytest.raises((TypeError, OverflowError)):
        call(two_sheets())


def test_questions_to_a_world_without_bodies() -> None:
    world = pliant.World()
    world.validate()
    assert world.bodies() == []
    for of in (pliant.Selection.WORLD, pliant.Selection.EVERYTHING):
        query = world.intersections(of)
        query.prepare()
        assert query.first() is None and not query.visit(lambda pair: True)
        assert query.all().shape == (0, 4) and query.all(at_most=0).dtype == np.uint32
    assert sum(world.statistics()) == 0


@pytest.mark.parametrize("given", ["EVERYTHING", "world", 0, None, (0, 1), pliant.Selection], ids=repr)
def test_what_is_no_selection_is_told_what_is(given: Any) -> None:
    world = two_sheets()
    calls: list[Callable[[], Any]] = [
        lambda: world.intersections(given),
        lambda: world.contacts(given),
        lambda: world.adjacent_intersections(given),
        lambda: world.vertex_triangle_candidates(given, 0.1),
        lambda: world.close_triangle_pairs(given, 0.1),
        lambda: world.edge_edge_impacts(given),
        lambda: world.first_impact(given),
        lambda: world.free_step(given),
        lambda: world.clearance(given, 1.0),
        lambda: world.contained(given),
    ]
    for call in calls:
        with pytest.raises(TypeError, match=r"pliant.Selection: Selection.EVERYTHING, .*Selection.within\(a\); not .*") as refused:
            call()
        assert repr(given) in str(refused.value)


def test_who_goes_through_a_question_is_told_to_ask_it() -> None:
    world, of = two_sheets(), pliant.Selection.WORLD
    queries: list[Any] = [
        world.intersections(of),
        world.edge_edge_candidates(of, 0.1),
        world.contacts(of),
        world.close_vertex_triangle_pairs(of, 0.1),
        world.vertex_triangle_impacts(of),
    ]
    for query in queries:
        for call in (lambda: list(query), lambda: len(query), lambda: [hit for hit in query]):
            with pytest.raises(TypeError, match=r"a question that was not answered yet: ask it for all\(\), first\(\) or visit"):
                call()
