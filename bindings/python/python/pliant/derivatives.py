"""Derivatives of squared distances of contacts, for solvers: closed forms, in numpy.

    contacts = pliant.feature_pairs(world, pliant.Selection.EVERYTHING, reach)
    positions = {body: world.positions(body) for body in world.bodies()}
    corners = derivatives.corners(contacts, positions)
    square, gradient, hessian = derivatives.squared_distance(contacts.kind, corners)

Features are frozen: of a vertex and an edge it is the distance of a point and a line, of a face
that of a point and a plane, of two edges that of two lines. These are the distances of the contacts
as long as the same features are closest.

With weights c, linear in the parameters s of both closest points, the square is the least of
f(x, s) = |sum_i c_i x_i|^2 over s. So its gradient is f_x, and its Hessian is
f_xx - f_xs f_ss^-1 f_sx.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ._types import FeatureKind, FeaturePairs

__all__ = ["corners", "positive_part", "squared_distance"]

# Weights of the four corners at parameters 0, and what each of two parameters adds, by kind.
_WEIGHTS = np.zeros((4, 4))
_ADDED = np.zeros((4, 2, 4))
_WEIGHTS[FeatureKind.VERTEX_VERTEX, :2] = 1, -1
_WEIGHTS[FeatureKind.VERTEX_EDGE, :2] = 1, -1
_ADDED[FeatureKind.VERTEX_EDGE, 0, 1:3] = 1, -1
_WEIGHTS[FeatureKind.EDGE_EDGE] = 1, 0, -1, 0
_ADDED[FeatureKind.EDGE_EDGE, 0, :2] = -1, 1
_ADDED[FeatureKind.EDGE_EDGE, 1, 2:] = 1, -1
_WEIGHTS[FeatureKind.VERTEX_FACE, :2] = 1, -1
_ADDED[FeatureKind.VERTEX_FACE, 0, 1:3] = 1, -1
_ADDED[FeatureKind.VERTEX_FACE, 1, 1:] = 1, 0, -1


def corners(
    contacts: FeaturePairs, positions: Mapping[int, NDArray[np.floating]]
) -> NDArray[np.float64]:
    """Positions of the vertices of contacts, (k, 4, 3) float64; zeros where there is none.

    positions has an array (n, 3) for the number of each body. KeyError without one that is needed.
    """
    rows = np.zeros((len(contacts.kind), 4, 3))
    first = np.where(contacts.kind == FeatureKind.EDGE_EDGE, 2, 1)
    of_second = np.arange(4) >= first[:, None]
    bodies = np.where(of_second, contacts.bodies[:, 1:], contacts.bodies[:, :1])
    used = contacts.vertices != 0xFFFFFFFF
    for body in np.unique(bodies[used]).tolist():
        here = used & (bodies == body)
        rows[here] = positions[body][contacts.vertices[here]]
    return rows


def squared_distance(
    kind: NDArray[np.integer], corners: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Squared distance (k,), gradient (k, 4, 3) and Hessian (k, 12, 12), with frozen features.

    kind is a FeatureKind each, (k,), and corners are (k, 4, 3): of the first feature, then of the
    second, as FeaturePairs has them. Rows of the Hessian are in the order of a flattened (4, 3).
    Corners that a kind does not have count nothing. Nearly parallel edges, and needles, lose digits
    as their lines and planes do. Cost: O(k).
    """
    kind = np.asarray(kind, dtype=np.intp)
    rows = np.asarray(corners, dtype=np.float64)
    fixed, added = _WEIGHTS[kind], _ADDED[kind]
    # r = r_0 + sum_l s_l e_l is least where (e e^T) s = -e r_0. What has fewer parameters has e = 0.
    e = added @ rows
    gram = e @ e.transpose(0, 2, 1)
    unused = ~added.any(axis=2)
    gram[unused[:, 0], 0, 0] = 1
    gram[unused[:, 1], 1, 1] = 1
    inverse = np.linalg.pinv(gram, hermitian=True) if len(gram) else gram
    start = np.einsum("ki,kid->kd", fixed, rows)
    s = -np.einsum("klm,kmd,kd->kl", inverse, e, start)
    weights = fixed + np.einsum("kl,kli->ki", s, added)
    r = np.einsum("ki,kid->kd", weights, rows)
    gradient = 2 * weights[:, :, None] * r[:, None, :]
    # f_xs of corner i and parameter l: 2 (added_li r + c_i e_l).
    mixed = 2 * (added[..., None] * r[:, None, None, :] + weights[:, None, :, None] * e[:, :, None, :])
    mixed = mixed.reshape(len(kind), 2, 12)
    hessian = 2 * np.einsum("ki,kj,ab->kiajb", weights, weights, np.eye(3)).reshape(-1, 12, 12)
    hessian -= np.einsum("kla,klm,kmb->kab", mixed, inverse / 2, mixed)
    return (r * r).sum(1), gradient, hessian


def positive_part(hessian: NDArray[np.float64]) -> NDArray[np.float64]:
    """The nearest positive semidefinite matrix of each of some symmetric ones, (k, n, n)."""
    values, vectors = np.linalg.eigh(hessian)
    return (vectors * np.maximum(values, 0)[:, None, :]) @ vectors.transpose(0, 2, 1)
