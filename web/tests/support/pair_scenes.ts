import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { writeMesh } from "../../src/format/write_pent.ts";
import type { SceneFiles } from "../../src/play/protocol.ts";
import { gridMesh } from "../../src/mesh/grid.ts";
import { native } from "./native.ts";
import { withFiles } from "./play.ts";

// Scenes in which features meet in pairs that the gallery does not have, small enough for steps of a millisecond. Each
// says its own solver; matrices are of doubles, as those of floats are rounded by each instruction set in its own way.

const kBar = gridMesh([3, 1, 1, 1], (p) => [0.6 * p[0], 0.2 * p[1], 0.2 * p[2], 0.2 * p[3]]);
const kCube = gridMesh([2, 2, 2, 2], (p) => [p[0] / 4, p[1] / 4, p[2] / 4, p[3] / 4]);

const kScene = "[scene]\ngravity = [0.5, -9.8, 0, -1]\nframes_per_second = 120\n";
const kFloor =
    "[[obstacle]]\nhalf_space = { normal = [0, 1, 0, 0.1], offset = 0 }\nstiffness = 2000\n";
const kContact = "[contact]\ndistance = 0.05\nstiffness = 500\nfriction = 0.4\nslip_speed = 0.01\n";
const kDamping = "[damping]\nstiffness = 0.005\nmass = 0.1\n";

function body(name: string, translate: string, more = "", material = ""): string {
    return (
        `[[body]]\nname = "${name}"\nmesh = "${name}.pent"\nplace = { translate = [${translate}] }\n` +
        `material = { young = 2e4, density = 100${material} }\n${more}`
    );
}

function solver(text: string): string {
    return `[solver]\nprecision = "double"\n${text}`;
}

const kRing =
    '[[attachment]]\nbody = "bar"\nselect = { half_space = { normal = [1, 0, 0, 0], offset = -0.5 } }\n';

