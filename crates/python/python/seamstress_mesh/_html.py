"""Reports as small tables with pictures, for notebooks."""

from __future__ import annotations

import base64
import html
from typing import Any


def figure(value: Any) -> str:
    """A number with four digits."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def page(title: str, figures: dict[str, Any], pictures: list[bytes]) -> str:
    """A title, a table of figures and pictures beside each other."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th><td>{html.escape(str(value))}</td></tr>"
        for name, value in figures.items()
        if value is not None
    )
    images = "".join(
        f"<img style='height:16em' src='data:image/png;base64,{base64.b64encode(picture).decode()}'>"
        for picture in pictures
    )
    return (
        f"<div><b>{html.escape(title)}</b>"
        f"<div style='display:flex;align-items:center;gap:1em'><table>{rows}</table>{images}</div></div>"
    )
