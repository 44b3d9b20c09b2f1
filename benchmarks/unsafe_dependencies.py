#!/usr/bin/env python3
"""Which dependencies of what is published have unsafe code or C: of the library, of the readers of files, of the program and of the
Python package, as this machine compiles them. Reads the sources that cargo has fetched.

    benchmarks/unsafe_dependencies.py                               prints the list
    benchmarks/unsafe_dependencies.py --check docs/RELIABILITY.md   fails too if that file does not name one of them in backquotes

Counted is the word `unsafe` in Rust sources, without comments, strings and modules of tests: of all that a package has for any
system and feature, so that nothing is missed. What runs only when something is compiled, macros and build scripts, is listed
apart; what only tests and experiments need is not. Needs Python 3.10 and cargo.
"""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parent.parent
# What people get, in the order of the columns.
PUBLISHED = {"library": "pliant", "files": "pliant-io", "program": "pliant-cli", "Python": "pliant-python"}

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
# In a package's folder, but not in what is compiled when another package uses it.
ELSEWHERE = {"tests", "benches", "examples", "fuzz", "target"}


def cargo(*arguments):
    return subprocess.run(["cargo", *arguments], cwd=CHECKOUT, check=True, capture_output=True, text=True).stdout


def dependencies(package, edges):
    """Names and versions of what a package needs, itself and the rest of the workspace left out."""
    tree = cargo("tree", "--locked", "--package", package, "--edges", edges, "--prefix", "none", "--format", "{p}")
    lines = {line.removesuffix(" (*)").removesuffix(" (proc-macro)") for line in tree.splitlines()}
    return {tuple(line.split(" v", 1)) for line in lines if line and "(" not in line}


def without_tests(source):
    """The source without its modules of tests; strings and comments are gone already, so that braces are braces."""
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
    """How many times a package says `unsafe`, and whether it has, or compiles, another language."""
    folder = Path(package["manifest_path"]).parent
    count = 0
    for file in rust_files(folder):
        text = file.read_text(encoding="utf-8", errors="replace")
        if FORBIDDEN.search(text) and file == folder / "src" / "lib.rs":
            # The compiler has made sure, whatever words there are.
            return 0, has_c(package, folder)
        count += len(UNSAFE.findall(without_tests(TOKENS.sub(" ", text))))
    return count, has_c(package, folder)


def has_c(package, folder):
    """Whether its build script is given a compiler of another language, or it brings what one made or would take."""
    needed = {it["name"] for it in package["dependencies"] if it["kind"] == "build" and not it["optional"]}
    files = (file for file in folder.rglob("*") if file.suffix in OTHER_LANGUAGES)
    return bool(COMPILERS & needed) or any(file.relative_to(folder).parts[0] not in ELSEWHERE for file in files)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", metavar="FILE", type=Path)
    arguments = parser.parse_args()

    metadata = json.loads(cargo("metadata", "--locked", "--format-version", "1"))
    packages = {(it["name"], it["version"]): it for it in metadata["packages"]}
    shipped = {name: dependencies(package, "normal,no-proc-macro") for name, package in PUBLISHED.items()}
    everything = set().union(*shipped.values())
    compiling = set().union(*(dependencies(package, "normal,build") for package in PUBLISHED.values())) - everything
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
        missing = sorted({name for name, _ in filter(is_listed, everything) if f"`{name}`" not in text})
        if missing:
            sys.exit(f"{arguments.check} does not name: {', '.join(missing)}")


if __name__ == "__main__":
    main()
