"""The study as files: numbers as JSON, tables as CSV, pictures as PNG, and one page of them all."""

import base64
import csv
import html
import io
import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from viscotack import save_figure

from ..whole import write_whole
from .figures import figures
from .sheet import Sheet
from .sheets import sheets
from .study import Study

# Longer tables are a file only.
_MOST_ROWS = 80
# Entries outside the thesis's spread that are named; rows of another make have many.
_MOST_NAMED = 4

_CAPTIONS = {
    "splits": "Typical error of each model by what is new to it; dotted without the descriptor.",
    "modulus_ratios": "Typical error on a modulus ratio that the model has not seen.",
    "predicted": "Predicted against simulated, rows not learned from (Fig. A.4 and A.5).",
    "bands": "A band of one input held out.",
    "learning": "Learning curves: rounds (Fig. A.8), trees (Fig. A.9), rows.",
    "architectures": "Layers and activation of the network (Fig. 5.12).",
    "extrapolation": "Beyond the rows (Fig. 5.5), mu = 3.24, preload 73 h0.",
    "importance": "Permutation importance.",
    "dependence": "Partial dependence of the force.",
    "trajectories": "Retractions that were not learned (Fig. 5.13).",
}


def write_study(study: Study, folder: str | os.PathLike[str], *, source: str) -> list[Path]:
    """Write the files of a study and return their paths.

    Parameters
    ----------
    folder : path
        Made if missing: ``numbers.json`` (without times: the same bytes for the same study),
        ``times.json``, ``tables/*.csv``, ``figures/*.png`` and ``report.html``, which needs none
        of the others.
    source : str
        What the page says the rows come from.
    """
    folder = Path(folder)
    for room in ("tables", "figures"):
        (folder / room).mkdir(parents=True, exist_ok=True)
    written = [folder / "numbers.json", folder / "times.json"]
    for path, content in zip(written, (study.numbers, study.times), strict=True):
        write_whole(path, json.dumps(content, indent=1, allow_nan=False) + "\n")
    read = sheets(study)
    for sheet in read:
        written.append(folder / "tables" / f"{sheet.name}.csv")
        table = io.StringIO()
        lines = csv.writer(table, lineterminator="\n")
        lines.writerow(sheet.columns)
        lines.writerows(sheet.rows)
        write_whole(written[-1], table.getvalue())
    pictures = {}
    for name, figure in figures(study.numbers).items():
        pictures[name] = folder / "figures" / f"{name}.png"
        save_figure(figure, pictures[name])
    written += [*pictures.values(), folder / "report.html"]
    write_whole(written[-1], _page(study, read, pictures, source))
    return written


