import type { Mesh } from "../format/mesh.ts";
import { writeMesh } from "../format/write_pent.ts";
import { gridMesh } from "../mesh/grid.ts";
import { toBall } from "../run/example.ts";
import octopusFile from "../../gallery/octopus.pent";
import type { SceneFiles } from "./protocol.ts";

export const kSceneName = "scene.toml";

const kFloor = `
[[obstacle]]
half_space = { normal = [0, 1, 0, 0], offset = 0 }
stiffness = 5000
`;

// Far along w, so that what falls that way comes to rest.
const kWalls = [1, -1]
    .map(
        (side) => `
[[obstacle]]
half_space = { normal = [0, 0, 0, ${side}], offset = -1.5 }
stiffness = 5000
`,
    )
    .join("");

const kSettings = `
[contact]
friction = 0.5
slip_speed = 0.01
distance = 0.04
stiffness = 3000

[damping]
stiffness = 0.01

[solver]
preset = "fast"
`;

function head(gravity = -9.8): string {
    return `[scene]\ngravity = [0, ${gravity}, 0, 0]\nframes_per_second = 60\n`;
}

function body(name: string, material: string, more = ""): string {
    return `\n[[body]]\nname = "${name}"\nmesh = "${name}.pent"\nmaterial = { ${material} }\n${more}`;
}

interface Parts {
    text: string;
    meshes: Record<string, Mesh | Uint8Array>; // or the bytes of a file
}

function octopus(): Parts {
    return {
        text:
            head() +
            body("octopus", "young = 3e4, density = 100") +
            kFloor.replace("offset = 0 ", "offset = -0.6 ") +
            kWalls +
            kSettings,
        meshes: { octopus: octopusFile },
    };
}

function jelly(): Parts {
    const place =
        'place = { rotate = [{ plane = "xy", degrees = 30 }, { plane = "zw", degrees = 20 }], ' +
        "translate = [0, 1.2, 0, 0] }\n";
    return {
        text:
            head() +
            body("jelly", "young = 1e4, density = 100", place) +
            kFloor +
            kWalls +
            kSettings,
        meshes: { jelly: gridMesh([3, 3, 3, 3], (p) => [p[0] / 2, p[1] / 2, p[2] / 2, p[3] / 2]) },
    };
}

function heap(): Parts {
    const at = (x: number, y: number, w: number) =>
        `place = { translate = [${x}, ${y}, 0, ${w}] }\n`;
    return {
        text:
            head() +
            body("slab", "young = 3e4, density = 100", at(0, 0.32, 0)) +
            body("ball", "young = 2e4, density = 100", at(0.12, 1.8, 0.06)) +
            body("crate", "young = 2e4, density = 100", at(-0.1, 1.02, -0.05)) +
            kFloor +
            kWalls +
            kSettings,
        meshes: {
            slab: gridMesh([3, 1, 3, 1], (p) => [0.8 * p[0], 0.3 * p[1], 0.8 * p[2], 0.5 * p[3]]),
            ball: gridMesh([2, 2, 2, 2], (p) => {
                const [x, y, z, w] = toBall(p);
                return [0.45 * x!, 0.45 * y!, 0.45 * z!, 0.45 * w!];
            }),
            crate: gridMesh([2, 2, 2, 2], (p) => [
                0.35 * p[0],
                0.35 * p[1],
                0.35 * p[2],
                0.35 * p[3],
            ]),
        },
    };
}

function bar(): Parts {
    const turns = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => {
        const degrees = i % 2 === 0 ? 60 : -60;
        return `{ rotate = [{ plane = "zw", degrees_per_s = ${degrees} }], from = ${3 * i}, to = ${3 * i + 3} }`;
    });
    const held = (x: number, motion: string) =>
        `\n[[constraint]]\nbody = "bar"\nselect = { half_space = { normal = [${x}, 0, 0, 0], ` +
        `offset = -1.45 } }\nmotion = ${motion}\n`;
    return {
        text:
            head(0) +
            body("bar", "young = 3e4, density = 100") +
            held(1, '"fixed"') +
            held(-1, `[${turns.join(", ")}]`) +
            '\n[damping]\nstiffness = 0.01\n\n[solver]\npreset = "fast"\n',
        meshes: {
            bar: gridMesh([10, 2, 2, 2], (p) => [1.5 * p[0], 0.4 * p[1], 0.4 * p[2], 0.4 * p[3]]),
        },
    };
}

function worm(): Parts {
    const muscle = (select: string, stretch: number, direction: string, phase: number) =>
        `\n[[activation]]\nbody = "worm"\nselect = ${select}\nstretch = ${stretch}\nfibers = "constant"\n` +
        `direction = ${direction}\nsignal = "sine"\nfrequency = 1.5\nphase = ${phase}\nwave = [0.5, 0, 0, 0]\n`;
    const below = "{ half_space = { normal = [0, 1, 0, 0], offset = 0.25 } }";
    return {
        text:
            head() +
            body(
                "worm",
                "young = 1e5, density = 200",
                "place = { translate = [0, 0.26, 0, 0] }\n",
            ) +
            muscle('"everything"', 0.6, "[1, 0, 0, 0]", 0) +
            muscle(below, 1.4, "[0, 1, 0, 0]", 0.5) +
            kFloor.replace("5000", "2e4") +
            kWalls +
            "\n[contact]\nfriction = 0.8\nslip_speed = 0.01\n\n[damping]\nstiffness = 0.005\n" +
            '\n[solver]\npreset = "fast"\n',
        meshes: {
            worm: gridMesh([12, 2, 2, 2], (p) => [
                1.3 * p[0],
                0.25 * p[1],
                0.25 * p[2],
                0.25 * p[3],
            ]),
        },
    };
}

const kMakers: Record<string, () => Parts> = { octopus, jelly, heap, bar, worm };

/** The scene file and the meshes of a scene of the gallery. */
export function galleryFiles(name: string): SceneFiles {
    const { text, meshes } = kMakers[name]!();
    const files: SceneFiles = new Map([[kSceneName, new TextEncoder().encode(text)]]);
    for (const [mesh, made] of Object.entries(meshes)) {
        files.set(`${mesh}.pent`, made instanceof Uint8Array ? made : writeMesh(made));
    }
    return files;
}
