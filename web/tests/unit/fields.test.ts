import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { fieldsOf } from "../../src/format/fields.ts";
import { parseHeader } from "../../src/format/header.ts";
import { readMesh } from "../../src/format/pent_file.ts";
import { lengths, makeRestCells, narrowed, vertexMeans } from "../../src/mesh/quantities.ts";
import type { Values } from "../../src/mesh/quantities.ts";
import { Decoder } from "../../src/run/decode.ts";
import { framePath, meshPath } from "../../src/run/listing.ts";
import { quantityOf } from "../../src/run/quantities.ts";
import { colorTitle, inUnits, suitableRange, unitOf } from "../../src/view/colors.ts";
import { messageOf } from "../support/message.ts";
import { native } from "../support/native.ts";
import { kPlaces, kTetHead, lines, twoTets } from "../support/two_tets.ts";

test("quantities are what is no other property, vectors where all axes follow one another", () => {
    const names = [
        "layer_x",
        "layer_y",
        "flow_x",
        "flow_y",
        "flow_z",
        "vx",
        "vw",
        "_x",
        "_y",
        "_z",
    ];
    const header = parseHeader(
        lines(
            ...kTetHead,
            "comment mesh a.pent 00000000",
            "element vertex 0",
            ...kPlaces,
            ...names.map((name) => `property double ${name}`),
            "property float pressure",
            "end_header",
        ),
        "a.pent",
    );
    const found = fieldsOf(header.elements[0]!, 3, ["", "v", "f"]);
    assert.deepEqual(
        found.map(({ name, size }) => [name, size]),
        [
            ["layer_x", 1],
            ["layer_y", 1],
            ["flow", 3],
            ["vw", 1],
            ["_x", 1],
            ["_y", 1],
            ["_z", 1],
        ],
    );
});

test("means go by volume, and quantities by their names", () => {
    const mesh = readMesh(twoTets(), "two.pent");
    const means = vertexMeans(makeRestCells(mesh), mesh.cellFields[0]!.values, 1);
    assert.deepEqual([...means], [5, 5, 5, 3, 6]);
    const { body } = new Decoder().mesh(twoTets(), "two", "two.pent");
    // Not what strain is called, and heat is that of the vertices.
    assert.deepEqual([...body.fields.keys()], ["heat", "phase", "flow"]);
    assert.deepEqual([...body.fields.get("heat")!], [1, 2, 3, 4, -5]);
    // A third along z and two along y: |(0, 2, 1)|.
    const flow = [...body.fields.get("flow")!];
    [Math.sqrt(5), Math.sqrt(5), Math.sqrt(5), 3, 3].forEach((length, v) =>
        assert.ok(Math.abs(flow[v]! - length) < 1e-6),
    );
    assert.match(
        messageOf(() => readMesh(twoTets("nan"), "two.pent")),
        /^two\.pent: vertex 0: heat is not finite, expected finite numbers$/,
    );
});

test("a quantity of a frame goes before that of its mesh", () => {
    const decoder = new Decoder();
    const { body, start } = decoder.mesh(twoTets(), "two", "two.pent");
    const frame = lines(
        ...kTetHead,
        "comment mesh two.pent 00000000",
        "element vertex 5",
        ...kPlaces,
        "property double heat",
        "property double speed",
        "end_header",
        ...["0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 -2"].map((p, v) => `${p} ${10 * v} 1`),
    );
    const decoded = decoder.frame(frame, "two", "frame.pent").frame;
    assert.deepEqual([...quantityOf(body, decoded, "heat")!], [0, 10, 20, 30, 40]);
    assert.equal(quantityOf(body, start, "heat")![3], 4);
    assert.equal(quantityOf(body, decoded, "speed"), undefined); // which is that of velocities
    assert.equal(quantityOf(body, decoded, "phase")![0], 5);
});

