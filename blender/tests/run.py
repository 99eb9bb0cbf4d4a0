"""Runs the tests of the add-on in Blender, or says loudly that it cannot: 77 then, which ctest
takes for skipped.

run.py [ARGUMENTS FOR UNITTEST]
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PYTHON = HERE.parents[1] / "python"
sys.dont_write_bytecode = True
sys.path[:0] = [str(PYTHON), str(PYTHON / "tests")]

blender = shutil.which("blender")
if blender is None:
    print("SKIPPED: Blender is not installed, its add-on is not tested: scripts/setup.sh --hosts")
    sys.exit(77)

import host_runs  # noqa: E402
import host_zip  # noqa: E402

host_runs.use_built()
with tempfile.TemporaryDirectory(prefix="pentimento-blender-") as folder:
    host_runs.make(pathlib.Path(folder))
    packed = host_zip.pack("blender", pathlib.Path(folder, "dist"))
    environment = dict(os.environ, BLENDER_USER_RESOURCES=folder, BLENDER_USER_SCRIPTS=folder)
    words = [blender, "--background", "--factory-startup", "--python-exit-code", "1"]
    words += ["--python", str(HERE / "in_blender.py"), "--", str(packed), folder, *sys.argv[1:]]
    sys.exit(subprocess.run(words, env=environment).returncode)
