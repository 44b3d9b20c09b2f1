"""pliant.arrow: checks of many meshes in the columns of record batches."""

from __future__ import annotations

import hashlib
import io
import json
import os
import pickle
import struct
import subprocess
import sys
import warnings
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pliant
import pytest

arro3 = pytest.importorskip("arro3.core", reason="pliant.arrow needs arro3-core: pip install 'pliant[arrow]'")

import pliant.arrow  # noqa: E402

# Two triangles that cross, and two that do not.
CROSSING = b"v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0.5 0.5 -1\nv 0.5 0.5 1\nv 1 0.5 1\nf 1 2 3\nf 4 5 6\n"
APART = CROSSING.replace(b" -1\n", b" 0.5\n")
FIGURES = ["triangles", "pairs", "crossing_edges", "adjacent", "touching", "degenerate", "inside"]


def batch(**columns: Any) -> Any:
    """A record batch of columns of bytes, or of arrays that are there already."""
    made = [
        arro3.Array(column, type=arro3.DataType.binary()) if isinstance(column, list) else column
        for column in columns.values()
    ]
    return arro3.RecordBatch.from_arrays(made, names=list(columns))


def rows(of: Any) -> list[dict[str, Any]]:
    """The rows of a batch as dictionaries."""
    record = arro3.RecordBatch.from_arrow(of)
    columns = {name: record.column(name).to_pylist() for name in record.column_names}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def lists(cells: list[np.ndarray[Any, Any]], width: int | None) -> Any:
    """A column of lists of numbers: flat, or of fixed or other lists of three."""
    values = arro3.Array.from_numpy(np.concatenate([cell.reshape(-1) for cell in cells]))
    sizes = np.array([0, *(cell.size for cell in cells)])
    if width == 3:
        values = arro3.fixed_size_list_array(values, 3)
    elif width == 0:
        ends = np.arange(0, len(values) + 1, 3, dtype=np.int32)
        values = arro3.list_array(arro3.Array.from_numpy(ends), values)
    per = 1 if width is None else 3
    return arro3.list_array(arro3.Array.from_numpy((np.cumsum(sizes) // per).astype(np.int32)), values)


def stl() -> bytes:
    """CROSSING as binary STL, whose first bytes are no mark."""
    vertices = np.array([line.split()[1:] for line in CROSSING.splitlines() if line[:1] == b"v"], np.float32)
    facets = [struct.pack("<12fH", 0, 0, 0, *vertices[at : at + 3].ravel(), 0) for at in (0, 3)]
    return b"solid, it says".ljust(80) + struct.pack("<I", 2) + b"".join(facets)


def formats() -> dict[str, bytes]:
    """CROSSING in the formats that the first bytes tell apart."""
    mesh = [line.split()[1:] for line in CROSSING.splitlines()]
    vertices = np.array(mesh[:6], np.float64)
    faces = np.array(mesh[6:], np.int64) - 1
    npz = io.BytesIO()
    np.savez(npz, vertices=vertices, faces=faces)
    ply = b"ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\nproperty double z\n"
    ply += b"element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    ply += b"".join(b" ".join(row) + b"\n" for row in mesh[:6]) + b"3 0 1 2\n3 3 4 5\n"
    buffer = vertices.astype("<f4").tobytes() + faces.astype("<u4").tobytes()
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5125, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 72},
            {"buffer": 0, "byteOffset": 72, "byteLength": 24},
        ],
        "buffers": [{"byteLength": 96}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    glb = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(buffer))
    glb += struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    return {"obj": CROSSING, "stl": stl(), "ply": ply, "npz": npz.getvalue(), "glb": glb}


def test_each_format_is_known_by_its_first_bytes() -> None:
    files = formats()
    found = rows(pliant.arrow.check(batch(mesh=list(files.values()))))
    assert [row["error"] for row in found] == [None] * len(files)
    assert [row["bodies"] for row in found] == [[f"mesh.{ending}"] for ending in files]
    assert [[row[name] for name in FIGURES] for row in found] == [[2, 1, 2, 0, 0, 0, 0]] * len(files)
    assert [row["line"] for row in found] == list(range(1, len(files) + 1))
    for row, data in zip(found, files.values(), strict=True):
        assert row["bytes"] == len(data) and row["sha256"] == hashlib.sha256(data).hexdigest()
        assert row["ms"] > 0 and row["peak_bytes"] is None


def test_rows_are_those_of_the_program(tmp_path: Path) -> None:
    program = os.environ.get("PLIANT")
    if program is None:
        pytest.skip("the variable PLIANT names no program to compare with")
    bodies = [CROSSING, APART, b"v 0 0 nan\nf 1 1 1\n", b""]
    others = [APART, APART.replace(b"0.5", b"9"), APART, APART]
    lines = []
    for number, files in enumerate(zip(bodies, others, strict=True)):
        names = [tmp_path / f"{number}_{which}.obj" for which in ("garment", "body")]
        for name, data in zip(names, files, strict=True):
            name.write_bytes(data)
        lines.append("\t".join(map(str, names)))
    (tmp_path / "list").write_text("\n".join(lines) + "\n")
    asked: list[tuple[dict[str, Any], list[str]]] = [({}, []), ({"itself": True}, ["--self"]), ({"within": 0.5}, ["--within", "0.5"])]
    for options, flags in asked:
        out = tmp_path / f"out{len(flags)}{flags[:1]}.jsonl"
        command = [program, "check", "--files-from", str(tmp_path / "list"), "--out", str(out), *flags]
        assert subprocess.run(command, capture_output=True).returncode == 2
        with out.open() as file:
            expected = sorted((json.loads(line) for line in file), key=lambda row: int(row["line"]))
        table = pliant.arrow.check(batch(garment=bodies, body=others), ["garment", "body"], format="obj", **options)
        found = rows(table)
        assert len(found) == len(expected) == 4
        for row, other in zip(found, expected, strict=True):
            same = ["line", "bytes", "sha256", *FIGURES]
            assert [row[name] for name in same] == [other.get(name) for name in same]
            assert (row["error"] is None) == (other.get("error") is None)
        assert list(found[0]) == list(expected[0])


@pytest.mark.parametrize("width", [3, 0, None])
@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int32])
def test_lists_of_numbers_are_meshes(width: int | None, dtype: type) -> None:
    vertices: list[np.ndarray[Any, Any]] = [np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, low], [1, 1, 2], [2, 1, 2]], dtype) for low in (-2, 1, -2)]
    faces = [np.array(faces, np.int64) for faces in ([[0, 1, 2], [3, 4, 5]],) * 2 + ([[0, 1, 2]],)]
    record = batch(v=lists(vertices, width), f=lists(faces, width), id=[b"a", b"b", b"c"])
    found = rows(pliant.arrow.check(record, "v", faces="f", keep=["id"]))
    assert [(row["id"], row["triangles"], row["pairs"], row["error"]) for row in found] == [
        (b"a", 2, 1, None),
        (b"b", 2, 0, None),
        (b"c", 1, 0, None),
    ]
    # Cells of a slice are its own.
    tail = rows(pliant.arrow.check(record.slice(1, 2), "v", faces="f"))
    assert [row["triangles"] for row in tail] == [2, 1]
    as_read = vertices[0] if dtype != np.int32 else vertices[0].astype(np.float64)
    data = as_read.tobytes() + faces[0].astype("<u4").tobytes()
    assert found[0]["sha256"] == hashlib.sha256(data).hexdigest() and found[0]["bytes"] == len(data)


