"""The pages for people: links lead somewhere, files that they name exist, paragraphs stay short."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from doc_examples import ROOT

PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")] + sorted(
    (ROOT / "docs").glob("*.md")
)
LINK = re.compile(r"\]\((?!https?:)([^)#]*)(#[^)]*)?\)")
NAMED = re.compile(r"`((?:harness|solver|synth|scenes|tests|docs)/[\w./-]+)`")
EXAMPLES = {"harness/src/report/left.rs"}
"""Files of the worked examples, which were thrown away."""
CRATES = {"harness/bench", "solver/formats", "solver/kernels"}
"""Crates that are being cut out; with them goes this line."""


def prose(text: str) -> list[str]:
    """Paragraphs and list items, without code and tables."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    blocks = [block for block in re.split(r"\n\s*\n|\n(?=- |\d+\. )", text) if block.strip()]
    return [" ".join(line for line in block.split("\n") if not line.startswith("|")) for block in blocks]


def anchor(heading: str) -> str:
    """A heading's anchor, as Markdown viewers make it."""
    return "#" + re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere_and_named_files_exist(page: Path) -> None:
    text = page.read_text()
    for target, place in LINK.findall(text):
        file = page.parent / target if target else page
        assert file.exists(), target
        if place:
            headings = re.findall(r"^#+ (.*)$", file.read_text(), re.MULTILINE)
            assert place in map(anchor, headings), f"{target}{place}"
    missing = {name for name in NAMED.findall(text) if not (ROOT / name).exists()} - EXAMPLES - CRATES
    assert not missing


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_paragraph_is_longer_than_five_lines(page: Path) -> None:
    """Of 120 columns."""
    long = [block[:60] for block in prose(page.read_text()) if len(block) > 5 * 120]
    assert not long


def test_the_readme_fits_on_two_screens() -> None:
    lines = (ROOT / "README.md").read_text().split("\n")
    assert sum(max(1, -(-len(line) // 120)) for line in lines) <= 120
