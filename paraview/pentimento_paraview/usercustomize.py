"""Gives Python what ParaView 5.11 of Debian 12 asks for before it loads a plug-in in Python.

In the folder that `python3 -m site --user-site` names, Python does this by itself at its start.
"""

import collections
import inspect

if not hasattr(inspect, "getargspec"):  # gone with Python 3.11
    _ArgSpec = collections.namedtuple("ArgSpec", "args varargs keywords defaults")

    def _getargspec(function):
        return _ArgSpec(*inspect.getfullargspec(function)[:4])

    inspect.getargspec = _getargspec
