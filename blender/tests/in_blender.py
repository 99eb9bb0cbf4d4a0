"""The tests of the add-on in Blender, which run.py starts: addon_*.py."""

import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import bpy  # noqa: E402
from addon_case import REST, ZIP  # noqa: E402

bpy.ops.preferences.addon_install(filepath=ZIP)
bpy.ops.preferences.addon_enable(module="pentimento_slices")
words = ["in_blender", "discover", "-s", str(HERE), "-p", "addon_*.py", *REST]
program = unittest.main(module=None, argv=words, exit=False, verbosity=2)
for test, reason in program.result.skipped:
    print(f"SKIPPED: {test.id()}: {reason}")
sys.stdout.flush()
if not program.result.wasSuccessful():
    raise SystemExit(1)