def summary(numbers: dict[str, Any]) -> list[str]:
    """Return what the study found, a sentence each."""
    entries = numbers["tables"]["entries"]
    judged = [e for e in entries if e["thesis"]]
    within = [e["thesis"]["mse_within_spread"] and e["thesis"]["r2_within_spread"] for e in judged]
    said = [
        f"{sum(within)} of {len(judged)} entries of Tables 5.1 to 5.4 are within the spread that "
        "the thesis states for them."
    ]
    outside = [
        f"{e['model']} in Table {e['table']} (MSE {e['mse_1e-3']:.4f}e-3 +- "
        f"{e['mse_spread_1e-3']:.4f}e-3 against {e['thesis']['mse_1e-3']:.4f}e-3 +- "
        f"{e['thesis']['mse_spread_1e-3']:.4f}e-3)"
        for e, good in zip(judged, within, strict=True)
        if not good
    ]
    if 0 < len(outside) <= _MOST_NAMED:
        said.append(f"Outside: {'; '.join(outside)}.")
    falls = {
        r["split"]: r
        for r in reversed(numbers["tables"]["reductions"])
        if (r["target"], r["descriptor"]) == ("force", "as published")
    }
    repeated = numbers["repeated"]["reduction_best_over_best"]
    said.append(
        "The descriptor lowers the error of the force by "
        f"{100 * falls['random rows']['best_over_best']:.1f} % on random rows, best over best "
        f"without the network (the thesis: {100 * numbers['tables']['reduction_published']:.1f} "
        f"%), {100 * min(repeated):.0f} to {100 * max(repeated):.0f} % over "
        f"{len(repeated)} draws of the folds; with the network among the models by "
        f"{100 * falls['random rows']['best_over_best_with_network']:.1f} %."
    )
    new = [e for e in entries if e["target"] == "force" and "a new k" in e["splits"]]
    for descriptor in ("none", "as published"):
        some = [
            e for e in new if e["descriptor"] == descriptor and e["model"] != "Linear Regression"
        ]
        words = ", ".join(f"{e['model']} {e['splits']['a new k']['r2']:.2f}" for e in some)
        if some:
            said.append(
                f"R2 of the force on a new modulus ratio, descriptor {descriptor}: {words}."
            )
    for which, floor in numbers["noise"].items():
        if floor["floor_mse_1e-3"] is not None:
            said.append(
                f"Repeated inputs set a floor of {floor['floor_mse_1e-3']:.4f}e-3 for the {which} "
                f"(R2 {floor['floor_r2']:.5f}); they differ by {100 * floor['spread_median']:.2f} "
                f"% in the middle and {100 * floor['spread_worst']:.0f} % at worst."
            )
    if "absent" in numbers["trajectories"]:
        said.append(f"Trajectories: {numbers['trajectories']['absent']}.")
    if numbers["settings"]["quick"]:
        said.insert(0, "A quick run of small models: its numbers mean nothing.")
    return said


def _page(study: Study, read: list[Sheet], pictures: dict[str, Path], source: str) -> str:
    said = "".join(f"<li>{html.escape(line)}</li>" for line in summary(study.numbers))
    drawn = "".join(_picture(path, _CAPTIONS[name]) for name, path in pictures.items())
    tables = "".join(_table(sheet) for sheet in read)
    rows = study.numbers["data"]["rows"]
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8"><title>Learning study</title>'
        f"<style>{_STYLE}</style><h1>What learned models of detachment are worth</h1>"
        f"<p>{rows} rows of {html.escape(source)}, seed {study.numbers['settings']['seed']}. "
        "After Maghami, PhD thesis (2025), chapter 5. Every mean square error is of a log10.</p>"
        f"<ul>{said}</ul>{drawn}{tables}</html>\n"
    )


def _picture(path: Path, caption: str) -> str:
    content = base64.b64encode(path.read_bytes()).decode()
    words = html.escape(caption)
    return (
        f'<figure><img alt="{words}" src="data:image/png;base64,{content}">'
        f"<figcaption>{words}</figcaption></figure>"
    )


def _table(sheet: Sheet) -> str:
    title = f"<h2>{html.escape(sheet.title)}</h2><p>{html.escape(sheet.note)}</p>"
    if len(sheet.rows) > _MOST_ROWS:
        return f"{title}<p>{len(sheet.rows)} rows in tables/{sheet.name}.csv.</p>"
    head = _cells("th", sheet.columns)
    return f"{title}<div><table>{head}{''.join(_cells('td', r) for r in sheet.rows)}</table></div>"


def _cells(tag: str, values: Iterable[Any]) -> str:
    return f"<tr>{''.join(f'<{tag}>{html.escape(_word(v))}</{tag}>' for v in values)}</tr>"


def _word(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.5g}" if isinstance(value, float) else str(value)


_STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 75rem; margin: 2rem auto; padding: 0 1rem; }
h2 { margin: 2rem 0 0.2rem; font-size: 1.15rem; }
div { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { border: 1px solid #ccc; padding: 0.2rem 0.5rem; text-align: right; }
th { background: #f3f3f3; }
img { max-width: 100%; }
figcaption { color: #444; font-size: 0.9rem; }
"""
