import assert from "node:assert/strict";
import { test } from "node:test";
import { Bounds } from "../../src/view/bounds.ts";
import { tesseract } from "../../src/view/box.ts";
import { makeCamera } from "../../src/view/camera.ts";
import { bodyColor, mapColor, suitableRange } from "../../src/view/colors.ts";
import { columnsFor, makeColoring, makePicture, slicePlaces } from "../../src/view/compose.ts";
import { transform } from "../../src/view/matrix.ts";
import { project } from "../../src/view/pointing.ts";
import {
    apply,
    applyTurn,
    axesOf,
    formatTurns,
    fromTurns,
    identity,
    kPlanes,
    orthonormalize,
    parseTurns,
    toTurns,
} from "../../src/view/rotation.ts";
import type { Rotation } from "../../src/view/rotation.ts";
import { defaultState, formatState, parseState } from "../../src/view/state.ts";
import { randomFrom } from "../support/native.ts";

function distance(a: Rotation, b: Rotation): number {
    return Math.max(...a.map((value, i) => Math.abs(value - b[i]!)));
}

function randomRotation(random: () => number): Rotation {
    return fromTurns(
        Array.from({ length: 9 }, () => {
            const [from, to] = axesOf(kPlanes[Math.floor(6 * random())]!);
            return { from, to, degrees: 720 * random() - 360 };
        }),
    );
}

test("the plane xw takes x towards w", () => {
    const R = fromTurns([{ from: 0, to: 3, degrees: 90 }]);
    assert.deepEqual(
        apply(R, [1, 0, 0, 0]).map((x) => Math.round(x * 1e9) / 1e9),
        [0, 0, 0, 1],
    );
    const back = fromTurns([{ from: 3, to: 0, degrees: 90 }]);
    applyTurn(back, 0, 3, 90);
    assert.ok(distance(back, identity()) < 1e-12);
});

test("turns apply in the order written", () => {
    const R = fromTurns(parseTurns("xy:90,yw:90")!);
    assert.ok(Math.abs(apply(R, [1, 0, 0, 0])[3] - 1) < 1e-12);
});

test("every rotation is the product of the turns it is told as, at most six", () => {
    const random = randomFrom(2);
    for (let i = 0; i < 200; ++i) {
        const R = randomRotation(random);
        const turns = toTurns(R);
        assert.ok(turns.length <= 6);
        assert.ok(distance(fromTurns(turns), R) < 1e-12);
        // Two digits of a degree are 1e-4 of an angle, six times.
        assert.ok(distance(fromTurns(parseTurns(formatTurns(turns))!), R) < 1e-3);
    }
    assert.equal(formatTurns(toTurns(identity())), "");
    assert.equal(formatTurns(toTurns(fromTurns(parseTurns("xw:30")!))), "xw:30");
});

test("rounding of many turns is taken out", () => {
    const random = randomFrom(3);
    const R = randomRotation(random);
    const rough = R.map((value) => value + 1e-3 * (random() - 0.5));
    orthonormalize(rough);
    for (let i = 0; i < 4; ++i) {
        for (let j = 0; j < 4; ++j) {
            const along = [0, 1, 2, 3].reduce(
                (sum, k) => sum + rough[4 * i + k]! * rough[4 * j + k]!,
                0,
            );
            assert.ok(Math.abs(along - (i === j ? 1 : 0)) < 1e-12);
        }
    }
});

test("what is no list of turns is refused", () => {
    for (const text of ["xx:3", "xw", "xw:", "xq:3", "xw:1e999", "xw:30;yz:2"]) {
        assert.equal(parseTurns(text), null, text);
    }
});

test("a state survives the address, whatever it is", () => {
    const random = randomFrom(4);
    for (let i = 0; i < 100; ++i) {
        const state = defaultState();
        state.rotation = randomRotation(random);
        // All digits: of bodies of 10^-12 m, of those far from 0, and of all between.
        const size = 10 ** (-12 + 31 * random());
        state.w = size * (random() - 0.5) + (random() < 0.5 ? 1e6 : 0);
        state.spacing = size;
        state.frame = Math.floor(1000 * random());
        state.layout = (["single", "side", "onion"] as const)[Math.floor(3 * random())]!;
        state.slices = 2 + Math.floor(8 * random());
        state.color = (["body", "w", "strain"] as const)[Math.floor(3 * random())]!;
        state.range = [size * random(), size * (1 + random())];
        state.smooth = random() < 0.5;
        state.orbit = { azimuth: -12.5, elevation: 40, zoom: 2, panX: 0.25, panY: 0 };
        const text = formatState(state);
        const { state: again, unknown } = parseState(`#${text}`);
        assert.deepEqual(unknown, []);
        assert.ok(distance(again.rotation, state.rotation) < 1e-3);
        assert.deepEqual({ ...again, rotation: null }, { ...state, rotation: null });
    }
    assert.equal(formatState(defaultState()), "");
});

