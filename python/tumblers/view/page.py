"""A run as one page that needs nothing else: its numbers, its script, and the library that draws it."""

from __future__ import annotations

import json
import re
from base64 import b64encode
from html import escape
from importlib.resources import files

import xarray as xr

from .content import page_content

__all__ = ["view_page"]

_LIBRARY = {"three": "three.module.js", "three/OrbitControls": "OrbitControls.js"}


def view_page(run: xr.Dataset) -> str:
    """Return the interactive 3-D page of a run, complete in itself.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`, or a file that it was saved to.

    Returns
    -------
    str
        HTML with its script and three.js inside: it asks nothing of the network, and its policy forbids it to.

    Raises
    ------
    InputError
        Something else than a run.
    """
    content = page_content(run)
    folder = files(__package__)
    imports = {name: _module((folder / "three" / file).read_bytes()) for name, file in _LIBRARY.items()}
    parts = {
        "title": escape(str(content["title"])),
        "style": (folder / "view.css").read_text(encoding="utf-8"),
        "imports": json.dumps({"imports": imports}),
        # A script ends at the first "</".
        "content": json.dumps(content, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        "script": (folder / "view.js").read_text(encoding="utf-8"),
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda mark: parts[mark[1]], (folder / "view.html").read_text(encoding="utf-8"))


def _module(code: bytes) -> str:
    return "data:text/javascript;base64," + b64encode(code).decode("ascii")
