import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { readFrame } from "../../src/format/pent_file.ts";
import type { Library, Simulation } from "../../src/play/library.ts";
import type { SceneFiles } from "../../src/play/protocol.ts";
import { kRoot } from "./native.ts";
import { edited, withFiles } from "./play.ts";

const kAsWritten = { stiffness: 1, damping: null, stepsPerSecond: null };

// Sums in another order; the largest seen over all scenes is 1e-12 m.
const kNear = 1e-9; // m

interface NativeStep {
    iterations: number;
    newton_iterations: number;
    substeps: number;
    inverted: number;
    energies: Record<string, number>;
}

/** Opens a scene in the module's own file system. */
export function openIn(held: Library, files: SceneFiles): Simulation {
    held.module.FS.chdir("/");
    files.forEach((bytes, name) => held.module.FS.writeFile(name, bytes));
    return held.open("scene.toml", kAsWritten, null);
}

function expectNear(found: Float64Array, expected: Float64Array, where: string): void {
    assert.equal(found.length, expected.length, where);
    found.forEach((value, k) => {
        assert.ok(Math.abs(value - expected[k]!) < kNear, `${where}: ${value}, ${expected[k]}`);
    });
}

/** Holds every step of a scene in the module to the same one of pent-sim: iterations, energies, positions.
 *
 * @return  What the last step did. */
export function expectStepsOf(sim: string, held: Library, files: SceneFiles, count: number) {
    const scene = edited(files, (text) =>
        text.replace("[scene]\n", `[scene]\nframes = ${count}\n`),
    );
    const simulation = openIn(held, scene);
    const last = withFiles(scene, (folder) => {
        const run = join(folder, "run");
        const options = ["--quiet", "--threads", "1", "--isa", "baseline"];
        execFileSync(sim, [join(folder, "scene.toml"), "-o", run, ...options]);
        const { steps } = JSON.parse(readFileSync(join(run, "report.json"), "utf8")) as {
            steps: NativeStep[];
        };
        assert.equal(steps.length, count);
        return steps.map((expected, i) => {
            const where = `step ${i + 1}`;
            const report = simulation.step();
            assert.equal(report.iterations, expected.iterations, `iterations of ${where}`);
            assert.equal(report.newtonIterations, expected.newton_iterations, where);
            assert.equal(report.substeps, expected.substeps, where);
            assert.equal(report.inverted, expected.inverted, where);
            const energies = simulation.energies();
            const size = Math.max(...Object.values(expected.energies).map(Math.abs));
            for (const [term, energy] of energies) {
                const other = expected.energies[term] ?? 0;
                assert.ok(Math.abs(energy - other) < 1e-6 * size, `${term}: ${energy}, ${other}`);
            }
            for (let body = 0; body < simulation.bodyCount; ++body) {
                const number = String(i + 1).padStart(6, "0");
                const file = `frames/${simulation.name(body)}_${number}.pent`;
                const frame = readFrame(readFileSync(join(run, file)), file);
                expectNear(simulation.positions(body), frame.positions, `${where}, ${file}`);
            }
            return { report, energies };
        });
    }).at(-1)!;
    simulation.close();
    return last;
}

/** What a hand does before a step. */
export type HandAct =
    | { act: "grab"; origin: number[]; direction: number[]; stiffness: number; damping: number }
    | { act: "move"; anchor: number[] }
    | { act: "remove" }
    | { act: "gravity"; gravity: number[] };

const kNormal = [0, 0, 0, 1]; // of the slice in which is picked

// The same acts by the shared library, through the package for Python; prints positions of all bodies for each step.
const kProgram = `
import json, sys
import pentimento
acts, count = json.load(sys.stdin)
simulation = pentimento.Scene.read(sys.argv[1]).simulate(threads=1)
hand = None
steps = []
for step in range(count):
    for act in acts.get(str(step), []):
        if act["act"] == "grab":
            hit = simulation.pick(act["origin"], act["direction"], ${JSON.stringify(kNormal)}, 0.0)
            hand = simulation.add_grab(hit, hit.place, act["stiffness"], damping=act["damping"])
        elif act["act"] == "move":
            hand.move(act["anchor"])
        elif act["act"] == "remove":
            hand.remove()
        else:
            simulation.set_gravity(act["gravity"])
    report = simulation.step()
    bodies = [simulation.positions(body).ravel().tolist() for body in range(len(simulation.bodies))]
    steps.append([report.iterations, bodies])
print(json.dumps(steps))
`;

/** The same for steps between which a hand acts: beside the shared library of the build that `sim` is of. */
export function expectHandOf(
    sim: string,
    held: Library,
    files: SceneFiles,
    acts: Record<number, HandAct[]>,
    count: number,
): void {
    const steps = withFiles(files, (folder) => {
        const output = execFileSync(
            "/usr/bin/python3",
            ["-c", kProgram, join(folder, "scene.toml")],
            {
                input: JSON.stringify([acts, count]),
                env: {
                    ...process.env,
                    PYTHONPATH: join(kRoot, "python"),
                    PENTIMENTO_LIBRARY: join(sim, "../../plugin/libpent_plugin.so"),
                },
                maxBuffer: 1 << 28,
            },
        );
        return JSON.parse(output.toString()) as [number, number[][]][];
    });
    const simulation = openIn(held, files);
    let hand = 0;
    for (let step = 0; step < count; ++step) {
        for (const act of acts[step] ?? []) {
            if (act.act === "grab") {
                const { origin, direction, stiffness, damping } = act;
                const slice = { normal: kNormal, offset: 0 };
                const hit = simulation.pick({ origin, direction, slice })!;
                hand = simulation.addGrab({ hit, anchor: hit.place, stiffness, damping });
            } else if (act.act === "move") {
                simulation.moveGrab(hand, act.anchor);
            } else if (act.act === "remove") {
                simulation.removeGrab(hand);
            } else {
                simulation.setGravity(act.gravity);
            }
        }
        const [iterations, bodies] = steps[step]!;
        assert.equal(simulation.step().iterations, iterations, `iterations of step ${step + 1}`);
        bodies.forEach((positions, body) =>
            expectNear(
                simulation.positions(body),
                Float64Array.from(positions),
                `step ${step + 1}, body ${body}`,
            ),
        );
    }
    simulation.close();
}
