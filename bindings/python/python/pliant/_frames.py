"""Many shapes of one mesh, or of two, in one call: a world and Query.of_frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ._pliant import Selection, World, _as_array
from ._types import Error, FrameHits

if TYPE_CHECKING:
    from typing import TypeAlias

    _Answer: TypeAlias = Literal["rows", "first", "counts", "any"]


def self_intersections(faces: Any, positions: Any, *, answer: _Answer = "rows", threads: int | Literal["all"] = 1) -> Any:
    """Self-intersections of many shapes of a mesh, in one call.

        found = pliant.self_intersections(faces, positions, threads="all")
        found.counts                # (frames,) pairs of each
        found.frame(7)              # (k, 2) uint32, sorted: smaller triangle, larger triangle

    faces are (m, 3) of any integer type, positions (frames, n, 3) float32 or float64, as World.add
    takes them. Triangles that share a vertex are left out. A frame is answered as
    self_intersection_pairs answers it, whatever the others are and however many threads there are.
    Answers and errors are those of Query.of_frames: "rows", "first", "counts" or "any".

    Cost: one tree, built on the first frame and copied for each thread; then for each frame what
    World.intersections costs.
    """
    return _pairs(Selection.within, [(faces, positions)], answer, threads)


def intersections(
    faces_a: Any,
    positions_a: Any,
    faces_b: Any,
    positions_b: Any,
    *,
    answer: _Answer = "rows",
    threads: int | Literal["all"] = 1,
) -> Any:
    """Intersections of many shapes of two meshes, in one call.

    As self_intersections; a pair is a triangle of a and a triangle of b. Positions of one of them
    may be (n, 3): a mesh that stays as it is. If one mesh is of float64, both are decided in it.
    """
    return _pairs(Selection.between, [(faces_a, positions_a), (faces_b, positions_b)], answer, threads)


def _pairs(select: Any, meshes: list[tuple[Any, Any]], answer: _Answer, threads: int | Literal["all"]) -> Any:
    shapes = [_as_array(positions, "positions") for _, positions in meshes]
    if not any(shape.ndim == 3 for shape in shapes):
        given = ", ".join(str(shape.shape) for shape in shapes)
        raise Error(f"positions have shape {given}; they must be (frames, n, 3)", "BadArray")
    world = World()
    frames = {}
    wide = any(shape.dtype.kind == "f" and shape.dtype.itemsize == 8 for shape in shapes)
    for (faces, _), shape in zip(meshes, shapes, strict=True):
        first = shape
        if shape.ndim == 3:
            first = shape[0] if len(shape) else np.zeros(shape.shape[1:], shape.dtype)
            # The tree needs numbers; a frame without is refused with its number.
            first = np.where(np.abs(first) <= np.finfo(np.float32).max, first, first.dtype.type(0))
        widened = wide and shape.dtype.kind == "f" and shape.dtype.itemsize == 4
        body = world.add(faces, first.astype(np.float64) if widened else first)
        if shape.ndim == 3:
            frames[body] = shape
    found = world.intersections(select(*range(len(meshes)))).of_frames(frames, answer=answer, threads=threads)
    # A hit is body, triangle, body, triangle, of bodies that are known.
    return FrameHits(np.ascontiguousarray(found.hits[:, 1::2]), found.offsets) if isinstance(found, FrameHits) else found
