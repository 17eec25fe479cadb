# SPDX-License-Identifier: GPL-3.0-or-later
"""The house rules that a machine can check: who knows what, one version, nothing left behind."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
NOT_OURS = {".git", ".venv", ".hypothesis", "__pycache__", "build", "dist", "wheels"}
COMMENTED = {".py", ".c", ".cpp", ".h", ".sh"}

#: Floors of the house, the longest matching path wins: a module imports from its own floor or below.
FLOORS = {
    "engine/native": 0,
    "engine/settings": 1,
    "engine/passes": 1,
    "engine/chart": 2,
    "engine/preferences": 1,
    "engine/map_choice": 1,
    "engine/messages": 1,
    "engine/session": 1,
    "engine/changes": 1,
    "engine/last_photons": 1,
    "engine/photon_look": 1,
    "engine/point_budget": 1,
    "engine/received": 1,
    "engine/search_disc": 1,
    "engine/viewport_rendering": 1,
    "engine/viewport_worker": 1,
    "engine/status": 1,
    "engine/summary": 1,
    "engine/properties": 1,
    "engine/user_settings": 1,
    "engine/property_items": 1,
    "engine/export": 2,
    "engine": 3,
    "engine/render_engine": 4,
    "operators": 5,
    "ui": 6,
    "__init__": 7,
}


def files(*suffixes: str) -> Iterator[Path]:
    """Yield the project's own files, relative to the root; of the given suffixes where there are any."""
    for folder, folders, names in os.walk(ROOT):
        folders[:] = [name for name in folders if name not in NOT_OURS]
        for name in names:
            path = Path(folder, name).relative_to(ROOT)
            if not suffixes or path.suffix in suffixes:
                yield path


def shipped_python() -> list[Path]:
    """Return the Python files that users get."""
    return [path for path in files(".py") if path.parts[0] in {"__init__.py", "engine", "operators", "ui"}]


def floor(module: Path) -> int:
    """Return the floor of a file or module, given as a path from the root."""
    name = module.with_suffix("").as_posix()
    return FLOORS[max((known for known in FLOORS if f"{name}/".startswith(f"{known}/")), key=len)]


def project_imports(path: Path) -> Iterator[Path]:
    """Yield the modules of the project that a file imports, as paths from the root."""
    for node in ast.walk(ast.parse((ROOT / path).read_text())):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = path.parents[node.level - 1]
            for alias in node.names:
                module = base / (node.module or "").replace(".", "/")
                inner = module / alias.name
                yield inner if (ROOT / inner).with_suffix(".py").exists() or (ROOT / inner).is_dir() else module
        elif isinstance(node, ast.ImportFrom | ast.Import):
            names = [node.module] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names]
            if any(name and name.split(".")[0] == "photon_maps_native" for name in names):
                yield Path("engine/native/photon_maps_native")


def test_everything_below_the_export_works_without_blender():
    script = """
import sys
sys.modules["bpy"] = None
import photon_maps_native
from engine import changes, last_chart, map_choice, messages, passes, session, settings, summary, viewport_worker
from engine.chart import figure, job, report
print(sorted(name for name in sys.modules if name.split(".")[0] in {"mathutils", "bmesh", "gpu"}))
"""
    paths = os.pathsep.join([str(ROOT), str(ROOT / "build" / "native")])
    result = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.strip() == "[]"


def test_lower_floors_do_not_reach_up():
    imports = [(path, module) for path in shipped_python() for module in project_imports(path)]
    assert (Path("engine/session.py"), Path("engine/passes")) in imports
    assert [f"{path} imports {module}" for path, module in imports if floor(module) > floor(path)] == []


def test_only_the_session_calls_the_helper():
    """Others may use its data classes and its error, and the panel may ask whether it is there."""
    callers = {
        path.as_posix()
        for path in shipped_python()
        if re.search(r"\b(Native(Scene|Render)|Device)\b", (ROOT / path).read_text())
        and not path.is_relative_to("engine/native")
    }
    assert callers == {"engine/session.py"}


def test_only_the_export_reads_the_scene_from_the_depsgraph():
    reading = re.compile(r"\.object_instances\b|\.to_mesh\(|depsgraph\w*\.(objects|ids)\b")
    readers = [path for path in shipped_python() if reading.search((ROOT / path).read_text())]
    assert readers
    assert [path for path in readers if not path.is_relative_to("engine/export")] == []


def test_only_the_library_binding_knows_ctypes():
    users = {
        path.as_posix()
        for path in shipped_python()
        if re.search(r"\bimport ctypes|from ctypes", (ROOT / path).read_text())
    }
    package = "engine/native/photon_maps_native"
    assert f"{package}/library.py" in users
    assert users <= {
        f"{package}/library.py",
        f"{package}/structs.py",
        f"{package}/convert.py",
        f"{package}/snapshot.py",
    }


def test_the_version_is_the_same_wherever_it_must_be_said():
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    native = tomllib.loads((ROOT / "engine/native/pyproject.toml").read_text())
    wheels = {name for name in manifest["wheels"] if "photon_maps_native-" in name}
    tags = dict(re.findall(r"^TAG_(\S+) := (\S+)$", (ROOT / "Makefile").read_text(), re.MULTILINE))
    from engine.summary import VERSION

    assert {native["project"]["version"], VERSION} == {manifest["version"]}
    assert list(tags) == manifest["platforms"]
    assert wheels == {f"./wheels/photon_maps_native-{manifest['version']}-py3-none-{tag}.whl" for tag in tags.values()}


@pytest.mark.parametrize("kind", ["machine paths", "registry addresses", "marks"])
def test_nothing_is_left_behind(kind):
    # In pieces, so that this file does not find itself.
    patterns = {
        "machine paths": "/wo" + r"rk/|/tm" + r"p/\w|/ho" + r"me/\w|/ro" + r"ot/",
        "registry addresses": r"py" + r"pi\.org|python" + r"hosted\.org|deb\.deb" + r"ian\.org",
        "marks": r"\b(TO" + "DO|FIX" + "ME|XX" + r"X)\b",
    }
    found = []
    for path in files():
        try:
            text = (ROOT / path).read_text()
        except UnicodeDecodeError:
            continue  # pictures and .blend files
        lines = enumerate(text.splitlines(), 1)
        found += [f"{path}:{number}: {line.strip()}" for number, line in lines if re.search(patterns[kind], line)]
    assert found == []


def test_every_source_file_states_its_licence():
    sources = [path for path in files() if path.suffix in COMMENTED or path.name in {"CMakeLists.txt", "Makefile"}]
    sources = [path for path in sources if (ROOT / path).stat().st_size > 0]
    assert Path("Makefile") in sources
    headless = [
        str(path)
        for path in sources
        if "SPDX-License-Identifier: GPL-3.0-or-later" not in (ROOT / path).read_text()[:300]
    ]
    assert headless == []


def test_the_page_about_tests_names_those_that_there_are():
    page = (ROOT / "docs/testing.md").read_text()
    named = re.findall(r"`(tests/[\w/]+\.py)(?:::(\w+))?`", page)
    assert len(named) > 40
    for path, name in named:
        assert (f"def {name}(" if name else "def test_") in (ROOT / path).read_text(), f"{path}::{name}"
    for program in re.findall(r"`(test_\w+)`", page):
        assert (ROOT / f"engine/native/tests/{program}.cpp").is_file(), program


def test_every_mutation_is_of_what_there_is():
    sys.path.insert(0, str(ROOT / "tools"))
    try:
        import mutate
    finally:
        sys.path.pop(0)
    assert len(mutate.read_table(ROOT / "tools/mutations.toml")) >= 60
