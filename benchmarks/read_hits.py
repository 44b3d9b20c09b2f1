"""Reads the files of `pliant check --hits` with VTK, on which ParaView is built, and with meshio.

    python -m venv target/vtk && target/vtk/bin/pip install vtk meshio numpy
    cargo build --release
    target/vtk/bin/python benchmarks/read_hits.py target/release/pliant BODY...

Checks the bodies three times, for JSON, for .vtp and for .vtu, and compares frame by frame. Cells,
with their bodies, triangles and partners, are compared with the pairs; points of the two readers
with each other. Fails at the first difference.
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


def by_vtk(path: Path) -> tuple[list[tuple[int, int, int]], np.ndarray]:
    """Cells, and the positions of their corners (cells, 3, 3)."""
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
        return [], np.zeros((0, 3, 3))
    arrays = [
        vtk_to_numpy(data.GetCellData().GetArray(name)) for name in ("body", "triangle", "partners")
    ]
    cells = data.GetPolys() if path.suffix == ".vtp" else data.GetCells()
    corners = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 3)
    assert all(data.GetCellType(cell) == 5 for cell in range(data.GetNumberOfCells()))
    return (
        list(zip(*(array.tolist() for array in arrays))),
        vtk_to_numpy(data.GetPoints().GetData())[corners],
    )


def by_meshio(path: Path) -> tuple[list[tuple[int, int, int]], np.ndarray]:
    mesh = meshio.read(path)
    arrays = [mesh.cell_data[name][0].tolist() for name in ("body", "triangle", "partners")]
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
        total = 0
        for frame in frames:
            number = str(frame["frame"]).zfill(len(str(len(frames) - 1)))
            ending = "" if len(frames) == 1 else f"_{number}"
            cells = expected(frame["pairs"])
            vtp, vtp_corners = by_vtk(folder / f"hits{ending}.vtp")
            vtu, vtu_corners = by_vtk(folder / f"hits{ending}.vtu")
            assert vtp == vtu == cells, f"frame {number}"
            assert (vtp_corners == vtu_corners).all()
            if cells:
                read, corners = by_meshio(folder / f"hits{ending}.vtu")
                assert read == cells and (corners == vtu_corners).all(), f"frame {number}"
            total += len(cells)
        print(f"{len(frames)} frames, {total} triangles: VTK and meshio read what the JSON says")


if __name__ == "__main__":
    main()
