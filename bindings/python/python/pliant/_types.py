"""What is easier said in Python than in Rust: the exception, and answers whose fields have names."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray


class Error(ValueError):
    """A call that was refused; the world is as it was before. Facts that do not apply are None.

    kind is a name of the Rust library's ErrorKind (NoTriangles, TooLarge, TooManyBodies, VertexOutOfRange, WrongLength,
    BadPosition, NeedsSubnormals, NotWritten, OutsideLooseBox, BadLooseBox, NoSuchBody, SameBody, TooManyHits, BadMargin, BadDistance, BadWidth, BadTime,
    DifferentCounts, BadCorner, NoSuchTriangle, EmptyTriangle, NoSuchVertex, EmptyVertex, VertexInUse, NotACorner, OutdatedEdit), or:

      BadArray     not an array of three columns, or not of a type that is taken
      BadOption    an option has no such value
      Precision    float64 positions in a float32 world
      Busy         the world is answering another call
      CannotRead   a file; file and place say which and where
      Broken       a bug of pliant; please report it

    Ctrl-C during a query is not one of these: it is the KeyboardInterrupt that it is everywhere.
    """

    #: What was wrong.
    kind: str | None
    #: The body the call was about; None for one that was to be added.
    body: int | None = None
    #: The triangle, and the vertex, counted from 0.
    triangle: int | None = None
    vertex: int | None = None
    #: How many vertices, and triangles, the body has.
    vertices: int | None = None
    triangles: int | None = None
    #: Where the vertex is.
    position: tuple[float, float, float] | None = None
    #: Vertices of the body, and positions or groups given.
    expected: int | None = None
    found: int | None = None
    #: "triangles", "vertices" or "pairs", how many there were, and how many there may be; of hits, how many were allowed. Of a wrong
    #: length, "positions" or "groups".
    what: str | None = None
    count: int | None = None
    limit: int | None = None
    #: The file, where in it, and which frame of the sequence.
    file: str | None = None
    place: str | None = None
    frame: int | None = None

    def __init__(self, message: str = "", kind: str | None = None, **facts: Any) -> None:
        super().__init__(message)
        self.kind = kind
        for name, fact in facts.items():
            setattr(self, name, fact)


class Pair(NamedTuple):
    """A hit: two triangles that intersect, of two bodies or of one.

    The smaller (body, triangle) is first; but of two bodies that the selection names, the one that is named first. Rows of
    Query.all have the same four numbers.
    """

    body_a: int
    triangle_a: int
    body_b: int
    triangle_b: int


class VertexTriangle(NamedTuple):
    """A vertex near a triangle that it is no corner of, of two bodies or of one. Rows of Query.all have the same four numbers."""

    vertex_body: int
    vertex: int
    triangle_body: int
    triangle: int


class EdgeEdge(NamedTuple):
    """Two edges near each other that have no end in common, of two bodies or of one; World.edges numbers them.

    The smaller (body, edge) is first; but of two bodies that the selection names, the one that is named first. Rows of
    Query.all have the same four numbers.
    """

    body_a: int
    edge_a: int
    body_b: int
    edge_b: int


class ClosePairs(NamedTuple):
    """Elements that are close, a row each.

    The distance is off by at most 2**-30 of itself and 2**-1074, the smallest number; it is 0 exactly if they touch.
    """

    pairs: NDArray[np.uint32]
    """(k, 4): body, vertex, body, triangle; or body, edge, body, edge; or body, triangle, body, triangle."""
    distance: NDArray[np.float64]
    """(k,)"""
    direction: NDArray[np.float64]
    """(k, 3): from the second element to the first, of length 1; zeros where they touch."""
    barycentric: NDArray[np.float64]
    """(k, 3): the point of the triangle, what each corner counts. Of edges (k, 4): what the ends of the first count, then
    of the second. Of two triangles (k, 6): what the corners of the first count, then of the second."""


class ClosePair(NamedTuple):
    """Two elements that are close, as a row of ClosePairs has them; direction is None if they touch."""

    pair: VertexTriangle | EdgeEdge | Pair
    distance: float
    direction: tuple[float, float, float] | None
    barycentric: tuple[float, ...]


class ContactKind(IntEnum):
    """How two triangles that intersect do so, decided exactly."""

    TOUCHING = 0
    """Neither of the others: a move of their corners, however small, could part them."""
    OVERLAPPING = 1
    """They lie in one plane, and have an area in common."""
    CROSSING = 2
    """They go through each other: after every small enough move of their corners they still intersect."""


class Contacts(NamedTuple):
    """Triangles that intersect, a row each, and how."""

    pairs: NDArray[np.uint32]
    """(k, 4): body, triangle, body, triangle."""
    kind: NDArray[np.uint8]
    """(k,): of each a ContactKind."""


class Contact(NamedTuple):
    """Two triangles that intersect, as a row of Contacts has them."""

    pair: Pair
    kind: ContactKind


class Edited(NamedTuple):
    """What an edit has changed: numbers, each list ascending."""

    new_triangles: NDArray[np.uint32]
    """Triangles that were empty, or not there."""
    changed_triangles: NDArray[np.uint32]
    """Triangles that have other corners."""
    removed_triangles: NDArray[np.uint32]
    """Triangles that are empty now."""
    new_vertices: NDArray[np.uint32]
    """Vertices that were empty, or not there, or that went and came again."""
    removed_vertices: NDArray[np.uint32]
    """Vertices that are empty now."""


class Piece(NamedTuple):
    """A body that was a component of another."""

    body: int
    """The new body."""
    triangles: NDArray[np.uint32]
    """For each of its triangles the number that it had; ascending."""
    vertices: NDArray[np.uint32]
    """For each of its vertices the number that it had; ascending."""


class Fused(NamedTuple):
    """The numbers of what came from another body; 0xFFFFFFFF for numbers that were empty."""

    triangles: NDArray[np.uint32]
    """For each triangle of the body that is no more the number that it has now."""
    vertices: NDArray[np.uint32]
    """The same of its vertices."""


class Impacts(NamedTuple):
    """Elements that meet on their way, a row each.

    They are apart from time 0 to low, both included, and meet after that and not after high; both are 0 if they meet at the start.
    """

    pairs: NDArray[np.uint32]
    """(k, 4): body, vertex, body, triangle; or body, edge, body, edge."""
    low: NDArray[np.float64]
    """(k,)"""
    high: NDArray[np.float64]
    """(k,)"""


class Impact(NamedTuple):
    """Two elements that meet on their way, as a row of Impacts has them."""

    pair: VertexTriangle | EdgeEdge
    low: float
    high: float


class FreeStep(NamedTuple):
    """How far everything may go, and how that begins: see World.free_step."""

    t: float
    """A time from 0 to 1, to call World.advance_motion with."""
    begins_in_contact: Pair | VertexTriangle | EdgeEdge | None
    """The first that are in contact at the start already: triangles that intersect; else elements at most min_distance apart. None if
    everything begins apart."""
    moves: bool
    """Whether a body that was asked about has a motion, be it nowhere. If none has, t is 1."""


class TreeShape(NamedTuple):
    """The tree of a body in numbers; the structure only, which no movement changes."""

    depth: int
    """The level of the deepest leaf, where the root is level 0."""
    nodes: int
    """All nodes, leaves and root included: the boxes of a complete refit."""
    leaves: int
    """Nodes that hold triangles."""


class TreeBoxes(NamedTuple):
    """The boxes of a level of a tree, one a part of tree_cut."""

    lower: NDArray[Any]
    """(k, 3): the smallest coordinates of the triangles below each node."""
    upper: NDArray[Any]
    """(k, 3): the largest."""
    valid: NDArray[np.bool_]
    """(k,): whether the tree holds this box for the shape that the body has now; else it is stale."""


class Statistics(NamedTuple):
    """The work of one query, with what Query.prepare did before it."""

    body_pairs: int
    """Pairs of bodies whose trees were traversed."""
    boxes_bottom_up: int
    """Boxes made ahead of a traversal."""
    boxes_top_down: int
    """Boxes made when a traversal reached them."""
    triangle_boxes: int
    """Boxes of single triangles in leaves of several."""
    node_pairs: int
    """Pairs of nodes with overlapping boxes."""
    candidate_pairs: int
    """Pairs of triangles with overlapping boxes, which were therefore decided."""
    scalar_decisions: int
    """Of moving elements, those that were not known to be apart eight at a time, and were decided one by one."""
    exact_decisions: int
    """Candidates that needed exact arithmetic."""
    pairs: int
    """Pairs found."""


@dataclass(frozen=True, eq=False)
class Body:
    """A body that was read from files, or a connected piece or a group of one."""

    name: str
    """The path as given; of a glTF file of several bodies, # and the name of the body; where it is split, # and the number of the
    piece, or the name of the group."""
    vertices: int
    triangles: int
    faces: NDArray[np.uint32] | None
    """For each triangle of the file the polygon it is part of; None where every polygon is a triangle."""
    welded: int
    """Vertices welded away in its file."""
    source: int
    """Which path it is of, counted from 0; each body of a glTF file counts."""
    first_triangle: int
    """Its lowest triangle, as numbered in the file."""


@dataclass(frozen=True)
class BodyThere:
    """The triangles of a body in a place."""

    body: int
    """Its number."""
    triangles: int
    """How many of its triangles intersect there."""
    first_triangle: int
    """The lowest of them."""


@dataclass(frozen=True)
class Place:
    """Pairs that hang together through triangles that are equal or share a vertex."""

    number: int
    """The same from frame to frame while the place lives, counted from 0."""
    count: int
    """How many pairs."""
    first_pair: tuple[int, int, int, int]
    """The smallest of them: body, triangle, body, triangle."""
    bodies: tuple[BodyThere, ...]
    """Whose triangles intersect there."""
    lower: tuple[float, float, float]
    """The smallest coordinates of these triangles."""
    upper: tuple[float, float, float]
    """The largest."""


@dataclass(frozen=True)
class Life:
    """A place, from its first frame to its last."""

    first_frame: int
    last_frame: int
    """The last so far."""
    worst_frame: int
    """The first frame in which it has the most pairs."""
    worst: Place
    """What it is there."""


@dataclass(frozen=True)
class FirstImpact:
    """What meets first on the way from a frame to the next."""

    time: float
    """When they have met, from 0, in the frame, to 1, in the next; at most a millionth late."""
    kind: str
    """"vertex_triangle" or "edge_edge"."""
    pair: tuple[int, ...]
    """Which they are, as a row of Interval.vertex_triangle or Interval.edge_edge."""


@dataclass(frozen=True, eq=False)
class Interval:
    """What meets on the way from a frame to the next that is checked: what is apart in the frame and meets before the next, or in it."""

    frame: int
    """The frame."""
    until: int
    """The next that is checked."""
    changed: tuple[int, ...]
    """The bodies that have another mesh there; where there are any nothing was looked for."""
    count: int
    """How many pairs of elements; at most one if only the first was asked for."""
    at_start: int
    """How many others meet in the frame already."""
    first: FirstImpact | None
    """The one of them that meets first."""
    vertex_triangle: NDArray[np.uint32]
    """(k, 4): body, vertex, body, triangle, sorted; vertices are those of the file."""
    vertex_triangle_times: NDArray[np.float64]
    """(k, 2): each is apart up to the first time and has met at the second, at most a millionth later."""
    edge_edge: NDArray[np.uint32]
    """(k, 6): body and two vertices, twice, the smaller first in an edge and of the two; sorted."""
    edge_edge_times: NDArray[np.float64]
    """(k, 2)."""
    complete: bool
    """Whether these are all; not if only the first was asked for."""


class Kinds(NamedTuple):
    """How many pairs of a frame intersect how: see ContactKind."""

    crossing: int
    overlapping: int
    touching: int


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame that was checked."""

    frame: int
    """Its number, counted from 0."""
    count: int
    """How many pairs."""
    pairs: NDArray[np.uint32]
    """(count, 4): body, triangle, body, triangle, sorted; with first the one pair, and with within too the nearest."""
    kinds: Kinds | None
    """How many pairs of each kind; None if only the first was asked for, or within."""
    distance: float | None
    """How far apart the nearest of the pairs of within is; None where there is none, or within was not asked for."""
    complete: bool
    """Whether these are all pairs; not if only the first was asked for."""
    left_out: int | None
    """How many pairs were left out because the baseline has them; None where there is no baseline, and where the search stopped at
    the first new pair."""
    only_touching: int | None
    """How many pairs were left out because in their places surfaces only touch; None if crossing was not asked for."""
    degenerate: int
    """How many pairs have a triangle without area: of these, or with skip_degenerate of those that were left out for it."""
    changed: dict[int, Body]
    """The bodies that have another mesh than in the frame before, or, of the first, than said in bodies: what is known of them now. Pairs
    number triangles as in the mesh of their frame."""
    places: tuple[Place, ...] | None
    """What the pairs join into, most pairs first; None where places were not asked for, and with first."""
    interval: Interval | None = None
    """What meets on the way to the next frame; None of the last, and where that was not asked."""


class Mesh(Protocol):
    """A mesh as trimesh has it."""

    @property
    def vertices(self) -> ArrayLike: ...
    @property
    def faces(self) -> ArrayLike: ...


class OpenMesh(Protocol):
    """A mesh as Open3D has it."""

    @property
    def vertices(self) -> Any: ...
    @property
    def triangles(self) -> Any: ...


for _public in (Error, Pair, VertexTriangle, EdgeEdge, ClosePair, ClosePairs, Contact, ContactKind, Contacts, Edited, Fused, Piece, Impact, Impacts, FreeStep, TreeBoxes, TreeShape, Statistics, Body, BodyThere, Place, Life, FirstImpact, Interval, Kinds, Frame, Mesh, OpenMesh):
    _public.__module__ = "pliant"
