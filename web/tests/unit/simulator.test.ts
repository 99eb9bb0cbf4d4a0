import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import type { TestContext } from "node:test";
import { readMesh } from "../../src/format/pent_file.ts";
import type { MeshFile } from "../../src/format/pent_file.ts";
import { galleryFiles } from "../../src/play/gallery.ts";
import { writeMesh } from "../../src/format/write_pent.ts";
import { Playground } from "../../src/play/playground.ts";
import type { SceneFiles } from "../../src/play/protocol.ts";
import { kGallery } from "../../src/play/scene_list.ts";
import { Decoder } from "../../src/run/decode.ts";
import { expectHandOf, expectStepsOf } from "../support/agreement.ts";
import type { HandAct } from "../support/agreement.ts";
import { native } from "../support/native.ts";
import { pairScenes } from "../support/pair_scenes.ts";
import { edited, library, withFiles } from "../support/play.ts";
import { lines } from "../support/two_tets.ts";

const kNothingBuilt = "the simulator for browsers is not built";
const kSteps = 30;

const now = () => performance.now();

async function playground(t: TestContext, said: string[] = []) {
    const held = await library();
    if (!held) {
        t.skip(kNothingBuilt);
        return null;
    }
    return { held, play: new Playground(held, (text) => said.push(text)) };
}

/** The module and pent-sim, or null. */
async function both(t: TestContext) {
    const sim = native("pent-sim");
    const held = await library();
    if (!held || !sim) {
        t.skip("pent-sim, or the simulator for browsers, is not built");
        return null;
    }
    return { held, sim };
}

// Matrices of floats are rounded by each instruction set in its own way, native ones among themselves, which
// the octopus makes 1e-6 m of in 30 steps. Those of doubles show what else there is: nothing.
const inDoubles = (name: string) =>
    edited(galleryFiles(name), (text) =>
        text.replace('preset = "fast"', 'preset = "fast"\nprecision = "double"'),
    );

for (const name of Object.keys(kGallery)) {
    test(`${name}: ${kSteps} steps are those of pent-sim`, async (t) => {
        const made = await both(t);
        if (made) {
            const { report } = expectStepsOf(made.sim, made.held, inDoubles(name), kSteps);
            assert.ok(report.iterations > 0, "something was solved");
        }
    });
}

for (const [name, files] of pairScenes()) {
    test(`${name}: ${kSteps} steps are those of pent-sim`, async (t) => {
        const made = await both(t);
        if (made) {
            expectStepsOf(made.sim, made.held, files, kSteps);
        }
    });
}

test("a hand in a heap, and gravity that turns: steps are those of the shared library", async (t) => {
    const made = await both(t);
    if (!made) {
        return;
    }
    const acts: Record<number, HandAct[]> = {
        2: [
            {
                act: "grab",
                origin: [0, 1.8, 5, 0],
                direction: [0.02, 0, -1, 0],
                stiffness: 2000,
                damping: 40,
            },
        ],
        4: [{ act: "move", anchor: [0.4, 2, 0.3, 0.2] }],
        9: [{ act: "move", anchor: [0.4, 1, 0, -0.6] }],
        16: [{ act: "gravity", gravity: [3, -5, 0, 4] }],
        22: [{ act: "remove" }],
    };
    expectHandOf(made.sim, made.held, inDoubles("heap"), acts, kSteps);
});

test("scenes of the gallery go on for two seconds without a step that is refused", async (t) => {
    const said: string[] = [];
    const made = await playground(t, said);
    for (const name of made ? Object.keys(kGallery) : []) {
        made!.play.open(galleryFiles(name), "scene.toml");
        for (let i = 0; i < 120; ++i) {
            made!.play.step(now);
        }
        const stats = made!.play.stats(1);
        assert.deepEqual(said, [], name);
        assert.equal(stats.inverted, 0, name);
    }
});