def test_what_is_poisoned_is_a_row_with_an_error() -> None:
    bomb = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    bomb += b"property float z\nelement face 1000000000\nproperty list uchar int vertex_indices\nend_header\n"
    poisoned: dict[str, bytes | None] = {
        "no format": b"\0\1\2\3",
        "null": None,
        "NaN": CROSSING.replace(b"0.5 0.5 -1", b"nan 0 0"),
        "truncated": stl()[:-7] + b"",
        "no more": formats()["npz"][:-30],
        "faces": bomb,
        "vertex": CROSSING.replace(b"f 4 5 6", b"f 4 5 7"),
        "empty": b"",
    }
    good = [CROSSING, APART]
    found = rows(pliant.arrow.check(batch(mesh=[good[0], *poisoned.values(), good[1]]), max_memory=1 << 28))
    assert [found[0]["pairs"], found[-1]["pairs"]] == [1, 0]
    for name, row in zip(poisoned, found[1:-1], strict=True):
        assert row["error"] and row["pairs"] is None, name
    assert "mesh is null" in found[2]["error"] and "format=" in found[1]["error"]
    # A limit of memory is an error of its row alone.
    large = b"".join(b"v %d 0 0\n" % i for i in range(100_000)) + b"f 1 2 3\n"
    found = rows(pliant.arrow.check(batch(mesh=[large, CROSSING]), max_memory=1 << 20))
    assert found[0]["error"] and "memory" in found[0]["error"] and found[1]["pairs"] == 1