test("numbers beyond those of floats keep their places in a range", () => {
    const usual = Float64Array.of(-1, -0.25, 0, 0.5, 1);
    assert.ok(narrowed(usual) instanceof Float32Array);
    assert.ok(narrowed(new Float64Array(3)) instanceof Float32Array);
    for (const factor of [1e-310, 1e-200, 1e-40, 1e-21, 1e21, 1e200, 1.7e308]) {
        const values = narrowed(usual.map((value) => value * factor));
        assert.ok(values instanceof Float64Array);
        const range = suitableRange(values, "heat");
        assert.deepEqual(range, [-factor, 0.5 * factor]); // of five: the first, and the last but one
        const unit = unitOf(range);
        const shown = inUnits(values, unit);
        const [low, high] = [range[0] * unit, range[1] * unit];
        shown.forEach((value, i) => {
            const place = (value - low) / (high - low);
            // Roundings of floats; numbers of 1e-310 have 14 digits.
            assert.ok(Math.abs(place - (usual[i]! + 1) / 1.5) < 1e-6, `${factor} ${i} ${place}`);
        });
    }
    assert.equal(unitOf([0, 3]), 1);
    // One number far away does not make the others zero, nor infinite itself.
    const far = inUnits(narrowed(Float64Array.of(1e300, 1, 2)), unitOf([1, 2]));
    assert.deepEqual([...far], [Math.fround(1e30), 1, 2]);
    // A range of one's own, far below the numbers.
    assert.ok(inUnits(narrowed(usual), unitOf([0, 1e-60])).every(Number.isFinite));
});

test("vectors have lengths where their squares are no numbers", () => {
    for (const factor of [1e-320, 1e-200, 1, 1e200, 3e307]) {
        const [a, b] = lengths(
            Float64Array.of(3, 0, 4, 0, 0, 0).map((x) => x * factor),
            3,
        );
        assert.ok(Math.abs(a! / (5 * factor) - 1) < 1e-3, `${a}`); // of 1e-320: three digits
        assert.equal(b, 0);
    }
});

/** Numbers of a quantity at places in space. */
interface Seen {
    place: number[];
    value: number;
}

// The vertices of a slice of pent-slice.
function readSlice(path: string): Seen[] {
    const bytes = readFileSync(path);
    const end = bytes.indexOf("end_header\n") + "end_header\n".length;
    const count = Number(/element vertex (\d+)/.exec(bytes.toString("latin1", 0, end))![1]);
    const kRow = 3 * 8 + 8 + 3;
    return Array.from({ length: count }, (_, i) => ({
        place: [0, 8, 16].map((at) => bytes.readDoubleLE(end + kRow * i + at)),
        value: bytes.readDoubleLE(end + kRow * i + 24),
    }));
}

// The same where edges of cells cross w, or of three dimensions at all vertices.
function crossings(
    mesh: ReturnType<typeof readMesh>,
    at: Float32Array,
    values: Values,
    w: number | null,
) {
    const place = (v: number) => [0, 1, 2, 3].map((k) => at[4 * v + k]!);
    if (w === null) {
        return [...values].map((value, v): Seen => ({ place: place(v).slice(0, 3), value }));
    }
    const seen: Seen[] = [];
    for (let cell = 0; cell < mesh.cells.length; cell += 5) {
        for (let i = 0; i < 5; ++i) {
            for (let j = 0; j < i; ++j) {
                const [a, b] = [mesh.cells[cell + i]!, mesh.cells[cell + j]!];
                const [p, q] = [place(a), place(b)];
                const share = (w - p[3]!) / (q[3]! - p[3]!);
                if (share >= 0 && share <= 1) {
                    const mix = (from: number, to: number) => from + share * (to - from);
                    seen.push({
                        place: [0, 1, 2].map((k) => mix(p[k]!, q[k]!)),
                        value: mix(values[a]!, values[b]!),
                    });
                }
            }
        }
    }
    return seen;
}

function nearest(seen: Seen[], place: number[]): Seen {
    const distance = (one: Seen) => Math.hypot(...one.place.map((x, k) => x - place[k]!));
    return seen.reduce((best, one) => (distance(one) < distance(best) ? one : best));
}

const scene = (dimension: number, gravity: string) => `
[scene]
dimension = ${dimension}
gravity = [${gravity}]
frames = 3
[output]
vertex = ["contact_force", "reaction", "energy_density"]
[[body]]
name = "held"
mesh = "held.pent"
material = { young = 2e4, poisson = 0.3, density = 1000 }
[[body]]
name = "free"
mesh = "free.pent"
place = { translate = [0.05, 0.76${", 0".repeat(dimension - 2)}] }
material = { young = 5e4, poisson = 0.3, density = 1000 }
[[constraint]]
body = "held"
select = { half_space = { normal = [1${", 0".repeat(dimension - 1)}], offset = -0.45 } }
[contact]
`;

