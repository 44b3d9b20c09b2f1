"""Types of the extension module, each with the first line of its documentation.

help(pliant.World) has all of it: shapes, dtypes, errors, cost.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from typing import (
    Any,
    ClassVar,
    Generic,
    Literal,
    Protocol,
    SupportsIndex,
    TypeAlias,
    TypedDict,
    TypeVar,
    final,
    overload,
)

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._types import (
    Body,
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
    Curves,
    Depth,
    EdgeEdge,
    Edited,
    FeaturePairs,
    FrameHits,
    HitRows,
    Frame,
    FreeStep,
    Fused,
    Impact,
    Impacts,
    Life,
    Located,
    Mesh,
    OpenMesh,
    Pair,
    PairDistances,
    Piece,
    Segments,
    Statistics,
    TreeBoxes,
    TreeShape,
    VertexTriangle,
    Watertight,
)

__all__ = [
    "Changes",
    "Check",
    "CloseQuery",
    "ContactQuery",
    "Edit",
    "ImpactQuery",
    "Query",
    "Selection",
    "World",
    "__version__",
    "check",
    "curves",
    "edge_edge_distances",
    "edge_edge_impacts",
    "feature_pairs",
    "intersection_pairs",
    "reference_intersection_pairs",
    "reference_self_intersection_pairs",
    "segments",
    "self_intersection_pairs",
    "triangle_contacts",
    "vertex_triangle_distances",
    "vertex_triangle_impacts",
    "_as_array",
]

__version__: str

_Hit = TypeVar("_Hit", Pair, CrossingEdge, VertexTriangle, EdgeEdge, covariant=True)

class _Dlpack(Protocol):
    def __dlpack__(self) -> Any: ...

_Array: TypeAlias = ArrayLike | _Dlpack
_Hits: TypeAlias = NDArray[np.uint32]
_Pairs: TypeAlias = NDArray[np.uint32]
_Corner: TypeAlias = Sequence[float] | NDArray[np.floating[Any]]
_Partition: TypeAlias = Literal["centre", "mean", "balanced", "connectivity"]
_Update: TypeAlias = Literal["bottom-up", "top-down", "hybrid"]
_Name: TypeAlias = str | PathLike[str] | int
_Frames: TypeAlias = Mapping[int, _Array] | Iterable[tuple[SupportsIndex, _Array]]
_Rule: TypeAlias = Literal["nonzero", "positive", "parity"]
_Broad: TypeAlias = Literal["brute", "sweep", "tree", "auto"]

class _Options(TypedDict):
    degree: Literal[2, 4, 8]
    partition: _Partition
    leaf_size: int
    update: _Update
    level: int | None
    broad: _Broad
    threads: int | Literal["all"]
    mending: bool

@final
class World:
    """Deforming triangle meshes, and exact answers about what of them meets or is near."""

    def __new__(
        cls,
        *,
        degree: Literal[2, 4, 8] = 8,
        partition: _Partition = "balanced",
        leaf_size: int = 8,
        update: _Update = "hybrid",
        level: int | None = None,
        broad: _Broad = "auto",
        threads: int | Literal["all"] = 1,
        mending: bool = False,
    ) -> World: ...
    def __copy__(self) -> World: ...
    def __deepcopy__(self, memo: Any, /) -> World: ...
    def __reduce__(self) -> tuple[Callable[[], World], tuple[()], dict[str, Any]]: ...
    def __setstate__(self, written: dict[str, Any], /) -> None: ...
    @property
    def dtype(self) -> np.dtype[np.float32] | np.dtype[np.float64] | None:
        """Dtype of all positions, numpy.float32 or numpy.float64; None before the first body."""
    def options(self) -> _Options:
        """Options of this world, a dict of the keyword arguments that make another like it."""
    @overload
    def add(
        self, faces: _Array | None, positions: _Array, *, edges: _Array | None = None, points: _Array | None = None,
    ) -> int:
        """Adds a body, and returns its number, an int that this world will not use again."""
    @overload
    def add(
        self, faces: Mesh | OpenMesh, positions: None = None, *, edges: _Array | None = None, points: _Array | None = None,
    ) -> int: ...
    @overload
    def set_mesh(self, body: SupportsIndex, faces: _Array, positions: _Array) -> None:
        """Gives a body another mesh and shape, of any size."""
    @overload
    def set_mesh(
        self, body: SupportsIndex, faces: Mesh | OpenMesh, positions: None = None,
    ) -> None: ...
    def set_edges(self, body: SupportsIndex, edges: _Array) -> None:
        """Numbers the edges of a body as given, (k, 2) of any integer type, two vertices a row."""
    def edit(self, body: SupportsIndex) -> Edit:
        """Begins an edit of a body's mesh: an Edit without steps, which apply makes all at once."""
    def apply(self, edit: Edit) -> Edited:
        """Makes the changes of an edit, all or none; returns an Edited, the changes by number."""
    def live_triangles(self, body: SupportsIndex) -> NDArray[np.bool_]:
        """Whether each triangle number of a body is in use, (m,) bool; False if left empty."""
    def live_vertices(self, body: SupportsIndex) -> NDArray[np.bool_]:
        """Whether each vertex number of a body is in use, (n,) bool; False if left empty."""
    def mesh_revision(self, body: SupportsIndex) -> int:
        """Counter of a body's meshes and tree orders, an int that changes when either does."""
    def components(self, body: SupportsIndex) -> NDArray[np.uint32]:
        """Connected component of each triangle of a body, (m,) uint32."""
    def split(self, body: SupportsIndex) -> list[Piece]:
        """Makes each connected component of a body but the largest a body of its own."""
    def fuse(self, a: SupportsIndex, b: SupportsIndex) -> Fused:
        """Appends the triangles and vertices of body b to body a, and removes b."""
    def weld(self, body: SupportsIndex, tolerance: float) -> Edited:
        """Joins boundary edges of a body that coincide within a tolerance; returns an Edited."""
    def remove(self, body: SupportsIndex) -> None:
        """Removes a body. Its number will not be used again."""
    def bodies(self) -> list[int]:
        """Numbers of all bodies, a list of int in the order in which they were added."""
    def set_positions(self, body: SupportsIndex, positions: _Array) -> None:
        """Gives a body a new shape: positions (n, 3), a row for each vertex."""
    def set_positions_of(
        self,
        shapes: Mapping[int, _Array] | Iterable[tuple[SupportsIndex, _Array]],
    ) -> None:
        """Gives several bodies new shapes at once: all of them, or none if one is refused."""
    def write_positions(self, body: SupportsIndex, write: Callable[[NDArray[Any]], object]) -> None:
        """Gives a body a new shape that write(positions) fills into an array."""
    def set_motion(self, body: SupportsIndex, end: _Array) -> None:
        """Begins a motion of a body: end (n, 3) is its shape at the end of the step."""
    def finish_motion(self) -> None:
        """Ends all motions: bodies that have one take the shape at its end, without a copy."""
    def advance_motion(self, t: float) -> None:
        """Ends all motions on the way: bodies that have one take their shape at time t, 0 to 1."""
    def end_positions(self, body: SupportsIndex) -> NDArray[Any] | None:
        """Shape at the end of a body's motion, a new array (n, 3) of the world's dtype or None."""
    def set_vertex_groups(self, body: SupportsIndex, groups: _Array) -> None:
        """Gives every vertex of a body a group, (n,) of integers from 0 to 2^32 - 1."""
    def set_rest_positions(self, body: SupportsIndex, positions: _Array | None) -> None:
        """Gives a body a rest shape, positions (n, 3), or takes it away with None."""
    def rest_positions(self, body: SupportsIndex) -> NDArray[Any] | None:
        """Positions of a body in its rest shape, a new array (n, 3), or None if it has none."""
    def set_labels(
        self,
        body: SupportsIndex,
        labels: _Array | None,
        neighbours: _Array | None = None,
    ) -> None:
        """Labels the faces of a body, (m,) integers: equal or neighbouring ones do not meet."""
    def labels(
        self, body: SupportsIndex
    ) -> tuple[NDArray[np.uint32], NDArray[np.uint32] | None] | None:
        """Labels of a body's faces (m,), and neighbours (k, 2) or None; None without labels."""
    def set_thickness(self, body: SupportsIndex, thickness: float) -> None:
        """Makes a body thick: every vertex is a ball of this radius, a float of at least 0."""
    def set_vertex_thickness(self, body: SupportsIndex, thickness: _Array) -> None:
        """Gives every vertex of a body a thickness of its own, (n,) floats: see set_thickness."""
    def thickness(self, body: SupportsIndex) -> NDArray[np.float64]:
        """Thickness of every vertex of a body, a new array (n,) float64."""
    def vertex_groups(self, body: SupportsIndex) -> NDArray[np.uint32]:
        """Group of every vertex of a body, a new array (n,) uint32."""
    def edges(self, body: SupportsIndex) -> NDArray[np.uint32]:
        """Edges of a body, a new array (k, 2) uint32: two vertices each, the smaller first."""
    def tree_quality(self, body: SupportsIndex) -> float:
        """Decay of a body's tree, a float: work of recent queries over that of a fresh tree."""
    def rebuild(self, body: SupportsIndex) -> None:
        """Builds the tree of a body anew on its present shape. Never needed for right answers."""
    def set_filter(self, body: SupportsIndex, membership: int, mask: int) -> None:
        """Sets the collision filter of a body, two 32-bit masks: what it is and what it meets."""
    def filter(self, body: SupportsIndex) -> tuple[int, int]:
        """Collision filter of a body, a tuple (membership, mask): see set_filter."""
    def ignored(self) -> list[tuple[int, int]]:
        """Pairs of bodies that ignore keeps apart, a sorted list of (lower, higher) numbers."""
    def loose_box(self, body: SupportsIndex) -> tuple[list[float], list[float]] | None:
        """Loose box of a body, (lower, upper) corners as lists of three floats, or None."""
    def set_environment(self, body: SupportsIndex, environment: int) -> None:
        """Puts a body into an environment, a number from 0 to 2^32 - 1; at first all are in 0."""
    def environment(self, body: SupportsIndex) -> int:
        """Environment of a body: see set_environment."""
    def ignore(self, a: SupportsIndex, b: SupportsIndex) -> None:
        """Keeps two bodies apart in queries of the whole world, or one body from itself."""
    def unignore(self, a: SupportsIndex, b: SupportsIndex) -> None:
        """Lets two bodies meet again that ignore keeps apart."""
    def set_loose_box(self, body: SupportsIndex, corners: tuple[_Corner, _Corner] | None) -> None:
        """Gives a body a fixed box that holds it in every pose to come; None takes it away."""
    def triangle_count(self, body: SupportsIndex) -> int:
        """Number of triangles of a body, numbers left empty by an edit included."""
    def vertex_count(self, body: SupportsIndex) -> int:
        """Number of vertices of a body, empty ones included; the rows of its positions."""
    def tree_shape(self, body: SupportsIndex) -> TreeShape:
        """Size of a body's tree, a TreeShape: depth, nodes, leaves."""
    def tree_cut(self, body: SupportsIndex, level: int) -> NDArray[np.uint32]:
        """Part of each triangle when a body's tree is cut at a level, (m,) uint32."""
    def triangles(self, body: SupportsIndex) -> NDArray[np.uint32]:
        """Faces of a body as added and edited, a new array (m, 3) uint32."""
    def positions(self, body: SupportsIndex) -> NDArray[Any]:
        """Present shape of a body, a new array (n, 3) of the world's dtype."""
    def tree_boxes(self, body: SupportsIndex, level: int) -> TreeBoxes:
        """Boxes of a level of a body's tree, a TreeBoxes: lower, upper, valid."""
    def vertex_order(self, body: SupportsIndex) -> NDArray[np.uint32]:
        """Order in which queries read the vertices of a body, (n,) uint32."""
    def intersections(self, of: Selection = ...) -> Query[Pair]:
        """Asks which triangles intersect: a Query, all() of which is (k, 4) uint32, sorted."""
    def contacts(
        self, of: Selection = ..., *, only: ContactKind | int | None = None,
    ) -> ContactQuery:
        """Asks which triangles intersect, and how: a ContactQuery, all() of which is a Contacts."""
    def adjacent_intersections(
        self, of: Selection = ..., *, only: ContactKind | int | None = None,
    ) -> ContactQuery:
        """Asks which triangles that share a vertex meet beyond it, and how: a ContactQuery."""
    def crossing_edges(self, of: Selection = ...) -> Query[CrossingEdge]:
        """Asks which edges cross which triangles: a Query of rows (k, 4) uint32."""
    def vertex_triangle_candidates(self, of: Selection, radius: float) -> Query[VertexTriangle]:
        """Asks which vertices are near which triangles: a Query of rows (k, 4) uint32."""
    def edge_edge_candidates(self, of: Selection, radius: float) -> Query[EdgeEdge]:
        """Asks which edges are near which edges: a Query of rows (k, 4) uint32."""
    def close_vertex_triangle_pairs(self, of: Selection, distance: float) -> CloseQuery:
        """Asks which vertices and triangles are at most distance apart: a CloseQuery."""
    def close_edge_edge_pairs(self, of: Selection, distance: float) -> CloseQuery:
        """Asks which edges are at most distance apart: a CloseQuery."""
    def close_triangle_pairs(self, of: Selection, distance: float) -> CloseQuery:
        """Asks which triangles are at most distance apart: a CloseQuery."""
    def distance(
        self, a: SupportsIndex, b: SupportsIndex, cut_off: float = ...,
    ) -> ClosePair | None:
        """Distance of the surfaces of two bodies, a ClosePair of their closest triangles."""
    def nearest_body(self, body: SupportsIndex, cut_off: float = ...) -> ClosePair | None:
        """Distance of a body to the nearest other that it may meet, a ClosePair."""
    def vertex_triangle_impacts(self, of: Selection, width: float = 1e-6) -> ImpactQuery:
        """Asks which vertices and triangles meet during the motion, and when: an ImpactQuery."""
    def edge_edge_impacts(self, of: Selection, width: float = 1e-6) -> ImpactQuery:
        """Asks which edges meet during the motion, and when: an ImpactQuery."""
    def first_impact(self, of: Selection, width: float = 1e-6) -> Impact | None:
        """First contact of the motion, an Impact of either kind, or None if nothing meets."""
    def free_step(self, of: Selection, min_distance: float = 0.0) -> FreeStep:
        """How far everything may go without collision: FreeStep(t, begins_in_contact, moves)."""
    def collision_free_step(self, of: Selection, min_distance: float = 0.0) -> float:
        """Time t from 0 to 1 up to which everything stays further apart than min_distance."""
    def clearance(self, of: Selection, cut_off: float) -> dict[int, NDArray[np.float64]]:
        """How far each vertex may move before anything can touch: dict of body to (n,) float64."""
    def watertight(self, body: SupportsIndex) -> Watertight:
        """Edges at which a body is not a closed surface, a Watertight: open, turned, doubled."""
    def points_inside(self, points: _Array, body: SupportsIndex, rule: _Rule = "nonzero") -> Located:
        """Whether points are inside a closed body, outside, or on its surface: a Located."""
    def inside(
        self, a: SupportsIndex, b: SupportsIndex, rule: _Rule = "nonzero", *,
        frames: _Frames | None = None, threads: int | Literal["all"] = 1,
    ) -> Located:
        """Whether each vertex of body a is inside body b, a closed one: a Located of (n,) arrays."""
    def contained(self, of: Selection = ...) -> Containment:
        """Components of bodies that lie inside other bodies: a Containment."""
    def closest_points(
        self, points: _Array, body: SupportsIndex | None = None, cut_off: float = ...,
    ) -> ClosestPoints:
        """Closest point of a body, or of all bodies, for each of some points: a ClosestPoints."""
    def signed_closest_points(
        self, points: _Array, body: SupportsIndex, cut_off: float = ...,
    ) -> ClosestPoints:
        """Closest point of a closed body for each of some points, with signed distances."""
    def depth(self, a: SupportsIndex, b: SupportsIndex) -> Depth:
        """How deep body a reaches into body b, a closed one, in their present shapes: a Depth."""
    def statistics(self) -> Statistics:
        """Counters of the work of the last query, Query.prepare included: a Statistics."""
    def memory_usage(self) -> int:
        """Bytes of memory that this world holds: bodies, trees, boxes, lists kept for queries."""
    def validate(self) -> None:
        """Checks every invariant of every tree, for tests and bug reports. Should never fail."""