def test_lists_that_are_no_mesh_are_rows_with_errors() -> None:
    vertices = [np.zeros((3, 3)), np.arange(9.0).reshape(3, 3), np.full((3, 3), np.inf)]
    record = batch(v=lists(vertices, 3), f=lists([np.array([[0, 1, 3]]), np.array([[0, 1, 2]]), np.array([[0, 1, 2]])], 3))
    errors = [row["error"] for row in rows(pliant.arrow.check(record, "v", faces="f"))]
    assert errors[1] is None and errors[0] and errors[2]
    assert all(row["error"] for row in rows(pliant.arrow.check(record, "f", faces="v")))
    two = arro3.list_array(arro3.Array.from_numpy(np.array([0, 2, 4], np.int32)), arro3.Array.from_numpy(np.arange(4.0)))
    pairs = arro3.list_array(arro3.Array.from_numpy(np.array([0, 1, 2], np.int32)), two)
    # A list that is null, among lists that are not.
    inner = arro3.fixed_size_list_array(arro3.Array.from_numpy(np.arange(9.0)), 3, mask=arro3.Array([False, True, False], type=arro3.DataType.bool()))
    holes = arro3.list_array(arro3.Array.from_numpy(np.array([0, 3], np.int32)), inner)
    (row,) = rows(pliant.arrow.check(batch(v=holes, f=lists([np.array([[0, 1, 2]])], 3)), "v", faces="f"))
    assert "null" in row["error"]
    for column, says in [(two, "three by three"), (pairs, "other than three"), (batch(x=[b"", b""]).column("x"), "lists of numbers")]:
        found = rows(pliant.arrow.check(batch(v=column, f=column), "v", faces="f"))
        assert all(says in row["error"] for row in found), found


def test_what_is_asked_wrongly_is_refused() -> None:
    record = batch(mesh=[CROSSING])
    with pytest.raises(pliant.Error, match="no column 'body'; it has 'mesh'") as error:
        pliant.arrow.check(record, ["mesh", "body"])
    assert error.value.kind == "BadOption"
    wrong: list[dict[str, Any]] = [{"mesh": []}, {"mesh": ["mesh", "mesh"]}, {"faces": ["mesh", "mesh"]}, {"faces": "mesh", "format": "obj"}]
    for arguments in wrong:
        with pytest.raises(pliant.Error):
            pliant.arrow.check(record, **arguments)
    for keep in ("line", ["mesh", "mesh"]):
        with pytest.raises(pliant.Error, match="keep names"):
            pliant.arrow.check(record, keep=keep)
    for frame in ("baseline", "rest"):
        with pytest.raises(TypeError, match="number of a frame"):
            pliant.arrow.check(record, **{frame: "old.json"})
    with pytest.raises(TypeError):
        pliant.arrow.check(batch(mesh=[]), within="far")
    for option in ("files", "swept", "labels", "no_such"):
        options: dict[str, Any] = {option: True}
        with pytest.raises(TypeError, match=option):
            pliant.arrow.check(record, **options)
    with pytest.raises(TypeError, match="__arrow_c_array__"):
        pliant.arrow.check([CROSSING])


def test_columns_that_mean_one_file_are_errors_of_rows() -> None:
    (row,) = rows(pliant.arrow.check(batch(**{"x": [CROSSING], "./x": [APART]}), ["x", "./x"]))
    assert "two files" in row["error"]


def test_a_panic_of_a_library_is_an_error_of_its_row() -> None:
    pa = pytest.importorskip("pyarrow")
    wrong = pa.Array.from_buffers(pa.string(), 2, pa.array([CROSSING, b"\xff\xfe"]).buffers())
    found = pliant.arrow.check(pa.record_batch({"mesh": wrong}))
    assert found["pairs"].to_pylist() == [1, None] and found["error"][1].as_py()


def test_an_empty_batch_has_an_empty_answer() -> None:
    found = pliant.arrow.check(batch(mesh=[]))
    assert found.num_rows == 0 and found.column_names[:2] == ["line", "bodies"]


def test_chunks_of_a_table_stay_apart() -> None:
    chunks = [batch(mesh=[CROSSING, None]), batch(mesh=[]), batch(mesh=[APART])]
    found = pliant.arrow.check(arro3.Table.from_batches(chunks), keep="mesh")
    assert found.column("line").to_pylist() == [1, 2, 3] and found.column("pairs").to_pylist() == [1, None, 0]
    assert found.column("mesh").to_pylist() == [CROSSING, None, APART]


def test_remarks_are_no_errors_whatever_filters_there_are() -> None:
    far = b"v 1e6 0 0\nv 2e6 0 0\nv 1e6 1e6 0\nf 1 2 3\n"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (row,) = rows(pliant.arrow.check(batch(a=[APART], b=[far]), ["a", "b"]))
        with pytest.raises(UserWarning):
            pliant.check("a.obj", "b.obj", files={"a.obj": APART, "b.obj": far}).counts()
    assert row["error"] is None and row["pairs"] == 0


