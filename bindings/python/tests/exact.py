"""Which triangles intersect, decided in integers and from another definition than the library's: two closed triangles meet if
and only if zero is in the convex hull of the nine differences of their corners.

By Carathéodory it is then in a tetrahedron, triangle, segment or point of at most four of them that spans its own dimension.
For coordinates that are small integers, so that no product leaves 64 bits.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

Integers = NDArray[np.int64]

_FOURS, _THREES, _TWOS = (np.array(list(combinations(range(9), k))) for k in (4, 3, 2))


def _dot(a: Integers, b: Integers) -> Integers:
    product: Integers = (a * b).sum(axis=-1)
    return product


def triangles_meet(a: Integers, b: Integers) -> NDArray[np.bool_]:
    """For rows of triangle pairs, (k, 3, 3) each."""
    corners = (a[:, :, None, :] - b[:, None, :, :]).reshape(-1, 9, 3)

    p, q, r, s = (corners[:, _FOURS[:, i]] for i in range(4))
    # Volumes of the tetrahedra that zero makes with each side, and of the whole, as their sum.
    sides = np.stack(
        [_dot(q, np.cross(r, s)), -_dot(p, np.cross(r, s)), _dot(p, np.cross(q, s)), -_dot(p, np.cross(q, r))]
    )
    whole = np.sign(sides.sum(axis=0))
    in_tetrahedron = (whole != 0) & (sides * whole >= 0).all(axis=0)

    p, q, r = (corners[:, _THREES[:, i]] for i in range(3))
    normal = np.cross(q - p, r - p)
    inside = np.stack([_dot(normal, np.cross(q, r)), _dot(normal, np.cross(r, p)), _dot(normal, np.cross(p, q))])
    in_triangle = (normal != 0).any(axis=-1) & (_dot(normal, p) == 0) & (inside >= 0).all(axis=0)

    p, q = (corners[:, _TWOS[:, i]] for i in range(2))
    in_segment = (np.cross(p, q) == 0).all(axis=-1) & (_dot(p, q) <= 0)

    found: NDArray[np.bool_] = in_tetrahedron.any(axis=1) | in_triangle.any(axis=1) | in_segment.any(axis=1)
    return found


def intersection_pairs(va: Integers, fa: Integers, vb: Integers, fb: Integers) -> Integers:
    """All pairs (triangle of a, triangle of b), sorted."""
    i, j = (index.ravel() for index in np.indices((len(fa), len(fb))))
    found: Integers = np.stack([i, j], axis=1)[triangles_meet(va[fa[i]], vb[fb[j]])]
    return found


def self_intersection_pairs(vertices: Integers, faces: Integers) -> Integers:
    """All pairs (smaller triangle, larger triangle) that share no vertex, sorted."""
    i, j = np.triu_indices(len(faces), 1)
    apart = (faces[i][:, :, None] != faces[j][:, None, :]).all(axis=(1, 2))
    i, j = i[apart], j[apart]
    found: Integers = np.stack([i, j], axis=1)[triangles_meet(vertices[faces[i]], vertices[faces[j]])]
    return found