test("mistakes in a scene are told with line and column, and the scene that was open stays", async (t) => {
    const made = await playground(t);
    if (!made) {
        return;
    }
    const { play } = made;
    const jelly = galleryFiles("jelly");
    play.open(jelly, "scene.toml");
    const open =
        (edit: (text: string) => string, name = "scene.toml") =>
        () =>
            play.open(edited(jelly, edit), name);
    assert.throws(
        open((text) => text.replace("gravity", "gravitty")),
        /^Error: scene\.toml:2:1: unknown key "gravitty".*did you mean "gravity"\?$/,
    );
    assert.throws(
        open((text) => text.replace("[scene]", "[scene")),
        /^Error: scene\.toml:1:\d+: /,
    );
    assert.throws(
        open((text) => text.replace("jelly.pent", "jolly.pent")),
        /^Error: scene\.toml:7:8: .*jolly\.pent: /,
    );
    assert.throws(
        open((text) => text, "other.toml"),
        /^Error: other\.toml: /,
    );
    const cut = new Map(jelly).set("jelly.pent", jelly.get("jelly.pent")!.slice(0, 5000));
    assert.throws(() => play.open(cut, "scene.toml"), /^Error: scene\.toml:7:8: jelly\.pent: /);
    assert.ok(play.step(now), "the jelly is still there");
    // With its files: it is opened again.
    play.reset();
    assert.equal(play.tune(2, 0.01, 60).stiffness, 2);
    assert.ok(play.step(now));
});

test("a scene of three dimensions is refused with what shows it, and the scene that was open stays", async (t) => {
    const made = await playground(t);
    if (!made) {
        return;
    }
    made.play.open(galleryFiles("jelly"), "scene.toml");
    const tet = writeMesh({
        dimension: 3,
        positions: Float64Array.of(0, 1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 1),
        cells: Uint32Array.of(0, 1, 2, 3),
    });
    const text =
        "[scene]\ndimension = 3\ngravity = [0, -9.8, 0]\n" +
        '[[body]]\nname = "tet"\nmesh = "tet.pent"\nmaterial = { young = 1e4, density = 100 }\n';
    const files = new Map([
        ["flat.toml", new TextEncoder().encode(text)],
        ["tet.pent", tet],
    ]);
    assert.throws(
        () => made.play.open(files, "flat.toml"),
        /^Error: flat\.toml: the scene has dimension 3; .* alone\. Simulate it with pent-sim, and drop the run here/,
    );
    assert.ok(made.play.step(now), "the jelly is still there");
});

// A tesseract with numbers and vectors of vertices and cells beside it.
function jellyWithFields(): SceneFiles {
    const files = galleryFiles("jelly");
    const { positions, cells, cellCount, vertexCount } = readMesh(
        files.get("jelly.pent")!,
        "jelly.pent",
    );
    const rows = (count: number, row: (i: number) => number[]) =>
        Array.from({ length: count }, (_, i) => row(i).join(" "));
    const of = (array: Float64Array | Uint32Array, size: number, i: number) => [
        ...array.subarray(size * i, size * (i + 1)),
    ];
    const vectors = ["x", "y", "z", "w"].map((axis) => `property double flow_${axis}`);
    const mesh = lines(
        "ply",
        "format ascii 1.0",
        "comment pent 1.0",
        "comment dimension 4",
        `element vertex ${vertexCount}`,
        ...["x", "y", "z", "w"].map((axis) => `property double ${axis}`),
        "property double heat",
        "property double speed",
        ...vectors,
        `element pentachoron ${cellCount}`,
        ...[0, 1, 2, 3, 4].map((k) => `property uint v${k}`),
        "property double phase",
        "end_header",
        ...rows(vertexCount, (v) => {
            const p = of(positions, 4, v);
            return [...p, 300 + p[0]! - p[3]!, 7, 1 + p[1]!, p[2]!, -2, p[0]!];
        }),
        ...rows(cellCount, (cell) => [...of(cells, 5, cell), cell % 17]),
    );
    return new Map(files).set("jelly.pent", mesh); // which is placed turned in xy and zw
}

