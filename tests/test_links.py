# SPDX-License-Identifier: GPL-3.0-or-later
"""Links among the pages lead somewhere, also where they are read without the site: files, pictures and headings."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"^(?: {4}|\t).*$|`[^`\n]*`", re.MULTILINE)
MOST_BYTES = 1_000_000  #: of a picture


def links(text: str) -> list[str]:
    """Return where the links of a page lead, code left out; a text may go on in the next line."""
    return LINK.findall(CODE.sub("", text))


def anchors(text: str) -> set[str]:
    """Return the names of a page's headings, as GitHub and the site make them."""
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    kept = [re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()) for heading in headings]
    return {re.sub(r" +", "-", heading.strip()) for heading in kept}


def faults(page: Path) -> list[str]:
    """Return the links of a page that lead nowhere, or out of the folder that becomes the site."""
    found = []
    for link in links(page.read_text(encoding="utf-8")):
        if re.match(r"[a-z]+:", link):
            continue
        name, _, anchor = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        is_inside = page.parent == ROOT or target.is_relative_to(ROOT / "docs")
        if (
            not target.is_file()
            or not is_inside
            or (anchor and anchor not in anchors(target.read_text(encoding="utf-8")))
        ):
            found.append(link)
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(page):
    assert faults(page) == []


def test_faults_are_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A name\n[a](page.md#a-name) [b](page.md#another) ![c](none.png) `[d](none)`\n\n    [e](none)\n")
    assert faults(page) == ["page.md#a-name", "page.md#another", "none.png"]  # the first is outside docs


def test_the_site_has_every_page():
    listed = re.findall(r": (\S+\.md)$", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(listed) == sorted(page.relative_to(ROOT / "docs").as_posix() for page in PAGES if page.parent != ROOT)


def test_pictures_are_small_and_shown():
    pictures = {path for path in (ROOT / "docs" / "images").rglob("*") if path.is_file()}
    texts = [(page.parent, page.read_text(encoding="utf-8")) for page in PAGES]
    shown = {(folder / link).resolve() for folder, text in texts for link in links(text)}
    assert pictures <= shown
    assert [path.name for path in pictures if path.stat().st_size > MOST_BYTES] == []
