# SPDX-License-Identifier: GPL-3.0-or-later
"""What the extension never does: reach the network, run programs, execute what a file holds, load others' libraries."""

from __future__ import annotations

import ast
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path

from tests.test_repository import ROOT, shipped_python

#: Modules by which Python reaches the network, other programs, or code that is data.
FORBIDDEN_MODULES = {
    *("socket", "ssl", "urllib", "http", "ftplib", "smtplib", "asyncio", "requests", "xmlrpc", "webbrowser"),
    *("subprocess", "multiprocessing", "pty", "runpy", "code", "codeop", "pickle", "marshal", "shelve", "pip"),
}
FORBIDDEN_CALLS = {"eval", "exec", "compile", "__import__", "breakpoint", "input"}
#: Members of the module os, and of Blender's operators and texts, that start or run something.
FORBIDDEN_OF_OS = {
    "system",
    "popen",
    "startfile",
    "fork",
    "posix_spawn",
    "execv",
    "execve",
    "execl",
    "spawnl",
    "spawnv",
}
FORBIDDEN_OF_BLENDER = {"python_file_run", "run_script", "as_module", "url_open", "path_open"}
#: The only place that loads libraries, and how many calls do.
LOADING = {"engine/native/photon_maps_native/library.py": 1}


def calls(path: Path) -> Iterator[ast.Call]:
    """Yield the calls in a file."""
    for node in ast.walk(ast.parse((ROOT / path).read_text())):
        if isinstance(node, ast.Call):
            yield node


def imported(path: Path) -> Iterator[str]:
    """Yield the top names of the modules of others that a file imports."""
    for node in ast.walk(ast.parse((ROOT / path).read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module.partition(".")[0]


def is_forbidden(node: ast.AST) -> bool:
    """Return whether a node asks for a member that starts or runs something."""
    if not isinstance(node, ast.Attribute):
        return False
    of_os = isinstance(node.value, ast.Name) and node.value.id == "os"
    return node.attr in FORBIDDEN_OF_BLENDER or (of_os and node.attr in FORBIDDEN_OF_OS)


def test_no_network_and_no_other_programs() -> None:
    paths = shipped_python()
    assert len(paths) > 80
    assert [f"{path}: {name}" for path in paths for name in imported(path) if name in FORBIDDEN_MODULES] == []
    nodes = ((path, node) for path in paths for node in ast.walk(ast.parse((ROOT / path).read_text())))
    assert [f"{path}:{node.lineno}" for path, node in nodes if is_forbidden(node)] == []


def test_nothing_is_executed_that_is_not_in_the_extension() -> None:
    named = [(path, call) for path in shipped_python() for call in calls(path) if isinstance(call.func, ast.Name)]
    assert len(named) > 100
    assert [f"{path}:{call.lineno}" for path, call in named if call.func.id in FORBIDDEN_CALLS] == []


def test_libraries_are_loaded_in_one_place_and_by_full_path() -> None:
    loading = {}
    for path in shipped_python():
        names = {"CDLL", "PyDLL", "WinDLL", "OleDLL", "LoadLibrary", "find_library"}
        found = [call for call in calls(path) if isinstance(call.func, ast.Attribute) and call.func.attr in names]
        if found:
            loading[path.as_posix()] = found
    assert {name: len(found) for name, found in loading.items()} == LOADING
    from photon_maps_native import library

    assert library.embree_path().is_absolute()
    assert Path(library.load_library()._name).is_absolute()


def test_the_helper_imports_no_function_of_the_network_or_of_other_programs() -> None:
    """As far as its table of symbols tells."""
    from photon_maps_native import library

    symbols = subprocess.run(
        ["nm", "--dynamic", "--undefined-only", library.load_library()._name],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    names = {line.split()[-1].partition("@")[0] for line in symbols.splitlines()}
    assert "dlopen" in names and "malloc" in names | {name.partition("@")[0] for name in names}
    assert names.isdisjoint(
        {"socket", "connect", "bind", "getaddrinfo", "system", "popen", "execve", "fork", "posix_spawn"}
    )


def test_the_manifest_asks_for_no_permission() -> None:
    assert "permissions" not in tomllib.loads((ROOT / "blender_manifest.toml").read_text())
