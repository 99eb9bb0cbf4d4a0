"""Scenes of Python as TOML."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def dumps(tables: Mapping[str, Any]) -> str:
    """A mapping of tables, and lists of tables, as the text of a TOML file.

    Raises a TypeError for what TOML does not have.
    """
    lines: list[str] = []
    for name, value in tables.items():
        if isinstance(value, Mapping):
            lines += [f"[{_key(name)}]", *_entries(name, value), ""]
        elif isinstance(value, (list, tuple)) and all(isinstance(v, Mapping) for v in value):
            for table in value:
                lines += [f"[[{_key(name)}]]", *_entries(name, table), ""]
        else:
            kind = type(value).__name__
            raise TypeError(f"{name}: found {kind}; expected a table or a list of them")
    return "\n".join(lines)


def _entries(where: str, table: Mapping[str, Any]) -> list[str]:
    return [f"{_key(key)} = {value_text(f'{where}.{key}', value)}" for key, value in table.items()]


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise TypeError(f"the key {key!r}: expected text")
    return key if _BARE.fullmatch(key) else _text(key)


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def value_text(where: str, value: Any) -> str:
    """A value as it stands behind its key. Raises a TypeError for what TOML does not have."""
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, (str, os.PathLike)):
        return _text(os.fspath(value))
    if isinstance(value, Mapping):
        return "{ " + ", ".join(_entries(where, value)) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(where, part) for part in value) + "]"
    kind = type(value).__name__
    raise TypeError(f"{where}: found {kind}; expected a number, text, a list or a table")
