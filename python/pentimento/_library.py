"""The C interface of libpent_plugin.so: its structures, functions and errors."""

from __future__ import annotations

import ctypes
import functools
import os
import weakref
from collections.abc import Callable
from ctypes import POINTER, c_char_p, c_double, c_int, c_int32, c_int64, c_void_p
from ctypes import c_uint32, c_uint64
from pathlib import Path
from typing import Any

from .errors import Error

VERSION = 2  #: Of pent_plugin.h.


class MeshArrays(ctypes.Structure):
    """`pent_mesh`."""

    _fields_ = [
        ("positions", c_void_p),
        ("vertices", c_int64),
        ("cells", c_void_p),
        ("cell_count", c_int64),
        ("regions", c_void_p),
        ("columns", c_void_p),
        ("layers", c_void_p),
        ("parents", c_void_p),
        ("fibers", c_void_p),
    ]


class MeshInfo(ctypes.Structure):
    """`pent_mesh_info`."""

    _fields_ = [
        ("dimension", c_int32),
        ("arrays", MeshArrays),
        ("hypervolume", c_double),
        ("created_by", c_char_p),
        ("crc32c", c_uint32),
    ]


class FrameInfo(ctypes.Structure):
    """`pent_frame_info`."""

    _fields_ = [
        ("dimension", c_int32),
        ("vertices", c_int64),
        ("positions", c_void_p),
        ("velocities", c_void_p),
        ("contact_forces", c_void_p),
        ("field_count", c_int64),
        ("mesh_name", c_char_p),
        ("mesh_crc32c", c_uint32),
        ("frame", c_uint64),
        ("step", c_uint64),
        ("time", c_double),
    ]


class Field(ctypes.Structure):
    """`pent_field`."""

    _fields_ = [("name", c_char_p), ("values", c_void_p), ("rows", c_int32)]


class MeshExtras(ctypes.Structure):
    """`pent_mesh_extras`."""

    _fields_ = [
        ("vertex_fields", POINTER(Field)),
        ("vertex_field_count", c_int64),
        ("cell_fields", POINTER(Field)),
        ("cell_field_count", c_int64),
        ("facets", c_void_p),
        ("facet_count", c_int64),
        ("labels", c_void_p),
        ("base_labels", c_void_p),
        ("bisection_tags", c_void_p),
    ]


class StepReport(ctypes.Structure):
    """`pent_step_report`."""

    _fields_ = [
        ("step", c_uint64),
        ("time", c_double),
        ("seconds", c_double),
        ("substeps", c_int32),
        ("refused", c_int32),
        ("newton_iterations", c_int32),
        ("iterations", c_int32),
        ("residual", c_double),
        ("unknowns", c_int64),
        ("inverted", c_int64),
        ("asleep", c_int64),
        ("point_facet", c_int64),
        ("mixed", c_int64),
        ("obstacle", c_int64),
        ("deepest", c_double),
        ("smallest_distance", c_double),
    ]


class Energy(ctypes.Structure):
    """`pent_energy`."""

    _fields_ = [("name", c_char_p), ("energy", c_double), ("is_stored", c_int32)]


class Contact(ctypes.Structure):
    """`pent_contact`."""

    _fields_ = [
        ("first", c_int32),
        ("second", c_int32),
        ("is_obstacle", c_int32),
        ("distance", c_double),
        ("force", c_double * 4),
    ]


class Point(ctypes.Structure):
    """`pent_point`."""

    _fields_ = [("body", c_int32), ("cell", c_int64), ("weights", c_double * 5)]


class Grab(ctypes.Structure):
    """`pent_grab`."""

    _fields_ = [
        ("point", Point),
        ("anchor", c_double * 4),
        ("stiffness", c_double),
        ("damping", c_double),
        ("max_force", c_double),
    ]


class Hit(ctypes.Structure):
    """`pent_hit`."""

    _fields_ = [("point", Point), ("place", c_double * 4), ("distance", c_double)]


