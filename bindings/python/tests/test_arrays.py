"""What arrays are taken, where they are copied, and what is refused."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import fold, grid, pairs_between, pairs_within
from numpy.typing import NDArray

FACES, FLAT = grid(12)
SHAPE = fold(FLAT, 1.0)
EXPECTED = {dtype: pliant.reference.self_intersection_pairs(SHAPE.astype(dtype), FACES).tolist() for dtype in ("f4", "f8")}


def unaligned(array: NDArray[Any]) -> NDArray[Any]:
    """The same values, one byte beside where they should lie."""
    buffer = np.frombuffer(b"x" + array.tobytes(), np.uint8)[1:]
    return buffer.view(array.dtype).reshape(array.shape)


LAYOUTS: dict[str, Callable[[NDArray[Any]], Any]] = {
    "contiguous": np.ascontiguousarray,
    "Fortran": np.asfortranarray,
    "every second row": lambda array: np.repeat(array, 2, axis=0)[::2],
    "backwards": lambda array: array[::-1].copy()[::-1],
    "three of four columns": lambda array: np.insert(array, 3, 7, axis=1)[:, :3],
    "other byte order": lambda array: array.astype(array.dtype.newbyteorder()),
    "unaligned": unaligned,
    "read only": lambda array: np.frombuffer(array.tobytes(), array.dtype).reshape(array.shape),
    "a subclass": lambda array: array.view(np.recarray),
    "a list": lambda array: array.tolist(),
    "an object that gives an array": lambda array: SimpleNamespace(__array_interface__=array.__array_interface__, keep=array),
}


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS.keys())
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_every_layout_has_the_same_answer(layout: Callable[[NDArray[Any]], Any], dtype: str) -> None:
    world = pliant.World()
    body = world.add(layout(FACES), layout(FLAT))
    assert world.dtype == np.float64
    world.set_positions(body, layout(SHAPE.astype(dtype)))
    assert pairs_within(world, body).tolist() == EXPECTED[dtype]
    assert len(EXPECTED[dtype]) > 10


@pytest.mark.parametrize("integer", [np.uint8, np.uint16, np.uint32, np.uint64, np.int8, np.int16, np.int32, np.int64])
def test_faces_of_any_integer_type(integer: Any) -> None:
    faces, positions = grid(7)  # 64 vertices: an int8 holds their numbers
    shape = fold(positions, 1.0)
    found = pliant.self_intersection_pairs(shape, faces.astype(integer))
    np.testing.assert_array_equal(found, pliant.reference.self_intersection_pairs(shape, faces))
    assert len(found) > 0


@pytest.mark.parametrize(
    ("dtype", "bad"),
    [(np.int64, -1), (np.int8, -128), (np.int64, 2**32), (np.uint64, 2**64 - 1), (np.uint32, 64), (np.int16, 64)],
)
def test_a_face_that_names_no_vertex_is_named(dtype: Any, bad: int) -> None:
    faces, positions = grid(7)
    faces = faces.astype(dtype)
    faces[5, 1] = bad
    with pytest.raises(pliant.Error, match=f"triangle 5 names vertex {bad}, but there are 64 vertices") as refused:
        pliant.World().add(faces, positions)
    facts = refused.value
    assert (facts.kind, facts.body, facts.triangle, facts.vertex, facts.vertices) == ("VertexOutOfRange", None, 5, bad, 64)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_shapes_are_copied_into_memory_that_the_world_keeps(dtype: Any) -> None:
    faces, flat = grid(100)
    flat = flat.astype(dtype)
    world = pliant.World()
    body = world.add(faces, flat)

    def allocated(positions: NDArray[Any]) -> int:
        """Bytes of numpy's for one call."""
        tracemalloc.start()
        world.set_positions(body, positions)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak

    # The same measure sees memory that is allocated: for the first shape, and each time for one in another byte order.
    assert allocated(flat) > flat.nbytes
    swapped = flat.astype(flat.dtype.newbyteorder())
    assert allocated(swapped) > flat.nbytes
    for layout in (np.ascontiguousarray, np.asfortranarray, LAYOUTS["every second row"], LAYOUTS["unaligned"]):
        assert allocated(layout(flat)) < 10_000
    # Smaller bodies are copied to the same place.
    faces, small = grid(50)
    body = world.add(faces, small.astype(dtype))
    assert allocated(small.astype(np.float32)) < 10_000


