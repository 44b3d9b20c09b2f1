"""The types: every public name has one, with the same arguments, and they say what they should."""

from __future__ import annotations

import ast
import builtins
import importlib.metadata
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pliant
import pliant._pliant
import pytest
from conftest import HERE

PACKAGE = Path(pliant.__file__).parent

pytest.importorskip("mypy")


def mypy(*arguments: str, cwd: Path = HERE.parent) -> str:
    """What mypy says; nothing if all is well."""
    said = subprocess.run([sys.executable, "-m", *arguments], cwd=cwd, capture_output=True, text=True)
    return said.stdout + said.stderr if said.returncode else ""


def names(members: list[ast.stmt]) -> set[str]:
    return {member.name for member in members if isinstance(member, ast.FunctionDef | ast.ClassDef)}


def constants(members: list[ast.stmt]) -> set[str]:
    return {member.target.id for member in members if isinstance(member, ast.AnnAssign) and isinstance(member.target, ast.Name)}


def test_stub_and_module_have_the_same_names() -> None:
    stub = ast.parse((PACKAGE / "_pliant.pyi").read_text()).body
    public = {name for name in dir(pliant._pliant) if not name.startswith("_")}
    assert {name for name in names(stub) if not name.startswith("_")} == public
    classes = {member.name: member.body for member in stub if isinstance(member, ast.ClassDef)}
    for name in ("World", "Query", "Selection", "Check"):
        # That a question cannot be gone through is said when somebody tries, not here.
        special = ("__iter__", "__next__") if name == "Check" else ()
        members = {member for member in vars(getattr(pliant, name)) if member in special or member[0] != "_"}
        assert {member for member in names(classes[name]) | constants(classes[name]) if member in members or member[:2] != "__"} == members


def source_of(*path: str) -> str:
    """A file, or all files of a folder, of the Rust library's worlds."""
    source = (HERE.parents[2] / "crates" / "pliant" / "src" / "world").joinpath(*path)
    if not source.exists():
        pytest.skip("these tests are not in a checkout of the whole project")
    return "".join(file.read_text() for file in source.rglob("*.rs")) if source.is_dir() else source.read_text()


def public_methods(source: str) -> set[str]:
    visible = re.sub(r"#\[doc\(hidden\)\]\s+pub fn \w+", "", source)
    return set(re.findall(r"^    pub fn (\w+)", visible, re.MULTILINE))


def of_class(kind: type) -> set[str]:
    return {name for name in vars(kind) if name[0] != "_"}


def test_worlds_and_queries_have_the_methods_of_the_rust_librarys() -> None:
    # Options of single kinds stand with these.
    of_query = public_methods(source_of("query.rs")) | {"only", "width"}
    of_world = public_methods(source_of()) - of_query
    assert {"write_positions", "tree_cut", "intersections", "validate"} < of_world
    assert {"all", "first", "visit", "prepare", "at_most", "interrupt_if"} <= of_query
    # What may be interrupted has the names of what it is.
    others = source_of().replace(source_of("interruptible.rs"), "")
    assert public_methods(source_of("interruptible.rs")) - {"interruptible"} < public_methods(others)
    # A pool or scheduler of threads is nothing of Python's, what makes a world has one name there, and signals interrupt it.
    of_world -= {"new", "with_options", "with_pool", "with_scheduler", "interruptible"}
    assert of_class(pliant.World) == of_world | {"dtype"}
    # How much is wanted at most, how wide intervals are and of which kind, are arguments, and what interrupts a query are signals.
    of_query -= {"at_most", "interrupt_if", "width", "only"}
    # A list in job order is all(sort=False), and its rows, which Rust's HitRows makes, are a method.
    assert of_class(pliant.Query) == of_query - {"unsorted"} | {"rows", "of_frames"}
    assert "at_most" in inspect.signature(pliant.Query.all).parameters


def test_edits_have_the_steps_of_the_rust_librarys() -> None:
    of_edit = public_methods(source_of("..", "edit.rs"))
    # One of a kind is an array of one.
    assert of_class(pliant.Edit) == of_edit - {"add_vertex", "add_triangle", "remove_triangle", "vertex_count", "triangle_count"}


def test_changes_have_the_methods_of_the_rust_librarys() -> None:
    of_changes = public_methods(source_of("..", "changes.rs"))
    # Renaming is a function there; here edges are arrays.
    assert of_class(pliant.Changes) == of_changes - {"new", "follow"} | {"edges_edited"}


def test_selections_have_the_names_of_the_rust_librarys() -> None:
    source = source_of("..", "selection.rs")
    variants = re.findall(r"^    (\w+)(\(.*\))?,$", source[source.index("pub enum Selection") :], re.MULTILINE)
    assert len(variants) == 4
    assert of_class(pliant.Selection) == {name.lower() if bodies else name.upper() for name, bodies in variants}


def test_everything_public_is_in_the_package() -> None:
    in_module = {name for name in dir(pliant._pliant) if name[0] != "_"} - {
        "reference_intersection_pairs",
        "reference_self_intersection_pairs",
    }
    assert in_module <= set(pliant.__all__)
    for name in pliant.__all__:
        thing = getattr(pliant, name)
        assert thing.__doc__, name
        if isinstance(thing, type):
            assert thing.__module__ == "pliant", name


def documented() -> dict[str, str]:
    """The documentation of everything public: classes, their methods and properties, functions."""
    public = {name: getattr(pliant, name) for name in pliant.__all__ if name != "__version__"}
    of_classes = {
        f"{name}.{member}": getattr(thing, member)
        for name, thing in public.items()
        if isinstance(thing, type) and hasattr(pliant._pliant, name)
        for member in of_class(thing)
    }
    return {name: inspect.getdoc(thing) or "" for name, thing in (public | of_classes).items()}


