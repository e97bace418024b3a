"""How results show themselves in a notebook."""

from __future__ import annotations

import html
from collections.abc import Iterable
from typing import Any

# Height of a page in a notebook, pixels.
HEIGHT = 720


def page(report: str) -> str:
    """A whole report, in a frame of its own: its scripts and colours stay there."""
    return (
        f'<iframe srcdoc="{html.escape(report)}" sandbox="allow-scripts allow-downloads" title="Frikan report" '
        f'style="width:100%;height:{HEIGHT}px;border:1px solid #8884"></iframe>'
    )


def table(header: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """A table."""
    head = "".join(f"<th>{html.escape(name)}</th>" for name in header)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
