"""Which triangles of deforming meshes intersect: exactly, never stale, and touching only what the contact region needs.

    world = pliant.World()
    cloth = world.add(faces, vertices)                  # (m, 3) of any integer type, (n, 3) float32 or float64
    for positions in frames:
        world.set_positions(cloth, positions)           # checked and taken over
        hits = world.intersections(pliant.Selection.EVERYTHING).all()

A hit is a row of four numbers, uint32: body, triangle, body, triangle; the rows are sorted.

Two triangles intersect as closed sets: touching in one point counts, coplanar overlap counts, a degenerate triangle is the
segment or point that it is. The decision is that of exact arithmetic on the coordinates given. Within a body, pairs that
share a vertex are left out. Surfaces only: a body wholly inside another meets no triangle of it.
"""

from . import reference
from ._pliant import (
    Check,
    CloseQuery,
    ContactQuery,
    Edit,
    ImpactQuery,
    Query,
    Selection,
    World,
    __version__,
    check,
    edge_edge_impacts,
    intersection_pairs,
    self_intersection_pairs,
    vertex_triangle_impacts,
)
from ._types import Body, BodyThere, ClosePair, ClosePairs, Contact, ContactKind, Contacts, EdgeEdge, Edited, Error, FirstImpact, Frame, FreeStep, Fused, Impact, Impacts, Interval, Kinds, Life, Mesh, OpenMesh, Pair, Piece, Place, Statistics, TreeBoxes, TreeShape, VertexTriangle

__all__ = [
    "Body",
    "BodyThere",
    "Check",
    "ClosePair",
    "ClosePairs",
    "CloseQuery",
    "Contact",
    "ContactKind",
    "ContactQuery",
    "Contacts",
    "EdgeEdge",
    "Edit",
    "Edited",
    "Error",
    "FirstImpact",
    "Frame",
    "FreeStep",
    "Fused",
    "Impact",
    "ImpactQuery",
    "Impacts",
    "Interval",
    "Kinds",
    "Life",
    "Mesh",
    "OpenMesh",
    "Pair",
    "Piece",
    "Place",
    "Query",
    "Selection",
    "Statistics",
    "TreeBoxes",
    "TreeShape",
    "VertexTriangle",
    "World",
    "__version__",
    "check",
    "edge_edge_impacts",
    "intersection_pairs",
    "reference",
    "self_intersection_pairs",
    "vertex_triangle_impacts",
]