class Surface(ctypes.Structure):
    """`pent_surface`."""

    _fields_ = [
        ("positions", c_void_p),
        ("vertices", c_int64),
        ("triangles", c_void_p),
        ("triangle_count", c_int64),
        ("ends", c_void_p),
        ("weights", c_void_p),
        ("frame", c_double * 16),
    ]


class Turn(ctypes.Structure):
    """`pent_turn`."""

    _fields_ = [("from_axis", c_int32), ("to_axis", c_int32), ("degrees", c_double)]


class Hyperplane(ctypes.Structure):
    """`pent_hyperplane`."""

    _fields_ = [("turns", POINTER(Turn)), ("turn_count", c_int64), ("offset", c_double)]


_OF_BODY = (c_void_p, c_int)
_COUNT = POINTER(c_int64)

# Name: what it returns, what it takes. Numbers below 0 and NULL are failures.
_FUNCTIONS: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "pent_open_scene": (
        c_void_p,
        (c_char_p, c_char_p, c_char_p, POINTER(MeshArrays), c_int64, c_int),
    ),
    "pent_close": (c_int, (c_void_p,)),
    "pent_keep": (c_void_p, (c_void_p,)),
    "pent_free_kept": (c_int, (c_void_p,)),
    "pent_dimension": (c_int, (c_void_p,)),
    "pent_time_step": (c_double, (c_void_p,)),
    "pent_time": (c_double, (c_void_p,)),
    "pent_body_count": (c_int, (c_void_p,)),
    "pent_obstacle_count": (c_int, (c_void_p,)),
    "pent_body_name": (c_char_p, _OF_BODY),
    "pent_find_body": (c_int, (c_void_p, c_char_p)),
    "pent_vertex_count": (c_int64, _OF_BODY),
    "pent_cell_count": (c_int64, _OF_BODY),
    "pent_cells": (c_void_p, _OF_BODY),
    "pent_rest_positions": (c_void_p, _OF_BODY),
    "pent_positions": (c_void_p, _OF_BODY),
    "pent_velocities": (c_void_p, _OF_BODY),
    "pent_forces": (c_void_p, _OF_BODY),
    "pent_masses": (c_void_p, _OF_BODY),
    "pent_is_asleep": (c_int, _OF_BODY),
    "pent_boundary": (c_void_p, (c_void_p, c_int, _COUNT)),
    "pent_slice": (c_int, (c_void_p, c_int, c_void_p, c_double, POINTER(Surface))),
    "pent_pick": (c_int, (c_void_p, c_void_p, c_double, c_void_p, c_void_p, POINTER(Hit))),
    "pent_contacts": (c_void_p, (c_void_p, _COUNT)),
    "pent_energies": (c_void_p, (c_void_p, _COUNT)),
    "pent_step": (c_int, (c_void_p, POINTER(StepReport))),
    "pent_set_targets": (c_int, (c_void_p, c_int, c_void_p, c_int64, c_void_p)),
    "pent_release": (c_int, (c_void_p, c_int, c_void_p, c_int64)),
    "pent_add_grab": (c_int64, (c_void_p, POINTER(Grab))),
    "pent_move_grab": (c_int, (c_void_p, c_int64, c_void_p)),
    "pent_remove_grab": (c_int, (c_void_p, c_int64)),
    "pent_set_forces": (c_int, (c_void_p, c_int, c_void_p)),
    "pent_set_gravity": (c_int, (c_void_p, c_void_p)),
    "pent_set_state": (c_int, (c_void_p, c_int, c_void_p, c_void_p)),
    "pent_save": (c_void_p, (c_void_p,)),
    "pent_restore": (c_int, (c_void_p, c_void_p)),
    "pent_free_state": (c_int, (c_void_p,)),
    "pent_add_body": (c_int, (c_void_p, c_char_p, POINTER(MeshArrays))),
    "pent_remove_body": (c_int, _OF_BODY),
    "pent_add_obstacle": (c_int, (c_void_p, c_char_p)),
    "pent_remove_obstacle": (c_int, (c_void_p, c_int)),
    "pent_read_mesh": (c_void_p, (c_char_p,)),
    "pent_store_mesh": (c_void_p, (c_int, POINTER(MeshArrays), POINTER(MeshExtras))),
    "pent_write_mesh": (c_int, (c_void_p, c_char_p, c_char_p, c_int)),
    "pent_mesh_info_of": (c_int, (c_void_p, POINTER(MeshInfo))),
    "pent_mesh_extras_of": (c_int, (c_void_p, POINTER(MeshExtras))),
    "pent_mesh_boundary": (c_void_p, (c_void_p, _COUNT)),
    "pent_slice_mesh": (c_int, (c_void_p, c_void_p, c_void_p, c_double, POINTER(Surface))),
    "pent_slice_turned": (
        c_int,
        (c_void_p, c_void_p, POINTER(Hyperplane), POINTER(Surface), POINTER(c_void_p)),
    ),
    "pent_mesh_strain": (c_void_p, (c_void_p, c_void_p)),
    "pent_mesh_means": (c_void_p, (c_void_p, c_void_p, c_int32)),
    "pent_colors": (c_void_p, (c_char_p, c_void_p, c_int64, c_double, c_double)),
    "pent_free_mesh": (c_int, (c_void_p,)),
    "pent_read_frame": (c_void_p, (c_char_p,)),
    "pent_frame_info_of": (c_int, (c_void_p, POINTER(FrameInfo))),
    "pent_frame_field": (c_int, (c_void_p, c_int64, POINTER(Field))),
    "pent_free_frame": (c_int, (c_void_p,)),
    "pent_scene_text": (c_char_p, (c_char_p, c_char_p, c_char_p)),
    "pent_scene_text_for": (c_char_p, (c_char_p, c_char_p, c_char_p, c_char_p)),
}


