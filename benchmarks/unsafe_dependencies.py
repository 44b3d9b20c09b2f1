#!/usr/bin/env python3
"""Lists dependencies with unsafe code or C of all that is published, as this machine compiles them.

Published are the library, the readers of files, the program and the Python package. Reads the
sources that cargo has fetched.

    benchmarks/unsafe_dependencies.py              prints the list
    benchmarks/unsafe_dependencies.py --check FILE fails if FILE does not name one in backquotes;
                                                   FILE is docs/RELIABILITY.md

Counts the word `unsafe` in Rust sources without comments, strings and test modules. All code of a
package counts, for any system and feature, so that nothing is missed. Macros and build scripts,
which run only during compilation, are listed apart. Dependencies of tests and experiments alone
are left out. Needs Python 3.10 and cargo.
"""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parent.parent
# Published packages, in the order of the columns.
PUBLISHED = {
    "library": "pliant",
    "files": "pliant-io",
    "program": "pliant-cli",
    "Python": "pliant-python",
}

TOKENS = re.compile(
    r"""//[^\n]* | /\*.*?\*/            # comments
      | b?r(\#*)".*?"\1 | b?"(?:\\.|[^"\\])*"   # strings
      | b?'(?:\\.[^']*|[^'\\])'         # characters""",
    re.DOTALL | re.VERBOSE,
)
TESTS = re.compile(r"#\[cfg\(test\)\]\s*(?:pub\s*(?:\([^)]*\)\s*)?)?mod\s+\w+\s*\{")
UNSAFE = re.compile(r"\bunsafe\b")
FORBIDDEN = re.compile(r"^#!\[forbid\([^\]]*\bunsafe_code\b", re.MULTILINE)
COMPILERS = {"cc", "cmake", "nasm-rs"}
OTHER_LANGUAGES = {".c", ".cc", ".cpp", ".s", ".S", ".asm", ".a", ".o", ".lib"}
# Folders of a package that are not compiled when another package uses it.
ELSEWHERE = {"tests", "benches", "examples", "fuzz", "target"}


def cargo(*arguments):
    return subprocess.run(
        ["cargo", *arguments], cwd=CHECKOUT, check=True, capture_output=True, text=True
    ).stdout


def dependencies(package, edges):
    """Names and versions of a package's dependencies, without packages of the workspace."""
    tree = cargo(
        "tree",
        "--locked",
        "--package",
        package,
        "--edges",
        edges,
        "--prefix",
        "none",
        "--format",
        "{p}",
    )
    lines = {line.removesuffix(" (*)").removesuffix(" (proc-macro)") for line in tree.splitlines()}
    return {tuple(line.split(" v", 1)) for line in lines if line and "(" not in line}


def without_tests(source):
    """Source without its test modules. It has no strings or comments, so every brace counts."""
    while begin := TESTS.search(source):
        depth, end = 1, begin.end()
        while depth and end < len(source):
            depth += {"{": 1, "}": -1}.get(source[end], 0)
            end += 1
        source = source[: begin.start()] + source[end:]
    return source


def rust_files(folder):
    for file in sorted(folder.rglob("*.rs")):
        inside = file.relative_to(folder)
        if inside.parts[0] not in ELSEWHERE and inside.name != "build.rs":
            yield file


def looked_at(package):
    """Number of times that a package says `unsafe`, and whether it has another language."""
    folder = Path(package["manifest_path"]).parent
    count = 0
    for file in rust_files(folder):
        text = file.read_text(encoding="utf-8", errors="replace")
        if FORBIDDEN.search(text) and file == folder / "src" / "lib.rs":
            # The compiler forbids unsafe code here, whatever words there are.
            return 0, has_c(package, folder)
        count += len(UNSAFE.findall(without_tests(TOKENS.sub(" ", text))))
    return count, has_c(package, folder)


def has_c(package, folder):
    """Whether it needs a compiler of another language, or has sources or objects of one."""
    needed = {
        it["name"] for it in package["dependencies"] if it["kind"] == "build" and not it["optional"]
    }
    files = (file for file in folder.rglob("*") if file.suffix in OTHER_LANGUAGES)
    return bool(COMPILERS & needed) or any(
        file.relative_to(folder).parts[0] not in ELSEWHERE for file in files
    )


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--check", metavar="FILE", type=Path)
    arguments = parser.parse_args()

    metadata = json.loads(cargo("metadata", "--locked", "--format-version", "1"))
    packages = {(it["name"], it["version"]): it for it in metadata["packages"]}
    shipped = {
        name: dependencies(package, "normal,no-proc-macro") for name, package in PUBLISHED.items()
    }
    everything = set().union(*shipped.values())
    compiling = (
        set().union(*(dependencies(package, "normal,build") for package in PUBLISHED.values()))
        - everything
    )
    found = {package: looked_at(packages[package]) for package in sorted(everything | compiling)}

    def is_listed(package):
        return any(found[package])

    print(f"{'dependency':<32} {'unsafe':>6}  C    in")
    for package in sorted(filter(is_listed, everything)):
        count, with_c = found[package]
        users = ", ".join(name for name, its in shipped.items() if package in its)
        print(f"{' '.join(package):<32} {count:>6}  {'yes' if with_c else '-':<3}  {users}")
    for name, its in shipped.items():
        print(f"{name}: {len(list(filter(is_listed, its)))} of {len(its)} dependencies")
    names = sorted({name for name, _ in filter(is_listed, compiling)})
    print(f"only when it is compiled: {', '.join(names)}")

    if arguments.check:
        text = arguments.check.read_text(encoding="utf-8")
        missing = sorted(
            {name for name, _ in filter(is_listed, everything) if f"`{name}`" not in text}
        )
        if missing:
            sys.exit(f"{arguments.check} does not name: {', '.join(missing)}")


if __name__ == "__main__":
    main()