def masked(array: NDArray[Any], row: int | None) -> Any:
    hidden = np.zeros(array.shape, bool)
    if row is not None:
        hidden[row, 1] = True
    return np.ma.array(array, mask=hidden)


def test_masked_arrays_that_hide_a_number_are_refused() -> None:
    world = pliant.World()
    # A mask that hides nothing changes nothing.
    body = world.add(masked(FACES, None), masked(FLAT, None))
    world.set_positions(body, masked(SHAPE, None))
    assert pairs_within(world, body).tolist() == EXPECTED["f8"]
    bad_positions, bad_faces = masked(FLAT, 7), masked(FACES.astype(np.int64), 7)
    calls: list[tuple[str, Callable[[], object]]] = [
        ("new body: positions", lambda: world.add(FACES, bad_positions)),
        ("new body: faces", lambda: world.add(bad_faces, FLAT)),
        ("new body: faces", lambda: world.add(masked(FACES, 0), FLAT)),
        ("new body: positions", lambda: world.add(SimpleNamespace(faces=FACES, vertices=bad_positions))),
        ("new body: faces", lambda: world.add(SimpleNamespace(triangles=bad_faces, vertices=FLAT))),
        ("body 0: positions", lambda: world.set_positions(body, bad_positions)),
        ("body 0: positions", lambda: world.set_positions(body, bad_positions.astype(np.float32))),
        ("body 0: positions", lambda: world.set_positions(body, list(bad_positions))),
        ("body 0: positions", lambda: world.set_positions(body, tuple(bad_positions))),
        ("b: faces", lambda: pliant.intersection_pairs(FLAT, FACES, FLAT, bad_faces)),
        ("mesh: positions", lambda: pliant.self_intersection_pairs(bad_positions, FACES)),
        ("mesh: positions", lambda: pliant.reference.self_intersection_pairs(bad_positions, FACES)),
    ]
    for about, call in calls:
        with pytest.raises(pliant.Error, match=f"^{about} are masked in places, .*filled") as refused:
            call()
        assert refused.value.kind == "BadArray" and len(str(refused.value).splitlines()) == 1
    assert world.bodies() == [body]
    assert pairs_within(world, body).tolist() == EXPECTED["f8"]


def test_arrays_larger_than_any_memory_are_refused() -> None:
    """A view that repeats three numbers, and claims to be 10^15 rows."""
    huge = np.broadcast_to(np.zeros(3), (10**15, 3))
    world = pliant.World()
    body = world.add(FACES, FLAT)
    with pytest.raises(pliant.Error, match=r"10{15}") as refused:
        world.set_positions(body, huge)
    assert (refused.value.kind, refused.value.expected, refused.value.found) == ("WrongLength", len(FLAT), 10**15)
    with pytest.raises(MemoryError):
        world.add(FACES, huge)
    with pytest.raises(MemoryError):
        world.add(np.broadcast_to(np.zeros(3, np.uint32), (10**15, 3)), FLAT)
    with pytest.raises(MemoryError):
        world.add(np.broadcast_to(np.zeros(3, np.int64), (10**15, 3)), FLAT)
    assert world.bodies() == [body]


def test_the_first_body_fixes_the_precision() -> None:
    world = pliant.World()
    assert world.dtype is None and repr(world) == "<pliant.World, no body yet>"
    with pytest.raises(pliant.Error):
        world.add(FACES, FLAT.astype(np.float32)[:3])
    assert world.dtype is None, "a body that was refused fixes nothing"
    body = world.add(FACES, FLAT.astype(np.float32))
    assert world.dtype == np.float32 and repr(world) == "<pliant.World of float32, 1 body>"
    for call, about in ((lambda: world.set_positions(body, SHAPE), body), (lambda: world.add(FACES, SHAPE), None)):
        with pytest.raises(pliant.Error, match=r"astype\(numpy.float32\)") as refused:
            call()
        assert (refused.value.kind, refused.value.body) == ("Precision", about)
    world.remove(body)
    assert world.dtype == np.float32


