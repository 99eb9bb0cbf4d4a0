import assert from "node:assert/strict";
import { test } from "node:test";
import { makeBoundary } from "../../src/mesh/boundary.ts";
import type { Obstacle } from "../../src/format/obstacles.ts";
import { determinant } from "../../src/format/mesh.ts";
import type { Mesh } from "../../src/format/mesh.ts";
import { readMesh } from "../../src/format/pent_file.ts";
import { galleryFiles } from "../../src/play/gallery.ts";
import { roomFor } from "../../src/play/live_run.ts";
import { Pace, kRates } from "../../src/play/pace.ts";
import { sceneAmong } from "../../src/play/scene_files.ts";
import { crc32, zip } from "../../src/play/zip.ts";
import { unzip } from "../support/unzip.ts";
import { Bounds, reachAlongW } from "../../src/view/bounds.ts";
import { makeColoring, makePicture } from "../../src/view/compose.ts";
import { add } from "../../src/view/matrix.ts";
import { fromSeen, onPlane, project, sightAt, toSeen } from "../../src/view/pointing.ts";
import { fromTurns } from "../../src/view/rotation.ts";
import { defaultState } from "../../src/view/state.ts";

const take = (pace: Pace, milliseconds: number, steps: number) => {
    for (let i = 0; i < steps; ++i) {
        pace.add(milliseconds);
    }
};

test("steps get longer where the machine is busy, shorter where it is idle, and stay between", () => {
    const after = (milliseconds: number, rate: number) => {
        const pace = new Pace();
        take(pace, milliseconds, 200);
        return pace.advise(rate);
    };
    assert.equal(after(15, 60), 30); // 90% of a second for a second
    assert.equal(after(40, 30), 30); // there are none longer
    assert.equal(after(8, 60), 60); // 48%
    assert.equal(after(1, 60), 120);
    assert.equal(after(0.1, 240), 240);
    assert.equal(after(1, 100), 120); // a rate of one's own
    assert.equal(after(9, 100), 60);
    assert.equal(after(0.1, 1000), 1000); // shorter than any of ours: stays
});

test("a pace that was chosen is kept where steps cost the same", () => {
    for (const cost of [0.2, 1, 3, 6, 12, 30]) {
        let rate = 60;
        const seen = new Set<number>();
        for (let i = 0; i < 20; ++i) {
            const pace = new Pace();
            take(pace, cost, 200);
            rate = pace.advise(rate);
            seen.add(i > 4 ? rate : 0);
        }
        assert.equal(seen.size, 2, `${cost} ms: ${[...seen].join(", ")}`); // the 0 and one rate
        assert.ok(kRates.includes(rate));
    }
});

test("one slow step changes nothing", () => {
    const pace = new Pace();
    take(pace, 8, 200);
    pace.add(60);
    assert.equal(pace.advise(60), 60);
    pace.reset();
    take(pace, 100, 5);
    assert.equal(pace.advise(60), 60, "few steps are no measure");
});

test("a scene among dropped files is found with all that lies in its folder", async () => {
    const text = (value: string) => new Blob([value]);
    const files = new Map([
        ["a/readme.md", text("")],
        ["a/jelly/scene.toml", text("[scene]")],
        ["a/jelly/meshes/jelly.pent", text("ply")],
        ["a/other.pent", text("")],
    ]);
    const scene = sceneAmong([...files.keys()])!;
    assert.equal(scene.path, "scene.toml");
    const taken = await scene.read(files);
    assert.deepEqual([...taken.keys()], ["scene.toml", "meshes/jelly.pent"]);
    assert.equal(new TextDecoder().decode(taken.get("scene.toml")), "[scene]");
});

test("meshes alone, run folders and hidden files are no scenes", () => {
    assert.equal(sceneAmong(["a.pent", "b.txt"]), null);
    assert.equal(sceneAmong([".scene.toml"]), null);
    assert.equal(
        sceneAmong(["run/scene.toml", "run/meshes/a.pent", "run/frames/a_000000.pent"]),
        null,
    );
});

