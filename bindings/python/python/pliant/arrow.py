"""Checks of many meshes in the columns of a record batch: a function for engines of data.

    rows = pliant.arrow.check(batch, "mesh")        # a column of bytes: files

Batches of any library are read through the Arrow C data interface, where they lie. It needs
pip install 'pliant[arrow]', which has no pyarrow.

The function depends on nothing but its arguments and can be pickled, so that Ray Data, Spark, Dask,
Daft or a process pool can run it. A mesh that cannot be checked is a row with an error.
"""

from __future__ import annotations

import hashlib
import inspect
import io
import re
import time
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np

try:
    from arro3.core import Array, DataType, RecordBatch, Schema, Table, list_array, list_flatten, list_offsets
except ModuleNotFoundError:
    raise ModuleNotFoundError("pliant.arrow needs arro3-core: pip install 'pliant[arrow]'", name="arro3") from None

from ._pliant import check as _check_files
from ._types import Error

__all__ = ["check"]

# Columns of the answer, in order.
_TYPES = {
    "line": "int64",
    "bodies": "list",
    "bytes": "int64",
    "sha256": "string",
    "triangles": "int64",
    "pairs": "int64",
    "crossing_edges": "int64",
    "adjacent": "int64",
    "touching": "int64",
    "degenerate": "int64",
    "inside": "int64",
    "ms": "float64",
    "peak_bytes": "int64",
    "error": "string",
}

# Keywords of pliant.check that say what else is found, which a row has no column for, or where files are.
_NOT_ROWS = {"paths", "swept", "places", "crossing_edges", "files", "labels", "threads", "warn"}
# Keywords that are a number of a frame here: a file would be one of the worker's disk.
_FRAMES = ("baseline", "rest")

# A byte that no text has: what has none, and no other mark, is OBJ.
_NO_TEXT = re.compile(rb"[\0-\x08\x0e-\x1f]")

# A mesh without a fault, on which options are tried.
_TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


class _File(NamedTuple):
    """A file in memory; its name has the ending of its format."""

    name: str
    data: bytes


def check(
    batch: Any,
    mesh: str | Sequence[str] = "mesh",
    *,
    faces: str | Sequence[str] | None = None,
    format: str | None = None,
    keep: str | Sequence[str] = (),
    **options: Any,
) -> Any:
    """Checks the meshes of each row of a record batch, as the program's `check --files-from` does.

        pliant.arrow.check(batch, "mesh")                           # bytes of a file
        pliant.arrow.check(batch, ["garment", "body"])              # two bodies a row
        pliant.arrow.check(batch, "vertices", faces="faces")        # lists of numbers

    batch is what has __arrow_c_array__ or __arrow_c_stream__: a RecordBatch or Table of pyarrow,
    arro3, nanoarrow, a DataFrame of Polars, or of pandas where pyarrow is.

    - mesh: columns of files, one for each body, of any format that pliant.check reads from one
      file but USD
    - faces: if given, mesh names columns of vertices, lists of three numbers, and faces as many
      columns of triangles, lists of three corners. Both may also be flat lists. Lists may be of any
      size, large or not; views of lists are errors
    - format: the ending of all files, "obj"; None finds it in their first bytes
    - keep: columns of the batch that the answer begins with
    - options: keywords of pliant.check, but for files on disk and what a row has no column for.
      max_memory is the limit of a frame, and of a list of pairs

    Returns a row for each row, in order: a record batch for what has __arrow_c_array__, else a
    table. It is pyarrow's where batch is; else arro3's. Columns are those of the program:

    - line: the row of the batch, from 1
    - bodies: names of the bodies, the column and the ending
    - bytes, sha256: of all files of the row, one after the other; of lists of numbers, the bytes
      of the vertices as they are and of the faces as uint32
    - triangles, pairs, crossing_edges, adjacent, touching, degenerate, inside: int64, see Counts,
      added up over frames; null where there is an error, or they were not asked for
    - ms: how long the row took; peak_bytes: null, as the memory of a worker is the engine's
    - error: why there is no answer, else null

    Raises pliant.Error BadOption for a column that is not there, or would be there twice; TypeError
    for a keyword that pliant.check has not, or of another type. An exception that a signal handler
    raises ends a row, except KeyboardInterrupt and SystemExit, which end the call. No time ends one.

    Cost: of pliant.check, row by row on one thread; besides, a row is copied.
    """
    bodies, kept = _names(mesh), _names(keep)
    of_faces = None if faces is None else _names(faces)
    _refuse(options)
    if not hasattr(batch, "__arrow_c_array__") and not hasattr(batch, "__arrow_c_stream__"):
        raise TypeError(f"batch is {type(batch).__name__}; it must have __arrow_c_array__ or __arrow_c_stream__")
    is_one = hasattr(batch, "__arrow_c_array__")
    # Chunks stay apart: together they may be too large for one.
    table = None if is_one else Table.from_arrow(batch)
    batches = [RecordBatch.from_arrow(batch)] if table is None else table.to_batches()
    schema = batches[0].schema if table is None else table.schema
    if len({*kept, *_TYPES}) < len(kept) + len(_TYPES):
        raise Error("keep names a column twice, or one that the answer has; rename it in the batch before", "BadOption")
    _look_for([*bodies, *(of_faces or ()), *kept], schema.names)
    if of_faces is not None and len(of_faces) != len(bodies):
        raise Error(f"{len(bodies)} columns of vertices and {len(of_faces)} of faces; give as many", "BadOption")
    if of_faces is not None and format is not None:
        raise Error("lists of numbers have no format; leave out format or faces", "BadOption")
    if not bodies or len(set(bodies)) < len(bodies):
        raise Error("mesh names no column, or one twice; name the column of each body once", "BadOption")
    answers, line = [], 1
    for record in batches:
        answers.append(_rows(record, line, bodies, of_faces, format, kept, options))
        line += record.num_rows
    if is_one:
        return _as_given(batch, answers[0])
    own = _answer([], {name: [] for name in _TYPES}).schema
    fields = [schema.field(name) for name in kept] + [own.field(name) for name in _TYPES]
    return _as_given(batch, Table.from_batches(answers, schema=Schema(fields)))


