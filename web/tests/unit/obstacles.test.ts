import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { readObstacles } from "../../src/format/obstacles.ts";
import type { Obstacle } from "../../src/format/obstacles.ts";
import { makeBoundary } from "../../src/mesh/boundary.ts";
import { gridMesh } from "../../src/mesh/grid.ts";
import { add, cross, dot, scale } from "../../src/view/matrix.ts";
import type { Vector } from "../../src/view/matrix.ts";
import { Boxes } from "../../src/view/boxes.ts";
import {
    ballOutline,
    ballSurface,
    groundOf,
    isAllSolid,
    sliceObstacle,
} from "../../src/view/obstacles.ts";
import type { ObstacleSlice, Round } from "../../src/view/obstacles.ts";
import { apply, fromTurns, parseTurns } from "../../src/view/rotation.ts";
import { native, randomFrom } from "../support/native.ts";
import { obstaclesFile, pointOf } from "../support/obstacles.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

const kUnit = Math.sqrt(0.25);
const kRounds: Round[] = [
    { kind: "half_space", normal: [0, 1, 0, 0], offset: -0.3 },
    { kind: "half_space", normal: [kUnit, kUnit, kUnit, kUnit], offset: 0.4 },
    { kind: "half_space", normal: [0, 0, 0, 1], offset: 0.1 },
    { kind: "ball", center: [0.3, -0.2, 0.1, 0.2], radius: 0.7 },
    { kind: "cavity", center: [0.1, 0.1, 0, -0.2], radius: 1.1 },
    { kind: "bowl", center: [0, 0.2, 0.1, 0.1], radius: 0.9, up: [0, 1, 0, 0] },
    { kind: "bowl", center: [0, 0.2, 0.1, 0.1], radius: 0.9, up: [0, 0.6, 0, 0.8] },
];

function isSolid(obstacle: Round, p: readonly number[]): boolean {
    const product = (n: number[], q: readonly number[]) =>
        n.reduce((sum, x, i) => sum + x * q[i]!, 0);
    if (obstacle.kind === "half_space") {
        return product(obstacle.normal, p) < obstacle.offset;
    }
    const away = p.map((x, i) => x - obstacle.center[i]!);
    const isWithin = Math.hypot(...away) < obstacle.radius;
    return obstacle.kind === "ball"
        ? isWithin
        : !isWithin && (obstacle.kind === "cavity" || product(obstacle.up, away) < 0);
}

function isSolidIn({ isEmpty, plane, ball, hollow }: ObstacleSlice, q: Vector): boolean {
    const within = (one: { center: Vector; radius: number }) =>
        Math.hypot(...add(q, one.center, -1)) < one.radius;
    if (isEmpty || (hollow && within(hollow))) {
        return false;
    }
    return ball ? within(ball) : plane ? dot(plane.normal, q) < plane.offset : true;
}

const kRotations = ["", "xw:40", "yz:20,zw:-65,xw:110", "yw:90"].map((text) =>
    fromTurns(parseTurns(text)!),
);

test("a slice of an obstacle is solid exactly where the obstacle is", () => {
    const random = randomFrom(7);
    const any = () => 3 * random() - 1.5;
    const kinds = new Set<string>();
    for (let round = 0; round < 300; ++round) {
        const rotation = kRotations[round % kRotations.length]!;
        const section = {
            rotation,
            shift: [any(), any(), any(), any()].map((x) => x / 4),
            w: any(),
        };
        for (const obstacle of kRounds) {
            const slice = sliceObstacle(obstacle, section);
            kinds.add(
                `${obstacle.kind} ${slice.isEmpty ? "empty" : isAllSolid(slice) ? "all" : "some"}`,
            );
            for (let i = 0; i < 20; ++i) {
                const q: Vector = [any(), any(), any()];
                const moved = [...q, section.w].map((x, axis) => x - section.shift[axis]!);
                const p = [0, 1, 2, 3].map((k) =>
                    moved.reduce((sum, x, row) => sum + rotation[4 * row + k]! * x, 0),
                );
                assert.equal(isSolidIn(slice, q), isSolid(obstacle, p), obstacle.kind);
            }
        }
    }
    // All that can be met was met.
    for (const kind of ["half_space empty", "half_space all", "half_space some", "ball empty"]) {
        assert.ok(kinds.has(kind), kind);
    }
    assert.ok(kinds.has("cavity all") && kinds.has("bowl some") && kinds.has("bowl all"));
});

