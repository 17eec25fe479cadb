# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the chart as markdown, and the sentences that follow from them; brings them into the documents."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from benchmarks.chart.analysis import TARGETS, Crossing, Curve, price, time_to
from benchmarks.chart.errors import Row
from benchmarks.chart.methods import DEFAULT, METHODS
from benchmarks.chart.rivals import FOREMOST, RIVALS
from benchmarks.chart.scenes import SCENES

Table = Sequence[Mapping[str, str]]
#: By scene and method.
Rows = Mapping[str, Mapping[str, Sequence[Row]]]

SUMMARY_ERROR = "2 %"
#: Two measurements of one thing differ by so much; a smaller difference is none.
TELLING = 1.1


def grouped(rows: Sequence[Row]) -> dict[str, dict[str, list[Row]]]:
    """Return rows by scene and method, in the order of the chart."""
    found: dict[str, dict[str, list[Row]]] = {}
    for scene in SCENES:
        for method in (*METHODS, *RIVALS):
            here = sorted((r for r in rows if (r.scene, r.method) == (scene, method)), key=lambda row: row.seconds)
            if here:
                found.setdefault(scene, {})[method] = here
    return found


def curve(rows: Sequence[Row]) -> Curve:
    """Return error against time."""
    return [(row.seconds, row.relmse) for row in rows]


def times_to(rows: Rows, error: float) -> dict[str, dict[str, Crossing | None]]:
    """Return by scene and method when each comes down to an error."""
    return {
        scene: {method: time_to(curve(here), error) for method, here in of_scene.items()}
        for scene, of_scene in rows.items()
    }