for (const dimension of [3, 4]) {
    test(`quantities are those of pent-slice and pent-render, dimension ${dimension}`, (t) => {
        const programs = ["pent-mesh", "pent-sim", "pent-slice", "pent-render"].map(native);
        if (programs.some((program) => program === null)) {
            t.skip("the native programs are not built");
            return;
        }
        const [mesher, simulator, slicer, renderer] = programs as string[];
        const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
        const at = (name: string) => join(folder, name);
        const run = (program: string, ...args: string[]) =>
            execFileSync(program, args, { encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
        try {
            const dim = ["--dim", String(dimension), "--quiet"];
            const more = dimension === 4 ? ",2" : "";
            run(mesher!, "--box", `2,2,2${more}`, ...dim, "-o", at("held.pent"));
            run(mesher!, "--box", `2,2,2${more}`, "--size", "0.5", ...dim, "-o", at("free.pent"));
            writeFileSync(
                at("scene.toml"),
                scene(dimension, dimension === 4 ? "0,-9.8,0,0" : "0,-9.8,0"),
            );
            run(simulator!, at("scene.toml"), "-o", at("run"), "--quiet");
            const kRun = ["speed", "strain", "force", "reaction", "energy_density"];
            compare("run", kRun, dimension === 4 ? 0.1317 : null);
            if (dimension === 3) {
                // What a body has been through, as one of four dimensions: its mesh has the quantities of the frames.
                const options = ["--body", "held", "--time-scale", "5", "--quiet"];
                run(mesher!, at("run"), "--space-time", ...options, "-o", at("history.pent"));
                compare("history.pent", kRun.slice(3), 0.1317);
                writeFileSync(at("tets.pent"), twoTets());
                compare("tets.pent", ["heat", "phase", "flow"], null);
            }
        } finally {
            rmSync(folder, { recursive: true });
        }

        function compare(name: string, colors: readonly string[], w: number | null): void {
            const isMesh = name.endsWith(".pent");
            const frames = isMesh ? [0] : [0, 3];
            const bodies = isMesh ? [name.replace(".pent", "")] : ["held", "free"];
            for (const color of colors) {
                const cut = [at(name), "--color", color, "--frames", frames.join()];
                cut.push(...(w === null ? [] : [`--w=${w}`]));
                run(slicer!, ...cut, "-o", at(`${name} ${color}`), "--quiet");
                const said = run(renderer!, ...cut, "--sheet", at("sheet.png"), "--size", "64x48");
                const [, title, low, high] =
                    /; (.*): (\S+) to (\S+)\n/.exec(said) ?? assert.fail(said);
                let range = [Infinity, -Infinity];
                let largest = 0;
                for (const body of bodies) {
                    const decoder = new Decoder();
                    const path = isMesh ? at(name) : join(at(name), meshPath(body));
                    const bytes = readFileSync(path);
                    const mesh = readMesh(bytes, path);
                    const { body: made, start } = decoder.mesh(bytes, body, path);
                    for (const number of frames) {
                        const file = join(at(name), framePath(body, number));
                        const frame = isMesh
                            ? start
                            : decoder.frame(readFileSync(file), body, file).frame;
                        frame.quantities.set("strain", decoder.strain(body, frame.positions));
                        const values = quantityOf(made, frame, color)!;
                        const ply = `${body}_${String(number).padStart(6, "0")}.ply`;
                        const expected = readSlice(join(at(`${name} ${color}`), ply));
                        const found = crossings(mesh, frame.positions, values, w);
                        const most = Math.max(...expected.map(({ value }) => Math.abs(value)));
                        assert.ok(expected.length >= 5);
                        largest = Math.max(largest, most);
                        for (const { place, value } of expected) {
                            const one = nearest(found, place);
                            // Positions are floats here: 1e-7 m of 0.3 m along w, and a strain that is as much off.
                            const bound = 1e-5 * most + (color === "strain" ? 2e-6 : 1e-12);
                            assert.ok(
                                Math.abs(one.value - value) < bound,
                                `${name} ${color} ${ply} ${one.value} ${value}`,
                            );
                        }
                        const here = suitableRange(
                            Float32Array.from(expected, (one) => one.value),
                            color,
                        );
                        range = [Math.min(range[0]!, here[0]), Math.max(range[1]!, here[1])];
                    }
                }
                assert.ok(largest > 0, color);
                assert.equal(title, colorTitle(color, w === null ? 3 : 4));
                // As many digits as pent-render says.
                [low, high].forEach((end, i) =>
                    assert.ok(
                        Math.abs(Number(end) - range[i]!) <= 1e-3 * Math.abs(range[i]!),
                        `${said} ${range}`,
                    ),
                );
            }
        }
    });
}
