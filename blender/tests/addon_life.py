"""What happens to a run: undo, saved files, damage, many frames."""

import math
import os
import pathlib
import shutil
import sys
import types

import bpy
import numpy as np
from addon_case import DATA, FIRST, AddOnCase, bodies, errors_caught, imported, points_of, sliced
from addon_case import values_of
from boxes import box

import pentimento

QUANTITIES = ("Color", "position", "material_index", "crease", "temperature")


def write_run(folder, frames, quantities=()):
    """A run of a unit tesseract that moves along x by 0.1 m a frame, with these quantities: the
    first is 1 everywhere, the second 2, and so on."""
    (folder / "meshes").mkdir(parents=True, exist_ok=True)
    (folder / "frames").mkdir(exist_ok=True)
    path = folder / "meshes" / "a.pent"
    if not path.exists():
        pentimento.Mesh(*box(4)).write(path)
    mesh = pentimento.Mesh.read(path)
    properties = "".join(f"property double {name}\n" for name in (*"xyzw", *quantities))
    numbers = [*range(1, 1 + len(quantities))]
    for frame in frames:
        rows = [[x + 0.1 * frame, *others, *numbers] for x, *others in mesh.points.tolist()]
        (folder / "frames" / f"a_{frame:06d}.pent").write_text(
            "ply\nformat ascii 1.0\ncomment pent 1.0\ncomment dimension 4\n"
            f"comment mesh a.pent {mesh.crc32c:08x}\ncomment frame {frame}\n"
            f"comment step {frame}\ncomment time {frame / 25}\n"
            f"element vertex {mesh.vertex_count}\n{properties}end_header\n"
            + "".join(" ".join(map(str, row)) + "\n" for row in rows)
        )
    return folder


def keys_of(run):
    curve = run.animation_data.action.fcurves.find("pentimento.frame")
    return [tuple(key.co) for key in curve.keyframe_points]


class Life(AddOnCase):
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

    def test_quantities_called_as_something_of_blenders_are_there_too(self):
        run = imported(write_run(DATA / "named", range(2), QUANTITIES))
        self.at(FIRST + 1)
        self.assertEqual(run.pentimento.message, "")
        mesh = bodies(run)["a"].data
        for number, name in enumerate(
            ("Color.001", "position_", "material_index_", "crease_", "temperature"), 1
        ):
            np.testing.assert_array_equal(values_of(mesh, name), number)
        self.assertEqual(values_of(mesh, "Color").shape, (len(mesh.vertices), 4))
        self.assertEqual(mesh.color_attributes.active_color.name, "Color")

    def test_read_again_goes_on_to_the_new_end_of_a_run_that_grew(self):
        scene = bpy.context.scene
        run = imported(write_run(DATA / "grown", range(4)))
        write_run(DATA / "grown", range(4, 9))
        self.assertEqual(bpy.ops.pentimento.reload(), {"FINISHED"})
        self.assertEqual((keys_of(run), scene.frame_end), ([(1, 0), (9, 8)], 9))
        self.at(FIRST + 8)
        self.assertAlmostEqual(points_of(bodies(run)["a"].data)[:, 0].max(), 1.8, places=6)
        curve = run.animation_data.action.fcurves.find("pentimento.frame")
        curve.keyframe_points[1].co = (17, 8)  # half as fast
        scene.frame_end = 12
        write_run(DATA / "grown", range(9, 11))
        bpy.ops.pentimento.reload()
        self.assertEqual((keys_of(run), scene.frame_end), ([(1, 0), (21, 10)], 12))
        curve.keyframe_points[1].co = (5, 4)  # the beginning alone
        write_run(DATA / "grown", range(11, 12))
        bpy.ops.pentimento.reload()
        self.assertEqual(keys_of(run), [(1, 0), (5, 4)])
        run.animation_data_clear()
        write_run(DATA / "grown", range(12, 13))
        self.assertEqual(bpy.ops.pentimento.reload(), {"FINISHED"})

    def test_a_run_that_was_imported_at_its_start_gets_its_keys_when_it_is_read_again(self):
        run = imported(write_run(DATA / "begun", range(1)))
        self.assertEqual(keys_of(run), [(1, 0)])
        write_run(DATA / "begun", range(1, 4))
        bpy.ops.pentimento.reload()
        self.assertEqual(keys_of(run), [(1, 0), (4, 3)])
        self.assertEqual(run.pentimento.frame, 0)
        self.at(FIRST + 2)
        self.assertEqual(run.pentimento.frame, 2)

    def test_a_body_in_edit_mode_stays_as_it_is_until_it_is_left(self):
        run = imported(write_run(DATA / "edited", range(4)))
        body = bodies(run)["a"]
        bpy.context.view_layer.objects.active = body
        bpy.ops.object.mode_set(mode="EDIT")
        with errors_caught():
            self.at(FIRST + 2)
        self.assertIn("a: is in Edit Mode", run.pentimento.message)
        bpy.ops.object.mode_set(mode="OBJECT")
        self.at(FIRST + 2)
        self.assertEqual(run.pentimento.message, "")
        self.assertAlmostEqual(points_of(body.data)[:, 0].max(), 1.2, places=6)

    def test_linked_copies_of_a_run_have_a_slice_each(self):
        run = imported(write_run(DATA / "copied", range(4)))
        for thing in bpy.data.objects:
            thing.select_set(True)
        bpy.ops.object.duplicate(linked=True)
        copy = bpy.data.objects["copied.001"]
        copy.pentimento.offset = 5
        self.at(FIRST + 1)
        self.assertEqual(len(bodies(copy)["a"].data.vertices), 0)
        self.assertGreater(len(bodies(run)["a"].data.vertices), 0)

    def test_every_frame_of_a_long_run_is_the_one_of_its_number(self):
        run = imported(write_run(DATA / "lengthy", range(2)))
        count = 60000
        curve = run.animation_data.action.fcurves.find("pentimento.frame")
        first, last = curve.keyframe_points
        first.co, last.co = (0, 0), (count - 1, count - 1)
        curve.update()
        below = [at for at in range(count) if curve.evaluate(at) < at - 1e-3]
        self.assertGreater(len(below), 100)  # in single precision
        look_of = sys.modules["pentimento_slices.settings"].look_of
        long = types.SimpleNamespace(frame_at=math.floor)
        for at in below[::100]:
            self.at(at)
            self.assertEqual(look_of(run.pentimento, long).frame, at)

    def test_a_path_that_blender_has_no_text_for_is_told(self):
        name = os.fsdecode(bytes(write_run(DATA / "named", range(2))) + b"\xff")
        shutil.copytree(DATA / "named", name)
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.pentimento.import_run(filepath=name)
        line = str(caught.exception).strip()
        self.assertIn("utf-8", line)
        self.assertEqual(line.count("\n"), 0, line)
        self.assertEqual(len(bpy.data.objects), 0)

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

    def test_off_and_on_again_goes_on(self):
        run = imported(DATA / "run")
        bpy.ops.preferences.addon_disable(module="pentimento_slices")
        self.at(FIRST + 3)
        bpy.ops.preferences.addon_enable(module="pentimento_slices")
        run = bpy.data.objects["run"]
        self.at(FIRST + 4)
        self.assert_is(bodies(run)["low"].data, sliced(DATA / "run", "low", 4))
