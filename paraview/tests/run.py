"""Runs the tests of the reader in ParaView, or says loudly that it cannot: 77 then, which ctest
takes for skipped.

run.py [ARGUMENTS FOR UNITTEST]
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
PYTHON = HERE.parents[1] / "python"
sys.dont_write_bytecode = True
sys.path[:0] = [str(PYTHON), str(PYTHON / "tests")]

pvpython = shutil.which("pvpython")
if pvpython is None:
    print("SKIPPED: ParaView is not installed, its reader is not tested: scripts/setup.sh --hosts")
    sys.exit(77)

import host_runs  # noqa: E402
import host_zip  # noqa: E402

host_runs.use_built()
with tempfile.TemporaryDirectory(prefix="pentimento-paraview-") as folder:
    host_runs.make(pathlib.Path(folder))
    packed = host_zip.pack("paraview", pathlib.Path(folder, "dist"))
    with zipfile.ZipFile(packed) as archive:
        archive.extractall(folder)
    # The library of the zip, and the programs of the build to compare with.
    environment = dict(os.environ)
    environment.pop("PENTIMENTO_LIBRARY", None)
    words = [pvpython, "--force-offscreen-rendering", str(HERE / "in_paraview.py"), folder]
    if shutil.which("xvfb-run"):  # Debian's ParaView draws with X alone
        server = "--server-args=-screen 0 640x480x24 -noreset"
        words = ["xvfb-run", "--auto-servernum", server, *words]
    sys.exit(subprocess.run([*words, *sys.argv[1:]], env=environment).returncode)
