import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { determinant } from "../../src/format/mesh.ts";
import type { Mesh } from "../../src/format/mesh.ts";
import { readMesh } from "../../src/format/pent_file.ts";
import { makeBoundary } from "../../src/mesh/boundary.ts";
import { Decoder } from "../../src/run/decode.ts";
import { messageOf } from "../support/message.ts";
import { native } from "../support/native.ts";
import { kPlaces, kTetHead, lines } from "../support/two_tets.ts";

const kRows = [..."xyzw"].map((to) => [..."xyz"].map((from) => to + from));
const kLayer = [...kRows.flat(), ..."xyzw"].map((name) => `property double ${name}`);
// Two tetrahedra on either side of a triangle, in orders that agree: by the numbers of the corners.
const kBase = {
    places: ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 -2"], // of volumes 1/6 and 1/3
    cells: ["0 1 2 3 0", "0 2 1 4 2"],
};

// A layer at w, each base vertex `scale` times as far from the origin.
const layer = (w: number, scale: number, reversed = 0) =>
    `${scale} 0 0 0 ${scale} 0 0 0 ${scale} 0 0 0 0 0 0 ${w} ${reversed}`;

function file(layers: string[], change = (text: string) => text, base = kBase): Uint8Array {
    const text = [
        ...kTetHead,
        `element vertex ${base.places.length}`,
        ...kPlaces,
        `element tetrahedron ${base.cells.length}`,
        ...[0, 1, 2, 3].map((k) => `property uint v${k}`),
        "property uchar order",
        `element layer ${layers.length}`,
        ...kLayer,
        "property uchar reversed",
        "end_header",
        ...base.places,
        ...base.cells,
        ...layers,
    ].join("\n");
    return lines(change(text));
}

// Volumes of all cells, which must be positive.
function volumeOf({ dimension: n, positions, cells }: Mesh): number {
    let sum = 0;
    for (let at = 0; at < cells.length; at += n + 1) {
        const edges = Array.from({ length: n * n }, (_, i) => {
            const corner = cells[at + 1 + Math.floor(i / n)]!;
            return positions[n * corner + (i % n)]! - positions[n * cells[at]! + (i % n)]!;
        });
        const volume = determinant(edges, n) / [1, 1, 2, 6, 24][n]!;
        assert.ok(volume > 0);
        sum += volume;
    }
    return sum;
}

test("base and layers become the body: prisms and pyramids over the base", () => {
    // 1/2 m^3 times w; and 1/4 of that towards a point, as of a pyramid of four dimensions.
    const cases: [string[], number, number][] = [
        [[layer(-1, 1), layer(2, 1)], 8, 1.5],
        [[layer(2, 1), layer(-1, 1)], 8, 1.5], // to the other side
        [[layer(0, 1), layer(1, 1), layer(3, 1)], 16, 1.5],
        [[layer(0, 1), layer(1, 1, 1), layer(3, 1)], 16, 1.5],
        [[layer(0, 0), layer(1, 1), layer(3, 1), layer(4, 0)], 12, 1.25],
        [[layer(0, 0), layer(2, 1), layer(4, 0)], 4, 0.5],
        [[layer(4, 0), layer(2, 1), layer(0, 0)], 4, 0.5],
    ];
    for (const [layers, cellCount, volume] of cases) {
        const mesh = readMesh(file(layers), "a.pent");
        assert.equal(mesh.dimension, 4);
        assert.equal(mesh.cellCount, cellCount);
        assert.ok(Math.abs(volumeOf(mesh) - volume) < 1e-14); // roundings of some twenty volumes
        // Every facet between two cells is one of both: else there would be more of the boundary, or a fault.
        const { facetCount } = makeBoundary(mesh, "a.pent");
        const ends = layers.filter((row) => row.startsWith("1")).length;
        const isOpen = [layers[0]!, layers.at(-1)!].filter((row) => row.startsWith("1")).length;
        // Six outer triangles of the base: three tetrahedra in each prism, one towards a point.
        assert.equal(facetCount, 6 * 3 * (ends - 1) + 6 * (2 - isOpen) + 2 * isOpen);
    }
});

