"""Every block of Python in the book runs."""

import re
from pathlib import Path

import pytest

BOOK = Path(__file__).parents[3] / "docs" / "book" / "src"
FENCED = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
BLOCKS = [
    pytest.param(block, id=f"{page.stem}-{number}")
    for page in sorted(BOOK.rglob("*.md"))
    for number, block in enumerate(FENCED.findall(page.read_text("utf-8")))
]


def test_the_book_has_python():
    assert BLOCKS


@pytest.mark.parametrize("block", BLOCKS)
def test_blocks_run(block):
    exec(compile(block, "the book", "exec"), {})