const kScenes: Record<string, string> = {
    "bodies that are tied, one to a point that moves, on a floor with friction":
        kScene +
        body("bar", "0, 0.24, 0, 0") +
        body("cube", "0.7, 0.4, 0, 0") +
        `${kRing}stiffness = 400\ndamping = 2\nmotion = { translate = [-0.3, 0.8, 0, 0.4] }\n` +
        '[[attachment]]\nbody = "cube"\nselect = { half_space = { normal = [1, 0, 0, 0], offset = 0.46 } }\n' +
        'target = "bar"\nmax_distance = 0.5\nstiffness = 300\nbreak_force = 12\n' +
        kFloor +
        kContact +
        solver('linear = "direct"\n'),
    "a barrier with friction, a body that is thrown and spins, a ball that moves":
        kScene +
        body("bar", "0, 0.3, 0, 0") +
        body(
            "cube",
            "0.1, 0.83, 0.05, 0",
            'velocity = [0, -2, 0, 0.3]\nspin = [{ plane = "xw", degrees_per_s = 90 }]\n',
        ) +
        kFloor +
        "[[obstacle]]\nball = { center = [-1.1, 0.3, 0, 0], radius = 0.4 }\nstiffness = 2000\n" +
        "motion = { translate = [0.5, 0, 0, 0.1] }\n" +
        `${kContact}model = "barrier"\n` +
        solver('integrator = "newton_euler"\nnewton_tolerance = 1e-6\ntolerance = 1e-8\n'),
    "quadratic elements with a muscle, damping and friction on the ground":
        kScene +
        body("quadratic", "0, 0.19, 0, 0") +
        '[[activation]]\nbody = "quadratic"\nselect = "everything"\nstretch = 0.8\nfibers = "constant"\n' +
        'direction = [1, 0, 0, 0.3]\npreserves_volume = true\nsignal = "sine"\nfrequency = 4\n' +
        kFloor +
        kContact +
        kDamping +
        solver('elements = "quadratic"\nintegrator = "bdf2"\npreconditioner = "block-jacobi"\n'),
    "smoothed elements of two materials under pressure, held and turned in zw":
        kScene +
        body(
            "bar",
            "0, 0, 0, 0",
            '[[body.region]]\nname = "end"\nselect = { half_space = { normal = [-1, 0, 0, 0], offset = 0 } }\n' +
                'material = { model = "mooney-rivlin", young = 5e4, second_invariant = 0.3, density = 200 }\n',
        ) +
        '[[constraint]]\nbody = "bar"\nselect = { half_space = { normal = [1, 0, 0, 0], offset = -0.5 } }\n' +
        'motion = { keyframes = [{ time = 0.2, rotate = [{ plane = "zw", degrees = 60 }] }] }\n' +
        '[[load]]\nbody = "bar"\nselect = "everything"\npressure = 800\nforce = [0, 0, 20, 0]\n' +
        "keyframes = [{ time = 0, factor = 0 }, { time = 0.2, factor = 1 }]\n" +
        kDamping +
        solver('elements = "smoothed"\nintegrator = "newton_euler"\ntolerance = 1e-6\n'),
    "bodies of other materials that meet themselves and a box that turns":
        kScene +
        body("cube", "0.1, 0.75, 0, 0", "friction = 0.8\n", ', model = "arap"') +
        body("bar", "0, 1.25, 0.1, 0", "", ', model = "st-venant-kirchhoff"') +
        "[[obstacle]]\nbox = { center = [0, 0, 0, 0], sides = [1, 1, 1, 1] }\nstiffness = 2000\n" +
        'motion = { rotate = [{ plane = "xw", degrees_per_s = 40 }] }\n' +
        `${kContact}self = true\nfilter = "absolute"\n` +
        kDamping +
        solver(
            'filter = "absolute"\nintegrator = "newton_euler"\npreconditioner = "column-jacobi"\n',
        ),
    "the equilibrium of a bar that is held, bent by its weight and pushed against a bowl":
        kScene +
        body("bar", "0, 0.25, 0, 0") +
        '[[constraint]]\nbody = "bar"\nselect = { half_space = { normal = [1, 0, 0, 0], offset = -0.5 } }\n' +
        'motion = { translate = [0, -0.2, 0, 0.1], rotate = [{ plane = "xw", degrees_per_s = 30 }] }\n' +
        "[[obstacle]]\nbowl = { center = [0, 0.5, 0, 0], radius = 0.55 }\nstiffness = 500\n" +
        kContact.replace(/friction.*\n/, "") +
        solver('integrator = "quasistatic"\nnewton_tolerance = 1e-8\ntolerance = 1e-8\n'),
    "a body that falls asleep on another one that is held":
        kScene.replace("0.5, -9.8, 0, -1", "0, -9.8, 0, 0") +
        body("bar", "0, 0, 0, 0") +
        body("cube", "0, 0.48, 0, 0", "", ', model = "linear"') +
        '[[constraint]]\nbody = "bar"\nselect = "everything"\n' +
        kContact +
        "[damping]\nstiffness = 0.02\nmass = 20\n[sleep]\nspeed = 0.5\ntime = 0.02\n" +
        solver('preset = "balanced"\n'),
};

// Whose cells are children of quadratic ones; without pent-mesh there is none.
function quadraticBar(): [string, Uint8Array][] {
    const program = native("pent-mesh");
    const options = ["--box", "3,1,1,1", "--size", "1.2,0.4,0.4,0.4", "--quadratic", "--quiet"];
    return program
        ? withFiles(new Map(), (folder) => {
              const path = join(folder, "quadratic.pent");
              execFileSync(program, [...options, "-o", path]);
              return [["quadratic.pent", readFileSync(path)]];
          })
        : [];
}

/** Files of such scenes, by what is in them. */
export function pairScenes(): Map<string, SceneFiles> {
    const encoder = new TextEncoder();
    const meshes: [string, Uint8Array][] = [
        ["bar.pent", writeMesh(kBar)],
        ["cube.pent", writeMesh(kCube)],
        ...quadraticBar(),
    ];
    return new Map(
        Object.entries(kScenes).map(([name, text]) => [
            name,
            new Map([["scene.toml", encoder.encode(text)], ...meshes]),
        ]),
    );
}
