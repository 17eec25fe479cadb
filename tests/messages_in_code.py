# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds every sentence that the extension can say, by reading its sources; what is filled in when it runs is "…"."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FILLED_IN = "…"
#: Which argument of a call or an exception is the sentence, by the name of what is called.
SENTENCES = {
    "add": 1,  # Messages.add(object, text)
    "name": 1,  # Compiler.name(node, text)
    "report": 1,  # Operator.report(kind, text)
    "fail": 0,
    "_fail": 1,
    "poll_message_set": 0,
    "CaptureError": 0,
    "ChartError": 0,
    "NativeError": 1,
}
#: Modules whose every sentence is said: why there is no map, and why an object received nothing.
SPOKEN = {"engine/map_choice.py", "engine/received.py"}
#: Exceptions of the helper whose words come to the user; those about arrays say what the export did wrong.
NATIVE = re.compile(
    r'(?:throw (?:EmbreeError|LibraryError|std::length_error)\(|fail\(PM_OUT_OF_MEMORY, )(?:std::string\()?"([^"]+)"'
)


def in_python() -> dict[str, str]:
    """Return the sentences of the Python sources, each with the file that says it."""
    folders = ("engine", "operators", "ui")
    paths = [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]
    found = {}
    for path in paths:
        name = path.relative_to(ROOT).as_posix()
        if "/tests/" in name:
            continue
        module = ast.parse(path.read_text(encoding="utf-8"))
        said = [*sentences(module), *(_spoken(module) if name in SPOKEN else ())]
        found.update({sentence: name for sentence in said if " " in sentence.replace(FILLED_IN, "").strip()})
    return found


def in_native() -> dict[str, str]:
    """Return how the helper's sentences begin, each with its file."""
    sources = sorted((ROOT / "engine/native/src").glob("*.[ch]*"))
    return {
        f"{match}{FILLED_IN}" if match[-1] == " " else match: path.relative_to(ROOT).as_posix()
        for path in sources
        for match in NATIVE.findall(path.read_text(encoding="utf-8"))
    }


def sentences(module: ast.Module) -> Iterator[str]:
    """Yield what the calls of SENTENCES are given in a module."""
    scopes = [module, *(node for node in ast.walk(module) if isinstance(node, ast.FunctionDef))]
    for call in (node for node in ast.walk(module) if isinstance(node, ast.Call)):
        name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
        place = SENTENCES.get(name)
        if place is not None and len(call.args) > place:
            around = [scope for scope in scopes if scope is module or scope.lineno <= call.lineno <= scope.end_lineno]
            yield from _alternatives(call.args[place], around[::-1])


def _alternatives(expression: ast.expr, scopes: list) -> list[str]:
    """Return what a string can be; nothing where that is not said here.

    :param scopes: functions around it, the innermost first, and the module.
    """
    match expression:
        case ast.Constant(value=str(text)):
            return [text]
        case ast.JoinedStr(values=parts):
            return [_joined(text) for text in _products([_part(part) for part in parts])]
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _products([_alternatives(left, scopes), _alternatives(right, scopes)])
        case ast.IfExp(body=body, orelse=orelse):
            return _alternatives(body, scopes) + _alternatives(orelse, scopes)
        case ast.Name(id=name):
            return _assigned(name, scopes)
    return []


def _part(part: ast.expr) -> list[str]:
    return [part.value] if isinstance(part, ast.Constant) else [FILLED_IN]


def _joined(text: str) -> str:
    return re.sub(f"{FILLED_IN}+", FILLED_IN, text)


def _products(choices: list[list[str]]) -> list[str]:
    texts = [""]
    for choice in choices:
        texts = [text + more for text in texts for more in choice]
    return texts


def _assigned(name: str, scopes: list) -> list[str]:
    for number, scope in enumerate(scopes):
        values = [
            node.value
            for node in ast.walk(scope)
            if isinstance(node, ast.Assign) and any(getattr(target, "id", "") == name for target in node.targets)
        ]
        if values:
            return [text for value in values for text in _alternatives(value, scopes[number:])]
    return []


def _spoken(module: ast.Module) -> Iterator[str]:
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef)
    docstrings = {ast.get_docstring(node, clean=False) for node in ast.walk(module) if isinstance(node, documented)}
    for node in ast.walk(module):
        text = node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""
        if text.endswith(".") and text[0].isupper() and text not in docstrings:
            yield text