test("what is not understood in an address is named, and the rest holds", () => {
    const { state, unknown } = parseState(
        "#w=0.1&rotat=xw:3&slices=77&layout=pile&%=%&smooth=off" +
            "&camera=1,2,0,0,0&range=2,1&__proto__=1&speed=x",
    );
    assert.equal(state.w, 0.1);
    assert.equal(state.smooth, false);
    assert.equal(state.speed, 1);
    assert.deepEqual(unknown, [
        "rotat=xw:3",
        "slices=77",
        "layout=pile",
        "%=%",
        "camera=1,2,0,0,0",
        "range=2,1",
        "__proto__=1",
        "speed=x",
    ]);
});

function boundsOf(points: number[][]): Bounds {
    const moment = {
        frame: 0,
        time: 0,
        obstacles: [],
        bodies: [
            {
                positions: Float32Array.from(points.flat()),
                quantities: new Map(),
            },
        ],
    };
    const bounds = new Bounds();
    bounds.add([moment]);
    bounds.settle([moment]);
    return bounds;
}

test("the pivot is the origin for bodies about it, and in their middle elsewhere", () => {
    assert.deepEqual(
        boundsOf([
            [-1, -1, 0, 0],
            [1.1, 1, 0, 0],
        ]).pivot,
        [0, 0, 0, 0],
    );
    const far = boundsOf([
        [9, 0, 0, 4],
        [11, 0, 0, 6],
    ]);
    assert.deepEqual(far.pivot, [10, 0, 0, 5]);
    const R = fromTurns([{ from: 0, to: 3, degrees: 50 }]);
    const shift = far.shift(R);
    const seen = apply(R, far.pivot).map((value, k) => value + shift[k]!);
    seen.forEach((value, k) => assert.ok(Math.abs(value - far.pivot[k]!) < 1e-12));
});

test("the reach of a turned box holds all that is in it", () => {
    const random = randomFrom(6);
    const points = Array.from({ length: 50 }, () => [0, 1, 2, 3].map(() => 4 * random() + 1));
    const bounds = boundsOf(points);
    const R = randomRotation(random);
    const shift = bounds.shift(R);
    for (let axis = 0; axis < 4; ++axis) {
        const [low, high] = bounds.reach(R, axis);
        for (const p of points) {
            const value = apply(R, p)[axis]! + shift[axis]!;
            assert.ok(value > low - 1e-5 && value < high + 1e-5); // points are floats
        }
    }
});

test("a tesseract has 32 edges, and its slice through the middle is a cube", () => {
    const bounds = boundsOf([
        [-1, -1, -1, -1],
        [1, 1, 1, 1],
    ]);
    const film = (p: number[]) => [p[0]!, p[1]!, p[2]!] as [number, number, number];
    const lines = tesseract(bounds, identity(), 0.25, film, [0, 0, 0]);
    assert.equal(lines.length, 32 + 12);
    // Across the long diagonal it is an octahedron; that the slice meets vertices makes some edges
    // of no length.
    const across = Float64Array.of(1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1, 1, 1, 1, 1).map(
        (value) => value / 2,
    );
    const edges = tesseract(bounds, across, 0, film, [0, 0, 0])
        .slice(32)
        .map(({ a, b }) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]))
        .filter((length) => length > 1e-9);
    assert.equal(edges.length, 12);
    assert.ok(edges.every((length) => Math.abs(length - Math.SQRT2 * 2) < 1e-9));
});

