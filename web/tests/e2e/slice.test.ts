import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { gridMesh } from "../../src/mesh/grid.ts";
import { openPage, useBrowser, useServer } from "../support/browser.ts";
import { native } from "../support/native.ts";
import { writeMesh } from "../support/write_pent.ts";

// A body without symmetry, with slices that miss its vertices, so that floats and doubles decide
// alike; and a grid with slices through layers of vertices, exactly.
const kCurved = writeMesh(
    gridMesh([5, 4, 3, 4], ([x, y, z, w]) => [
        1.3 * x + 0.3 * y * y - 0.1 * w,
        0.8 * y + 0.2 * Math.sin(2 * x) + 0.15 * w,
        0.6 * z * (1 + 0.3 * x),
        0.7 * w + 0.2 * x * z + 0.1 * y,
    ]),
);
const kGrid = writeMesh(gridMesh([2, 3, 2, 4], (p) => p));

const browser = useBrowser();
const server = useServer(
    new Map([
        ["curved.pent", kCurved],
        ["grid.pent", kGrid],
    ]),
);

const kViews = [
    { mesh: "curved", w: 0.0537, rotate: "" },
    { mesh: "curved", w: -0.3123, rotate: "xw:40" },
    { mesh: "curved", w: 0.2071, rotate: "yz:20,zw:-65,xw:110" },
    { mesh: "grid", w: 0, rotate: "" }, // through a layer of vertices
    { mesh: "grid", w: 0.5, rotate: "xw:90" },
    { mesh: "grid", w: 0.1, rotate: "xw:45,yw:45" },
];

/** Triangles of the slice that the page draws, nine numbers each. */
function capture(page: Page, w: number, rotate: string): Promise<number[]> {
    return page.evaluate(
        async ([w, rotate]) => {
            const { viewer } = window.pentimento!;
            // As a person does who edits the address; the page has listened before.
            const isHeard = new Promise((resolve) =>
                window.addEventListener("hashchange", resolve, { once: true }),
            );
            location.hash = `#speed=2&w=${w}&rotate=${rotate}&shade=off`;
            await isHeard;
            const picture = viewer.makePicture(32, 32, 1);
            return [...viewer.renderer.captureSlice(picture, 0, Number(w))];
        },
        [String(w), rotate] as const,
    );
}

interface Soup {
    triangles: number[][]; // nine numbers each
}

/** The binary PLY of pent-slice. */
function readPly(bytes: Buffer): Soup {
    const end = bytes.indexOf("end_header\n") + "end_header\n".length;
    const header = bytes.subarray(0, end).toString("latin1");
    const count = (name: string) => Number(new RegExp(`element ${name} (\\d+)`).exec(header)![1]);
    const sizes = { double: 8, float: 4, uchar: 1, int: 4, uint: 4 };
    const rowBytes = [...header.split("element face")[0]!.matchAll(/property (\w+) \w+/g)].reduce(
        (sum, match) => sum + sizes[match[1] as keyof typeof sizes],
        0,
    );
    const vertex = (i: number) =>
        [0, 8, 16].map((at) => bytes.readDoubleLE(end + i * rowBytes + at));
    const faces = end + count("vertex") * rowBytes;
    return {
        triangles: Array.from({ length: count("face") }, (_, f) =>
            [0, 1, 2].flatMap((k) => vertex(bytes.readUInt32LE(faces + 13 * f + 1 + 4 * k))),
        ),
    };
}

function volumeOf(triangles: number[][]): number {
    return triangles.reduce(
        (sum, [a, b, c, d, e, f, g, h, i]) =>
            sum +
            (a! * (e! * i! - f! * h!) - b! * (d! * i! - f! * g!) + c! * (d! * h! - e! * g!)) / 6,
        0,
    );
}

function split(numbers: number[]): number[][] {
    return Array.from({ length: numbers.length / 9 }, (_, i) => numbers.slice(9 * i, 9 * i + 9));
}

test("the slice is that of pent-slice, triangle by triangle", async (t) => {
    const slicer = native("pent-slice");
    if (!slicer) {
        t.skip("pent-slice is not built");
        return;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    writeFileSync(join(folder, "curved.pent"), kCurved);
    writeFileSync(join(folder, "grid.pent"), kGrid);
    try {
        for (const { mesh, w, rotate } of kViews) {
            const out = join(folder, `${mesh} ${w} ${rotate}`);
            mkdirSync(out, { recursive: true });
            const turns = rotate.split(",").filter((turn) => turn !== "");
            execFileSync(slicer, [
                join(folder, `${mesh}.pent`),
                "-o",
                out,
                "--keep-degenerate",
                "--quiet",
                `--w=${w}`,
                ...turns.flatMap((turn) => ["--rotate", turn]),
            ]);
            const ply = readdirSync(out).find((name) => name.endsWith(".ply"))!;
            const expected = readPly(readFileSync(join(out, ply))).triangles;
            const { page, close } = await openPage(
                browser.get(),
                `${server.address()}?run=${mesh}.pent#shade=off`,
            );
            const found = split(await capture(page, w, rotate));
            await close();
            assert.equal(found.length, expected.length, `${mesh} ${w} ${rotate}`);
            // Both in the order of the boundary. Heights are floats near 1, wrong by 1e-7; an edge at
            // a small angle to the slice makes that a hundred times as much along itself.
            found.forEach((triangle, i) =>
                triangle.forEach((value, k) =>
                    assert.ok(Math.abs(value - expected[i]![k]!) < 1e-5, `triangle ${i}`),
                ),
            );
        }
    } finally {
        rmSync(folder, { recursive: true });
    }
});

test("slices are closed and outward, to the bit, also through layers of vertices", async () => {
    for (const mesh of ["curved", "grid"]) {
        const { page, close } = await openPage(
            browser.get(),
            `${server.address()}?run=${mesh}.pent#shade=off`,
        );
        for (const { w, rotate } of kViews.filter((view) => view.mesh === mesh)) {
            const triangles = split(await capture(page, w, rotate));
            assert.ok(triangles.length > 50);
            const open = new Map<string, number>();
            for (const triangle of triangles) {
                const corners = [0, 3, 6].map((at) => triangle.slice(at, at + 3).join());
                corners.forEach((corner, k) => {
                    const next = corners[(k + 1) % 3]!;
                    const [key, way] =
                        corner < next ? [`${corner} ${next}`, 1] : [`${next} ${corner}`, -1];
                    if (corner !== next) {
                        // an edge of no length has no direction
                        open.set(key, (open.get(key) ?? 0) + way);
                    }
                });
            }
            const left = [...open.values()].filter((count) => count !== 0).length;
            assert.equal(left, 0, `${mesh} ${w} ${rotate}`);
            assert.ok(volumeOf(triangles) > 0);
        }
        await close();
    }
});

test("the slice of a unit tesseract has the volume that it must have", async () => {
    const { page, close } = await openPage(
        browser.get(),
        `${server.address()}?run=grid.pent#shade=off`,
    );
    assert.ok(Math.abs(volumeOf(split(await capture(page, 0.1, ""))) - 8) < 1e-5);
    // Turned by 45 degrees in xw the square of x and w stands on a corner: 2 (sqrt 2 - w) wide.
    const slab = 4 * 2 * (Math.SQRT2 - 0.1);
    assert.ok(Math.abs(volumeOf(split(await capture(page, 0.1, "xw:45"))) - slab) < 1e-4);
    await close();
});