def as_rows(files: list[bytes]) -> list[dict[str, Any]]:
    """The function of a worker, by name, on what can be pickled."""
    return rows(pliant.arrow.check(batch(mesh=files)))


def test_processes_of_a_pool_find_the_same() -> None:
    assert pickle.loads(pickle.dumps(pliant.arrow.check)) is pliant.arrow.check
    parts = [[CROSSING, b"broken"], [APART], [CROSSING, CROSSING]]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(as_rows, parts))
    timeless = [[{**row, "ms": 0} for row in part] for part in found]
    assert timeless == [[{**row, "ms": 0} for row in as_rows(part)] for part in parts]


def test_batches_of_pyarrow_come_back_as_its_own() -> None:
    pa = pytest.importorskip("pyarrow")
    one = pa.record_batch({"mesh": pa.array([CROSSING, None], pa.large_binary())})
    found = pliant.arrow.check(one)
    assert isinstance(found, pa.RecordBatch) and found["pairs"].to_pylist() == [1, None]
    several = pa.Table.from_batches([one, one.slice(0, 1)])
    found = pliant.arrow.check(several)
    assert isinstance(found, pa.Table) and found["pairs"].to_pylist() == [1, None, 1]
    assert found["line"].to_pylist() == [1, 2, 3]
    assert pliant.arrow.check(several.slice(0, 0)).num_rows == 0
    for kind in (pa.string(), pa.string_view(), pa.binary_view(), pa.dictionary(pa.int8(), pa.binary())):
        text = pa.array([CROSSING.decode() if "string" in str(kind) else CROSSING]).cast(kind)
        assert pliant.arrow.check(pa.record_batch({"mesh": text}))["pairs"].to_pylist() == [1], kind
    vertices = np.array([line.split()[1:] for line in CROSSING.splitlines()[:6]], float).tolist()
    for list_of in (pa.list_, pa.large_list):
        arrays = {
            "v": pa.array([None, vertices], list_of(pa.list_(pa.float32(), 3))),
            "f": pa.array([[[0, 1, 2]], [[0, 1, 2], [3, 4, 5]]], list_of(list_of(pa.uint16()))),
        }
        found = pliant.arrow.check(pa.record_batch(arrays), "v", faces="f")
        assert found["pairs"].to_pylist() == [None, 1], list_of
        holes = pa.array([[[0.0, None, 0.0]] * 6], list_of(pa.list_(pa.float32(), 3)))
        found = pliant.arrow.check(pa.record_batch({"v": holes, "f": arrays["f"].slice(1)}), "v", faces="f")
        assert "null" in found["error"][0].as_py()


@pytest.mark.parametrize("library", ["polars", "nanoarrow", "pandas"])
def test_batches_of_other_libraries_are_read(library: str) -> None:
    other = pytest.importorskip(library)
    if library == "pandas":
        pytest.importorskip("pyarrow")
    made = other.c_array(batch(mesh=[CROSSING, APART])) if library == "nanoarrow" else other.DataFrame({"mesh": [CROSSING, APART]})
    assert pliant.arrow.check(made).column("pairs").to_pylist() == [1, 0]


GUARD = Path(__file__).parents[3] / "docs" / "guard-your-assets.md"


@pytest.mark.parametrize("engine", ["Ray Data", "Dask", "Spark", "Daft"])
def test_engines_of_the_document_find_the_same(engine: str, monkeypatch: pytest.MonkeyPatch) -> None:
    modules = {"Ray Data": "ray", "Dask": "dask.dataframe", "Spark": "pyspark", "Daft": "daft"}
    pytest.importorskip(modules[engine], reason=f"{engine} is not installed")
    pa = pytest.importorskip("pyarrow")
    # Workers of Spark are of the first Python on the path else.
    monkeypatch.setenv("PYSPARK_PYTHON", sys.executable)
    block = GUARD.read_text().split(f"```python\n# {engine}\n")[1].split("```")[0]
    names = {"table": pa.table({"id": range(6), "mesh": [CROSSING, APART, b"broken"] * 2})}
    exec(block, names)
    found: Any = names["rows"]
    found = found.sort_values("id")
    assert found["id"].tolist() == list(range(6))
    assert found["pairs"].fillna(-1).tolist() == [1, 0, -1] * 2
    assert found["error"].notna().tolist() == [False, False, True] * 2


def test_pliant_is_imported_without_arrow() -> None:
    code = "import pliant, sys; assert not {'pyarrow', 'arro3', 'pliant.arrow'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
    code = "import sys; sys.modules['arro3'] = None; import pliant.arrow"
    failed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "pip install 'pliant[arrow]'" in failed.stderr
