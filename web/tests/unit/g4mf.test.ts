import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { G4mfModel } from "../../src/format/g4mf.ts";
import { G4mfDocument } from "../../src/format/g4mf_document.ts";
import { determinant } from "../../src/format/mesh.ts";
import { makeBoundary } from "../../src/mesh/boundary.ts";
import { matchFacets } from "../../src/mesh/facets.ts";
import { orientOutward } from "../../src/mesh/orient.ts";
import { ModelDecoder } from "../../src/run/decode.ts";
import { gridMesh } from "../../src/mesh/grid.ts";
import { damage } from "../support/damage.ts";
import { messageOf } from "../support/message.ts";
import { kRoot, native, randomFrom } from "../support/native.ts";
import { kSixteenCell, textModel } from "../support/write_g4mf.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

const kCorpus = ["g4mf/five_cell.g4tf", "g4mf_chunks/five_cell.g4b"].map((path) =>
    readFileSync(join(kRoot, "tests/fuzz/corpus", path)),
);

function open(bytes: Uint8Array, beside: [string, Uint8Array][] = []): G4mfModel {
    const document = new G4mfDocument(bytes, "a.g4tf");
    beside.forEach(([uri, file]) => document.put(uri, file));
    return new G4mfModel(document);
}

function enclosed(points: Float64Array, tetrahedra: Uint32Array): number {
    let sum = 0;
    for (let at = 0; at < tetrahedra.length; at += 4) {
        const corners = [...tetrahedra.subarray(at, at + 4)];
        sum += determinant(
            corners.flatMap((v) => [...points.subarray(4 * v, 4 * v + 4)]),
            4,
        );
    }
    return sum / 24;
}

// Triangles without a neighbor that sees them from the other side.
function faults(tetrahedra: Uint32Array, points: number): number {
    let count = 0;
    const add = () => void ++count;
    matchFacets(tetrahedra, 4, points, { onBoundary: add, onFault: add });
    return count;
}

test("the samples, of text and of chunks, are one five-cell that faces outward", () => {
    for (const bytes of kCorpus) {
        const [body, ...others] = open(bytes).bodies;
        assert.equal(others.length, 0);
        assert.equal(body!.name, "five_cell");
        assert.equal(body!.points.length, 20);
        assert.equal(faults(body!.tetrahedra, 5), 0);
        assert.ok(Math.abs(enclosed(body!.points, body!.tetrahedra) - 1 / 24) < 1e-12);
    }
});

// As others may write it: the words of earlier drafts, indices in two bytes, points in a file beside, a node that is
// scaled and one that is mirrored.
test("nodes put meshes in their places, mirrored ones turned over, and buffers may lie beside", () => {
    const { json, points, indices } = kSixteenCell;
    const nodes = [
        { children: [1, 2] },
        { name: "left", mesh: 0, position: [5, 0, 0, 0] },
        { children: [3], scale: [2] },
        { meshInstance: { mesh: 0 }, basis: [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] },
    ];
    const files: [string, Uint8Array][] = [
        ["points.bin", points],
        ["indices.bin", indices],
    ];
    const text = new TextEncoder().encode(JSON.stringify({ ...json, nodes }));
    assert.deepEqual(new G4mfDocument(text, "a.g4tf").uris(), ["points.bin", "indices.bin"]);
    const { bodies } = open(text, files);
    assert.deepEqual(
        bodies.map(({ name }) => name),
        ["left", "mesh 1"],
    );
    const sizes = bodies.map((body) => enclosed(body.points, body.tetrahedra));
    // 2/3 and 16 times that: sums of small whole numbers.
    assert.ok(Math.abs(Math.abs(sizes[0]!) - 2 / 3) < 1e-12);
    assert.ok(Math.abs(sizes[1]! / sizes[0]! - 16) < 1e-12, "both face one way");
    assert.equal(bodies[0]!.points[0], 6);
    assert.match(
        messageOf(() => open(text)),
        /^a\.g4tf: buffers\[0\]\.uri: no such file beside this one$/,
    );
});

test("shapes that pent-convert names are frames in time; others come one by one behind the mesh", () => {
    const ofRun = open(textModel({ shapes: ["a_000003 at 0.1 s", "a_000007 at 2.5e-1 s"] }));
    assert.deepEqual(ofRun.frames, [
        { frame: 3, time: 0.1, shape: 0 },
        { frame: 7, time: 0.25, shape: 1 },
    ]);
    for (const shapes of [["smile"], ["a_000003 at 0.1 s", "a_000003 at 0.2 s"]]) {
        const { frames } = open(textModel({ shapes }));
        assert.deepEqual(
            frames.map(({ shape }) => shape),
            [null, ...shapes.map((_, i) => i)],
        );
    }
});

