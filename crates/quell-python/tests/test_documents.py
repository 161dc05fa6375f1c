"""The code in the documents runs."""

from __future__ import annotations

import ast
import re
import textwrap
from pathlib import Path

import pytest
from conftest import ROOT

import quell

READMES = [ROOT / "README.md", Path(__file__).parents[1] / "README.md"]


def blocks(text: str) -> list[str]:
    """Python code of a Markdown text."""
    return re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)


@pytest.mark.parametrize("path", READMES, ids=["project", "package"])
def test_the_code_of_a_readme_runs(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = blocks(path.read_text(encoding="utf-8"))
    assert len(found) == 1
    exec(compile(found[0], str(path), "exec"), {})
    assert "0.2" in capsys.readouterr().out


def test_the_code_of_the_package_s_docstring_runs() -> None:
    code = (quell.__doc__ or "").split("::\n", 1)[1].split("\nStudies are made", 1)[0]
    exec(compile(textwrap.dedent(code), "quell.__doc__", "exec"), {})


def test_every_public_name_says_what_it_is() -> None:
    for module in (quell, quell.results):
        for name in module.__all__:
            it = getattr(module, name)
            if isinstance(it, str) or not callable(it):
                continue
            assert it.__doc__, name
            for member, value in vars(it).items() if isinstance(it, type) else ():
                if not member.startswith("_") and callable(value):
                    assert value.__doc__, f"{name}.{member}"


def test_every_fact_of_a_result_says_what_it_is() -> None:
    folder = Path(quell.results.__file__ or "").parent
    files = [folder.parent / "_result.py", *folder.glob("*.py")]
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in files]
    classes = [node for tree in trees for node in tree.body if isinstance(node, ast.ClassDef)]
    facts = 0
    for it in classes:
        for node, behind in zip(it.body, [*it.body[1:], None], strict=True):
            # The status of a quantity of a map is documented once for all.
            if isinstance(node, ast.AnnAssign) and not ast.unparse(node.target).endswith("_status"):
                facts += 1
                documented = isinstance(behind, ast.Expr) and isinstance(behind.value, ast.Constant)
                assert documented, f"{it.name}.{ast.unparse(node.target)}"
    # Result alone has three.
    assert facts > 130


def test_the_example_for_a_cluster_calls_what_there_is() -> None:
    tree = ast.parse((ROOT / "docs" / "dask-jobqueue.py").read_text(encoding="utf-8"))
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    sweep = next(node for node in calls if ast.unparse(node.func) == "quell.sweep")
    arguments = {keyword.arg for keyword in sweep.keywords}
    parameters = set(quell.Study.map.__annotations__)
    assert arguments <= parameters and len(sweep.args) == 2