def library_path() -> Path:
    """Where the library is: what PENTIMENTO_LIBRARY names, or beside this package."""
    named = os.environ.get("PENTIMENTO_LIBRARY")
    return Path(named) if named else Path(__file__).parent / "lib" / "libpent_plugin.so.2"


@functools.cache
def library() -> Any:
    """The library, loaded at the first use. Raises an Error that says where it was looked for."""
    path = library_path()
    try:
        loaded = ctypes.CDLL(os.fspath(path))
        version = loaded.pent_plugin_version()
        loaded.pent_last_error.restype = c_char_p
    except (OSError, AttributeError) as error:
        raise Error(
            f"{path}: the library cannot be loaded ({error}); install the package anew, or let"
            " PENTIMENTO_LIBRARY name libpent_plugin.so"
        ) from None
    if version != VERSION:
        raise Error(f"{path}: version {version} of the C interface; expected {VERSION}")

    def check(result: Any, _function: Any, _arguments: Any) -> Any:
        if result is None or (not isinstance(result, bytes) and result < 0):
            raise Error(loaded.pent_last_error().decode("utf-8", "replace"))
        return result

    for name, (result, arguments) in _FUNCTIONS.items():
        try:
            function = getattr(loaded, name)
        except AttributeError:
            raise Error(f"{path}: has no {name}(): the library is older than the package") from None
        function.restype = result
        function.argtypes = arguments
        function.errcheck = check
    return loaded


class Handle:
    """Something of the library's by its number, freed when nobody refers to it any more."""

    __slots__ = ("number", "_free", "__weakref__")

    def __init__(self, number: int, free: Callable[[int], Any]) -> None:
        self.number = number
        self._free = weakref.finalize(self, free, number)
        self._free.atexit = False  # the process ends, and with it all there is

    def __copy__(self) -> Handle:
        return self  # freed once

    def __deepcopy__(self, _: Any) -> Handle:
        return self

    def __reduce__(self) -> Any:
        # The number would be that of something else in another process.
        raise TypeError("cannot be pickled: it is in the memory of this process alone")

    def free(self) -> None:
        """Frees it now."""
        self._free()

    @property
    def is_alive(self) -> bool:
        """Whether it has not been freed."""
        return self._free.alive
