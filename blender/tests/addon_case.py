"""What the tests in Blender share: imports, what meshes hold, and pent-slice beside it."""

import contextlib
import io
import pathlib
import sys
import unittest

import bpy
import numpy as np

ZIP, FOLDER, *REST = sys.argv[sys.argv.index("--") + 1 :]
DATA = pathlib.Path(FOLDER)
PYTHON = pathlib.Path(__file__).resolve().parents[2] / "python"
sys.path[:0] = [str(PYTHON), str(PYTHON / "tests")]

import pentimento  # noqa: E402

FIRST = 1  # of Blender's frames
_made = {}


def imported(path, **options):
    """The empty object of a run."""
    assert bpy.ops.pentimento.import_run(filepath=str(path), **options) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def bodies(run):
    return {one.name.partition(".")[0]: one for one in bpy.data.objects if one.parent == run}


def points_of(mesh):
    """In our axes."""
    found = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", found)
    x, y, z = found.reshape(-1, 3).T.astype(float)
    return np.column_stack([x, z, -y])


def triangles_of(mesh):
    found = np.empty(3 * len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("vertices", found)
    return found.reshape(-1, 3)


def values_of(mesh, name):
    attribute = mesh.attributes[name]
    kind, size = ("color", 4) if attribute.data_type == "FLOAT_COLOR" else ("value", 1)
    found = np.empty(size * len(mesh.vertices), np.float32)
    attribute.data.foreach_get(kind, found)
    return found.reshape(-1, size).squeeze()


def surface_of(mesh):
    return pentimento.Surface(points_of(mesh), triangles_of(mesh))


def sliced(path, body, frame, **look):
    """What pent-slice makes."""
    key = (str(path), frame, str(look))
    if key not in _made:
        _made[key] = pentimento.slice(path, frames=frame, **look)
    return next(one.surface for one in _made[key] if one.body == body)


@contextlib.contextmanager
def errors_caught():
    said = io.StringIO()
    with contextlib.redirect_stderr(said):
        yield said


class AddOnCase(unittest.TestCase):
    """An empty file for each test."""

    def setUp(self):
        bpy.ops.wm.read_homefile(use_empty=True)

    def assert_is(self, mesh, other):
        """The same triangles; places to single precision, which Blender keeps."""
        np.testing.assert_array_equal(triangles_of(mesh), other.triangles)
        np.testing.assert_allclose(points_of(mesh), other.points, rtol=0, atol=3e-7)

    def at(self, frame):
        bpy.context.scene.frame_set(frame)
