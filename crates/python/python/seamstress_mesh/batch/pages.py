"""The manifest as pages with thumbnails."""

from __future__ import annotations

import html
import os
from itertools import islice
from pathlib import Path
from typing import Any
from urllib.parse import quote

from .export import FIGURES
from .manifest import Manifest

#: Meshes on a page.
ROWS = 500
STYLE = """
body { font: 14px system-ui, sans-serif; margin: 1.5em; color-scheme: light dark }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(15em, 1fr)); gap: 1em }
article { border: 1px solid #8886; border-radius: 6px; padding: .6em; overflow-wrap: anywhere }
article img { width: 100%; aspect-ratio: 1; object-fit: contain }
.not-ok { border-color: #d60 } small { opacity: .75 } p { margin: .3em 0 }
"""


def write(manifest: Manifest, job: str, folder: Path, title: str) -> Path:
    """Writes ``index.html``, and further pages where there are many meshes."""
    rows = manifest.rows(job)
    counts = manifest.counts(job)
    n_pages = max(1, -(-sum(counts.values()) // ROWS))
    heading = f"{html.escape(title)}: " + ", ".join(f"{n} {status}" for status, n in counts.items())
    for number in range(n_pages):
        articles = "".join(_article(row, folder) for row in islice(rows, ROWS))
        links = " ".join(f"<a href='{_name(k)}'>{k + 1}</a>" for k in range(n_pages)) if n_pages > 1 else ""
        page = (
            f"<!doctype html><meta charset='utf-8'><title>{html.escape(title)}</title><style>{STYLE}</style>"
            f"<h1>{heading}</h1><nav>{links}</nav><main>{articles}</main>"
        )
        temporary = folder / f".{_name(number)}"
        temporary.write_text(page, encoding="utf-8")
        os.replace(temporary, folder / _name(number))
    return folder / _name(0)


def _name(number: int) -> str:
    return f"index-{number + 1}.html" if number else "index.html"


def _article(row: dict[str, Any], folder: Path) -> str:
    is_ok = row["status"] == "ok"
    picture = f"pictures/{row['name']}.png"
    image = ""
    if is_ok and (folder / picture).exists():
        image = f"<img loading='lazy' alt='' src='{quote(picture)}'>"
    name = html.escape(row["name"])
    linked = f"<a href='{quote(row['output'])}'>{name}</a>" if row["output"] else name
    values = ((label, row["metrics"].get(key)) for label, key in FIGURES.items())
    known = [f"{label} {value:.4g}" if isinstance(value, float) else f"{label} {value}" for label, value in values if value is not None]
    cost = f"{row['seconds']:.1f} s" + (f", {row['memory_bytes'] / 1e6:.0f} MB" if row["memory_bytes"] else "")
    said = "" if is_ok else f"<p>{html.escape(row['status'])}: {html.escape(row['code'] or '')}</p><small>{html.escape((row['message'] or '')[:300])}</small>"
    figures = html.escape(", ".join(known))
    return (
        f"<article class='{'ok' if is_ok else 'not-ok'}'>{image}<p><b>{linked}</b></p><p>{figures}</p>{said}"
        f"<p><small>{cost}</small></p></article>"
    )
