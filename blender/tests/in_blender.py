"""The add-on in Blender, beside pent-slice and what is known: run.py starts it."""

import contextlib
import io
import math
import os
import pathlib
import runpy
import shutil
import sys
import unittest

import bpy
import numpy as np

ZIP, FOLDER, *REST = sys.argv[sys.argv.index("--") + 1 :]
DATA = pathlib.Path(FOLDER)
PYTHON = pathlib.Path(__file__).resolve().parents[2] / "python"
sys.dont_write_bytecode = True
sys.path[:0] = [str(PYTHON), str(PYTHON / "tests")]

import host_runs  # noqa: E402

import pentimento  # noqa: E402

FIRST = 1  # of Blender's frames
_made = {}


def install():
    bpy.ops.preferences.addon_install(filepath=ZIP)
    bpy.ops.preferences.addon_enable(module="pentimento_slices")


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


class AddOn(unittest.TestCase):
    def setUp(self):
        bpy.ops.wm.read_homefile(use_empty=True)

    def assert_is(self, mesh, other):
        """The same triangles; places to single precision, which Blender keeps."""
        np.testing.assert_array_equal(triangles_of(mesh), other.triangles)
        np.testing.assert_allclose(points_of(mesh), other.points, rtol=0, atol=3e-7)

    def at(self, frame):
        bpy.context.scene.frame_set(frame)

    def test_slices_of_a_run_are_those_of_pent_slice_at_every_frame(self):
        run = imported(DATA / "run")
        self.assertEqual(set(bodies(run)), {"high", "low"})
        self.assertAlmostEqual(run.pentimento.offset, 0.5)  # through the middle
        for frame in range(9):
            self.at(FIRST + frame)
            for name, thing in bodies(run).items():
                made = sliced(DATA / "run", name, frame)
                self.assert_is(thing.data, made)
                found = surface_of(thing.data)
                # A float has 2^-24 of a coordinate of a few m.
                self.assertAlmostEqual(found.volume, made.volume, delta=2e-6)
                self.assertAlmostEqual(found.area, made.area, delta=2e-6)

    def test_turned_slices_are_those_of_pent_slice(self):
        run = imported(DATA / "run")
        for plane, angle in (("zw", 12.5), ("yz", -30), ("xw", 40)):
            setattr(run.pentimento, plane, angle)
        run.pentimento.offset = 0.3
        self.at(FIRST + 5)
        # In the order of the page and the panel, whatever the order they were set in.
        rotate = ["zw:12.5", "yz:-30", "xw:40"]
        for name, thing in bodies(run).items():
            made = sliced(DATA / "run", name, 5, w=0.3, rotate=rotate)
            self.assertGreater(len(made.triangles), 0)
            self.assert_is(thing.data, made)

    def test_a_tesseract_has_the_slices_of_a_tesseract(self):
        run = imported(DATA / "tesseract.pent")
        (thing,) = bodies(run).values()
        straight = surface_of(thing.data)
        self.assertAlmostEqual(straight.volume, 1, places=6)
        self.assertAlmostEqual(straight.area, 6, places=5)
        run.pentimento.xw = 45
        run.pentimento.offset = host_runs.TILTED["offset"]
        tilted = surface_of(thing.data)
        self.assertAlmostEqual(tilted.volume, host_runs.TILTED_VOLUME, places=5)
        self.assertAlmostEqual(tilted.area, host_runs.TILTED_AREA, places=5)
        run.pentimento.offset = 3
        self.assertEqual(len(thing.data.polygons), 0)

    def test_up_is_up_and_triangles_face_outward(self):
        run = imported(DATA / "run")
        heights = {
            name: np.mean([vertex.co.z for vertex in thing.data.vertices])
            for name, thing in bodies(run).items()
        }
        self.assertAlmostEqual(heights["high"] - heights["low"], 1.12, places=5)
        for thing in bodies(run).values():
            mesh = thing.data
            middle = np.mean([vertex.co for vertex in mesh.vertices], axis=0)
            for polygon in mesh.polygons:
                self.assertGreater(np.dot(np.array(polygon.center) - middle, polygon.normal), 0)

    def test_attributes_and_colors_are_those_of_pent_slice(self):
        run = imported(DATA / "run")
        self.at(FIRST + 4)
        for quantity in ("w", "speed", "strain", "force"):
            run.pentimento.color = quantity
            bpy.ops.pentimento.fit_colors()
            low, high = run.pentimento.low, run.pentimento.high
            for name, thing in bodies(run).items():
                made = sliced(DATA / "run", name, 4, color=quantity).attributes
                np.testing.assert_allclose(
                    values_of(thing.data, quantity), made[quantity], rtol=1e-6, atol=1e-7
                )
                wanted = pentimento.View(DATA / "run").slice(name, 4, None, 0.5)
                np.testing.assert_allclose(
                    values_of(thing.data, "Color")[:, :3],
                    wanted.colors(quantity, low, high), atol=2e-3,
                )  # fmt: skip
        run.pentimento.color = "body"
        for number, name in enumerate(("high", "low")):
            mesh = bodies(run)[name].data
            self.assertTrue((values_of(mesh, "body") == number).all())
            linear = values_of(mesh, "Color")[0, :3].astype(float)
            curve = 1.055 * linear ** (1 / 2.4) - 0.055
            srgb = np.where(linear <= 0.0031308, 12.92 * linear, curve)
            made = sliced(DATA / "run", name, 4).attributes
            for value, channel in zip(srgb, ("red", "green", "blue")):
                self.assertLessEqual(abs(255 * value - made[channel][0]), 0.51)

    def test_a_quantity_that_frames_have_not_is_refused_in_one_line(self):
        run = imported(DATA / "tesseract.pent")
        (thing,) = bodies(run).values()
        before = len(thing.data.polygons)
        with errors_caught() as said:
            run.pentimento.color = "force"
        self.assertIn("has no attribute force; there are body, w, speed, strain", said.getvalue())
        self.assertEqual(run.pentimento.message.count("\n"), 0)
        self.assertEqual(len(thing.data.polygons), before)
        run.pentimento.color = "strain"
        self.assertEqual(run.pentimento.message, "")

    def test_all_bodies_may_be_one_object(self):
        run = imported(DATA / "run", as_one=True)
        self.at(FIRST + 6)
        (thing,) = bodies(run).values()
        made = [sliced(DATA / "run", name, 6) for name in ("high", "low")]
        self.assertEqual(len(thing.data.polygons), sum(len(one.triangles) for one in made))
        found = surface_of(thing.data)
        self.assertAlmostEqual(found.volume, sum(one.volume for one in made), delta=4e-6)
        self.assertEqual(set(values_of(thing.data, "body")), {0, 1})

    def test_keys_of_offset_and_angles_change_the_mesh(self):
        run = imported(DATA / "run")
        low = bodies(run)["low"]
        for frame, offset, angle in ((1, 0.2, 0), (5, 0.8, 60)):
            run.pentimento.offset, run.pentimento.xw = offset, angle
            run.keyframe_insert("pentimento.offset", frame=frame)
            run.keyframe_insert("pentimento.xw", frame=frame)
        for curve in run.animation_data.action.fcurves:
            for key in curve.keyframe_points:
                key.interpolation = "LINEAR"
        for frame, offset, angle in ((1, 0.2, 0), (3, 0.5, 30), (5, 0.8, 60)):
            self.at(frame)
            made = sliced(DATA / "run", "low", frame - FIRST, w=offset, rotate=f"xw:{angle}")
            found = surface_of(low.data)
            # Animated values are singles: the hyperplane is 1e-7 off.
            self.assertAlmostEqual(found.volume, made.volume, delta=1e-5)
            self.assertAlmostEqual(found.area, made.area, delta=1e-5)

    def test_a_driver_changes_the_mesh_without_a_new_frame(self):
        run = imported(DATA / "tesseract.pent")
        (thing,) = bodies(run).values()
        hand = bpy.data.objects.new("hand", None)
        bpy.context.collection.objects.link(hand)
        driver = run.driver_add("pentimento.offset").driver
        driver.type = "SUM"
        target = driver.variables.new().targets[0]
        target.id, target.data_path = hand, "location.x"
        hand.location.x = 0.4
        bpy.context.view_layer.update()
        made = sliced(DATA / "tesseract.pent", "tesseract", 0, w=0.4)
        self.assertEqual(len(thing.data.polygons), len(made.triangles))
        hand.location.x = 4
        bpy.context.view_layer.update()
        self.assertEqual(len(thing.data.polygons), 0)

    def test_normals_are_those_of_the_body_or_of_the_triangles(self):
        run = imported(DATA / "run")
        run.pentimento.yw = 20
        self.at(FIRST + 5)
        mesh = bodies(run)["low"].data
        wanted = pentimento.View(DATA / "run").slice("low", 5, {"yw": 20}, 0.5, shading=True)

        def normals():
            if hasattr(mesh, "calc_normals_split"):
                mesh.calc_normals_split()
            found = np.array([loop.normal for loop in mesh.loops])
            return np.column_stack([found[:, 0], found[:, 2], -found[:, 1]])

        # Blender keeps them as two angles of 16 bits.
        smooth = wanted.normals.reshape(-1, 3)
        self.assertGreater((normals() * smooth).sum(axis=1).min(), 0.999)
        run.pentimento.shading = "FLAT"
        corners = wanted.points[wanted.triangles]
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        size = np.linalg.norm(flat, axis=1)
        flat /= size[:, None]
        found = normals().reshape(-1, 3, 3)
        there = size > 1e-6  # singles leave no direction to slivers
        self.assertGreater((found * flat[:, None])[there].sum(axis=2).min(), 0.999)

    def test_three_dimensional_runs_are_shown_whole(self):
        run = imported(DATA / "solid")
        self.assertEqual((run.pentimento.dimension, run.pentimento.offset), (3, 0))
        for frame in (0, 7):
            self.at(FIRST + frame)
            for name, thing in bodies(run).items():
                self.assert_is(thing.data, sliced(DATA / "solid", name, frame))
        before = surface_of(bodies(run)["low"].data).volume
        run.pentimento.offset = 5
        self.assertEqual(surface_of(bodies(run)["low"].data).volume, before)

    def test_two_runs_have_a_hyperplane_each(self):
        first, second = imported(DATA / "run"), imported(DATA / "run")
        second.pentimento.offset = 0.7
        solid = imported(DATA / "solid")
        self.at(FIRST + 3)
        self.assert_is(bodies(first)["low"].data, sliced(DATA / "run", "low", 3, w=0.5))
        self.assert_is(bodies(second)["low"].data, sliced(DATA / "run", "low", 3, w=0.7))
        self.assert_is(bodies(solid)["low"].data, sliced(DATA / "solid", "low", 3))

    def test_what_cannot_be_imported_is_told_in_one_line_and_leaves_nothing(self):
        (DATA / "empty").mkdir(exist_ok=True)
        (DATA / "noise.pent").write_bytes(os.urandom(999))
        (DATA / "cut.pent").write_bytes((DATA / "tesseract.pent").read_bytes()[:-40])
        mixed = DATA / "mixed" / "meshes"
        mixed.mkdir(parents=True, exist_ok=True)
        shutil.copy(DATA / "run" / "meshes" / "low.pent", mixed / "a.pent")
        shutil.copy(DATA / "solid" / "meshes" / "low.pent", mixed / "b.pent")
        unmoved = DATA / "unmoved" / "meshes"
        unmoved.mkdir(parents=True, exist_ok=True)
        shutil.copy(DATA / "run" / "meshes" / "low.pent", unmoved / "a.pent")
        for name, said in {
            "nowhere": "expected the folder of a run",
            "empty": "expected the folder of a run",
            "noise.pent": "noise.pent: ",
            "cut.pent": "cut.pent: ",
            "flat.pent": "a mesh of 2 dimensions; slices are of bodies of 3 or 4",
            "run/frames/low_000002.pent": "this is a frame of the mesh low.pent",
            "mixed": "bodies of different dimension",
            "unmoved": "has no frame of every body yet",
        }.items():
            with self.assertRaises(RuntimeError) as caught:
                bpy.ops.pentimento.import_run(filepath=str(DATA / name))
            line = str(caught.exception).strip()
            self.assertIn(said, line)
            self.assertEqual(line.count("\n"), 0, line)
            self.assertEqual(len(bpy.data.objects), 0)

    def test_a_file_within_a_run_stands_for_the_run(self):
        run = imported(DATA / "run" / "scene.toml")
        self.assertEqual(set(bodies(run)), {"high", "low"})

    def test_a_damaged_frame_is_told_and_the_slice_stays_until_a_whole_one(self):
        shutil.copytree(DATA / "run", DATA / "damaged")
        frame = DATA / "damaged" / "frames" / "low_000003.pent"
        frame.write_bytes(frame.read_bytes()[:-100])
        run = imported(DATA / "damaged")
        self.at(FIRST + 2)
        low = bodies(run)["low"].data
        before = points_of(low)
        with errors_caught() as said:
            self.at(FIRST + 3)
        self.assertIn("low_000003.pent: ", run.pentimento.message)
        self.assertEqual(said.getvalue(), f"pentimento: {run.pentimento.message}\n")
        np.testing.assert_array_equal(points_of(low), before)
        self.at(FIRST + 4)
        self.assertEqual(run.pentimento.message, "")
        self.assert_is(low, sliced(DATA / "run", "low", 4))

    def test_frames_that_bytes_were_changed_in_never_stop_blender(self):
        shutil.copytree(DATA / "run", DATA / "fuzzed")
        whole = (DATA / "run" / "frames" / "low_000001.pent").read_bytes()
        run = imported(DATA / "fuzzed")
        random = np.random.default_rng(7)
        told = 0
        with errors_caught():
            for _ in range(60):
                data = bytearray(whole[: random.integers(1, len(whole) + 1)])
                for place in random.integers(0, len(data), random.integers(0, 4)):
                    data[place] = random.integers(256)
                (DATA / "fuzzed" / "frames" / "low_000001.pent").write_bytes(data)
                self.at(FIRST)
                self.at(FIRST + 1)
                told += run.pentimento.message != ""
        self.assertGreater(told, 50)
        self.at(FIRST + 2)
        self.assert_is(bodies(run)["low"].data, sliced(DATA / "run", "low", 2))

    def test_where_frames_are_missing_the_one_before_stays_until_read_again(self):
        shutil.copytree(DATA / "run", DATA / "gaps")
        kept = DATA / "gaps" / "low_000004.pent"
        shutil.move(DATA / "gaps" / "frames" / "low_000004.pent", kept)
        run = imported(DATA / "gaps")
        self.at(FIRST + 4)
        mesh = bodies(run)["high"].data
        self.assert_is(mesh, sliced(DATA / "run", "high", 3))
        shutil.move(kept, DATA / "gaps" / "frames" / "low_000004.pent")
        self.assertEqual(bpy.ops.pentimento.reload(), {"FINISHED"})
        self.assert_is(mesh, sliced(DATA / "run", "high", 4))
        self.at(FIRST + 40)  # behind the end the last stays
        self.assert_is(mesh, sliced(DATA / "run", "high", 8))

    def test_a_run_that_went_away_is_told_by_operators(self):
        shutil.copytree(DATA / "run", DATA / "gone")
        run = imported(DATA / "gone")
        shutil.rmtree(DATA / "gone")
        with errors_caught(), self.assertRaises(RuntimeError) as caught:
            bpy.ops.pentimento.reload()
        self.assertIn("gone: expected the folder of a run", str(caught.exception))
        self.assertGreater(len(bodies(run)["low"].data.polygons), 0)

    def test_another_path_is_another_run(self):
        run = imported(DATA / "run")
        with errors_caught():
            run.pentimento.path = str(DATA / "tesseract.pent")
        self.assertIn('no body is called "', run.pentimento.message)
        run.pentimento.path = str(DATA / "solid")
        self.assertEqual((run.pentimento.message, run.pentimento.dimension), ("", 3))
        self.assert_is(bodies(run)["low"].data, sliced(DATA / "solid", "low", 0))

    def test_a_saved_file_goes_on_when_it_is_opened_again(self):
        run = imported(DATA / "run")
        run.pentimento.offset = 0.25
        run.keyframe_insert("pentimento.offset", frame=1)
        path = str(DATA / "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        run.pentimento.path = bpy.path.relpath(str(DATA / "run"))
        self.assertEqual(run.pentimento.message, "")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True)
        self.assertEqual(len(bpy.data.objects), 0)
        bpy.ops.wm.open_mainfile(filepath=path)
        run = bpy.data.objects["run"]
        self.assertTrue(run.pentimento.path.startswith("//"))
        self.at(FIRST + 7)
        self.assert_is(bodies(run)["low"].data, sliced(DATA / "run", "low", 7, w=0.25))

    def test_undo_and_redo_keep_slice_and_settings_together(self):
        run = imported(DATA / "run")
        bpy.ops.ed.undo_push(message="imported")
        run.pentimento.offset = 0.8
        bpy.ops.ed.undo_push(message="moved")
        bpy.ops.ed.undo()
        run = bpy.data.objects["run"]
        self.assertAlmostEqual(run.pentimento.offset, 0.5)
        self.at(FIRST + 2)
        self.assert_is(bodies(run)["low"].data, sliced(DATA / "run", "low", 2))
        run.pentimento.offset = 0.6
        self.assert_is(bodies(run)["low"].data, sliced(DATA / "run", "low", 2, w=0.6))

    def test_deleted_bodies_and_runs_are_no_more_sliced(self):
        run, other = imported(DATA / "run"), imported(DATA / "solid")
        bpy.data.objects.remove(bodies(run)["low"])
        self.at(FIRST + 1)
        alone = bodies(run)["high"]
        bpy.data.objects.remove(run)
        with errors_caught() as said:
            self.at(FIRST + 2)
        self.assertEqual(said.getvalue(), "")
        self.assertGreater(len(alone.data.polygons), 0)
        self.assertEqual(other.pentimento.message, "")

    def test_scrubbing_ends_where_it_ends_in_constant_memory(self):
        long = DATA / "long"
        (long / "frames").mkdir(parents=True)
        shutil.copytree(DATA / "run" / "meshes", long / "meshes")
        for frame in range(200):  # frames know their number: of those that are read, 9 differ
            for body in ("high", "low"):
                source = DATA / "run" / "frames" / f"{body}_{frame % 9:06d}.pent"
                os.link(source, long / "frames" / f"{body}_{frame:06d}.pent")
        run = imported(long, set_time=False)
        frames = np.random.default_rng(3).permutation(np.tile(np.arange(200), 3))

        def scrub(numbers):
            for number in numbers:
                self.at(FIRST + int(number))
            pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
            return pages * os.sysconf("SC_PAGE_SIZE") / 2**20

        before = scrub(frames[:200])
        after = scrub(frames[200:])
        # 400 frames more of both bodies would be 400 x 2 x 81 x 12 x 8 bytes = 6 MB, and slices.
        self.assertLess(after - before, 3, "MB more after 400 frames more")
        number = int(frames[-1])
        self.assert_is(bodies(run)["low"].data, sliced(DATA / "run", "low", number % 9))

    def test_the_scene_plays_at_the_speed_of_the_simulation(self):
        imported(DATA / "run")
        scene = bpy.context.scene
        self.assertEqual((scene.frame_start, scene.frame_end), (1, 9))
        self.assertAlmostEqual(scene.render.fps / scene.render.fps_base, 30, places=5)

    def test_pictures_show_each_frame_its_slice(self):
        imported(DATA / "run")
        scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.cycles.samples = 1
        scene.cycles.use_denoising = False  # which Debian's Blender cannot
        scene.render.resolution_x = scene.render.resolution_y = 24
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(camera)
        camera.location, camera.rotation_euler = (0.5, -6, 1.2), (math.pi / 2, 0, 0)
        camera.data.type, camera.data.ortho_scale = "ORTHO", 3
        scene.camera = camera
        scene.frame_start, scene.frame_end, scene.frame_step = 1, 9, 8
        scene.render.film_transparent = True
        scene.world = bpy.data.worlds.new("light")
        scene.world.color = (1, 1, 1)
        scene.render.filepath = str(DATA / "picture_")
        bpy.ops.render.render(animation=True)
        for frame in (1, 9):
            image = bpy.data.images.load(str(DATA / f"picture_{frame:04d}.png"))
            pixels = np.array(image.pixels[:]).reshape(24, 24, 4)
            alpha = pixels[:, :, 3]
            orange = pixels[alpha > 0.5][-24:].mean(axis=0)  # of the first body, which is above
            self.assertGreater(orange[0], orange[2] + 0.1)
            # Rows count from below, 24 of them are 3 m, and the camera is 1.2 m up.
            seen = (np.nonzero(alpha.max(axis=1) > 0.5)[0].max() + 1 - 12) / 8 + 1.2
            made = sliced(DATA / "run", "high", frame - FIRST)
            self.assertLess(abs(seen - made.points[:, 1].max()), 1 / 8)  # a row

    def test_the_example_makes_a_picture(self):
        names = runpy.run_path(str(PYTHON.parent / "blender" / "example.py"), run_name="example")
        run = names["import_run"](str(DATA / "run"))
        names["set_up"](run)
        bpy.context.scene.render.resolution_percentage = 5
        names["render"](str(DATA / "example.png"), 1)
        image = bpy.data.images.load(str(DATA / "example.png"))
        self.assertEqual(tuple(image.size), (36, 24))
        orange = np.array(image.pixels[:]).reshape(24, 36, 4)[10:14, 16:20].mean(axis=(0, 1))
        self.assertGreater(orange[0], orange[2])  # the first body, in the middle

    def test_exported_sequences_have_every_slice(self):
        imported(DATA / "run", as_one=True)
        bpy.ops.wm.obj_export(
            filepath=str(DATA / "sequence.obj"), export_animation=True, start_frame=1, end_frame=9,
            export_materials=False, forward_axis="NEGATIVE_Z", up_axis="Y",
        )  # fmt: skip
        for frame in range(9):
            lines = (DATA / f"sequence{frame + 1}.obj").read_text().splitlines()
            points = [line.split()[1:4] for line in lines if line.startswith("v ")]
            faces = [line.split()[1:] for line in lines if line.startswith("f ")]
            faces = [[corner.split("/")[0] for corner in face] for face in faces]
            found = pentimento.Surface(np.array(points, float), np.array(faces, int) - 1)
            made = [sliced(DATA / "run", name, frame) for name in ("high", "low")]
            # OBJ has six digits.
            self.assertAlmostEqual(found.volume, sum(one.volume for one in made), delta=2e-5)

    def test_objects_have_the_modifier_by_which_exporters_see_that_they_change(self):
        run = imported(DATA / "run")
        self.at(FIRST + 5)
        for thing in bodies(run).values():
            self.assertEqual(len(thing.modifiers), 1)
            shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
            self.assertEqual(len(shown.polygons), len(thing.data.polygons))

    def test_alembic_has_every_slice(self):
        if not bpy.app.build_options.alembic:
            self.skipTest("this Blender was built without Alembic, as Debian's is")
        imported(DATA / "run", as_one=True)
        path = str(DATA / "run.abc")
        bpy.ops.wm.alembic_export(filepath=path, start=1, end=9, as_background_job=False)
        self.assert_comes_back(path, bpy.ops.wm.alembic_import, as_background_job=False)

    def test_usd_has_every_slice(self):
        if not bpy.app.build_options.usd:
            self.skipTest("this Blender was built without USD, as Debian's is")
        imported(DATA / "run", as_one=True)
        path = str(DATA / "run.usdc")
        bpy.ops.wm.usd_export(filepath=path, export_animation=True)
        self.assert_comes_back(path, bpy.ops.wm.usd_import)

    def assert_comes_back(self, path, importer, **options):
        bpy.ops.wm.read_homefile(use_empty=True)
        importer(filepath=path, **options)
        (thing,) = [one for one in bpy.data.objects if one.type == "MESH"]
        for frame in (0, 4, 8):
            self.at(FIRST + frame)
            shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
            wanted = sum(len(sliced(DATA / "run", b, frame).triangles) for b in ("high", "low"))
            self.assertEqual(len(shown.data.polygons), wanted)

    def test_off_and_on_again_goes_on(self):
        run = imported(DATA / "run")
        bpy.ops.preferences.addon_disable(module="pentimento_slices")
        self.at(FIRST + 3)
        bpy.ops.preferences.addon_enable(module="pentimento_slices")
        run = bpy.data.objects["run"]
        self.at(FIRST + 4)
        self.assert_is(bodies(run)["low"].data, sliced(DATA / "run", "low", 4))


if __name__ == "__main__":
    install()
    program = unittest.main(argv=["in_blender", *REST], exit=False, verbosity=2)
    for test, reason in program.result.skipped:
        print(f"SKIPPED: {test.id()}: {reason}")
    sys.stdout.flush()
    if not program.result.wasSuccessful():
        raise SystemExit(1)
