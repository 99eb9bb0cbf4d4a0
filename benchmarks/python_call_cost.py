"""What a call from Python costs over the library's own time, on the smallest body there is.

PYTHONPATH=python PENTIMENTO_LIBRARY=build/release/plugin/libpent_plugin.so python3 benchmarks/python_call_cost.py
"""

import statistics
import time

import numpy as np
import pentimento

cell = pentimento.Mesh(np.vstack([np.zeros(4), np.eye(4)]), [[0, 1, 2, 3, 4]])
scene = pentimento.SceneBuilder(gravity=[0, -9.8, 0, 0]).body("cell", cell).build()
with scene.simulate(threads=1) as simulation:
    simulation.step(1000)
    begin = time.perf_counter()
    own = sum(simulation.step().seconds for _ in range(20000))
    spent = time.perf_counter() - begin
    single = []
    for _ in range(20000):
        begin = time.perf_counter()
        report = simulation.step()
        single.append(time.perf_counter() - begin - report.seconds)
    begin = time.perf_counter()
    for _ in range(20000):
        simulation.positions()
    view = (time.perf_counter() - begin) / 20000
    print(f"step()      {1e6 * spent / 20000:6.2f} us a call, of which the library {1e6 * own / 20000:6.2f} us")
    print(f"beyond it   {1e6 * statistics.median(single):6.2f} us, median of single calls")
    print(f"positions() {1e6 * view:6.2f} us a view")
