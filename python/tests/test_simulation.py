"""Simulations: what pent-sim does, and what a host does besides."""

import copy
import gc
import pickle
import threading

import numpy as np
import pytest
from conftest import two_boxes

import pentimento
from pentimento import BodyPoint, Error


@pytest.mark.parametrize("integrator", ["linear_euler", "newton_euler", "bdf2"])
@pytest.mark.parametrize("dimension", [3, 4])
def test_steps_give_the_frames_of_pent_sim_to_the_bit(
    tmp_path, cube, tesseract, dimension, integrator
):
    scene = two_boxes(cube if dimension == 3 else tesseract, integrator=integrator)
    run = scene.run(tmp_path / "run", threads=1)
    assert run.report["verdict"] == "finished"
    with scene.simulate(threads=3) as simulation:
        for number in run.frames:
            if number > 0:
                simulation.step(scene.steps_per_frame)
            for body in scene.bodies:
                frame = run.frame(number, body)
                np.testing.assert_array_equal(simulation.positions(body), frame.positions)
                np.testing.assert_array_equal(simulation.velocities(body), frame.velocities)
                assert simulation.time == pytest.approx(frame.time, rel=1e-15)


def test_a_report_says_what_happened(simulation):
    reports = list(simulation.iterate(4))
    assert [report.step for report in reports] == [1, 2, 3, 4]
    assert reports[-1].time == pytest.approx(4 * simulation.time_step)
    assert reports[-1].unknowns == 2 * 16 * 4
    assert reports[-1].obstacle > 0


def test_targets_are_reached_and_held(simulation):
    vertices = [3, 1]
    targets = simulation.positions()[vertices] + 0.01
    simulation.set_targets("low", vertices, targets)
    simulation.step(2)
    np.testing.assert_array_equal(simulation.positions()[vertices], targets)
    simulation.release(0, vertices)
    simulation.step()
    assert not np.array_equal(simulation.positions()[vertices], targets)


def test_a_grab_pulls_what_was_picked(scene):
    def height(pull: bool) -> float:
        with scene.simulate(threads=1) as simulation:
            hit = simulation.pick([0.5, 0.5, -3, 0.5], [0, 0, 1, 0])
            assert hit is not None and hit.point.body == 0 and hit.distance == pytest.approx(3)
            np.testing.assert_allclose(hit.place, [0.5, 0.5, 0, 0.5], atol=1e-12)
            if pull:
                grab = simulation.add_grab(hit, hit.place, 1e5, damping=10)
                grab.move(hit.place + [0, 1, 0, 0])
                simulation.step(4)
                top = simulation.positions()[:, 1].mean()
                grab.remove()
                with pytest.raises(Error, match="there is no grab"):
                    grab.remove()
                return float(top)
            simulation.step(4)
            return float(simulation.positions()[:, 1].mean())

    assert height(True) > height(False) + 0.01


def test_forces_and_gravity_move_a_free_body(scene):
    with scene.simulate(threads=1) as simulation:
        simulation.set_gravity([0, 0, 0, 0])
        masses = simulation.masses("high")
        forces = np.outer(masses, [0, 6.0, 0, 0])
        simulation.set_forces("high", forces)
        before = simulation.velocities("high").copy()
        simulation.step(3)
        gained = simulation.velocities("high") - before
        # An equal push on every kilogram: all go the same way, to the tolerance of the solver.
        np.testing.assert_allclose(gained[:, 1], 6.0 * simulation.time, rtol=1e-3)
        simulation.set_forces("high", None)
        before = simulation.velocities("high").copy()
        simulation.step()
        np.testing.assert_allclose(simulation.velocities("high"), before, atol=1e-3)


def test_a_saved_state_goes_on_to_the_bit(scene):
    with scene.simulate(threads=1) as one, scene.simulate(threads=2) as two:
        one.step(3)
        two.restore(one.save())
        assert one.time == two.time
        one.step(4)
        two.step(4)
        for body in scene.bodies:
            np.testing.assert_array_equal(one.positions(body), two.positions(body))
            np.testing.assert_array_equal(one.velocities(body), two.velocities(body))


@pytest.mark.parametrize("integrator", ["linear_euler", "bdf2"])
@pytest.mark.parametrize("dimension", [3, 4])
def test_a_state_goes_on_with_another_stiffness_but_no_other_time_step(
    cube, tesseract, dimension, integrator
):
    mesh = cube if dimension == 3 else tesseract
    falling = [0.0, -9.0, *[0.0] * (dimension - 2)]

    def thrown(steps: int, young: float) -> pentimento.Simulation:
        scene = pentimento.SceneBuilder(dimension=dimension, gravity=falling, steps_per_frame=steps)
        scene.body("a", mesh, material={"young": young}).solver(integrator=integrator)
        return scene.build().simulate(threads=1)

    with thrown(2, 1e4) as one, thrown(2, 3e5) as two, thrown(5, 1e4) as other:
        one.step(4)
        two.restore(one.save())
        assert two.time == one.time
        np.testing.assert_array_equal(two.positions(), one.positions())
        np.testing.assert_array_equal(two.velocities(), one.velocities())
        # The clock of the third would leap, and BDF2 would take a past of longer steps for its own.
        with pytest.raises(Error, match="of 0.0166666667 s; this one has steps of 0.00666666667 s"):
            other.restore(one.save())
        assert other.time == 0 and (other.velocities() == 0).all()
        other.set_state(0, one.positions(), one.velocities())
        for going, before in ((two, 0.0), (other, one.time)):
            for _ in range(5):  # the center falls by either rule, whatever the step and stiffness
                going.step()
                center = going.masses() @ going.velocities() / going.masses().sum()
                fallen = (before + going.time) * np.array(falling)
                # To what the linear solver leaves over, in single precision.
                np.testing.assert_allclose(center, fallen, atol=1e-5)