test("the box about the bodies is in the picture where it is asked for, whatever the bodies are", () => {
    const bodies = [
        [1, 1, 1, 1, -1, -1, -1, -1],
        // A ball, which the box about it is much larger than.
        [0, 1, 2, 3].flatMap((axis) =>
            [1, -1].flatMap((x) => [0, 1, 2, 3].map((k) => (k === axis ? x : 0))),
        ),
        [3, 0, 0, 0.1, 0, 0.2, 0.1, 0, 1, 0, 0.3, 0.1],
    ];
    for (const positions of bodies) {
        const body = { positions: Float32Array.from(positions), quantities: new Map() };
        const moment = { frame: 0, time: 0, bodies: [body], obstacles: [] };
        const bounds = new Bounds();
        bounds.add([moment]);
        bounds.settle([moment]);
        for (const [width, height] of [
            [400, 300],
            [320, 640],
        ] as const) {
            const picture = makePicture(
                { ...defaultState(), box: true },
                {
                    width,
                    height,
                    pixelRatio: 1,
                    theme: "light",
                    dimension: 4,
                    bounds,
                    coloring: makeColoring(defaultState(), [0, 1], 1),
                    obstacles: [],
                    reach: null,
                },
            );
            const ends = picture.tiles[0]!.lines.flatMap(({ a, b }) => [a, b]);
            assert.ok(ends.length > 0);
            for (const end of ends) {
                const [x, y] = project(picture, end);
                assert.ok(x > 0 && x < 1 && y > 0 && y < 1, `${end} at ${x} ${y}`);
            }
        }
    }
});

test("slices lie about w, evenly", () => {
    const bounds = boundsOf([
        [-1, -1, -1, -1],
        [1, 1, 1, 1],
    ]);
    const state = { ...defaultState(), w: 0.5, layout: "side" as const, slices: 3, spacing: 0.2 };
    assert.deepEqual(
        slicePlaces(state, bounds, 4).map((w) => Number(w.toFixed(9))),
        [0.3, 0.5, 0.7],
    );
    assert.deepEqual(slicePlaces(state, bounds, 3), [0.5]);
});

test("tiles are as large as can be", () => {
    assert.equal(columnsFor(3, 1200, 400), 3);
    assert.equal(columnsFor(3, 390, 700), 1);
    assert.equal(columnsFor(4, 800, 700), 2);
    assert.equal(columnsFor(1, 10, 900), 1);
});

test("the camera sees what it looks at in the middle, and depth between near and far", () => {
    const camera = makeCamera(
        { azimuth: 200, elevation: -30, zoom: 1.5, panX: 0, panY: 0 },
        [1, 2, 3],
        2,
        1.6,
    );
    const [x, y, z, w] = transform(camera.viewProjection, [1, 2, 3]);
    assert.ok(Math.abs(x / w) < 1e-5 && Math.abs(y / w) < 1e-5 && Math.abs(z / w) < 1);
});

test("the camera sees the whole ball, and little else, in pictures of any shape", () => {
    const random = randomFrom(5);
    for (const aspect of [0.3, 1, 1.6, 4]) {
        const camera = makeCamera(
            { azimuth: 40, elevation: 20, zoom: 1, panX: 0, panY: 0 },
            [1, 2, 3],
            2,
            aspect,
        );
        let most = 0;
        for (let i = 0; i < 20000; ++i) {
            const direction = [0, 1, 2].map(() => random() + random() + random() - 1.5);
            const scale = 2 / Math.hypot(...direction);
            const at = direction.map((value, k) => k + 1 + scale * value);
            const [x, y, , w] = transform(camera.viewProjection, at as [number, number, number]);
            most = Math.max(most, Math.abs(x / w), Math.abs(y / w));
        }
        assert.ok(most > 0.95 && most <= 1, `${most} at ${aspect}`);
    }
});

test("colors are clamped at the ends, and those of bodies begin again after eight", () => {
    assert.deepEqual(mapColor("speed", -5), mapColor("speed", 0));
    assert.deepEqual(mapColor("w", 7), mapColor("w", 1));
    assert.deepEqual(bodyColor(8), bodyColor(0));
    const luminance = ([r, g, b]: number[]) => 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
    assert.ok(luminance(mapColor("w", 0.5)) > luminance(mapColor("w", 0)));
});

test("one bad element does not take the colors from all others", () => {
    const values = Float32Array.from({ length: 1000 }, (_, i) => (i === 3 ? 1e9 : i / 1000));
    assert.ok(suitableRange(values, "strain")[1] < 1);
    assert.deepEqual(suitableRange(Float32Array.of(-2, 5, 1), "w"), [-2, 5]);
    assert.deepEqual(suitableRange(new Float32Array(0), "speed"), [0, 0]);
});
