"""Calls drawn at random, right ones and wrong ones: an answer or an exception with a sentence.

PENTIMENTO_FUZZ_CALLS and PENTIMENTO_FUZZ_SEED change how many and which (docs/python.md).
"""

from __future__ import annotations

import gc
import math
import os
import random

import numpy as np
from conftest import box, two_boxes

import pentimento
from pentimento import BodyPoint, Error, Image, Mesh, Scene, Simulation, Surface

CALLS = int(os.environ.get("PENTIMENTO_FUZZ_CALLS", "2000"))
SEED = int(os.environ.get("PENTIMENTO_FUZZ_SEED", "22"))
EXPECTED = (Error, TypeError, ValueError, IndexError, StopIteration)


class Draw:
    """Arguments: mostly right, sometimes of every wrong kind."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.numbers = np.random.default_rng(seed)
        self.views: list[np.ndarray] = []  # which must stay what they are

    def one(self, *choices):
        return self.random.choice(choices)

    def rubbish(self):
        return self.one(
            None, "", "x", "a\0b", b"bytes", -1, 2**31, 2**63, 2**70, 1.5, math.nan, math.inf,
            -1e308, True, [], [[]], {}, object(), 1j, "\ud800", np.float32(1), np.zeros(0),
            np.zeros((2, 3)), np.array("x"), np.array([None]), [[1], [2, 3]], range(3),
            np.zeros((1, 1, 1), complex), lambda: 1,
        )  # fmt: skip

    def real(self):
        return self.one(0, 1, -1, 0.5, 1e-9, 1e3, 1e300, math.nan, math.inf, self.rubbish())

    def body(self, simulation):
        return self.one(0, 1, 2, "low", "high", "new", -1, 99, self.rubbish())

    def array(self, *shape):
        """Of this shape or nearly, of one or another type, contiguous or not."""
        kind = self.random.random()
        if kind < 0.08:
            return self.rubbish()
        if kind < 0.16:
            shape = tuple(side + self.one(-1, 1) if side else side for side in shape)
        made = self.numbers.uniform(-1, 1, [max(side, 0) for side in shape])
        if kind > 0.9:
            made.ravel()[: 1 + made.size // 3] = self.one(math.nan, math.inf, 1e300, 1e160)
        if kind > 0.8:
            made = np.asfortranarray(made)
        elif kind > 0.7:
            made = np.repeat(made, 2, axis=-1)[..., ::2]
        if kind < 0.3:
            return made.tolist()
        with np.errstate(all="ignore"):  # what does not fit becomes rubbish, as it may
            return made.astype(self.one("f8", "f8", "f4", "i4", "f2", ">f8"), copy=False)

    def rotations(self):
        plane = self.one("xw", "yz", "ww", "xv", "x", self.rubbish())
        try:
            turn = self.one(f"{plane}:{self.real()}", {plane: self.real()})
        except TypeError:  # not hashable
            turn = plane
        return self.one(None, "xw:30", {"zw": self.real()}, [turn], turn, ["xy:1", "xw:nan"])

    def vertices(self):
        count = self.one(0, 1, 3, 16)
        good = self.numbers.permutation(16)[:count]
        near = good + self.one(0, 1, 9)
        wrong = self.one(-good, good * 1.0, self.rubbish())
        return self.one(good, good.tolist(), near, good.astype("i1"), wrong)

    def kept(self, view):
        self.views.append(view)
        if len(self.views) > 200:
            del self.views[:100]
        return view


def calls(draw: Draw, simulation: Simulation, mesh: Mesh, states: list, grabs: list):
    s, d = simulation, simulation.dimension
    body = draw.body(s)
    n = 16 if d == 4 else 8
    weights = draw.one([1] + [0] * d, [0.5, 0.5] + [0] * (d - 1), draw.array(d + 1))
    point = BodyPoint(draw.one(0, 1, 5), draw.one(0, 3, 99, -1), weights)
    point = draw.one(point, point, draw.rubbish())
    pull = {"damping": draw.real(), "max_force": draw.one(None, draw.real())}
    place = {"translate": draw.array(d)}
    cells = draw.one([range(d + 1)], draw.array(2, d + 1), draw.rubbish())
    return [
        lambda: s.step(draw.one(1, 1, 1, 2, 0, -1, 1.5, 2**70, None, "x")),
        lambda: next(s.iterate(draw.one(None, 1, draw.rubbish()))),
        lambda: draw.kept(s.positions(body)),
        lambda: draw.kept(s.velocities(body)),
        lambda: draw.kept(s.forces(body)),
        lambda: draw.kept(s.rest_positions(body)),
        lambda: draw.kept(s.masses(body)),
        lambda: draw.kept(s.cells(body)),
        lambda: draw.kept(s.boundary(body)),
        lambda: (s.bodies, s.time, s.time_step, s.obstacle_count, repr(s)),
        lambda: s.is_asleep(body),
        lambda: s.slice(body, draw.array(4), draw.real()),
        lambda: s.pick(draw.array(d), draw.array(d), draw.one(None, draw.array(d)), draw.real()),
        lambda: s.contacts(),
        lambda: s.energies(),
        lambda: s.set_targets(body, draw.vertices(), draw.array(draw.one(1, 3, 16), d)),
        lambda: s.release(body, draw.vertices()),
        lambda: grabs.append(s.add_grab(point, draw.array(d), draw.real(), **pull)),
        lambda: draw.one(*grabs).move(draw.array(d)),
        lambda: draw.one(*grabs).remove(),
        lambda: s._move_grab(draw.rubbish(), draw.array(d)),
        lambda: s.set_forces(body, draw.one(None, draw.array(n, d))),
        lambda: s.set_gravity(draw.array(d)),
        lambda: s.set_state(body, draw.array(n, d), draw.array(n, d)),
        lambda: states.append(s.save()),
        lambda: s.restore(draw.one(*states)),
        lambda: s.restore(draw.rubbish()),
        lambda: states.pop(),
        lambda: s.add_body(draw.one("new", "low", draw.rubbish()), mesh, place=place),
        lambda: s.add_body("new", draw.rubbish()),
        lambda: s.add_body("new", mesh, place={"translate": [9.0] * d}),
        lambda: s.remove_body(draw.one(2, "new", 0, draw.rubbish())),
        lambda: s.add_obstacle(half_space={"normal": draw.array(d), "offset": draw.real()}),
        lambda: s.remove_obstacle(draw.one(1, draw.rubbish())),
        lambda: draw.kept(Mesh(draw.array(6, d), cells).points),
        lambda: draw.kept(mesh.points),
        lambda: mesh.slice(draw.array(4), draw.real(), draw.one(None, draw.array(n, d))),
        lambda: mesh.slice(
            draw.one(None, draw.array(4)), draw.real(), draw.one(None, draw.array(n, d)),
            rotate=draw.rotations(), shading=draw.one(True, False),
        ),
        lambda: mesh.strain(draw.array(n, d)),
        lambda: Surface(
            np.zeros((3, 3)), np.zeros((1, 3)), attributes={q: draw.array(3) for q in ("w", "body")}
        ).colors(draw.one("w", "body", "speed", draw.rubbish()), draw.real(), draw.real()),
        lambda: Mesh.read(draw.rubbish()),
        lambda: Scene.from_text(draw.rubbish()),
        lambda: Scene({"scene": {draw.one("gravity", "frames", "x"): draw.rubbish()}}),
        lambda: Image(draw.one(b"", b"\x89PNG\r\n\x1a\n" + bytes(99))).array,
        lambda: s.close() if draw.random.random() < 0.05 else None,
    ]


def test_calls_drawn_at_random_answer_or_raise_a_sentence():
    draw = Draw(SEED)
    meshes = {3: Mesh(*box(3)), 4: Mesh(*box(4))}
    scenes = [two_boxes(meshes[3]), two_boxes(meshes[4], integrator="bdf2"), two_boxes(meshes[4])]
    simulation: Simulation | None = None
    answered = refused = 0
    for number in range(CALLS):
        if number % 100 == 0:
            scene = draw.one(*scenes)
            simulation = scene.simulate(threads=draw.one(1, 2))
            mesh, states, grabs = meshes[scene.dimension], [], []
        call = draw.one(*calls(draw, simulation, mesh, states, grabs))
        try:
            call()
            answered += 1
        except EXPECTED as error:
            refused += 1
            said = str(error)
            assert "\n" not in said, said
            assert said or isinstance(error, (StopIteration, IndexError)), repr(error)
        for view in draw.views[-3:]:
            view.sum()
    gc.collect()
    for view in draw.views:  # of simulations closed, reshaped and gone
        view.sum()
    assert answered > CALLS / 4 and refused > CALLS / 10
    with pentimento.Simulation(scenes[0], threads=1) as fresh:
        assert fresh.step().step == 1