@final
class Changes:
    """Memory of the last list of hits: what began, persists and ended is told of the next."""

    def __new__(cls, kind: Literal["triangles", "vertex-triangle", "edge-edge", "edge-triangle"] = "triangles") -> Changes: ...
    def update(self, rows: NDArray[np.uint32]) -> Changed:
        """Compares a list with the last one, and remembers it; returns a Changed."""
    def edited(self, body: SupportsIndex, edited: Edited) -> None:
        """Notes an edit between two lists: takes the Edited that World.apply or weld gave."""
    def split(self, body: SupportsIndex, pieces: Iterable[Piece]) -> None:
        """Notes that World.split made pieces of a body: takes the list of Piece that it gave."""
    def fused(self, kept: SupportsIndex, gone: SupportsIndex, fused: Fused) -> None:
        """Notes that World.fuse put body gone into kept: takes the Fused that it gave."""
    def edges_edited(
        self, body: SupportsIndex, before: NDArray[np.uint32], after: NDArray[np.uint32]
    ) -> None:
        """Notes an edit between two lists: takes World.edges of the body before and after it."""

@final
class CloseQuery:
    """A question which elements are close, answered by all() or first()."""

    def all(self, *, at_most: int | None = None, sort: bool = True) -> ClosePairs:
        """All close pairs, a ClosePairs of arrays, sorted by their numbers."""
    def rows(self, *, at_most: int | None = None) -> HitRows:
        """All hits in compressed rows (CSR), a HitRows: a row for each first element."""
    def first(self) -> ClosePair | None:
        """Some close pair, a ClosePair, or None if there is none."""
    def visit_some(self, visit: Callable[[ClosePairs], object]) -> bool:
        """Calls visit(close) with a ClosePairs of some at a time, until it returns true."""
    def prepare(self) -> None:
        """Does early what the query would do first, and asks nothing: see Query.prepare."""
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["rows", "first"] = "rows",
        threads: int | Literal["all"] = 1,
    ) -> FrameHits:
        """Asks about many shapes of bodies, frame by frame, in one call: see Query.of_frames."""
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["counts"], threads: int | Literal["all"] = 1
    ) -> NDArray[np.int64]: ...
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["any"], threads: int | Literal["all"] = 1
    ) -> NDArray[np.bool_]: ...

