"""What is open: a View of each path, with the Python package that the add-on carries."""

import os

import bpy

try:
    from .pentimento import Error, View
except ModuleNotFoundError:  # used from where it is written, without the zip
    from pentimento import Error, View

#: What reading and slicing raise for what is wrong outside; Blender's texts are UTF-8, paths may
#: have any bytes.
FAILURES = (Error, OSError, IndexError, UnicodeError)

_open = {}


def _absolute(path):
    return os.path.abspath(bpy.path.abspath(path))


def view_of(path):
    """The View of a path as Blender has it, "//" and all; read once. Those that no object has any
    more are closed when another is opened."""
    absolute = _absolute(path)
    if absolute not in _open:
        used = {_absolute(thing.pentimento.path) for thing in bpy.data.objects}
        for other in set(_open) - used:
            del _open[other]
        _open[absolute] = View(absolute)
    return _open[absolute]


def forget(path=None):
    """The next view_of() reads anew: this path, or all."""
    if path is None:
        _open.clear()
    else:
        _open.pop(_absolute(path), None)


def one_line(error):
    """What an error says, as reports and panels have it."""
    return " ".join(str(error).split())
