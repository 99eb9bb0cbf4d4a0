"""Pictures and exported files have the slice of every frame."""

import math
import runpy

import bpy
import numpy as np
from addon_case import DATA, FIRST, PYTHON, AddOnCase, bodies, imported, sliced

import pentimento


class Output(AddOnCase):
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
