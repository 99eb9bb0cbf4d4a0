"""The reader in ParaView, beside pent-slice and what is known: run.py starts it."""

import os
import pathlib
import runpy
import shutil
import sys
import unittest

import numpy as np
from paraview import servermanager, simple
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import vtk_to_numpy

FOLDER, *REST = sys.argv[1:]
DATA = pathlib.Path(FOLDER)
PYTHON = pathlib.Path(__file__).resolve().parents[2] / "python"
sys.dont_write_bytecode = True

PentimentoReader = runpy.run_path(str(DATA / "pentimento_paraview" / "load.py"))["PentimentoReader"]
import pentimento  # noqa: E402

sys.path[:0] = [str(PYTHON / "tests")]
import host_runs  # noqa: E402

_made = {}


def sliced(path, body, frame, **look):
    """What pent-slice makes."""
    key = (str(path), frame, str(look))
    if key not in _made:
        _made[key] = pentimento.slice(path, frames=frame, **look)
    return next(one.surface for one in _made[key] if one.body == body)


def opened(path):
    return PentimentoReader(FileName=str(path))


def blocks(reader, time=None):
    """The bodies by their names."""
    if time is None:
        reader.UpdatePipeline()
    else:
        reader.UpdatePipeline(time)
    data = servermanager.Fetch(reader)
    names = [data.GetMetaData(i).Get(data.NAME()) for i in range(data.GetNumberOfBlocks())]
    return {name: data.GetBlock(i) for i, name in enumerate(names)}