def kinds_of_errors() -> set[str]:
    return set(re.findall(r"^  ([A-Z]\w+)  ", inspect.getdoc(pliant.Error) or "", re.MULTILINE))


def test_help_says_which_kinds_of_errors_there_are() -> None:
    source = source_of("..", "error.rs").split("impl ErrorKind")[0]
    variants = re.findall(r"^    (\w+)(?:,| \{)$", source, re.MULTILINE)
    assert {"NoTriangles", "OutdatedEdit"} < set(variants)
    of_python = {"Precision", "BadArray", "Busy", "BadOption", "CannotRead", "Broken"}
    # Python has exceptions of signal handlers in place of the other.
    assert kinds_of_errors() == (set(variants) - {"Interrupted"}) | of_python


def test_help_names_the_errors_of_every_call() -> None:
    named = 0
    for name, text in documented().items():
        first, *rest = text.splitlines()
        assert first.endswith(".") and len(first) <= 90 and not any(rest[:1]), name
        assert all(len(line) <= 100 for line in rest), name
        for raised in re.findall(r"[Rr]aises pliant\.Error: (.*?)(?:\n\n|$)", text, re.DOTALL):
            said = set(re.findall(r"\b[A-Z][a-z]+[A-Z]\w+\b|\bPrecision\b|\bBusy\b", raised))
            others = {kind for kind in said if hasattr(builtins, kind) or hasattr(pliant, kind)}
            assert said - others <= kinds_of_errors(), name
            named += 1
    assert named >= 50
    for name, method in vars(pliant.World).items():
        if name[0] == "_" or not callable(method):
            continue
        if {"body", "a", "of"} & set(inspect.signature(method).parameters):
            assert "NoSuchBody" in documented()[f"World.{name}"], name


def test_stubs_have_the_first_lines_of_help() -> None:
    said = {}

    def read(members: list[ast.stmt], within: str) -> None:
        for member in members:
            if isinstance(member, ast.ClassDef | ast.FunctionDef):
                if text := ast.get_docstring(member):
                    said[within + member.name] = text
                if isinstance(member, ast.ClassDef):
                    read(member.body, f"{member.name}.")

    read(ast.parse((PACKAGE / "_pliant.pyi").read_text()).body, "")
    for name in pliant.reference.__all__:
        text = inspect.getdoc(getattr(pliant.reference, name)) or ""
        assert said.pop(f"reference_{name}") == text.splitlines()[0]
    first = {
        name: text.splitlines()[0]
        for name, text in documented().items()
        if hasattr(pliant._pliant, name.split(".")[0])
        and name not in ("Selection.WORLD", "Selection.EVERYTHING")
    }
    assert said == first


def test_the_package_knows_its_version() -> None:
    assert pliant.__version__ == importlib.metadata.version("pliant")


def test_arguments_and_defaults_agree() -> None:
    said = mypy("mypy.stubtest", "pliant")
    assert said == "", said


def test_tests_and_examples_have_the_right_types() -> None:
    said = mypy("mypy", "tests", "examples")
    assert said == "", said


@pytest.mark.parametrize(
    ("line", "wrong"),
    [
        ("world.add(faces, positions)", None),
        ("world.add(faces, positions).bit_length()", None),
        ("world.intersections().all().sum()", None),
        ("pliant.self_intersection_pairs(positions, faces, threads=2)", None),
        ("[frame.pairs[0] for frame in pliant.check('a.npz', frames=range(3))]", None),
        ("pliant.World(degree=3)", "degree"),
        ("pliant.World(partition='octree')", "partition"),
        ("world.set_positions(positions)", "positions"),
        ("world.add(faces)", "No overload"),
        ("world.intersections(pliant.Selection.EVERYTHING).all(at_most=3)[0]", None),
        ("{pliant.Selection.within(0): pliant.Selection.between(0, np.uint32(1)) == pliant.Selection.WORLD}", None),
        ("world.intersections(0)", "Selection"),
        ("for pair in world.intersections(): print(pair)", "__iter__"),
        ("len(world.intersections())", "Sized"),
        ("world.intersections(pliant.Selection.between(0))", "between"),
        ("world.intersections(pliant.Selection.EVERY)", "EVERY"),
        ("world.intersections(pliant.Selection.within(0)).first().body_a", "None"),
        ("world.intersections().all(3)", "Too many positional"),
        ("world.intersections().visit(lambda: True)", "visit"),
        ("world.intersections().visit(lambda pair: pair.triangle_c)", "triangle_c"),
        ("pliant.intersection_pairs(positions, faces)", "No overload"),
        ("pliant.check('a.npz', frames=3)", "frames"),
        ("pliant.check('a.npz', split='components', groups={'g': ['a.npz', 1]}, ignore=[('g', 0)], baseline=0)", None),
        ("[frame.left_out + 1 for frame in pliant.check('a.npz')]", "None"),
        ("pliant.check('a.npz', split='halves')", "split"),
        ("pliant.check('a.npz', ignore=['g'])", "tuple"),
    ],
)
def test_the_types_find_mistakes(tmp_path: Path, line: str, wrong: str | None) -> None:
    head = "import numpy as np\nimport pliant\nworld = pliant.World()\n"
    head += "faces = np.zeros((1, 3), np.int64)\npositions = np.zeros((3, 3))\n"
    (tmp_path / "snippet.py").write_text(head + line + "\n")
    said = mypy("mypy", "--strict", "--cache-dir", str(HERE.parent / ".mypy_cache"), str(tmp_path / "snippet.py"))
    assert (said == "") if wrong is None else (wrong in said and "snippet.py:6" in said), said