def test_float32_in_a_float64_world_changes_no_coordinate() -> None:
    """A plane and points on it that no rounding but the exact widening keeps there."""
    tenth = np.float32(0.1)
    faces = [[0, 1, 2]]
    plane = np.array([[0, 0, float(tenth)], [1, 0, float(tenth)], [0, 1, float(tenth)]])
    point = np.full((3, 3), tenth, np.float32)
    world = pliant.World()
    a = world.add(faces, plane)
    b = world.add(faces, point)
    assert pairs_between(world, a, b).tolist() == [[0, 0]]
    world.set_positions(b, np.full((3, 3), 0.1))
    assert pairs_between(world, a, b).tolist() == []
    assert pliant.intersection_pairs(plane, faces, point, faces).tolist() == [[0, 0]]
    assert pliant.intersection_pairs(point, faces, plane, faces).tolist() == [[0, 0]]


@pytest.mark.parametrize(
    ("faces", "positions", "message"),
    [
        (FACES, FLAT[:, :2], r"positions have shape \(169, 2\); it must be \(n, 3\): two coordinates; pliant needs three"),
        (FACES, FLAT.ravel(), r"positions have shape \(507,\).*: flat; give positions.reshape\(-1, 3\)"),
        (FACES, FLAT[None], r"positions have shape \(1, 169, 3\).*: give one frame at a time"),
        (FACES[:, [0, 1, 2, 2]], FLAT, r"faces have shape \(288, 4\); it must be \(m, 3\): cut quads into two.*tetrahedra give the surface"),
        (np.insert(FACES, 0, 3, axis=1), FLAT, r"\(288, 4\).*cells of VTK, \[3, a, b, c\]; give faces\[:, 1:\]"),
        (np.insert(FACES, 0, 3, axis=1)[:3].tolist(), FLAT, r"\(3, 4\).*cells of VTK, \[3, a, b, c\]; give faces\[:, 1:\]"),
        (np.insert(FACES, 0, 3, axis=1).ravel(), FLAT, r"\(1152,\).*cells of VTK.*give faces.reshape\(-1, 4\)\[:, 1:\]"),
        (FACES[:, [0, 1, 2, 0, 1]], FLAT, r"\(288, 5\); it must be \(m, 3\)$"),
        (FACES.ravel(), FLAT, r"\(864,\); it must be \(m, 3\): flat; give faces.reshape\(-1, 3\)"),
        (FACES[:, :2], FLAT, r"\(288, 2\).*of edges give each as the triangle \[i, j, j\]"),
        (FACES.T, FLAT, r"\(3, 288\).*transposed\?"),
        (FACES[None], FLAT, r"\(1, 288, 3\).*one frame at a time"),
        (FACES[:0, [0, 0, 0, 0]], FLAT, r"\(0, 4\).*cut quads"),
        (FACES.ravel()[:0], FLAT, r"\(0,\); it must be"),
        (FACES, FLAT.T, r"positions have shape \(3, 169\); it must be \(n, 3\): transposed\?"),
        (FACES.astype(float), FLAT, "faces are of type float64; they must be integers"),
        (FLAT, FACES, "positions are of type uint32.*exchanged"),
        (FACES.astype(bool), FLAT, "faces are of type bool"),
        (FACES, FLAT.astype(np.float16), r"positions are of type float16.*astype\(numpy.float64\)"),
        (FACES, FLAT.astype(np.longdouble), "positions are of type float128|positions are of type longdouble"),
        (FACES, FLAT.astype(complex), "positions are of type complex128"),
        (FACES, FLAT.astype(str), "positions are of type <U"),
        (FACES, None, "has no .faces"),
        (FACES, "positions", r"positions have shape \(\)"),
    ],
    ids=range(24),
)
def test_what_is_no_mesh_is_refused(faces: Any, positions: Any, message: str) -> None:
    world = pliant.World()
    with pytest.raises(pliant.Error, match=message) as refused:
        world.add(faces, positions) if positions is not None else world.add(faces)
    assert refused.value.kind == "BadArray"
    assert world.bodies() == []


@pytest.mark.parametrize("names", [("vertices", "faces"), ("vertices", "triangles")])
def test_anything_with_vertices_and_faces_is_a_mesh(names: tuple[str, str]) -> None:
    def mesh(z: float) -> Any:
        return SimpleNamespace(**dict(zip(names, (SHAPE + [0, 0, z], FACES.astype(np.int64)))))

    a, b = mesh(0.0), mesh(0.05)
    world = pliant.World()
    assert world.add(a) == 0
    assert pairs_within(world, 0).tolist() == EXPECTED["f8"]
    assert pliant.self_intersection_pairs(a).tolist() == EXPECTED["f8"]
    assert pliant.reference.self_intersection_pairs(a).tolist() == EXPECTED["f8"]
    between = pliant.intersection_pairs(a, b).tolist()
    assert between == pliant.reference.intersection_pairs(a, b).tolist() and between
    # In trimesh, .triangles are coordinates; .faces are what is meant.
    if "faces" in names:
        a.triangles = SHAPE[FACES]
        assert pliant.self_intersection_pairs(a).tolist() == EXPECTED["f8"]