test("an archive has every file, by its name, with its checksum", async () => {
    assert.equal(crc32(new TextEncoder().encode("123456789")), 0xcbf43926);
    const texts = { "run/a.txt": "one", "run/b/\u00e9.txt": "", c: "three".repeat(9999) };
    const files = new Map(
        Object.entries(texts).map(([name, text]) => [name, new TextEncoder().encode(text)]),
    );
    const blob = new Blob(zip(files));
    assert.deepEqual(unzip(new Uint8Array(await blob.arrayBuffer())), files);
});

function volume(mesh: Mesh): number {
    const n = mesh.dimension;
    let sum = 0;
    for (let cell = 0; cell < mesh.cellCount; ++cell) {
        const corner = (k: number, axis: number) =>
            mesh.positions[n * mesh.cells[(n + 1) * cell + k]! + axis]!;
        const edges = Array.from(
            { length: n * n },
            (_, i) => corner(1 + Math.floor(i / n), i % n) - corner(0, i % n),
        );
        const value = determinant(edges, n);
        assert.ok(value > 0, `cell ${cell} is oriented`);
        sum += value;
    }
    return sum / [1, 1, 2, 6, 24][n]!;
}

test("the octopus of the gallery has the volume of its base times its height, and fits together", () => {
    const mesh = readMesh(galleryFiles("octopus").get("octopus.pent")!, "octopus.pent");
    const { facets, facetCount } = makeBoundary(mesh, "octopus.pent"); // throws where it does not fit
    const isBelow = (v: number) => mesh.positions[4 * v + 3] === -0.4;
    const base = Array.from({ length: facetCount }, (_, f) => [
        ...facets.subarray(4 * f, 4 * f + 4),
    ]).filter((facet) => facet.every(isBelow));
    assert.equal(mesh.cellCount, base.length * 3 * 4); // layers of prisms
    const area = base.reduce((sum, [a, ...others]) => {
        const edges = others.flatMap((v) =>
            [0, 1, 2].map((axis) => mesh.positions[4 * v + axis]! - mesh.positions[4 * a! + axis]!),
        );
        return sum + Math.abs(determinant(edges, 3)) / 6;
    }, 0);
    assert.ok(Math.abs(volume(mesh) - 0.8 * area) < 1e-12); // sums of thousands of numbers near 1e-3
});

const bounds = new Bounds();
bounds.add([roomMoment([-1, -1, -1, -1], [2, 1, 1, 1])]);
bounds.settle([roomMoment([-1, -1, -1, -1], [2, 1, 1, 1])]);

function roomMoment(low: number[], high: number[]) {
    const positions = Float32Array.from([...low, ...high]);
    const body = { positions, quantities: new Map() };
    return { frame: 0, time: 0, bodies: [body], obstacles: [] as Obstacle[] };
}

function pictureOf(layout: "single" | "side", reach: [number, number] | null = null) {
    const state = {
        ...defaultState(),
        layout,
        w: 0.25,
        rotation: fromTurns([
            { from: 0, to: 3, degrees: 40 },
            { from: 1, to: 2, degrees: -25 },
        ]),
    };
    return makePicture(state, {
        width: 800,
        height: 500,
        pixelRatio: 1,
        theme: "light",
        dimension: 4,
        bounds,
        obstacles: [],
        reach,
        coloring: makeColoring(state, [0, 1], 1),
    });
}