test("quantities of a scene's mesh are those of its run, and are in what is recorded", async (t) => {
    const made = await both(t);
    if (!made) {
        return;
    }
    const files = jellyWithFields();
    const play = new Playground(made.held, () => {});
    const { fields } = play.open(files, "scene.toml").bodies[0]!;
    assert.deepEqual([...fields.keys()], ["heat", "flow", "phase"]); // speed is that of a frame
    play.startRecording();
    const recorded = play.stopRecording()!.get("meshes/jelly.pent")!;
    const meshOfRun = withFiles(files, (folder) => {
        const scene = edited(files, (text) => text.replace("[scene]\n", "[scene]\nframes = 1\n"));
        writeFileSync(join(folder, "scene.toml"), scene.get("scene.toml")!);
        execFileSync(made.sim, [join(folder, "scene.toml"), "-o", join(folder, "run"), "--quiet"]);
        return new Uint8Array(readFileSync(join(folder, "run/meshes/jelly.pent")));
    });
    const expected = new Decoder().mesh(meshOfRun, "jelly", "jelly.pent").body.fields;
    assert.deepEqual([...expected.keys()], [...fields.keys()]);
    for (const [name, values] of expected) {
        values.forEach((value, v) =>
            // Lengths of vectors that were turned, in floats; means by volumes of cells that were.
            assert.ok(Math.abs(fields.get(name)![v]! - value) < 1e-6 * Math.abs(value), name),
        );
    }
    const [found, other] = [recorded, meshOfRun].map((bytes) => readMesh(bytes, "jelly.pent"));
    for (const kind of ["vertexFields", "cellFields"] as const) {
        assert.equal(found![kind].length, other![kind].length);
        found![kind].forEach(({ name, values }, i) => {
            assert.equal(name, other![kind][i]!.name);
            values.forEach((value, v) =>
                assert.ok(Math.abs(value - other![kind][i]!.values[v]!) < 1e-12, name),
            );
        });
    }
    const flowOf = (mesh: MeshFile) =>
        mesh.vertexFields.find(({ name }) => name === "flow")!.values;
    const before = flowOf(readMesh(files.get("jelly.pent")!, "jelly.pent"));
    // 30 degrees in xy.
    const expectedX = before[0]! * Math.cos(Math.PI / 6) - before[1]! / 2;
    assert.ok(Math.abs(flowOf(found!)[0]! - expectedX) < 1e-14);
});

test("obstacles are where the scene has them, and move as they do in it", async (t) => {
    const made = await playground(t);
    if (!made) {
        return;
    }
    const { play } = made;
    const jelly = galleryFiles("jelly");
    play.open(jelly, "scene.toml");
    assert.deepEqual(play.moment().obstacles, [
        { kind: "half_space", normal: [0, 1, 0, 0], offset: 0 },
        { kind: "half_space", normal: [0, 0, 0, 1], offset: -1.5 },
        { kind: "half_space", normal: [0, 0, 0, -1], offset: -1.5 },
    ]);
    const ball =
        "\n[[obstacle]]\nball = { center = [3, 1, 0, 0.5], radius = 0.25 }\n" +
        "motion = [{ translate = [0, 0.6, 0, -0.3] }]\n";
    play.open(
        edited(jelly, (text) => text.replace("\n[contact]", `${ball}\n[contact]`)),
        "scene.toml",
    );
    play.step(now);
    const moment = play.moment();
    const moved = moment.obstacles.find((one) => one.kind === "ball")!;
    const expected = [3, 1 + 0.6 * moment.time, 0, 0.5 - 0.3 * moment.time];
    assert.ok(moment.time > 0);
    // Sums of doubles near 1.
    moved.center.forEach((x, axis) => assert.ok(Math.abs(x - expected[axis]!) < 1e-12));
});
