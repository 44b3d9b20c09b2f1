"""Exact collision detection for deforming triangle meshes.

    world = pliant.World()
    cloth = world.add(faces, vertices)          # (m, 3) integers, (n, 3) float32 or float64
    for positions in frames:
        world.set_positions(cloth, positions)   # checked and copied
        hits = world.intersections(pliant.Selection.EVERYTHING).all()

A hit is a row of four numbers, uint32: body, triangle, body, triangle. Rows are sorted.

  World                     bodies that deform, and every question about them
  Selection                 which bodies a question is about
  self_intersection_pairs   one mesh, in one call
  intersection_pairs        two meshes, in one call
  self_intersections, intersections    many shapes of one mesh, or of two, in one call
  vertex_triangle_impacts, edge_edge_impacts    when single pairs of moving elements meet
  vertex_triangle_distances, edge_edge_distances    how far single pairs are apart
  triangle_contacts         whether and how single pairs of triangles intersect
  segments, curves          where listed pairs meet
  feature_pairs             each contact of close elements once, as solvers sum it
  Changes                   hits that began, persist and ended since the last list
  check                     files, frame by frame
  Error                     every refusal, with its kind and facts
  derivatives               of squared distances of contacts, for solvers
  reference                 intersections by brute force, to compare with

Two triangles intersect as closed sets: touching in one point counts, and so does coplanar overlap.
A degenerate triangle is the segment or point that it is. The decision is that of exact arithmetic
on the coordinates given. Within a body, triangles that share a vertex are left out. Surfaces only:
a body wholly inside another meets none of its triangles, and World.contained finds it.

help(pliant.World) lists all questions, with shapes, dtypes, errors and cost.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from . import derivatives, reference
from ._frames import intersections, self_intersections
from ._pliant import (
    Changes,
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
    curves,
    edge_edge_distances,
    edge_edge_impacts,
    feature_pairs,
    intersection_pairs,
    segments,
    self_intersection_pairs,
    triangle_contacts,
    vertex_triangle_distances,
    vertex_triangle_impacts,
)
from ._types import (
    Adjacent,
    Body,
    BodyThere,
    Changed,
    ClosePair,
    ClosePairs,
    ClosestPoints,
    Contact,
    ContactKind,
    Contacts,
    Containment,
    Counts,
    CrossingEdge,
    CrossingEdges,
    CurveEnd,
    Curves,
    Depth,
    EdgeEdge,
    Edited,
    Error,
    FeatureKind,
    FeaturePairs,
    FirstImpact,
    Frame,
    FrameHits,
    FreeStep,
    Fused,
    HitRows,
    Impact,
    Impacts,
    Interval,
    Kinds,
    Life,
    Located,
    Mesh,
    OpenMesh,
    Pair,
    PairDistances,
    Piece,
    Place,
    Segments,
    Statistics,
    TreeBoxes,
    TreeShape,
    VertexTriangle,
    Watertight,
)

__all__ = [
    "Adjacent",
    "Body",
    "BodyThere",
    "Changed",
    "Changes",
    "Check",
    "ClosePair",
    "ClosePairs",
    "CloseQuery",
    "ClosestPoints",
    "Contact",
    "ContactKind",
    "ContactQuery",
    "Contacts",
    "Containment",
    "CrossingEdge",
    "CrossingEdges",
    "CurveEnd",
    "Curves",
    "Depth",
    "EdgeEdge",
    "Edit",
    "Edited",
    "Error",
    "FeatureKind",
    "FeaturePairs",
    "FirstImpact",
    "Frame",
    "FrameHits",
    "FreeStep",
    "Fused",
    "HitRows",
    "Impact",
    "ImpactQuery",
    "Impacts",
    "Interval",
    "Kinds",
    "Life",
    "Located",
    "Mesh",
    "OpenMesh",
    "Pair",
    "PairDistances",
    "Piece",
    "Place",
    "Query",
    "Segments",
    "Selection",
    "Statistics",
    "TreeBoxes",
    "TreeShape",
    "VertexTriangle",
    "Watertight",
    "World",
    "__version__",
    "check",
    "curves",
    "derivatives",
    "edge_edge_distances",
    "edge_edge_impacts",
    "feature_pairs",
    "intersection_pairs",
    "intersections",
    "reference",
    "segments",
    "self_intersection_pairs",
    "self_intersections",
    "triangle_contacts",
    "vertex_triangle_distances",
    "vertex_triangle_impacts",
]

if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        # arrow needs another package, so it is imported when it is asked for. Workers of engines ask for it so.
        if name == "arrow":
            return import_module("pliant.arrow")
        raise AttributeError(f"module 'pliant' has no attribute {name!r}")
