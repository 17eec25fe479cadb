# SPDX-License-Identifier: GPL-3.0-or-later
"""Break the program on purpose, one place at a time, and see whether the tests named for it notice.

The table is tools/mutations.toml. Each mutation is made in a copy of the tree and built there; what was found is kept
until the mutated file, the mutation or its tests change, so that a run that was stopped goes on where it was.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
import zipfile
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutate"
TREE = WORK / "tree"  #: the copy
BUILT = WORK / "native"  #: what CMake makes of it
SITE = TREE / "build" / "native"  #: what its tests import, where pyproject.toml says it is
RESULTS = WORK / "results.json"
PACKAGE = Path("engine/native/photon_maps_native")
COPIED = ("engine", "operators", "ui", "tests", "benchmarks", "tools", "licenses")
COPIED_FILES = ("__init__.py", "LICENSE", "blender_manifest.toml", "pyproject.toml")
TEST_SECONDS = 900  #: a test that takes longer hangs, which is noticed too


class TableError(Exception):
    """The table names what is not there, or what cannot be built or tested."""


@dataclass(frozen=True)
class Mutation:
    """One place to break, and who should notice."""

    name: str  #: what is broken
    file: str
    text: str  #: must occur exactly once in the file
    replacement: str
    tests: list[str] = field(hash=False)  #: a C++ test program, or a pytest name from the root; the first to fail ends

    @property
    def key(self) -> str:
        """What was found holds as long as this is the same."""
        parts = [self.name, self.text, self.replacement, (ROOT / self.file).read_text()]
        parts += [(ROOT / source_of(test)).read_text() for test in self.tests]
        return hashlib.sha256("\0".join([*parts, *self.tests]).encode()).hexdigest()

    def mutated(self) -> str:
        """Return the file's text with the mutation.

        :raises TableError: if the place is not there, or not the only one.
        """
        source = (ROOT / self.file).read_text()
        if source.count(self.text) != 1:
            raise TableError(f"{self.name}: {self.file} has the text {source.count(self.text)} times:\n{self.text}")
        return source.replace(self.text, self.replacement)


def source_of(test: str) -> str:
    """Return the path of a test's file."""
    return test.partition("::")[0] if test.endswith(".py") or ".py::" in test else f"engine/native/tests/{test}.cpp"


def is_program(test: str) -> bool:
    return not source_of(test).endswith(".py")


def read_table(path: Path) -> list[Mutation]:
    """Return the mutations of a table, each tried for its place.

    :raises TableError: if a place, a test's file, or a field is missing, or two have one name.
    """
    mutations = [Mutation(**row) for row in tomllib.loads(path.read_text())["mutation"]]
    if len({mutation.name for mutation in mutations}) != len(mutations):
        raise TableError("two mutations have the same name")
    for mutation in mutations:
        mutation.mutated()
        for test in mutation.tests:
            if not (ROOT / source_of(test)).is_file():
                raise TableError(f"{mutation.name}: there is no test {test}")
    return mutations


# --- The copy of the tree ---


def write_if_other(path: Path, data: bytes) -> None:
    """Write a file unless it is the same already, so that what was built of it stays."""
    if path.is_file() and path.read_bytes() == data:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def copy_tree() -> None:
    """Bring the copy up to date."""
    sources = [ROOT / name for name in COPIED_FILES]
    for folder in COPIED:
        sources += [path for path in (ROOT / folder).rglob("*") if path.is_file() and "__pycache__" not in path.parts]
    wanted = {TREE / path.relative_to(ROOT): path for path in sources}
    for folder in COPIED:
        for path in (TREE / folder).rglob("*"):
            if path.is_file() and path not in wanted:
                path.unlink()
    for target, path in wanted.items():
        write_if_other(target, path.read_bytes())
    for path in (ROOT / "build" / "native").iterdir():
        if path.name.startswith("embreex") and not (SITE / path.name).exists():
            shutil.copytree(path, SITE / path.name)