def markdown(table: Table) -> str:
    """Return a table as markdown."""
    header = list(dict.fromkeys(name for line in table for name in line))
    lines = [header, ["---"] * len(header), *([line.get(name, "") for name in header] for line in table)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def scenes_table(rows: Rows) -> Table:
    """Return what the scenes are, and where their references come from."""
    table = []
    for name in rows:
        scene = SCENES[name]
        if scene.given:
            made = "other renderers, 256 x 256"
        else:
            kind = "paths" if "integrator" in scene.reference_fields else "photon map"
            made = f"{kind}, 2 x {scene.passes} passes"
        noise = scene.reference().noise
        table.append({"scene": name, "what": scene.what, "reference": made, "its own relMSE": f"{noise:.1e}"})
    return table


def times_table(rows: Rows) -> Table:
    """Return the CPU-seconds to 5 % and 2 % of the default and of what it is compared with."""
    table = []
    for scene, of_scene in rows.items():
        line = {"scene": scene}
        for method in FOREMOST:
            if any(method in of_other for of_other in rows.values()):
                here = of_scene.get(method)
                found = [str(time_to(curve(here), TARGETS[share]) or "–") for share in ("5 %", "2 %")] if here else []
                line[method] = " / ".join(found)
        table.append(line)
    return table


def prices_table(rows: Rows) -> Table:
    """Return for each part of the method and scene its time over the default's to the same error."""
    table = []
    for method in METHODS:
        line = {"part": method}
        for scene, of_scene in rows.items():
            if method not in of_scene or DEFAULT.name not in of_scene:
                continue
            if method == DEFAULT.name:
                line[scene] = str(time_to(curve(of_scene[method]), TARGETS[SUMMARY_ERROR]) or "–") + " s"
            else:
                line[scene] = str(price(curve(of_scene[method]), curve(of_scene[DEFAULT.name])))
        if len(line) > 1:
            table.append(line)
    return table


def scene_table(of_scene: Mapping[str, Sequence[Row]]) -> Table:
    """Return the last picture of every method of a scene in all figures."""
    table = []
    for method, here in of_scene.items():
        last = here[-1]
        table.append(
            {
                "method": method,
                "samples": f"{last.samples:,}",
                "CPU s": f"{last.seconds:.1f}",
                "relMSE": f"{last.relmse:.1e}",
                "of all pixels": f"{last.relmse_unclipped:.1e}",
                "bias": f"{100 * last.bias:+.2f} %",
                "worst block": f"{100 * last.worst_block:.1f} %",
                "FLIP": f"{last.flip:.4f}",
            }
        )
    return table


def where_others_lead(rows: Rows) -> str:
    """Return in a sentence or two in which scenes another engine comes to the same error sooner."""
    behind, ahead, untold, sooner = [], [], [], []
    for scene, of_scene in rows.items():
        default = of_scene.get(DEFAULT.name)
        others = {name: here for name, here in of_scene.items() if name in RIVALS}
        if default is None or not others:
            continue
        # What both come to; to an error that only one reaches there is no ratio. Where the default was there from its
        # first picture on, the ratio is one at least, and does not tell who is nearest.
        prices = {name: price(curve(here), curve(default)) for name, here in others.items()}
        ratios = {name: found.ratio for name, found in prices.items() if found.sign != ">"}
        ratios = ratios or {name: found.ratio for name, found in prices.items()}
        best = min(ratios, key=lambda name: ratios[name])
        entry = (scene, best, ratios[best])
        (behind if ratios[best] < 1 / TELLING else ahead if ratios[best] > TELLING else untold).append(entry)
        if ratios[best] >= 1 / TELLING:
            sooner += [(scene, *lead) for lead in leads(default, others)]
    sentences = []
    if behind:
        named = ", ".join(f"{scene} ({name}, {1 / ratio:.1f} times)" for scene, name, ratio in behind)
        sentences.append(f"Another engine is faster to the same error in {len(behind)} of the scenes: {named}.")
    if untold:
        sentences.append(f"No difference can be told in {', '.join(scene for scene, _, _ in untold)}.")
    if ahead:
        ratios = sorted(ratio for _, _, ratio in ahead)
        span = f"{ratios[0]:.2g} to {ratios[-1]:.2g}" if len(ratios) > 1 else f"{ratios[0]:.2g}"
        scenes = ", ".join(scene for scene, _, _ in ahead)
        sentences.append(f"In {scenes} the photon map is the faster, by {span} times.")
    if sooner:
        named = ", ".join(f"{scene} ({name}, {ratio:.1f} times)" for scene, name, ratio in sooner)
        sentences.append(f"On the way there, at {SUMMARY_ERROR}, another engine is still ahead in {named}.")
    return " ".join(sentences)


def leads(default: Sequence[Row], others: Mapping[str, Sequence[Row]]) -> Iterator[tuple[str, float]]:
    """Yield the engines that come to the summary's error sooner than the default method, and how many times."""
    ours = time_to(curve(default), TARGETS[SUMMARY_ERROR])
    for name, here in others.items():
        theirs = time_to(curve(here), TARGETS[SUMMARY_ERROR])
        if ours and theirs and theirs.seconds * TELLING < ours.seconds:
            yield name, ours.seconds / theirs.seconds


def left_out(rows: Rows, failures: Sequence[str]) -> str:
    """Return as a list what is not in the chart, and why."""
    missing = [rival for rival in RIVALS.values() if rival.version() is None]
    lines = []
    for rival in missing:
        needed = rival.package + (" or LLVM 19" if rival.has_llvm else "")
        lines.append(f"- {rival.name}: {needed} is not installed; `make chart PEERS=1` brings it.")
    lines += [f"- {failure}" for failure in failures]
    rendered = {m: [s for s, of_scene in rows.items() if m in of_scene] for m in RIVALS}
    lines += [f"- {m}: {', '.join(s)} only." for m, s in rendered.items() if s and len(s) < len(rows)]
    return "\n".join(lines) + "\n" if lines else "Nothing.\n"


def sections(rows: Rows, failures: Sequence[str], parts: Mapping[str, Table]) -> dict[str, str]:
    """Return everything by the names that the documents have for it."""
    found = {
        "scenes": markdown(scenes_table(rows)),
        "times": markdown(times_table(rows)),
        "prices": markdown(prices_table(rows)),
        "leaders": where_others_lead(rows) + "\n",
        "left out": left_out(rows, failures),
        "figures": "\n".join(_figure(scene, of_scene) for scene, of_scene in rows.items()),
    }
    return found | {name: markdown(table) for name, table in parts.items() if table}


def _figure(scene: str, of_scene: Mapping[str, Sequence[Row]]) -> str:
    return f"### {scene}\n\n![{SCENES[scene].what}](images/chart_{scene}.png)\n\n{markdown(scene_table(of_scene))}"


def write(path: Path, found: Mapping[str, str]) -> None:
    """Write everything in one file."""
    path.write_text("\n".join(f"## {name}\n\n{text}" for name, text in found.items()))


def bring_into(document: Path, found: Mapping[str, str], subject: str = "chart") -> None:
    """Replace what stands between `<!-- subject: name -->` and `<!-- subject end -->`, for every name that was
    measured."""

    def replaced(match: re.Match[str]) -> str:
        name = match[1]
        return f"<!-- {subject}: {name} -->\n{found[name]}<!-- {subject} end -->" if name in found else match[0]

    pattern = rf"<!-- {subject}: ([\w ]+) -->\n.*?<!-- {subject} end -->"
    document.write_text(re.sub(pattern, replaced, document.read_text(), flags=re.DOTALL))


def bring_pictures(folder: Path, images: Path) -> None:
    """Copy the figures of scenes and methods to where the documents have them."""
    for path in sorted([*folder.glob("chart_*.png"), *folder.glob("method_*.png")]):
        shutil.copyfile(path, images / path.name)


def progress(rows: Sequence[Row]) -> str:
    """Return in a few words where methods have come to."""
    last = max(rows, key=lambda row: row.seconds)
    return f"relMSE {last.relmse:.1e} after {last.seconds:.0f} CPU-seconds"
