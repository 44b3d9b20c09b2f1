"""Arrays of torch, JAX and Warp, on the processor: read, and results given back without a copy."""

from __future__ import annotations

import gc
from typing import Any

import numpy as np
import pliant
import pytest
from conftest import fold, grid

FACES, FLAT = grid(6)
SHAPES = np.stack([FLAT, fold(FLAT, 1.0), fold(FLAT, 2.0)]).astype(np.float32)


def of_torch(array: Any) -> Any:
    return pytest.importorskip("torch").from_numpy(array.copy())


def of_jax(array: Any) -> Any:
    return pytest.importorskip("jax.numpy").asarray(array)


def of_warp(array: Any) -> Any:
    warp = pytest.importorskip("warp")
    warp.config.quiet = True
    return warp.array(array, dtype=warp.dtype_from_numpy(array.dtype), device="cpu")


@pytest.mark.parametrize("library", [of_torch, of_jax, of_warp])
def test_arrays_of_other_libraries_are_read(library: Any) -> None:
    faces, flat, folded = library(FACES.astype(np.int32)), library(SHAPES[0]), library(SHAPES[1])
    world = pliant.World()
    body = world.add(faces, flat)
    assert world.dtype == np.float32
    world.set_positions(body, folded)
    expected = pliant.self_intersection_pairs(SHAPES[1], FACES)
    assert len(expected) > 0
    pairs = world.intersections(pliant.Selection.within(body)).all()
    assert pairs[:, 1::2].tolist() == expected.tolist()
    found = pliant.self_intersections(faces, library(SHAPES))
    assert found.frame(1).tolist() == expected.tolist()
    assert world.intersections(pliant.Selection.within(body)).of_frames({body: library(SHAPES)}).counts.tolist() == found.counts.tolist()
    assert world.closest_points(library(SHAPES[2]), body).found.all()


def test_results_are_given_to_torch_without_a_copy() -> None:
    torch = pytest.importorskip("torch")
    held = []
    for shape in SHAPES[1:]:
        found = pliant.self_intersections(FACES, shape[None])
        held.append((torch.from_dlpack(found.offsets), found.offsets.tolist(), torch.from_dlpack(found.hits), found.hits.tolist()))
        assert held[-1][0].data_ptr() == found.offsets.ctypes.data
    del found
    gc.collect()
    # Nobody has the arrays but the tensors.
    assert [(offsets.tolist(), hits.tolist()) for offsets, _, hits, _ in held] == [(offsets, hits) for _, offsets, _, hits in held]
    assert held[0][3]


def test_results_are_given_to_jax() -> None:
    numpy = pytest.importorskip("jax.numpy")
    found = pliant.self_intersections(FACES, SHAPES)
    hits = numpy.from_dlpack(found.hits)
    assert hits.tolist() == found.hits.tolist()
