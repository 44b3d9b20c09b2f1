"""The Rust files of the binding use only those that the table of lib.rs has above them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

SOURCE = Path(__file__).parent.parent / "src"


def test_files_use_only_those_above_them() -> None:
    if not SOURCE.exists():
        pytest.skip("the Rust files are not beside the tests")
    table = re.findall(r"^//! \| `([a-z_/]+)\.rs` \|", (SOURCE / "lib.rs").read_text(), re.M)
    order = [name.removesuffix("/mod").replace("/", "::") for name in table]
    files = {
        str(path.relative_to(SOURCE).with_suffix("")).removesuffix("/mod").replace("/", "::"): path
        for path in SOURCE.rglob("*.rs")
    }
    assert sorted(order) == sorted(files.keys() - {"lib"})
    for name, path in files.items():
        if name == "lib":
            continue
        text = path.read_text()
        assert not re.search(r"\b(super::|crate::\{)", text), f"{name} is not seen through"
        for used in re.findall(r"\bcrate::([a-z_]+(?:::[a-z_]+)?)", text):
            module = used if used in files else used.split("::")[0]
            assert module == name or order.index(module) < order.index(name), f"{name} uses {module}"
