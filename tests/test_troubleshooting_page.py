# SPDX-License-Identifier: GPL-3.0-or-later
"""The page for troubleshooting has every message that the code can give, and none that it cannot."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from tests.messages_in_code import in_native, in_python, sentences

PAGE = Path(__file__).resolve().parent.parent / "docs" / "troubleshooting.md"
#: Sections whose left column is no message of the code.
OTHERS = {"The picture is not what I expected", "Installing"}


def messages_of_the_page() -> list[str]:
    """Return the left column of the page's tables, in the order of the page."""
    section, found = "", []
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if heading := re.match(r"#+ (.+)", line):
            section = heading[1]
        if line.startswith("| ") and not line.startswith("| message |") and section not in OTHERS:
            found.append(line.split(" | ")[0].removeprefix("| "))
    return found


def test_every_message_has_one_entry():
    said = in_python() | in_native()
    listed = messages_of_the_page()
    assert len(said) > 100
    assert [f"{file}: {message}" for message, file in said.items() if message not in listed] == []
    assert [message for message in listed if message not in said] == []
    assert len(listed) == len(set(listed))


def test_sentences_are_found_in_all_their_forms():
    source = """
TEXT = "is found in the module."
def f(self, messages, node):
    text = "is a " + ("sheet." if node else "block.")
    messages.add(node.name, text)
    self.messages.add(node.name, f"has {len(node)} of {node.name}{node.kind}.", "Advice is none.")
    compiler.name(node, TEXT)
    messages.add(node.name, str(node))
"""
    assert set(sentences(ast.parse(source))) == {
        "is a sheet.",
        "is a block.",
        "has … of ….",
        "is found in the module.",
    }
