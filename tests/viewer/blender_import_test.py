"""Imports slices of pent-slice by scripts/blender_import.py into a stand-in for Blender that keeps count.

Usage: blender_import_test.py PENT_SLICE WRITE_RUN SCRIPTS_FOLDER
"""
import pathlib
import subprocess
import sys
import tempfile
from unittest.mock import MagicMock

sys.dont_write_bytecode = True


def main():
    pent_slice, write_run, scripts = sys.argv[1:4]
    sys.path.insert(0, scripts)
    import blender_import

    with tempfile.TemporaryDirectory() as folder:
        run, out = pathlib.Path(folder, "run"), pathlib.Path(folder, "out")
        subprocess.run([write_run, run], check=True)
        subprocess.run([pent_slice, run, "-o", out, "--quiet", "--w", "0.3,0.6"], check=True)
        (out / "unrelated_000000.ply").write_text("not ours")

        series = blender_import.read_series(out)
        assert len(series) % 2 == 0 and all("_s0" in name for name in series), series
        for name, slices in series.items():
            assert [frame for frame, _, _ in slices] == sorted({frame for frame, _, _ in slices})
            for frame, time, path in slices:
                assert path.is_file() and path.stem == f"{name}_{frame:06d}"
                assert abs(time - 0.1 * frame) < 1e-12  # write_run's frames are 0.1 s apart
            whole, base = blender_import.frames_per_second(slices)
            assert whole == int(whole) and abs(whole / base - (len(slices) - 1) / (slices[-1][1] - slices[0][1])) < 1e-9

        bpy = MagicMock()
        name = next(iter(series))
        assert blender_import.load(bpy, out, [name]) == len(series[name])
        paths = [call.kwargs["filepath"] for call in bpy.ops.wm.ply_import.call_args_list]
        assert paths == [str(path) for _, _, path in series[name]]
        try:
            blender_import.load(bpy, out, ["nobody"])
            raise AssertionError("an unknown series was taken")
        except SystemExit as error:
            assert "nobody" in str(error) and name in str(error)

        mesh = pathlib.Path(folder, "ü, b.pent")
        mesh.write_bytes(next(run.glob("meshes/*.pent")).read_bytes())
        subprocess.run([pent_slice, mesh, "-o", out, "--quiet"], check=True)
        (((_, _, path),),) = blender_import.read_series(out).values()
        assert path.is_file() and path.stem == f"{mesh.stem}_000000"
    print("imported", len(paths), "slices")


main()