def test_a_state_is_of_its_process_and_its_copies_are_the_same(simulation):
    # As a number it would be another state in another process.
    simulation.step(3)
    then = simulation.positions("high").copy()
    state = simulation.save()
    with pytest.raises(TypeError, match="cannot be pickled: it is in the memory of this process"):
        pickle.dumps({"saved": state})
    copies = [copy.copy(state), copy.deepcopy({"saved": state})["saved"]]
    simulation.step(2)
    for kept in copies:
        simulation.restore(kept)
        np.testing.assert_array_equal(simulation.positions("high"), then)
        simulation.step()
    del copies, kept
    gc.collect()
    simulation.restore(state)
    np.testing.assert_array_equal(simulation.positions("high"), then)


def test_contacts_and_energies_are_those_of_the_moment(simulation):
    simulation.step(10)
    contacts = simulation.contacts()
    on_ground = contacts[contacts["is_obstacle"] == 1]
    assert len(on_ground) > 0 and (on_ground["force"][:, 1] > 0).all()
    energies = {part.name: part for part in simulation.energies()}
    assert energies["kinetic"].energy > 0 and energies["kinetic"].is_stored
    velocities = simulation.velocities("low"), simulation.velocities("high")
    masses = simulation.masses("low"), simulation.masses("high")
    kinetic = sum(0.5 * m @ (v**2).sum(axis=1) for m, v in zip(masses, velocities))
    assert energies["kinetic"].energy == pytest.approx(kinetic, rel=1e-12)


def test_slices_are_those_of_the_mesh_where_the_vertices_are(simulation, tesseract):
    simulation.step(3)
    for body in ("low", "high"):
        own = simulation.slice(body, (0.1, 0.2, 0.3, 1), 0.5)
        same = tesseract.slice((0.1, 0.2, 0.3, 1), 0.5, simulation.positions(body))
        assert len(own.triangles) > 0
        np.testing.assert_array_equal(own.points, same.points)
        np.testing.assert_array_equal(own.triangles, same.triangles)


def test_bodies_come_and_go(simulation, tesseract):
    assert simulation.bodies == ("low", "high")
    place = {"translate": [0, 5, 0, 0]}
    simulation.add_body("third", tesseract, place=place, velocity=[1, 0, 0, 0])
    assert simulation.bodies == ("low", "high", "third")
    simulation.step()
    np.testing.assert_allclose(simulation.velocities("third")[:, 0], 1, atol=1e-4)  # of the solver
    simulation.remove_body("low")
    assert simulation.bodies == ("high", "third")
    simulation.add_obstacle(ball={"center": [0, -9, 0, 0], "radius": 1})
    assert simulation.obstacle_count == 2
    simulation.remove_obstacle(0)
    simulation.step()


def test_a_held_body_without_motion_sleeps(tesseract):
    scene = (
        pentimento.SceneBuilder(gravity=[0, 0, 0, 0]).body("a", tesseract).table("sleep").build()
    )
    with scene.simulate(threads=1) as simulation:
        assert not simulation.is_asleep("a")
        simulation.step(60)
        assert simulation.is_asleep(0)


def test_nothing_works_after_the_end(scene):
    simulation = scene.simulate(threads=1)
    state = simulation.save()
    grab = simulation.add_grab(BodyPoint(0, 0, (1, 0, 0, 0, 0)), [0, 0, 0, 0], 10)
    simulation.close()
    simulation.close()  # is no harm
    with pytest.raises(Error, match="is closed"):
        simulation.step()
    for use in (
        lambda: simulation.time,
        lambda: simulation.bodies,
        lambda: simulation.positions(),
        lambda: simulation.cells("low"),
        lambda: simulation.contacts(),
        lambda: simulation.energies(),
        lambda: simulation.slice(),
        lambda: simulation.restore(state),
        lambda: simulation.save(),
        lambda: simulation.set_gravity([0, 0, 0, 0]),
        lambda: simulation.remove_body(0),
        lambda: grab.move([0, 0, 0, 0]),
        lambda: next(simulation.iterate()),
    ):
        with pytest.raises(Error, match="is closed"):
            use()
    assert repr(simulation) == "<pentimento.Simulation: closed>"


def test_what_is_in_memory_alone_says_so_and_all_else_is_pickled(simulation):
    for act in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="a simulation cannot be pickled or copied"):
            act(simulation)
    for one in (simulation.step(), simulation.energies(), simulation.slice("low")):
        assert type(pickle.loads(pickle.dumps(one))) is type(one)
    with pytest.raises(Error, match='no body is called "hihg"; there are low, high'):
        simulation.positions("hihg")


def test_two_threads_at_once_are_refused_or_take_turns(simulation):
    wrong = []
    refused = []

    def use():
        for _ in range(200):
            try:
                simulation.step()
                simulation.contacts()
                simulation.positions().sum()
            except Error as error:
                (refused if "another thread is using" in str(error) else wrong).append(str(error))

    threads = [threading.Thread(target=use) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong
    assert simulation.step().step > 100
