"""The version of the installed package."""

from __future__ import annotations

from importlib import metadata

try:
    __version__ = metadata.version("pentimento")
except metadata.PackageNotFoundError:
    __version__ = "0+source"  # used from where it is written, without being installed