test("where no body is at the slice the picture knows where they are", () => {
    assert.deepEqual(pictureOf("single", [0.5, 1]).tiles[0]!.away, [0.5, 1]);
    assert.equal(pictureOf("single", [0, 1]).tiles[0]!.away, null);
    const side = pictureOf("side", [-9, 0.25]);
    assert.deepEqual(
        side.tiles.map(({ away }) => away !== null),
        [false, false, true],
    );
    // As it is seen of all vertices.
    const { rotation, shift } = side;
    const moment = roomMoment([-1, 0.5, 0.2, -0.3], [2, 1, 0.7, 0.1]);
    const { positions } = moment.bodies[0]!;
    const seen = [0, 4].map((v) => toSeen(side, [...positions.subarray(v, v + 4)])[3]!);
    const found = reachAlongW(moment, rotation, shift[3]);
    [Math.min(...seen), Math.max(...seen)].forEach((w, end) =>
        assert.ok(Math.abs(w - found[end]!) < 1e-12),
    );
});

test("the picture goes along with bodies that leave its middle, though not along w, and comes back with them", () => {
    const followed = new Bounds();
    const stage = [roomMoment([-2, 0, -2, -1], [2, 2, 2, 1])];
    followed.add(stage);
    followed.settle(stage);
    const pivotAt = (x: number, y: number, z: number, w: number) => {
        followed.follow(roomMoment([x - 1, y, z, w], [x + 1, y, z, w]));
        return followed.pivot;
    };
    const home = [0, 1, 0, 0];
    assert.deepEqual(followed.pivot, home);
    assert.deepEqual(pivotAt(1, 0, -1, 5), home); // a quarter of 4 m, half of 2 m
    assert.deepEqual(pivotAt(3.5, -0.5, -1.5, 0), [2.5, 0.5, -0.5, 0]);
    assert.deepEqual([followed.low[0], followed.high[0]], [0.5, 4.5]);
    assert.deepEqual(pivotAt(0, 1, 0, 0), home);
});

test("what is seen of a point goes back to the point", () => {
    const picture = pictureOf("single");
    const p = [0.3, -0.2, 0.7, 0.1];
    const back = fromSeen(picture, toSeen(picture, p));
    back.forEach((value, axis) => assert.ok(Math.abs(value - p[axis]!) < 1e-12)); // rounding
});

test("a line of sight through a place of the picture meets the point that is seen there", () => {
    const picture = pictureOf("single");
    const seen = [0.4, 0.1, -0.3] as [number, number, number];
    const [x, y] = project(picture, seen);
    const sight = sightAt(picture, x, y);
    assert.equal(sight.w, 0.25);
    const met = onPlane(picture, sight, seen)!;
    // Matrices of the camera are floats.
    met.forEach((value, axis) => assert.ok(Math.abs(value - seen[axis]!) < 1e-5));
    assert.equal(onPlane(picture, sight, add(sight.eye, picture.camera.back, 1)), null, "behind");
});

test("of slices side by side the one that is pointed at counts", () => {
    const picture = pictureOf("side");
    const places = [1 / 6, 1 / 2, 5 / 6].map((x) => sightAt(picture, x, 0.5).w);
    assert.deepEqual(
        places,
        picture.tiles.map((tile) => tile.slices[0]!.w),
    );
    const [left, right] = [1 / 6, 5 / 6].map((x) => sightAt(picture, x, 0.5).direction);
    // Tiles begin at whole pixels.
    left!.forEach((value, axis) => assert.ok(Math.abs(value - right![axis]!) < 2e-3));
});

test("there is room about a scene of one's own, down to its floor", () => {
    const moment = roomMoment([0, 1, 0, 0], [2, 2, 1, 0]);
    const above = (offset: number) => {
        const wall: Obstacle = { kind: "half_space", normal: [0, 0, 0, 1], offset: 0.7 };
        const floor: Obstacle = { kind: "half_space", normal: [0, 1, 0, 0], offset };
        return roomFor({ ...moment, obstacles: [wall, floor] });
    };
    assert.deepEqual(above(-1).low[1], -1);
    const none = roomFor(moment);
    assert.deepEqual([none.low[3], none.high[3]], [0, 0], "none along an axis without extent");
    assert.ok(none.low[0]! < 0 && none.high[0]! > 2 && none.low[1]! < 1);
    const far = above(-1000);
    assert.ok(far.low[1]! > 0, "a floor far below is left out");
});