@final
class Edit:
    """Changes of one body's mesh, which World.apply makes all at once or not at all."""

    def body(self) -> int:
        """Number of the body whose mesh it changes."""
    def add_vertices(self, positions: _Array) -> NDArray[np.uint32]:
        """Adds vertices at positions (k, 3); returns their numbers, (k,) uint32."""
    def place_vertex(self, vertex: SupportsIndex, position: _Array) -> None:
        """Uses an empty vertex number again, at a position (3,) of float32 or float64."""
    def split_vertex(self, vertex: SupportsIndex, triangles: _Array) -> int:
        """Adds a vertex in the place of another, for the given triangles; returns its number."""
    def merge_vertices(self, kept: SupportsIndex, gone: SupportsIndex) -> None:
        """Replaces the vertex gone by the vertex kept in all triangles. kept stays where it is."""
    def add_triangles(self, faces: _Array) -> NDArray[np.uint32]:
        """Adds triangles, faces (k, 3) of any integer type; returns their numbers, (k,) uint32."""
    def set_triangle(
        self, triangle: SupportsIndex, corners: Sequence[SupportsIndex] | NDArray[np.integer[Any]],
    ) -> None:
        """Gives a triangle other corners, three vertex numbers; an empty number is used again."""
    def remove_triangles(self, triangles: _Array) -> None:
        """Removes triangles, (k,) of any integer type. Their numbers become empty."""