def _names(names: str | Sequence[str]) -> list[str]:
    return [names] if isinstance(names, str) else list(names)


def _rows(
    record: Any, line: int, bodies: list[str], of_faces: list[str] | None, format: str | None, keep: list[str], options: dict[str, Any]
) -> Any:
    """The rows of a record batch, whose first has this number."""
    rows: dict[str, list[Any]] = {name: [] for name in _TYPES}
    for number in range(record.num_rows):
        begun = time.perf_counter()
        row: dict[str, Any] = {"line": line + number, "bodies": bodies}
        try:
            if of_faces is None:
                files = [_file(record.column(name), number, name, format) for name in bodies]
                hashed = [file.data for file in files]
            else:
                files, hashed = _arrays(record, number, bodies, of_faces)
            _count(row, files, hashed, options)
        except (KeyboardInterrupt, SystemExit, GeneratorExit):
            raise
        except BaseException as error:  # whatever it is, a panic of a library too: the other rows have answers
            row["error"] = " ".join(str(error).split()) or type(error).__name__
        row["ms"] = (time.perf_counter() - begun) * 1e3
        for name, column in rows.items():
            column.append(row.get(name))
    return _answer([(name, record.column(name)) for name in keep], rows)


def _answer(kept: list[tuple[str, Any]], rows: dict[str, list[Any]]) -> Any:
    """The record batch of these rows, behind the columns that are kept."""
    columns = [*kept, *((name, _column(values, _TYPES[name])) for name, values in rows.items())]
    return RecordBatch.from_arrays([column for _, column in columns], names=[name for name, _ in columns])


def _count(row: dict[str, Any], files: list[_File], hashed: list[bytes], options: dict[str, Any]) -> None:
    """Fills a row with the numbers of a check of these files."""
    row["bodies"] = [file.name for file in files]
    row["bytes"] = sum(map(len, hashed))
    digest = hashlib.sha256()
    for data in hashed:
        digest.update(data)
    row["sha256"] = digest.hexdigest()
    found = _check_files(
        *row["bodies"],
        files=dict(files),
        crossing_edges=not options.get("first") and options.get("within") is None,
        places=bool(options.get("crossing")) and not options.get("first"),
        warn=False,
        **options,
    )
    triangles = sum(body.triangles for body in found.bodies)
    counts = found.counts()
    row["triangles"] = triangles
    row.update((name, count) for name, count in counts._asdict().items() if name in _TYPES)


def _as_given(batch: Any, rows: Any) -> Any:
    """Rows as a record batch or table of pyarrow, where the batch is one."""
    if type(batch).__module__.partition(".")[0] != "pyarrow":
        return rows
    pyarrow = import_module("pyarrow")
    return pyarrow.table(rows) if isinstance(batch, pyarrow.Table) else pyarrow.record_batch(rows)