def build(target: str) -> None:
    """Build the library or a test program.

    :raises TableError: if it cannot be built.
    """
    done = subprocess.run(["cmake", "--build", BUILT, "--target", target], capture_output=True, text=True)
    if done.returncode != 0:
        raise TableError(f"{target} cannot be built:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


def bring_package() -> None:
    """Build the library, and bring the package that Python imports up to date."""
    build("photon_maps_native")
    for path in (TREE / PACKAGE).glob("*.py"):
        write_if_other(SITE / PACKAGE.name / path.name, path.read_bytes())
    library = "libphoton_maps_native.so"
    write_if_other(SITE / PACKAGE.name / library, (BUILT / library).read_bytes())


def configure() -> None:
    """Make the build folder; a mutation may leave something unused, of which nobody needs to be warned."""
    subprocess.run(
        ["cmake", "-S", TREE / "engine/native", "-B", BUILT, "-DPHOTON_MAPS_TESTS=ON", "-DCMAKE_CXX_FLAGS=-w"],
        check=True,
        capture_output=True,
    )


def write_zip() -> None:
    """Make the zip that the tests in Blender install: the project's own, with the copy's modules in it."""
    (source,) = (ROOT / "build").glob("photon_maps-*-linux-x64.zip")
    with zipfile.ZipFile(source) as built, zipfile.ZipFile(TREE / "build" / source.name, "w") as copy:
        for name in built.namelist():
            own = TREE / name
            is_module = name.endswith(".py") and own.is_file()
            copy.writestr(built.getinfo(name), own.read_bytes() if is_module else built.read(name))


# --- The tests ---


def passes(test: str) -> bool:
    """Build what a test needs, and run it.

    :raises TableError: if it cannot be built or run.
    """
    if is_program(test):
        build(test)
    elif "tests/blender" in test:
        write_zip()
    else:
        bring_package()
    (embree,) = SITE.glob("embreex.libs/libembree4-*.so.4")
    environment = {**os.environ, "PHOTON_MAPS_EMBREE": str(embree), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [str(BUILT / test)] if is_program(test) else [sys.executable, "-m", "pytest", "-x", "-q", test]
    if "tests/blender" in test:
        command += ["-o", "pythonpath=."]  # the wheels are the zip's
    try:
        done = subprocess.run(
            command, cwd=TREE, env=environment, timeout=TEST_SECONDS, capture_output=True, text=True, errors="replace"
        )
    except subprocess.TimeoutExpired:
        return False
    if not is_program(test) and done.returncode not in (0, 1, -6, -11):  # neither passed nor failed nor crashed
        raise TableError(f"{test} cannot be run:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.returncode == 0


def first_to_notice(mutation: Mutation) -> str | None:
    """Make the mutation in the copy, and return the first test that fails; the copy is whole again afterwards.

    :raises TableError: if it cannot be built.
    """
    target = TREE / mutation.file
    original = target.read_bytes()
    try:
        target.write_text(mutation.mutated())
        return next((test for test in mutation.tests if not passes(test)), None)
    finally:
        target.write_bytes(original)


def check_unbroken(tests: set[str]) -> None:
    """See that the tests that noticed something pass as long as nothing is broken.

    :raises TableError: if one does not.
    """
    failing = [test for test in sorted(tests) if not passes(test)]
    if failing:
        raise TableError(f"these fail with nothing broken, so what they noticed counts for nothing: {failing}")


def main() -> int:
    """Try all mutations; return 1 if one survives."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="those in whose name or file this is found, a regular expression")
    parser.add_argument("--fresh", action="store_true", help="forget what was found before")
    arguments = parser.parse_args()
    try:
        table = read_table(ROOT / "tools" / "mutations.toml")
        found = json.loads(RESULTS.read_text()) if RESULTS.is_file() and not arguments.fresh else {}
        chosen = [m for m in table if re.search(arguments.only, f"{m.name}\n{m.file}")]
        keys = {m.name: m.key for m in chosen}  # once: files may change meanwhile
        left = [m for m in chosen if keys[m.name] not in found]
        if left:
            copy_tree()
            configure()
        for number, mutation in enumerate(left, 1):
            started = time.monotonic()
            noticed = found[keys[mutation.name]] = first_to_notice(mutation)
            seconds = time.monotonic() - started
            print(f"{number}/{len(left)} {mutation.name}: {noticed or 'SURVIVES'} ({seconds:.0f} s)", flush=True)
            partial = RESULTS.with_suffix(".partial")
            partial.write_text(json.dumps(found, indent=1))
            os.replace(partial, RESULTS)
        if left:
            check_unbroken({found[keys[mutation.name]] for mutation in left} - {None})
    except TableError as error:
        print(f"mutate: {error}")
        return 2
    survivors = [m for m in chosen if found[keys[m.name]] is None]
    for mutation in survivors:
        print(f"survives: {mutation.name} ({mutation.file}), not seen by {', '.join(mutation.tests)}")
    print(f"{len(chosen)} mutations, {len(chosen) - len(survivors)} noticed, {len(survivors)} survive")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
