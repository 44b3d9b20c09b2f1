"""Reads the files of `pliant check --hits` with VTK, on which ParaView is built, and with meshio.

    python -m venv target/vtk && target/vtk/bin/pip install vtk meshio numpy
    cargo build --release
    target/vtk/bin/python benchmarks/read_hits.py target/release/pliant BODY...

Checks the bodies three times, for JSON, for .vtp and for .vtu, and compares frame by frame. Cells,
with their bodies, triangles and partners, are compared with the pairs; points and curves of the two
readers with each other. Fails at the first difference.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import meshio
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader


def expected(pairs: list[list[int]]) -> list[tuple[int, int, int]]:
    partners = Counter(
        (body, triangle) for a, t, b, u in pairs for body, triangle in ((a, t), (b, u))
    )
    return [(body, triangle, count) for (body, triangle), count in sorted(partners.items())]


def by_vtk(path: Path) -> tuple[list[tuple[int, int, int]], np.ndarray, list[np.ndarray]]:
    """Triangles, the positions of their corners (cells, 3, 3), and the points of curves."""
    reader = vtkXMLPolyDataReader() if path.suffix == ".vtp" else vtkXMLUnstructuredGridReader()
    problems: list[str] = []
    reader.AddObserver("ErrorEvent", lambda *_: problems.append("error"))
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    assert not problems, path
    time = vtk_to_numpy(data.GetFieldData().GetArray("TimeValue"))
    assert len(time) == 1
    if data.GetNumberOfCells() == 0:
        return [], np.zeros((0, 3, 3)), []
    arrays = [
        vtk_to_numpy(data.GetCellData().GetArray(name)) for name in ("body", "triangle", "partners")
    ]
    kinds = [data.GetCellType(cell) for cell in range(data.GetNumberOfCells())]
    points = vtk_to_numpy(data.GetPoints().GetData())
    of_cells = [
        points[[data.GetCell(cell).GetPointId(i) for i in range(data.GetCell(cell).GetNumberOfPoints())]]
        for cell in range(len(kinds))
    ]
    is_triangle = np.array(kinds) == 5
    curve, length = (vtk_to_numpy(data.GetCellData().GetArray(name)) for name in ("curve", "length"))
    assert ((curve == 0xFFFFFFFF) == is_triangle).all()
    # Polylines, or the sides of them.
    assert set(kinds) <= ({4, 5} if path.suffix == ".vtp" else {3, 5})
    curves = [np.concatenate([side for side, of in zip(of_cells, curve) if of == number])
              for number in range(len(set(curve[~is_triangle].tolist())))]
    sides = 1 if path.suffix == ".vtp" else 2
    curves = [line if sides == 1 else np.append(line[::2], line[-1:], axis=0) for line in curves]
    for number, line in enumerate(curves):
        found = np.linalg.norm(np.diff(line.astype(float), axis=0), axis=1).sum()
        rounding = 4 * len(line) * np.finfo(points.dtype).eps * np.abs(line).max()
        assert abs(found - length[curve == number][0]) <= rounding
    return (
        list(zip(*(array[is_triangle].tolist() for array in arrays))),
        np.array([line for line, kind in zip(of_cells, kinds) if kind == 5]),
        curves,
    )


def by_meshio(path: Path) -> tuple[list[tuple[int, int, int]], np.ndarray]:
    mesh = meshio.read(path)
    where = [block.type for block in mesh.cells].index("triangle")
    arrays = [mesh.cell_data[name][where].tolist() for name in ("body", "triangle", "partners")]
    return list(zip(*arrays)), mesh.points[mesh.cells_dict["triangle"]]


def main() -> None:
    program, *bodies = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        runs = [["--hits", str(folder / "hits.vtp")], ["--hits", str(folder / "hits.vtu")]]
        said = [
            json.loads(
                subprocess.run(
                    [program, "check", "--format", "json", *run, *bodies], capture_output=True
                ).stdout
            )
            for run in runs
        ]
        frames = said[0]["frames"]
        assert frames == said[1]["frames"]
        total = lines = 0
        for frame in frames:
            number = str(frame["frame"]).zfill(len(str(len(frames) - 1)))
            ending = "" if len(frames) == 1 else f"_{number}"
            cells = expected(frame["pairs"] + frame.get("adjacent_pairs", []))
            vtp, vtp_corners, vtp_curves = by_vtk(folder / f"hits{ending}.vtp")
            vtu, vtu_corners, vtu_curves = by_vtk(folder / f"hits{ending}.vtu")
            assert vtp == vtu == cells, f"frame {number}"
            assert (vtp_corners == vtu_corners).all()
            assert len(vtp_curves) == len(vtu_curves)
            assert all((a == b).all() for a, b in zip(vtp_curves, vtu_curves))
            if cells:
                read, corners = by_meshio(folder / f"hits{ending}.vtu")
                assert read == cells and (corners == vtu_corners).all(), f"frame {number}"
            total += len(cells)
            lines += len(vtp_curves)
        print(f"{len(frames)} frames, {total} triangles, {lines} curves: VTK and meshio read what the JSON says")


if __name__ == "__main__":
    main()
