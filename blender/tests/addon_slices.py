"""Slices, colors and normals beside pent-slice and what is known."""

import bpy
import host_runs
import numpy as np
from addon_case import (
    DATA,
    FIRST,
    AddOnCase,
    bodies,
    errors_caught,
    imported,
    sliced,
    surface_of,
    values_of,
)

import pentimento


class Slices(AddOnCase):
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

    def test_the_scene_plays_at_the_speed_of_the_simulation(self):
        imported(DATA / "run")
        scene = bpy.context.scene
        self.assertEqual((scene.frame_start, scene.frame_end), (1, 9))
        self.assertAlmostEqual(scene.render.fps / scene.render.fps_base, 30, places=5)