test("in three dimensions an obstacle is whole", () => {
    const section = { rotation: kRotations[0]!, shift: [0, 0, 0, 0], w: null };
    const ball = sliceObstacle({ kind: "ball", center: [1, 2, 3], radius: 2 }, section);
    assert.deepEqual(ball.ball, { center: [1, 2, 3], radius: 2 });
    const ground = sliceObstacle({ kind: "half_space", normal: [0, 0, 1], offset: 4 }, section);
    assert.deepEqual(ground.plane, { normal: [0, 0, 1], offset: 4 });
});

const kView = { center: [0.2, 0.1, -0.1] as Vector, reach: 4 };

test("ground lies on the surface of the solid, and faces what is free", () => {
    const random = randomFrom(11);
    let count = 0;
    for (const rotation of kRotations) {
        for (const w of [-0.4, 0, 0.05, 0.3]) {
            for (const obstacle of kRounds) {
                const slice = sliceObstacle(obstacle, { rotation, shift: [0, 0, 0, 0], w });
                if (slice.isEmpty) {
                    continue;
                }
                const { surfaces, rims } = groundOf(slice, kView);
                for (const surface of [...surfaces, ...rims]) {
                    for (let i = 0; i < 30; ++i, ++count) {
                        const [part, turn] = [0.02 + 0.96 * random(), 2 * Math.PI * random()];
                        const p = pointOf(surface, part, turn);
                        // Its front by the order of corners, as the shader has them.
                        const along = add(pointOf(surface, part + 1e-4, turn), p, -1);
                        const around = add(pointOf(surface, part, turn + 1e-4), p, -1);
                        const n = cross(along, around);
                        const step = scale(n, 1e-3 / Math.hypot(...n));
                        assert.equal(isSolidIn(slice, add(p, step, 1)), false, obstacle.kind);
                        assert.equal(isSolidIn(slice, add(p, step, -1)), true, obstacle.kind);
                        const far = Math.hypot(...add(p, kView.center, -1));
                        assert.ok(far > surface.nearest - 1e-9, "none is nearer");
                    }
                }
            }
        }
    }
    assert.ok(count > 1000);
});

test("a large ball is shown where it is near, as far as ground is seen", () => {
    const slice = { isEmpty: false, plane: null, hollow: null };
    const ball = { center: [0, -1000, 0] as Vector, radius: 999 };
    const [cap] = groundOf({ ...slice, ball }, kView).surfaces;
    const end = pointOf(cap!, 1, 0.3);
    const spread = Math.sqrt(Math.hypot(...add(end, kView.center, -1)) ** 2 - cap!.nearest ** 2);
    assert.ok(Math.abs(spread - kView.reach) < 1e-6); // distances near 1000 are right to 1e-10
    assert.ok(Math.abs(Math.hypot(...add(end, ball.center, -1)) - ball.radius) < 1e-9);
});

test("the outline of a ball is that of its image on the film", () => {
    const center = [0.4, -0.3, 0.5, -0.6];
    const ball: Obstacle = { kind: "ball", center, radius: 0.5 };
    const random = randomFrom(5);
    for (const rotation of kRotations) {
        for (const eye of [
            [0.1, 0.2, -0.3, 3],
            [0.1, 0.2, -0.3, 0],
            [...apply(rotation, center).slice(0, 3), 2.5], // right above
        ] as [number, number, number, number][]) {
            const section = { rotation, shift: [0, 0, 0, 0], w: 0.2 };
            const outline = ballOutline(ball, section, eye)!;
            const middle = apply(rotation, center);
            let most = 0;
            for (let i = 0; i < 20000; ++i) {
                // Points of the ball, even over it.
                const n = [0, 1, 2, 3].map(
                    () => Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(7 * random()),
                );
                const size = Math.hypot(...n) / ball.radius;
                const q = n.map((x, axis) => middle[axis]! + x / size);
                const grow = eye[3] > 0 ? eye[3] / (eye[3] - (q[3]! - section.w)) : 1;
                const image = [0, 1, 2].map((k) => eye[k]! + (q[k]! - eye[k]!) * grow) as Vector;
                const away = add(image, outline.center, -1);
                const place = Math.hypot(
                    ...outline.axes.map((axis) => dot(away, axis) / dot(axis, axis)),
                );
                assert.ok(place < 1 + 1e-9, `${place}`);
                most = Math.max(most, place);
            }
            assert.ok(most > 0.995, `${most}`); // of so many points some are near it
        }
    }
    const near = [0, 0, 0, 0.3] as [number, number, number, number];
    const film = { rotation: kRotations[0]!, shift: [0, 0, 0, 0], w: 0 };
    const around: Obstacle = { kind: "ball", center: [0, 0, 0, 0], radius: 0.5 };
    assert.equal(ballOutline(around, film, near), null, "the eye is in the ball");
});