@final
class ContactQuery:
    """A question which triangles intersect and how, answered by all() or first()."""

    def all(self, *, at_most: int | None = None, sort: bool = True) -> Contacts:
        """All contacts, a Contacts of arrays, sorted by their numbers."""
    def rows(self, *, at_most: int | None = None) -> HitRows:
        """All hits in compressed rows (CSR), a HitRows: a row for each first element."""
    def first(self) -> Contact | None:
        """Some contact, a Contact, or None if there is none."""
    def visit_some(self, visit: Callable[[Contacts], object]) -> bool:
        """Calls visit(contacts) with a Contacts of some at a time, until it returns true."""
    def prepare(self) -> None:
        """Does early what the query would do first, and asks nothing: see Query.prepare."""
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["rows", "first"] = "rows",
        threads: int | Literal["all"] = 1,
    ) -> FrameHits:
        """Asks about many shapes of bodies, frame by frame, in one call: see Query.of_frames."""
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["counts"], threads: int | Literal["all"] = 1
    ) -> NDArray[np.int64]: ...
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["any"], threads: int | Literal["all"] = 1
    ) -> NDArray[np.bool_]: ...

@final
class ImpactQuery:
    """A question which elements meet during the motion, answered by all() or first()."""

    def all(self, *, at_most: int | None = None, sort: bool = True) -> Impacts:
        """All impacts, an Impacts of arrays, sorted by their numbers."""
    def rows(self, *, at_most: int | None = None) -> HitRows:
        """All hits in compressed rows (CSR), a HitRows: a row for each first element."""
    def first(self) -> Impact | None:
        """The impact with the least exact time, an Impact, or None if nothing meets."""
    def visit_some(self, visit: Callable[[Impacts], object]) -> bool:
        """Calls visit(impacts) with an Impacts of some at a time, until it returns true."""
    def prepare(self) -> None:
        """Does early what the query would do first, and asks nothing: see Query.prepare."""

