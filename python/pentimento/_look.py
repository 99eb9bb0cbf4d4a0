"""How things show themselves in notebooks."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING

from .errors import Error

if TYPE_CHECKING:
    from .mesh import Mesh
    from .run import Run

_SIZE = (480, 320)  # of a picture


def picture_of(what: Mesh | Run, *, sheet: bool = False) -> bytes | None:
    """A small picture; None where none can be made."""
    from .render import render

    try:
        return render(what, size=_SIZE, sheet=sheet).png
    except Error:
        return None


def html_picture(png: bytes | None) -> str:
    """A picture within a page; nothing for None."""
    if png is None:
        return ""
    return f'<img src="data:image/png;base64,{base64.b64encode(png).decode()}"/>'
