"""The notebooks, run cell by cell."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import HERE

NOTEBOOKS = HERE.parent / "notebooks"


def run(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The names of a notebook after its last cell; it runs in a folder, and draws into nothing."""
    matplotlib = pytest.importorskip("matplotlib", reason="notebooks draw with matplotlib")
    matplotlib.use("Agg")
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {}
    cells = json.loads((NOTEBOOKS / name).read_text())["cells"]
    for number, cell in enumerate(cells):
        if cell["cell_type"] == "code":
            assert cell["outputs"] or number == 0, "it is committed with what it says"
            exec("".join(cell["source"]), names)
    matplotlib.pyplot.close("all")
    return names


def test_character(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    names = run("character.ipynb", tmp_path, monkeypatch)
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "49 frames of 4480 triangles" and said[-1] == "49 frames, 0 pairs"
    # The arms are in the torso where they come in most, at time 4, and as deep as they are there.
    assert set(names["bad"]) == set(range(names["bad"].min(), names["bad"].max() + 1)) and names["worst"] in names["bad"]
    assert abs(names["time"][names["worst"]] - 4) < 0.2 and 0.02 < names["deepest"].max() < 0.11
    assert 0.25 < names["good"] < 0.45
    meets = [line for line in said if "contacts" in line and ": 0 contacts" not in line]
    assert [line.split(":")[0] for line in meets] == ["frame 24", "frame 30"]


def test_tearing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run("tearing.ipynb", tmp_path, monkeypatch)
    assert len(names["new"]) == 17 and np.bincount(names["pieces"]).tolist() == [256, 256]
    assert names["began"][0] == names["ended"][1] == names["touching"]
    assert names["world"].bodies() == [0, 1] and 0.3 < names["step"].t < 0.5