def test_a_mesh_of_trimesh() -> None:
    trimesh = pytest.importorskip("trimesh")
    a = trimesh.creation.icosphere(subdivisions=3)
    b = a.copy()
    b.apply_translation([0.5, 0.25, 0.125])
    pairs = pliant.intersection_pairs(a, b)
    assert pairs.tolist() == pliant.reference.intersection_pairs(a.vertices, a.faces, b.vertices, b.faces).tolist()
    assert len(pairs) > 50
    assert len(pliant.self_intersection_pairs(a)) == 0


def test_a_mesh_of_open3d() -> None:
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    a = open3d.geometry.TriangleMesh.create_sphere(1.0, 20)
    b = open3d.geometry.TriangleMesh.create_sphere(1.0, 20).translate((0.5, 0.25, 0.125))
    expected = pliant.reference.intersection_pairs(a, b).tolist()
    assert pliant.intersection_pairs(a, b).tolist() == expected and expected
    world = pliant.World()
    bodies = [world.add(a), world.add(a)]
    world.set_positions(bodies[1], b.vertices)
    assert pairs_between(world, bodies[0], bodies[1]).tolist() == expected


def test_answers_belong_to_the_caller() -> None:
    world = pliant.World()
    body = world.add(FACES, SHAPE)
    itself = world.intersections(pliant.Selection.within(body))
    hits = itself.all()
    world.set_positions(body, FLAT)
    assert itself.all().shape == (0, 4)
    del world, itself
    hits[:] += 0
    assert hits[:, [1, 3]].tolist() == EXPECTED["f8"]


def test_an_iterable_that_raises_raises() -> None:
    class Raises:
        def __array__(self, *_: Any, **__: Any) -> Any:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        pliant.World().add(FACES, Raises())


@pytest.mark.parametrize("count", [0, 1, 3, 5])
def test_the_one_liners_say_what_they_want(count: int) -> None:
    with pytest.raises(TypeError, match="two meshes, or four arrays"):
        pliant.intersection_pairs(*[FLAT] * count)
    with pytest.raises(TypeError, match="a mesh, or two arrays"):
        pliant.self_intersection_pairs(*[FLAT] * (count + 2 if count else 0))


def test_the_one_liners_say_which_mesh_is_wrong() -> None:
    with pytest.raises(pliant.Error, match="^b: positions have shape"):
        pliant.intersection_pairs(FLAT, FACES, FLAT[0], FACES)
    bad = FLAT.copy()
    bad[3, 2] = np.nan
    with pytest.raises(pliant.Error, match="^a: vertex 3 is at") as refused:
        pliant.intersection_pairs(bad, FACES, FLAT, FACES)
    assert refused.value.kind == "BadPosition" and refused.value.vertex == 3
    with pytest.raises(pliant.Error, match="^mesh: vertex 3 is at"):
        pliant.self_intersection_pairs(bad, FACES)
    with pytest.raises(pliant.Error, match="^new body: vertex 3 is at"):
        pliant.World().add(FACES, bad)


def test_the_cures_that_are_named_are_cures() -> None:
    """Of cells of VTK, of flat arrays and of edges."""
    cells = np.insert(FACES, 0, 3, axis=1)
    world = pliant.World()
    for faces in (cells[:, 1:], cells.ravel().reshape(-1, 4)[:, 1:], FACES.ravel().reshape(-1, 3)):
        body = world.add(faces, SHAPE.ravel().reshape(-1, 3))
        assert pairs_within(world, body).tolist() == EXPECTED["f8"]
    edges = FACES[:, :2]
    assert world.triangle_count(world.add(np.stack([edges[:, 0], edges[:, 1], edges[:, 1]], axis=1), SHAPE)) == len(edges)


