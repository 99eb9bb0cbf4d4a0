"""The reader in docs/ gets the same numbers from binary, ascii and frame files as the library wrote."""
import importlib.util
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("numpy is not installed: skipped")
    sys.exit(77)

sys.dont_write_bytecode = True
spec = importlib.util.spec_from_file_location("read_pent", sys.argv[1])
module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)

with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.argv[2], folder], check=True)

    def path(name):
        return os.path.join(folder, name)

    positions = np.loadtxt(path("positions.txt"))
    cells = np.loadtxt(path("cells.txt"), dtype=int)
    for name in ("binary.pent", "ascii.pent"):
        comments, arrays = module.read_pent(path(name))
        assert comments["dimension"] == "4"
        vertex, pentachoron = arrays["vertex"], arrays["pentachoron"]
        assert (np.stack([vertex[axis] for axis in "xyzw"], axis=1) == positions).all()
        assert (np.stack([pentachoron["v%d" % k] for k in range(5)], axis=1) == cells).all()
        assert (vertex["column"] == 5).all() and (vertex["layer"] == 6).all()
        assert (pentachoron["region"] == 7).all()
    comments, arrays = module.read_pent(path("frame.pent"))
    assert comments["mesh"].startswith("binary.pent ") and float(comments["time"]) == 0.5
    assert (np.stack([arrays["vertex"]["v" + axis] for axis in "xyzw"], axis=1) == -positions).all()
print("1 passed, 0 failed")