test("a box is a closed body of the box's volume", () => {
    for (const dimension of [3, 4] as const) {
        const mesh = gridMesh(dimension === 3 ? [1, 1, 1] : [1, 1, 1, 1], (p) =>
            p.map((x) => x / 2),
        );
        assert.equal(mesh.cellCount, dimension === 3 ? 6 : 24);
        const { facetCount, facets } = makeBoundary(mesh, "box");
        assert.equal(facetCount, dimension === 3 ? 12 : 48);
        if (dimension === 3) {
            let volume = 0;
            for (let f = 0; f < facetCount; ++f) {
                const [a, b, c] = [0, 1, 2].map((k) => {
                    const v = 3 * facets[4 * f + k]!;
                    return [...mesh.positions.slice(v, v + 3)] as Vector;
                });
                volume += dot(a!, cross(b!, c!)) / 6;
            }
            assert.ok(Math.abs(volume - 1) < 1e-12); // outward, of sums of twelve
        }
    }
});

test("a box that is turned has its corners where its axes take them", () => {
    const center = [0.1, 0.2, 0.3, 0.4];
    const sides = [1, 0.2, 0.6, 0.8];
    const axes = [
        [0.6, 0, 0, 0.8],
        [0, 1, 0, 0],
        [0, 0, 1, 0],
        [-0.8, 0, 0, 0.6],
    ];
    const boxes = new Boxes().of([{ kind: "box", center, sides, axes }], 4);
    const { positions } = boxes[0]!.frame;
    assert.equal(positions.length, 4 * 16);
    for (let v = 0; v < 16; ++v) {
        const away = center.map((x, i) => positions[4 * v + i]! - x);
        axes.forEach((axis, k) => {
            const along = axis.reduce((sum, x, i) => sum + x * away[i]!, 0);
            assert.ok(Math.abs(Math.abs(along) - sides[k]! / 2) < 1e-6);
        });
    }
});

test("obstacles that are wrong are refused in the words of the other programs", () => {
    const ball = { kind: "ball", center: [0, 0, 0], radius: 1 };
    const refusal = (entry: unknown) => {
        try {
            readObstacles(
                { pent_obstacles: 1, dimension: 3, obstacles: [ball, entry] },
                "run/obstacles.json",
                3,
            );
        } catch (error) {
            return (error as Error).message;
        }
        return "";
    };
    const where = "run/obstacles.json: obstacle 2: ";
    const kinds = "expected half_space, ball, cavity, bowl or box";
    assert.equal(refusal(3), `${where}found no kind; ${kinds}`);
    assert.equal(
        refusal({ kind: "cap\nsule" }),
        `${where}found an obstacle of kind "cap\\nsule"; ${kinds}; a newer pent-sim may have made it`,
    );
    const wrong = (key: string, expected: string) =>
        `${where}"${key}" is missing or out of range; expected ${expected}`;
    assert.equal(refusal({ ...ball, center: [0, 0] }), wrong("center", "3 finite numbers"));
    assert.equal(refusal({ ...ball, center: [0, 0, "0"] }), wrong("center", "3 finite numbers"));
    assert.equal(refusal({ ...ball, radius: 0 }), wrong("radius", "a number above 0"));
    assert.equal(
        refusal({ kind: "half_space", normal: [0, 2, 0], offset: 0 }),
        wrong("normal", "3 numbers, of length 1 together"),
    );
    assert.equal(
        refusal({ kind: "half_space", normal: [0, 1, 0] }),
        wrong("offset", "a finite number"),
    );
    assert.equal(
        refusal({ kind: "box", center: [0, 0, 0], sides: [1, 0, 1] }),
        wrong("sides", "3 numbers above 0"),
    );
    const box = { kind: "box", center: [0, 0, 0], sides: [1, 2, 3] };
    for (const axes of [
        [],
        3,
        [1, 0, 0],
        [
            [1, 0, 0],
            [0, 1, 0],
            [0, 0, -1],
        ],
        [
            [1, 0, 0],
            [0, 1, 0],
            [0, 0.1, 1],
        ],
    ]) {
        assert.equal(
            refusal({ ...box, axes }),
            wrong("axes", "3 vectors of length 1 across one another"),
        );
    }
    assert.match(
        refusal({ ...ball, poses: [] }),
        /found the key "poses", which is not known; a newer/,
    );
    for (const text of ["", "{", "[]", "null", "{}", '{"pent_obstacles": 2, "obstacles": []}']) {
        assert.throws(
            () => readObstacles(text, "o.json", 4),
            /^Error: o\.json: is not the list of/,
        );
    }
    assert.throws(
        () => readObstacles(obstaclesFile([], 3), "o.json", 4),
        /o\.json: has no dimension or another; expected 4 as the bodies have/,
    );
});