test("base and layers that make no body are refused by the words of the programs", (t) => {
    const two = [layer(0, 1), layer(1, 1)];
    const cases: [Uint8Array, string][] = [
        [file([layer(0, 1)]), "1 layers, expected two or more"],
        [
            file([layer(0, 1), layer(1, 0), layer(2, 1)]),
            "layer 1: is a point, which only the first and the last may be",
        ],
        [file([layer(0, 0), layer(1, 0)]), "layer 1: is a point as the only other one is"],
        [
            file([layer(0, 1), layer(NaN, 1)], (text) => text.replace("NaN", "nan")),
            "layer 1: has a number that is not finite",
        ],
        [
            file([layer(0, 1, 1), layer(1, 1)]),
            "the layers that are reversed are not every second one; expected those, or none",
        ],
        [
            file(two, (text) => text.replace("3 0\n", "3 24\n")),
            "tetrahedron 0: order is 24, expected at most 23",
        ],
        [
            file(two, (text) => text.replace("4 2\n", "4 0\n")),
            "the edge of vertices 1 and 2 goes one way in one cell and back in another; " +
                "expected orders in which neighbors agree",
        ],
        [
            file(two, (text) => text.replace("uchar order", "uchar sequence")),
            "header: element tetrahedron has no order, which an extrusion needs",
        ],
        [
            file(two, (text) => text.replace("double yz", "double zy2")),
            "header: element layer has no yz, which an extrusion needs",
        ],
        [
            file(two, (text) => text.replace("uchar order", "uint order")),
            "header: property order of element tetrahedron is uint, expected uchar",
        ],
        [
            file([layer(0, 1), layer(0, 1)]),
            "pentachoron 0: degenerate (flat to rounding error), expected a positive volume",
        ],
        [
            file([layer(0, 1), layer(2, 1), layer(1, 1)]),
            "pentachoron 4: inverted (its determinant is negative), expected positive orientation: " +
                "swap two of its vertices",
        ],
    ];
    const check = native("pent-check");
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    try {
        for (const [bytes, expected] of cases) {
            const path = join(folder, "a.pent");
            assert.equal(
                messageOf(() => readMesh(bytes, path)),
                `${path}: ${expected}`,
            );
            if (check) {
                writeFileSync(path, bytes);
                let said = "";
                try {
                    execFileSync(check, [path, "--quiet"], { stdio: "pipe", encoding: "utf8" });
                } catch (error) {
                    said = (error as { stderr: string }).stderr.trim();
                }
                assert.equal(said, `pent-check: ${path}: ${expected}`);
            }
        }
    } finally {
        rmSync(folder, { recursive: true });
    }
    if (!check) {
        t.diagnostic("pent-check is not built: not compared with its words");
    }
});

test("what would be too much is refused before it is made", () => {
    // Tetrahedra of four vertices each, none of which another one has.
    const said = (tets: number, layers: number) => {
        const base = {
            places: Array.from({ length: tets }, () => kBase.places.slice(0, 4)).flat(),
            cells: Array.from({ length: tets }, (_, i) =>
                [...[0, 1, 2, 3].map((k) => 4 * i + k), 0].join(" "),
            ),
        };
        const rows = Array.from({ length: layers }, (_, w) => layer(w, 1));
        return messageOf(() => readMesh(file(rows, undefined, base), "a.pent"));
    };
    assert.equal(said(3, 3), "");
    assert.equal(
        said(1000, 10_001),
        "a.pent: its base and 10001 layers make 40004000 vertices and 40000000 pentachora, which " +
            "take 2.08 GB; this page takes at most 2: take fewer layers, or look at it by " +
            "pent-slice or pent-render",
    );
    assert.equal(
        said(20_000, 60_001),
        "a.pent: its base and 60001 layers make 4800080000 vertices and 4800000000 pentachora; at " +
            "most 4294967295 of each can be numbered: take fewer layers",
    );
});

test("bodies are those that pent-mesh writes in full, number by number", (t) => {
    const mesher = native("pent-mesh");
    if (!mesher) {
        t.skip("pent-mesh is not built");
        return;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    const at = (name: string) => join(folder, name);
    writeFileSync(at("square.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    writeFileSync(
        at("profile"),
        "-1 0\n-0.3 0.9 0.05 0 0 4 0 0 0 0 3\n0 1 0.1 0.1 0\n0.6 1.1 0 0.2 0 0 3 4 0 0 0\n",
    );
    const ball = ["--ball", "2"];
    const cases = [
        [...ball, "--thickness", "1", "--layers", "3"],
        [...ball, "--thickness", "0.7", "--layers", "4", "--lean", "--order", "sweep"],
        [...ball, "--thickness", "-0.5", "--one-sided", "--layers", "2", "--order", "quality"],
        [...ball, "--round", "--layers", "6"],
        [...ball, "--round", "--layers", "2"],
        [...ball, "--extrude", "0.1,0.2,0.3,-0.5", "--layers", "3"],
        [...ball, "--profile", at("profile")],
        [at("square.obj"), "--dim", "3", "--thickness", "0.3", "--layers", "3"],
    ];
    try {
        for (const options of cases) {
            const written = (more: string[]) => {
                execFileSync(mesher, [...options, ...more, "--quiet", "-o", at("body.pent")]);
                return readFileSync(at("body.pent"));
            };
            const small = written(["--unextruded"]);
            const expected = readMesh(written([]), "body.pent");
            const found = readMesh(small, "body.pent");
            const where = options.join(" ");
            assert.equal(found.dimension, expected.dimension, where);
            assert.deepEqual(found.positions, expected.positions, where);
            assert.deepEqual(found.cells, expected.cells, where);
            const { body } = new Decoder().mesh(small, "body", "body.pent");
            assert.equal(body.cellCount, expected.cellCount);
        }
    } finally {
        rmSync(folder, { recursive: true });
    }
});