test("a shape moves its points by its offsets, and the file's own amounts count where it is shown as it is", () => {
    const model = open(textModel({ shapes: ["one", "two"], amounts: [0, 0.5] }));
    const [still, one, two] = model.frames.map((frame) => model.points(frame)[0]!);
    const rest = open(textModel({})).bodies[0]!.points;
    // Offsets of shape i are (i + 1) / 4 along every axis, of the first point alone; all are sums of eighths.
    const moved = (by: number) => rest.map((value, at) => value + (at < 4 ? by : 0));
    assert.deepEqual(still, moved(0.25));
    assert.deepEqual(one, moved(0.25));
    assert.deepEqual(two, moved(0.5));
    assert.deepEqual(model.bodies[0]!.points, still);
});

test("what is wrong is said with its entry", () => {
    const cases: [(json: Record<string, never>) => void, RegExp][] = [
        [(json) => set(json, "asset.dimension", 3), /asset\.dimension: found 3; expected 4$/],
        [
            (json) => set(json, "buffers.0.byteLength", 9999),
            /buffers\[0\]: has \d+ bytes; expected 9999/,
        ],
        [
            (json) => set(json, "buffers.0.uri", "data:a;base64,?"),
            /buffers\[0\]\.uri: is no base64$/,
        ],
        [
            (json) => set(json, "buffers.0.compression", "x"),
            /buffers\[0\]: is compressed; expected/,
        ],
        [(json) => set(json, "bufferViews.1.byteLength", 9999), /bufferViews\[1\]: reaches beyond/],
        [
            (json) => set(json, "bufferViews.1.byteLength", 17),
            /accessors\[1\]: its 17 bytes are no/,
        ],
        [
            (json) => set(json, "accessors.1.componentType", "int128"),
            /accessors\[1\]\.componentType: found "int128"; expected uint8, uint16 or uint32$/,
        ],
        [
            (json) => set(json, "accessors.0.vectorSize", 3),
            /accessors\[0\]: has elements of 3 numbers; expected 4$/,
        ],
        [
            (json) => set(json, "meshes.0.vertices", 7),
            /meshes\[0\]\.vertices: points to entry 7 of 2$/,
        ],
        [
            (json) => set(json, "meshes.0.vertices", -1),
            /vertices: found -1; expected a whole number/,
        ],
        [
            (json) => set(json, "meshes.0.surfaces", []),
            /no tetrahedron in it; expected the boundary/,
        ],
        [(json) => set(json, "nodes.1.children", [0]), /nodes\[0\]: is the child of two nodes$/],
        [(json) => set(json, "nodes.1.rotor", [1]), /nodes\[1\]: is turned by a rotor/],
        [
            (json) => set(json, "nodes.1.position", [1, 2]),
            /nodes\[1\]\.position: found \[1,2\]; expected 4 finite numbers$/,
        ],
        [(json) => set(json, "nodes.1.scale", [1e300]), /meshes\[0\]: point 0 is not finite/],
        [(json) => set(json, "accessors", undefined), /points to entry 0 of 0$/],
    ];
    for (const [damageIt, expected] of cases) {
        const json = JSON.parse(new TextDecoder().decode(textModel({ base: 1e30 }))) as never;
        damageIt(json);
        const text = new TextEncoder().encode(JSON.stringify(json));
        const message = messageOf(() => open(text));
        assert.match(message, /^a\.g4tf: /);
        assert.match(message, expected);
    }
    const text = (words: string) => messageOf(() => open(new TextEncoder().encode(words)));
    assert.match(text("{"), /^a\.g4tf: is no G4MF file \(/);
    assert.match(
        text("G4MF\n\n"),
        /^a\.g4tf: a damaged header; expected that of a G4MF draft with 6/,
    );
    assert.match(text("[\n\n?]"), /^a\.g4tf: is no G4MF file \(/);
    assert.match(text("null"), /^a\.g4tf: asset\.dimension: is missing; expected a whole number/);
});

// The value of the entry at a path, as "nodes.1.scale".
function set(json: unknown, path: string, value: unknown): void {
    const keys = path.split(".");
    const last = keys.pop()!;
    const holder = keys.reduce((at, key) => (at as Record<string, unknown>)[key], json);
    (holder as Record<string, unknown>)[last] = value;
}

test("cut and damaged files are taken or said why not, and nothing else is thrown", () => {
    const random = randomFrom(8);
    const model = textModel({ shapes: ["a_000001 at 0 s", "b"], amounts: [1, 2] });
    const read = (bytes: Uint8Array) =>
        messageOf(() => {
            const decoder = new ModelDecoder();
            decoder.open(bytes, "a.g4b");
            const { frames } = decoder.bodies(new Map());
            frames.forEach((_, place) => decoder.frame(place));
        });
    for (const bytes of [...kCorpus, model]) {
        assert.equal(read(bytes), "");
        let refused = 0;
        for (let i = 0; i < 400; ++i) {
            refused += read(damage(bytes, random)) === "" ? 0 : 1;
        }
        assert.ok(refused > 100, `${refused} refused: else damage tries little`);
    }
    const [, chunks] = kCorpus;
    for (let size = 0; size < chunks!.length; ++size) {
        assert.notEqual(read(chunks!.subarray(0, size)), "");
    }
});

test("tetrahedra that face anyhow are turned outward, piece by piece", () => {
    const grid = gridMesh([2, 1, 2, 1], (p) => p);
    const { facets } = makeBoundary(grid, "grid");
    const random = randomFrom(3);
    const count = grid.vertexCount;
    // Two of them, away from one another: the first anyhow, the second inside out.
    const points = Float64Array.from([...grid.positions, ...grid.positions], (x, i) =>
        i < 4 * count ? x : x + 9,
    );
    const both = Uint32Array.from([...facets, ...facets], (v, i) =>
        i < facets.length ? v : v + count,
    );
    const expected = both.slice();
    for (let at = 0; at < both.length; at += 4) {
        if (at >= facets.length || random() < 0.5) {
            both.set([both[at]!, both[at + 1]!, both[at + 3]!, both[at + 2]!], at);
        }
    }
    assert.ok(faults(both, 2 * count) > 0);
    orientOutward(points, both);
    assert.deepEqual(both, expected);
    const inside = both.map((v, i) => (i % 4 < 2 ? v : both[i % 4 === 2 ? i + 1 : i - 1]!));
    orientOutward(points, inside);
    assert.deepEqual(inside, expected, "all the other way round");
});

test("what is not closed stays as it is", () => {
    const { facets } = makeBoundary(
        gridMesh([1, 1, 1, 1], (p) => p),
        "grid",
    );
    const open = facets.slice(4);
    const before = open.slice();
    orientOutward(gridMesh([1, 1, 1, 1], (p) => p).positions, open);
    assert.deepEqual(open, before);
});

test("what pent-convert makes of a run is its boundary, facet by facet, and its frames", (t) => {
    const convert = native("pent-convert");
    if (!convert) {
        t.skip("pent-convert is not built");
        return;
    }
    const grid = gridMesh([3, 2, 3, 2], (p) => [2 * p[0], p[1] + 0.3 * p[0], p[2], p[3]]);
    const file = writeMesh(grid);
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    const at = (name: string) => join(folder, name);
    const moved = (frame: number) => [...grid.positions].map((x, i) => x + frame * (i % 3));
    try {
        writeFileSync(at("grid.pent"), file);
        const frames = [2, 5].map((frame) => {
            const path = at(`grid_00000${frame}.pent`);
            writeFileSync(path, writeFrame(file, frame, frame / 8, moved(frame), moved(0)));
            return path;
        });
        for (const name of ["grid.g4b", "grid.g4tf"]) {
            execFileSync(convert, [at("grid.pent"), "-o", at(name), "--frames", ...frames]);
            const decoder = new ModelDecoder();
            assert.deepEqual(decoder.open(readFileSync(at(name)), name), []);
            const { bodies, frames: shown } = decoder.bodies(new Map());
            assert.deepEqual(
                shown.map(({ frame, time }) => [frame, time]),
                [
                    [2, 0.25],
                    [5, 0.625],
                ],
            );
            const { facets } = makeBoundary(grid, "grid");
            const used = [...new Set(facets)].sort((a, b) => a - b);
            assert.deepEqual(
                bodies[0]!.boundary.facets,
                facets.map((v) => used.indexOf(v)),
            );
            shown.forEach(({ frame }, place) => {
                const [body] = decoder.frame(place);
                const expected = used.flatMap((v) => moved(frame).slice(4 * v, 4 * v + 4));
                // The sum of two floats below 16.
                expected.forEach((x, i) => assert.ok(Math.abs(body!.positions[i]! - x) < 2e-6));
            });
        }
    } finally {
        rmSync(folder, { recursive: true });
    }
});
