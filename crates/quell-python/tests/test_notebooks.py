"""The notebooks of the documentation run anywhere, from the first cell to the last, and their text is true.

The metadata of a cell of text name the code of each number in it, under ``computed``: the number equals the value of that code
to the digits that are written.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import nbformat
import pytest
from conftest import ROOT
from nbclient import NotebookClient

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))

NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:·10⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)?(?![\w.]*[\w])")
YEAR = re.compile(r"\(\d{4}\)")
CODE = re.compile(r"`[^`]*`")

MARK = "numbers of the text: "


def numbers(text: str) -> set[str]:
    """Numbers in a text, without years in brackets and code."""
    return set(NUMBER.findall(CODE.sub("", YEAR.sub("", text))))


def value(written: str) -> tuple[float, float]:
    """The value of a written number, and half of the unit of its last digit."""
    mantissa, _, power = written.partition("·10")
    exponent = int(power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))) if power else 0
    decimals = len(mantissa.partition(".")[2])
    return float(mantissa) * 10.0**exponent, 0.5 * 10.0 ** (exponent - decimals)


def computed(notebook: Any) -> dict[str, str]:
    """The code of each number of the text, by cell and number."""
    return {
        f"{place} {written}": code
        for place, cell in enumerate(notebook.cells)
        for written, code in cell.metadata.get("computed", {}).items()
    }


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) >= 3


def test_numbers_are_found_and_read() -> None:
    assert numbers("at 4.322, of *D* = 3 (2005) and `x[7]`, 2.5·10⁻² and *v*₀ = 1.") == {"4.322", "3", "2.5·10⁻²", "1"}
    assert value("2.5·10⁻²") == (pytest.approx(0.025), pytest.approx(0.0005)) and value("9.90") == (9.9, pytest.approx(0.005))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_anywhere_and_its_text_is_true(path: Path, tmp_path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "clear the outputs before it is kept"
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            assert numbers(cell.source) == set(cell.metadata.get("computed", {})), f"numbers without code in: {cell.source}"
    codes = computed(notebook)
    inside = ", ".join(f"{key!r}: float({code})" for key, code in codes.items())
    notebook.cells.append(nbformat.v4.new_code_cell(f"import json; print({MARK!r} + json.dumps({{{inside}}}))"))
    # In an empty folder: a notebook needs no file next to it.
    NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("image/png" in output.get("data", {}) for output in shown)
    assert not any(output.get("name") == "stderr" for output in shown), shown
    last = notebook.cells[-1].outputs[0]["text"]
    found = json.loads(last.removeprefix(MARK))
    for key, number in found.items():
        written, unit = value(key.partition(" ")[2])
        assert abs(number - written) <= unit * (1 + 1e-9), f"cell {key}: the code gives {number}"