/** Vertices of a PLY of pent-slice. */
function verticesOf(path: string): Vector[] {
    const bytes = readFileSync(path);
    const end = bytes.indexOf("end_header\n") + "end_header\n".length;
    const header = bytes.subarray(0, end).toString("latin1");
    const count = Number(/element vertex (\d+)/.exec(header)![1]);
    const sizes = { double: 8, float: 4, uchar: 1, int: 4, uint: 4 };
    const row = [...header.split("element face")[0]!.matchAll(/property (\w+) \w+/g)].reduce(
        (sum, match) => sum + sizes[match[1] as keyof typeof sizes],
        0,
    );
    return Array.from(
        { length: count },
        (_, i) => [0, 8, 16].map((at) => bytes.readDoubleLE(end + i * row + at)) as Vector,
    );
}

test("slices of obstacles are those of pent-slice", (t) => {
    const slicer = native("pent-slice");
    if (!slicer) {
        t.skip("pent-slice is not built");
        return;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    const run = join(folder, "run");
    const mesh = writeMesh(gridMesh([1, 1, 1, 1], (p) => p));
    const corners = [...gridMesh([1, 1, 1, 1], (p) => p).positions];
    try {
        ["meshes", "frames"].forEach((part) => mkdirSync(join(run, part), { recursive: true }));
        writeFileSync(join(run, "meshes/body.pent"), mesh);
        const frame = writeFrame(mesh, 0, 0, corners, corners);
        writeFileSync(join(run, "frames/body_000000.pent"), frame);
        writeFileSync(join(run, "obstacles.json"), obstaclesFile(kRounds));
        let compared = 0;
        ["", "xw:40", "yz:20,zw:-65,xw:110"].forEach((turns, place) =>
            [-0.3, 0.15].forEach((w) => {
                const out = join(folder, `slices ${place} ${w}`);
                const rotate = turns.split(",").flatMap((turn) => (turn ? ["--rotate", turn] : []));
                const options = ["--obstacles", "--quiet", `--w=${w}`, ...rotate];
                execFileSync(slicer, [run, "-o", out, ...options]);
                const rotation = fromTurns(turns ? parseTurns(turns)! : []);
                kRounds.forEach((obstacle, i) => {
                    const slice = sliceObstacle(obstacle, { rotation, shift: [0, 0, 0, 0], w });
                    const found = verticesOf(join(out, `obstacle.${i + 1}_000000.ply`));
                    assert.equal(found.length === 0, slice.isEmpty || isAllSolid(slice));
                    const { plane } = slice;
                    const round = slice.ball ?? slice.hollow;
                    for (const p of found) {
                        const toRound = round
                            ? Math.abs(Math.hypot(...add(p, round.center, -1)) - round.radius)
                            : Infinity;
                        const toPlane = plane
                            ? Math.abs(dot(plane.normal, p) - plane.offset)
                            : Infinity;
                        // Rounding of sums near 1, and in the file.
                        assert.ok(Math.min(toRound, toPlane) < 1e-9, `${obstacle.kind} ${i}`);
                        ++compared;
                    }
                    if (slice.ball) {
                        // All of it: its middle is the mean of two poles that are vertices.
                        const surface = ballSurface(slice.ball);
                        const top = pointOf(surface, 0, 0);
                        const gap = Math.min(...found.map((p) => Math.hypot(...add(p, top, -1))));
                        assert.ok(gap < 1e-9);
                    }
                });
            }),
        );
        assert.ok(compared > 10000);
    } finally {
        rmSync(folder, { recursive: true });
    }
});