def _refuse(options: dict[str, Any]) -> None:
    known = set(inspect.signature(_check_files).parameters) - _NOT_ROWS
    for name in options.keys() - known:
        raise TypeError(f"check() has no option {name!r} for rows; there are {', '.join(sorted(known))}")
    for name in _FRAMES:
        if not isinstance(options.get(name), int | None):
            raise TypeError(f"{name} is {options[name]!r}; for rows it is the number of a frame")
    try:
        _check_files("triangle.obj", files={"triangle.obj": _TRIANGLE}, warn=False, **options)
    except Error:
        pass  # about this mesh, or about each


def _look_for(names: list[str], there: list[str]) -> None:
    for name in names:
        if name not in there:
            raise Error(f"the batch has no column {name!r}; it has {', '.join(map(repr, there))}", "BadOption")


def _file(column: Any, number: int, name: str, format: str | None) -> _File:
    """A cell of bytes or text as a file."""
    data = column[number].as_py()
    if isinstance(data, str):
        data = data.encode()
    if data is None:
        raise ValueError(f"{name} is null; a row needs a mesh in each column")
    if not isinstance(data, bytes):
        raise TypeError(f"{name} is a {_called(column)}; give a column of bytes, or lists of numbers with faces=")
    return _File(f"{name}.{format or _ending(data, name)}", data)


def _ending(data: bytes, name: str) -> str:
    """The ending of a file's format, by its first bytes, and the length of a binary STL file."""
    if data.startswith((b"ply\n", b"ply\r")):
        return "ply"
    if data.startswith(b"glTF"):
        return "glb"
    if data.startswith(b"PK\3\4"):
        return "npz"
    if len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little"):
        return "stl"
    start = data[:1000].removeprefix(b"\xef\xbb\xbf").lstrip()
    if start[:5].lower() == b"solid":
        return "stl"
    if start.startswith(b"{"):
        return "gltf"
    if start and not _NO_TEXT.search(start):
        return "obj"
    raise ValueError(f"the first bytes of {name} are of no format that is known by them; give format=" if data else f"{name} is empty")


def _arrays(record: Any, number: int, bodies: list[str], of_faces: Sequence[str]) -> tuple[list[_File], list[bytes]]:
    """Cells of numbers as files of NumPy, and what is hashed of them."""
    files, hashed = [], []
    for name, name_of_faces in zip(bodies, of_faces, strict=True):
        vertices = _threes(record.column(name), number, name)
        if vertices.dtype not in (np.float32, np.float64):
            vertices = vertices.astype(np.float64)
        faces = _threes(record.column(name_of_faces), number, name_of_faces)
        if faces.dtype.kind not in "iu":
            raise TypeError(f"{name_of_faces} has {faces.dtype}; corners must be integers")
        written = io.BytesIO()
        np.savez(written, vertices=vertices, faces=faces)
        files.append(_File(f"{name}.npz", written.getvalue()))
        hashed += [vertices.tobytes(), faces.astype("<u4").tobytes()]
    return files, hashed


def _threes(column: Any, number: int, name: str) -> np.ndarray[Any, Any]:
    """A cell of numbers as rows of three: of a list of lists of three, or of a flat list."""
    cell = column.slice(number, 1)
    if cell.null_count:
        raise ValueError(f"{name} is null; a row needs a mesh in each column")
    if not (cell.type.is_nested(cell.type) and cell.type.value_type):
        raise TypeError(f"{name} is a {_called(cell)}; give a column of lists of numbers")
    values = list_flatten(cell)
    if values.null_count:
        raise ValueError(f"{name} has entries that are null")
    if values.type.value_type is not None:
        size = values.type.list_size
        sizes = [size] if size is not None else np.diff(list_offsets(values).to_numpy())
        if np.any(np.not_equal(sizes, 3)):
            raise ValueError(f"{name} has a list of other than three numbers; give three for each vertex and triangle")
        values = list_flatten(values)
    if values.null_count:
        raise ValueError(f"{name} has numbers that are null")
    values = values.to_numpy()
    if values.dtype.kind not in "fiu":
        raise TypeError(f"{name} has {values.dtype}; give numbers")
    if len(values) % 3:
        raise ValueError(f"{name} has {len(values)} numbers; they must be three by three")
    rows: np.ndarray[Any, Any] = values.reshape(-1, 3)
    return rows


def _called(column: Any) -> str:
    """The type of a column, as messages name it."""
    return str(column.type).strip().removeprefix("arro3.core.DataType")


def _column(values: list[Any], kind: str) -> Any:
    if kind != "list":
        return Array(values, type=getattr(DataType, kind)())
    lengths = [len(names) for names in values]
    offsets = np.concatenate([[0], np.cumsum(lengths, dtype=np.int32)]).astype(np.int32)
    names = [name for names in values for name in names]
    return list_array(Array.from_numpy(offsets), Array(names, type=DataType.string()))
