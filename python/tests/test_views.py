"""Views are the library's memory, and nothing that happens to their owner harms them."""

import ctypes
import gc
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import box, two_boxes

from pentimento import Mesh
from pentimento._library import library


def test_views_are_where_the_library_has_its_arrays(simulation):
    number = simulation._number
    for name in ("positions", "velocities", "forces", "rest_positions", "masses", "cells"):
        seen = getattr(simulation, name)("high")
        assert seen.ctypes.data == getattr(library(), f"pent_{name}")(number, 1), name
    count = ctypes.c_int64()
    address = library().pent_boundary(number, 1, ctypes.byref(count))
    assert simulation.boundary("high").ctypes.data == address


def test_views_show_the_state_of_the_time_and_keep_their_place(simulation):
    positions = simulation.positions()
    address = positions.ctypes.data
    before = positions.copy()
    state = simulation.save()
    simulation.step(5)
    assert simulation.positions().ctypes.data == address
    assert not np.array_equal(positions, before)
    simulation.set_state(0, positions + 0.01, simulation.velocities())
    assert simulation.positions().ctypes.data == address
    simulation.restore(state)
    np.testing.assert_array_equal(positions, before)


def test_nobody_writes_into_a_view(simulation, tesseract):
    for seen in (simulation.positions(), simulation.cells(), tesseract.points, tesseract.cells):
        with pytest.raises(ValueError, match="read-only"):
            seen[0] = 0
        with pytest.raises(ValueError, match="WRITEABLE"):
            seen.flags.writeable = True


def test_views_outlive_the_simulation(scene):
    simulation = scene.simulate(threads=1)
    simulation.step()
    seen = [simulation.positions()[1:, 0], simulation.cells()]
    seen += [simulation.boundary(), simulation.masses()]
    kept = [array.copy() for array in seen]
    simulation.close()
    del simulation
    gc.collect()
    hungry = [np.ones(1000) for _ in range(1000)]  # takes what has been freed
    for array, copy in zip(seen, kept):
        np.testing.assert_array_equal(array, copy)
    del hungry


def test_views_outlive_bodies_that_come_and_go(simulation, tesseract):
    old = simulation.positions("high")
    boundary = simulation.boundary("high")
    last = old.copy()
    simulation.remove_body("low")
    simulation.step(3)
    np.testing.assert_array_equal(old, last)
    assert boundary.max() < 16
    assert simulation.positions("high").ctypes.data != old.ctypes.data
    assert simulation.positions("high")[0, 1] < old[0, 1]
    newer = simulation.positions("high")
    simulation.add_body("third", tesseract, place={"translate": [0, 5, 0, 0]})
    simulation.add_obstacle(ball={"center": [9, 0, 0, 0], "radius": 1})
    simulation.remove_obstacle(1)
    assert np.isfinite(newer).all() and np.isfinite(old).all()


def test_views_of_a_mesh_outlive_it():
    mesh = Mesh(*box(4, 2), regions=np.arange(16 * 24) % 3)
    seen = [mesh.points, mesh.cells, mesh.boundary(), mesh.regions]
    kept = [array.copy() for array in seen]
    del mesh
    gc.collect()
    for array, copy in zip(seen, kept):
        np.testing.assert_array_equal(array, copy)


def test_memory_goes_with_the_last_view(cube):
    scene = two_boxes(cube)
    simulation = scene.simulate(threads=1)
    seen = simulation.positions()
    handle = simulation._kept
    simulation.close()
    assert handle.is_alive
    del handle
    owner = seen.base.owner
    assert owner.is_alive
    finalizer = owner._free
    del owner, seen
    gc.collect()
    assert not finalizer.alive


def test_any_number_of_threads_looks_at_one_mesh():
    mesh = Mesh(*box(4, 3))
    heights = np.linspace(0.05, 0.95, 40)
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda height: mesh.slice(offset=height).volume, heights))
    np.testing.assert_allclose(found, 1, atol=1e-12)