def surface_of(block):
    data = dataset_adapter.WrapDataObject(block)
    triangles = vtk_to_numpy(block.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    points = np.zeros((0, 3)) if block.GetNumberOfPoints() == 0 else np.asarray(data.Points)
    attributes = {name: np.asarray(data.PointData[name]) for name in data.PointData.keys()}
    return pentimento.Surface(points, triangles, attributes=attributes)


def area_by_paraview(reader):
    """Of all bodies, by its own filter."""
    integral = simple.IntegrateVariables(Input=reader)
    integral.UpdatePipeline(reader.TimestepValues[0] if len(reader.TimestepValues) else 0.0)
    area = integral.CellData["Area"].GetRange()[0]
    simple.Delete(integral)
    return area


class Reader(unittest.TestCase):
    def tearDown(self):
        for source in list(simple.GetSources().values()):
            simple.Delete(source)

    def assert_is(self, block, other):
        """To the bit."""
        found = surface_of(block)
        np.testing.assert_array_equal(found.triangles, other.triangles)
        np.testing.assert_array_equal(found.points, other.points)

    def test_the_package_is_that_of_the_zip(self):
        self.assertEqual(pathlib.Path(pentimento.__file__).parents[1], DATA / "pentimento_paraview")

    def test_slices_of_a_run_are_those_of_pent_slice_at_every_time(self):
        reader = opened(DATA / "run")
        times = list(reader.TimestepValues)
        np.testing.assert_allclose(times, np.arange(9) / 30, atol=1e-12)
        for frame, time in enumerate(times):
            found = blocks(reader, time)
            self.assertEqual(set(found), {"high", "low"})
            for name, block in found.items():
                made = sliced(DATA / "run", name, frame)
                self.assert_is(block, made)
                self.assertAlmostEqual(surface_of(block).area, made.area, delta=1e-12)
                self.assertAlmostEqual(surface_of(block).volume, made.volume, delta=1e-12)

    def test_the_slider_goes_from_end_to_end_and_begins_in_the_middle(self):
        reader = opened(DATA / "run")
        self.assertEqual(reader.Offset, 0.5)
        domain = reader.GetProperty("Offset").SMProperty.FindDomain("vtkSMDoubleRangeDomain")
        self.assertEqual((domain.GetMinimum(0), domain.GetMaximum(0)), (0, 1))

    def test_turned_slices_are_those_of_pent_slice(self):
        reader = opened(DATA / "run")
        reader.Offset, reader.xw, reader.zw, reader.yz = 0.3, 40, 12.5, -30
        rotate = ["zw:12.5", "yz:-30", "xw:40"]  # in the order of the page, whatever was set first
        for name, block in blocks(reader, 5 / 30).items():
            made = sliced(DATA / "run", name, 5, w=0.3, rotate=rotate)
            self.assertGreater(len(made.triangles), 0)
            self.assert_is(block, made)

    def test_a_tesseract_has_the_slices_of_a_tesseract(self):
        reader = opened(DATA / "tesseract.pent")
        self.assertEqual(len(reader.TimestepValues), 0)
        found = surface_of(blocks(reader)["tesseract"])
        self.assertAlmostEqual(found.volume, 1, places=12)
        self.assertAlmostEqual(area_by_paraview(reader), 6, places=9)
        reader.xw, reader.Offset = 45, host_runs.TILTED["offset"]
        found = surface_of(blocks(reader)["tesseract"])
        self.assertAlmostEqual(found.volume, host_runs.TILTED_VOLUME, places=12)
        self.assertAlmostEqual(found.area, host_runs.TILTED_AREA, places=12)
        self.assertAlmostEqual(area_by_paraview(reader), host_runs.TILTED_AREA, places=9)
        reader.Offset = 9
        self.assertEqual(blocks(reader)["tesseract"].GetNumberOfCells(), 0)

    def test_arrays_are_those_of_pent_slice(self):
        reader = opened(DATA / "run")
        found = blocks(reader, 4 / 30)
        for number, name in enumerate(("high", "low")):
            attributes = surface_of(found[name]).attributes
            self.assertTrue((attributes["body"] == number).all())
            for quantity in ("w", "speed", "strain", "force"):
                made = sliced(DATA / "run", name, 4, color=quantity).attributes[quantity]
                np.testing.assert_allclose(attributes[quantity], made, rtol=1e-14, atol=1e-15)

    def test_smooth_normals_are_those_of_the_body_with_its_edges(self):
        reader = opened(DATA / "run")
        reader.Smooth, reader.yw = 1, 20
        made = pentimento.View(DATA / "run").slice("low", 5, {"yw": 20}, 0.5, shading=True)
        found = surface_of(blocks(reader, 5 / 30)["low"])
        corners = found.triangles.ravel()
        # Normals that differ by less than 1e-4 are one.
        normals = found.attributes["Normals"][corners].reshape(-1, 3, 3)
        np.testing.assert_allclose(normals, made.normals, atol=2e-4)
        np.testing.assert_array_equal(found.points[corners], made.points[made.triangles.ravel()])
        self.assertGreater(len(found.points), len(made.points))
        self.assertEqual(found.volume, made.volume)
        reader.Offset = 9
        self.assertEqual(blocks(reader, 0)["low"].GetNumberOfCells(), 0)

    def test_three_dimensional_runs_are_shown_whole(self):
        reader = opened(DATA / "solid")
        reader.Offset, reader.xw = 7, 20
        for name, block in blocks(reader, 3 / 30).items():
            self.assert_is(block, sliced(DATA / "solid", name, 3))

    def test_two_runs_have_a_hyperplane_each(self):
        first, second = opened(DATA / "run"), opened(DATA / "run" / "scene.toml")
        second.Offset = 0.7
        self.assert_is(blocks(first, 0.1)["low"], sliced(DATA / "run", "low", 3, w=0.5))
        self.assert_is(blocks(second, 0.1)["low"], sliced(DATA / "run", "low", 3, w=0.7))
        self.assert_is(blocks(first, 0.2)["low"], sliced(DATA / "run", "low", 6, w=0.5))

    def test_scenes_and_meshes_open_by_their_endings(self):
        run = simple.OpenDataFile(str(DATA / "run" / "scene.toml"))
        self.assertEqual(set(blocks(run)), {"high", "low"})
        mesh = simple.OpenDataFile(str(DATA / "tesseract.pent"))
        self.assertEqual(set(blocks(mesh)), {"tesseract"})

    def test_a_file_that_changed_is_read_again(self):
        reader = opened(DATA / "run")
        blocks(reader)
        reader.FileName = str(DATA / "tesseract.pent")
        self.assertEqual(set(blocks(reader)), {"tesseract"})

    def test_where_frames_are_missing_the_one_before_stays(self):
        shutil.copytree(DATA / "run", DATA / "gaps")
        (DATA / "gaps" / "frames" / "low_000004.pent").unlink()
        reader = opened(DATA / "gaps")
        self.assertEqual(len(reader.TimestepValues), 8)
        self.assert_is(blocks(reader, 4.5 / 30)["high"], sliced(DATA / "run", "high", 3))
        self.assert_is(blocks(reader, 5 / 30)["high"], sliced(DATA / "run", "high", 5))
        self.assert_is(blocks(reader, 99)["high"], sliced(DATA / "run", "high", 8))
        name = "low_000004.pent"
        shutil.copy(DATA / "run" / "frames" / name, DATA / "gaps" / "frames" / name)
        simple.ReloadFiles(reader)
        self.assert_is(blocks(reader, 4 / 30)["high"], sliced(DATA / "run", "high", 4))

    def test_names_that_are_not_utf_8_do_not_end_paraview(self):
        shutil.copytree(DATA / "run", DATA / "latin")
        latin = os.fsdecode(b"l\xf6w")
        for file in [*(DATA / "latin").glob("meshes/low*"), *(DATA / "latin").glob("frames/low*")]:
            file.rename(file.with_name(file.name.replace("low", latin)))
        reader = opened(DATA / "latin")
        found = blocks(reader, 3 / 30)
        self.assertEqual(set(found), {"high", "l?w"})
        self.assert_is(found["l?w"], sliced(DATA / "run", "low", 3))
        frames = DATA / "latin" / "frames"
        shutil.copy(frames / "high_000004.pent", frames / f"{latin}_000004.pent")
        found, lines = self.told(lambda: blocks(reader, 4 / 30))
        self.assertEqual(found, {})
        self.assertTrue(lines)
        self.assertTrue(all("l?w_000004.pent: is a frame of another" in x for x in lines), lines)

    def test_what_cannot_be_read_gives_nothing_and_a_line(self):
        (DATA / "cut.pent").write_bytes((DATA / "tesseract.pent").read_bytes()[:-40])
        (DATA / "noise.pent").write_bytes(os.urandom(999))
        (DATA / "empty").mkdir()
        for name, said in {
            "nowhere.pent": "expected the folder of a run",
            "empty": "expected the folder of a run",
            "cut.pent": "the file is truncated",
            "noise.pent": "is this a .pent file?",
            "flat.pent": "2 dimensions",
            "run/frames/low_000002.pent": "this is a frame of the mesh low.pent",
        }.items():
            reader, lines = self.told(lambda: opened(DATA / name), lambda one: blocks(one))
            self.assertTrue(lines, name)
            for line in lines:
                self.assertIn("pentimento: ", line)
                self.assertIn(said, line)
            self.assertEqual(blocks(reader), {})

    def test_a_damaged_frame_gives_nothing_and_the_next_is_there(self):
        shutil.copytree(DATA / "run", DATA / "damaged")
        frame = DATA / "damaged" / "frames" / "low_000003.pent"
        whole = frame.read_bytes()
        random = np.random.default_rng(5)
        reader = opened(DATA / "damaged")
        for _ in range(20):
            frame.write_bytes(whole[: random.integers(1, len(whole))])
            blocks(reader, 0.0)
            found, lines = self.told(lambda: blocks(reader, 3 / 30))
            self.assertEqual(found, {})
            self.assertTrue(lines)
            self.assertTrue(all("low_000003.pent: " in line for line in lines), lines)
        self.assert_is(blocks(reader, 4 / 30)["low"], sliced(DATA / "run", "low", 4))

    def told(self, *calls):
        """What the first gives, which the others are called with, and what went to stderr."""
        sys.stderr.flush()
        kept, (out, into) = os.dup(2), os.pipe()
        os.dup2(into, 2)
        try:
            found = calls[0]()
            for call in calls[1:]:
                call(found)
        finally:
            sys.stderr.flush()
            os.dup2(kept, 2)
            os.close(into)
            os.close(kept)
        with os.fdopen(out, errors="replace") as said:
            lines = [line for line in said.read().splitlines() if line.strip()]
        return found, lines

    def test_scrubbing_ends_where_it_ends_in_constant_memory(self):
        def resident():
            pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
            return pages * os.sysconf("SC_PAGE_SIZE") / 2**20

        reader = opened(DATA / "run")
        times = np.random.default_rng(3).permutation(np.tile(np.arange(9) / 30, 60))
        for time in times[:140]:
            reader.UpdatePipeline(time)
        before = resident()
        for time in times[140:]:
            reader.UpdatePipeline(time)
        # 400 frames of two bodies would be 6 MB, and their slices more.
        self.assertLess(resident() - before, 3, "MB more")
        frame = round(times[-1] * 30)
        self.assert_is(blocks(reader, times[-1])["low"], sliced(DATA / "run", "low", frame))

    @unittest.skipUnless("DISPLAY" in os.environ, "no display and no xvfb-run to draw with")
    def test_a_picture_shows_the_slice_of_its_time(self):
        reader = opened(DATA / "run")
        view = simple.CreateRenderView(ViewSize=[60, 60], Background=[0, 0, 0])
        view.UseColorPaletteForBackground = 0
        view.CameraParallelProjection = 1
        view.CameraPosition, view.CameraFocalPoint = [0.5, 1, 9], [0.5, 1, 0]
        view.CameraViewUp, view.CameraParallelScale = [0, 1, 0], 1.5  # 3 m high
        view.OrientationAxesVisibility = 0
        simple.Show(reader, view)
        for frame in (0, 8):
            view.ViewTime = frame / 30
            path = str(DATA / f"picture{frame}.png")
            simple.SaveScreenshot(path, view, ImageResolution=[60, 60])
            pixels = pentimento.Image(pathlib.Path(path).read_bytes()).array.max(axis=2)
            rows = np.nonzero(pixels.max(axis=1) > 40)[0]
            top = 2.5 - rows.min() * 3 / 60
            made = sliced(DATA / "run", "high", frame)
            self.assertLess(abs(top - made.points[:, 1].max()), 0.1)  # two rows
        simple.Delete(view)


if __name__ == "__main__":
    program = unittest.main(argv=["in_paraview", *REST], exit=False, verbosity=2)
    for test, reason in program.result.skipped:
        print(f"SKIPPED: {test.id()}: {reason}")
    sys.exit(not program.result.wasSuccessful())
