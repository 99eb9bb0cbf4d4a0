"""When slices are cut: at a new frame, at what a driver changed, and after a file was opened."""

import bpy
from bpy.app.handlers import persistent

from . import views
from .slicing import refresh_all


@persistent
def frame_changed(_scene, depsgraph=None):
    refresh_all(depsgraph)


@persistent
def graph_updated(_scene, depsgraph=None):
    # While a picture is made the slices are those of its frame.
    if not bpy.app.is_job_running("RENDER"):
        refresh_all(depsgraph)


@persistent
def file_opened(*_):
    views.forget()


_HANDLERS = (
    ("frame_change_post", frame_changed),
    ("depsgraph_update_post", graph_updated),
    ("load_post", file_opened),
)


def register():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    views.forget()