@final
class Selection:
    """Which bodies a query asks about: a value that every kind of query takes."""

    WORLD: ClassVar[Selection]
    EVERYTHING: ClassVar[Selection]
    @staticmethod
    def between(a: SupportsIndex, b: SupportsIndex) -> Selection:
        """Two different bodies, whatever filters say. Body a is the first of every hit."""
    @staticmethod
    def within(body: SupportsIndex) -> Selection:
        """One body with itself, whatever filters say."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Query(Generic[_Hit]):
    """A question to a world, answered by all(), first() or visit()."""

    def all(self, *, at_most: int | None = None, sort: bool = True) -> _Hits:
        """All hits, a new array (k, 4) uint32, sorted."""
    def rows(self, *, at_most: int | None = None) -> HitRows:
        """All hits in compressed rows (CSR), a HitRows: a row for each first element."""
    def first(self) -> _Hit | None:
        """Some hit, a Pair, CrossingEdge, VertexTriangle or EdgeEdge, or None if there is none."""
    def visit(self, visit: Callable[[_Hit], object]) -> bool:
        """Calls visit(hit) for every hit once, until it returns true. Returns whether it did."""
    def visit_some(self, visit: Callable[[_Hits], object]) -> bool:
        """Calls visit(rows) with some hits at a time, (k, 4) uint32, until it returns true."""
    def prepare(self) -> None:
        """Does early what the query would do first, and asks nothing."""
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["rows", "first"] = "rows",
        threads: int | Literal["all"] = 1,
    ) -> FrameHits:
        """Asks about many shapes of bodies, frame by frame, in one call."""
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["counts"], threads: int | Literal["all"] = 1
    ) -> NDArray[np.int64]: ...
    @overload
    def of_frames(
        self, frames: _Frames, *, answer: Literal["any"], threads: int | Literal["all"] = 1
    ) -> NDArray[np.bool_]: ...

@final
class Check:
    """Check of files that is under way: an iterator of its frames, made by pliant.check."""

    @property
    def bodies(self) -> tuple[Body, ...]:
        """Bodies of the check, a tuple of Body: one for each path, piece or group, in order."""
    @property
    def frame_count(self) -> int:
        """Number of frames in the files, an int."""
    @property
    def places(self) -> tuple[Life, ...]:
        """Places of the frames so far, at most 1000 Life, most pairs in a frame first."""
    def counts(self) -> Counts:
        """Checks the frames that are left and counts what they have, in a Counts; lists no pairs."""
    def __iter__(self) -> Check: ...
    def __next__(self) -> Frame: ...

def check(
    *paths: str | PathLike[str],
    itself: bool = False,
    within: float | None = None,
    rest: int | str | PathLike[str] | None = None,
    labels: Mapping[_Name, str | PathLike[str]] | None = None,
    crossing: bool = False,
    ignore_adjacent: bool = False,
    swept: bool = False,
    first: bool = False,
    weld: bool = True,
    weld_tolerance: float = 0.0,
    split: Literal["components", "groups"] | None = None,
    groups: Mapping[str, Sequence[_Name]] | None = None,
    ignore: Sequence[tuple[_Name, _Name]] | None = None,
    baseline: int | str | PathLike[str] | None = None,
    skip_degenerate: bool = False,
    crossing_edges: bool = False,
    places: bool = False,
    solid: bool = False,
    frames: range | None = None,
    clip: str | None = None,
    fps: float = 30.0,
    files: Mapping[str, bytes | bytearray] | None = None,
    max_memory: int | None = None,
    warn: bool = True,
    threads: int | Literal["all"] = 1,
) -> Check:
    """Checks files frame by frame, as the program `pliant check` does: an iterator of Frame."""

@overload
def intersection_pairs(
    va: _Array, fa: _Array, vb: _Array, fb: _Array, /, *, threads: int | Literal["all"] = 1
) -> _Pairs:
    """Intersecting triangles of two meshes, (k, 2) uint32, sorted: triangle of a, triangle of b."""

@overload
def intersection_pairs(
    mesh_a: Mesh | OpenMesh, mesh_b: Mesh | OpenMesh, /, *, threads: int | Literal["all"] = 1,
) -> _Pairs: ...
@overload
def self_intersection_pairs(vertices: _Array, faces: _Array, /, *, threads: int | Literal["all"] = 1) -> _Pairs:
    """Self-intersections of a mesh, (k, 2) uint32, sorted: smaller triangle, larger triangle."""

@overload
def self_intersection_pairs(mesh: Mesh | OpenMesh, /, *, threads: int | Literal["all"] = 1) -> _Pairs: ...
@overload
def reference_intersection_pairs(va: _Array, fa: _Array, vb: _Array, fb: _Array, /) -> _Pairs:
    """Intersecting triangles of two meshes by brute force, (k, 2) uint32, sorted."""

@overload
def reference_intersection_pairs(mesh_a: Mesh | OpenMesh, mesh_b: Mesh | OpenMesh, /) -> _Pairs: ...
@overload
def reference_self_intersection_pairs(vertices: _Array, faces: _Array, /) -> _Pairs:
    """Self-intersections of a mesh by brute force, (k, 2) uint32, sorted."""

@overload
def reference_self_intersection_pairs(mesh: Mesh | OpenMesh, /) -> _Pairs: ...

def segments(world: World, pairs: _Pairs) -> Segments:
    """Says where pairs of triangles meet in the present shapes of a world: a Segments of arrays."""

def curves(world: World, pairs: _Pairs, *, areas: bool = False) -> Curves:
    """Finds the curves in which pairs of triangles meet: a Curves of arrays."""

def feature_pairs(world: World, of: Selection, distance: float) -> FeaturePairs:
    """Finds each contact of close elements once, with its features: a FeaturePairs of arrays."""

def vertex_triangle_impacts(
    start: _Array, end: _Array, width: float = 1e-6
) -> tuple[NDArray[np.bool_], NDArray[np.float64], NDArray[np.float64]]:
    """When vertices meet moving triangles, pair by pair, without a world: (hit, low, high)."""

def edge_edge_impacts(
    start: _Array, end: _Array, width: float = 1e-6
) -> tuple[NDArray[np.bool_], NDArray[np.float64], NDArray[np.float64]]:
    """When edges meet moving edges, pair by pair, without a world: (hit, low, high)."""

def vertex_triangle_distances(corners: _Array) -> PairDistances:
    """How far vertices and triangles are apart, pair by pair, without a world: a PairDistances."""

def edge_edge_distances(corners: _Array) -> PairDistances:
    """How far edges are apart, pair by pair, without a world: a PairDistances."""

def triangle_contacts(corners: _Array) -> NDArray[np.int8]:
    """Whether and how triangles intersect, pair by pair, without a world: (k,) int8."""

def _as_array(given: _Array, what: str) -> NDArray[Any]: ...