class OnlyDlpack:
    """What has nothing but this, as arrays of some libraries."""

    def __init__(self, array: Any) -> None:
        self.array = array

    def __dlpack__(self, **keywords: Any) -> Any:
        return self.array.__dlpack__(**keywords)

    def __dlpack_device__(self) -> Any:
        return self.array.__dlpack_device__()


class Elsewhere:
    """What is in the memory of another device, from where numpy would copy it."""

    def __dlpack__(self, **_: Any) -> Any:
        raise BufferError("on a GPU")

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise AssertionError("nobody asked for a copy")

    def __dlpack_device__(self) -> tuple[int, int]:
        return (2, 0)


def test_what_has_nothing_but_dlpack_is_an_array() -> None:
    world = pliant.World()
    body = world.add(OnlyDlpack(FACES.astype(np.int64)), OnlyDlpack(FLAT))
    shape = SHAPE.copy()
    world.set_positions(body, OnlyDlpack(shape))
    shape[:] = 9  # the world keeps a copy of its own
    assert pairs_within(world, body).tolist() == EXPECTED["f8"]
    world.set_vertex_groups(body, OnlyDlpack(np.arange(len(FLAT), dtype=np.uint32)))
    assert world.vertex_groups(body).tolist() == list(range(len(FLAT)))
    pair = np.array([[[1, 1, 1], [0, 0, 0], [4, 0, 0], [0, 4, 0]]], dtype=np.float64)
    assert pliant.vertex_triangle_impacts(OnlyDlpack(pair), OnlyDlpack(pair * [1, 1, -1]))[0].tolist() == [True]
    with pytest.raises(pliant.Error, match=r"positions have shape \(288, 4\)"):
        world.set_positions(body, OnlyDlpack(np.zeros((288, 4))))
    calls: list[tuple[str, Callable[[], object]]] = [
        ("positions", lambda: world.set_positions(body, Elsewhere())),
        ("faces", lambda: world.add(Elsewhere(), FLAT)),
        ("groups", lambda: world.set_vertex_groups(body, Elsewhere())),
        ("corners", lambda: pliant.edge_edge_impacts(Elsewhere(), pair)),
        ("positions", lambda: pliant.self_intersections(FACES, Elsewhere())),
        ("positions", lambda: world.intersections().of_frames({body: Elsewhere()})),
    ]
    for what, call in calls:
        with pytest.raises(pliant.Error, match=rf"{what} are on another device \(kind 2 of DLPack, number 0\);.* as {what}.cpu\(\) does") as refused:
            call()
        assert refused.value.kind == "BadArray"


def test_groups_of_a_wrong_length_are_called_groups() -> None:
    world = pliant.World()
    body = world.add(FACES, FLAT)
    with pytest.raises(pliant.Error, match="^body 0: 168 groups for 169 vertices; give one") as refused:
        world.set_vertex_groups(body, np.ones(168, np.uint32))
    facts = refused.value
    assert (facts.kind, facts.what, facts.expected, facts.found) == ("WrongLength", "groups", 169, 168)
    with pytest.raises(pliant.Error, match="^body 0: 168 positions for 169 vertices; give one"):
        world.set_positions(body, FLAT[1:])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_many_shapes_at_once(dtype: type) -> None:
    """As of one body after the other; all of them, or none."""
    world, twin = pliant.World(), pliant.World()
    bodies = [world.add(FACES, SHAPE.astype(dtype)) for _ in range(3)]
    for _ in bodies:
        twin.add(FACES, SHAPE.astype(dtype))
    shapes: dict[int, Any] = {body: (SHAPE + body).astype(dtype) for body in bodies}
    world.set_positions_of(shapes)
    for body, shape in shapes.items():
        twin.set_positions(body, shape)
        np.testing.assert_array_equal(world.positions(body), twin.positions(body))
    for wrong, body in (
        ([(bodies[0], SHAPE), (bodies[1], SHAPE * np.nan)], bodies[1]),
        ([(bodies[2], SHAPE), (bodies[2], SHAPE)], bodies[2]),
        ([(bodies[0], SHAPE), (99, SHAPE)], 99),
    ):
        wrong = [(number, shape.astype(dtype)) for number, shape in wrong]
        with pytest.raises(pliant.Error) as refused:
            world.set_positions_of(wrong)
        assert refused.value.body == body
        for body, shape in shapes.items():
            np.testing.assert_array_equal(world.positions(body), shape)
