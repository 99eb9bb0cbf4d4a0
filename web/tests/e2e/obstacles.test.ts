import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { gridMesh } from "../../src/mesh/grid.ts";
import type { Obstacle } from "../../src/format/obstacles.ts";
import { difference, openPage, pixels, useBrowser, useServer } from "../support/browser.ts";
import { obstaclesFile } from "../support/obstacles.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

const kCube = gridMesh([1, 1, 1, 1], (p) => p.map((x) => x / 2) as typeof p);
const kMesh = writeMesh(kCube);
const kFrame = writeFrame(kMesh, 0, 0, [...kCube.positions], [...kCube.positions]);
const kBall: Obstacle = { kind: "ball", center: [0.9, 0.2, 0.3, 0.2], radius: 0.6 };
const kBox: Obstacle = { kind: "box", center: [-1, 0, 0.2, 0.1], sides: [0.6, 0.8, 0.5, 0.7] };
const kGround: Obstacle = { kind: "half_space", normal: [0, 1, 0, 0], offset: -0.5 };

const files = new Map<string, Uint8Array | string>();

/** A run of some frames in which a cube stands still. */
function addRun(
    name: string,
    listing: string,
    obstacles: Record<string, string>,
    frames = 1,
): void {
    files.set(`${name}/meshes/cube.pent`, kMesh);
    for (let frame = 0; frame < frames; ++frame) {
        files.set(`${name}/frames/cube_00000${frame}.pent`, kFrame);
    }
    const ranges = `"frames":{"cube":[[0,${frames - 1}]]}`;
    files.set(`${name}/run.json`, `{"meshes":["cube"],${ranges},"follow":false${listing}}`);
    Object.entries(obstacles).forEach(([path, text]) => files.set(`${name}/${path}`, text));
}

const kStill = ',"obstacles":"still"';
addRun("none", ',"obstacles":"none"', {});
addRun("all", kStill, { "obstacles.json": obstaclesFile([kGround, kBall, kBox]) });
addRun("inside", kStill, {
    "obstacles.json": obstaclesFile([{ kind: "half_space", normal: [0, 0, 0, 1], offset: -0.2 }]),
});
addRun("unlisted", "", { "obstacles.json": obstaclesFile([kGround]) });
const moving = [0, 1, 2].map((frame): Obstacle => ({ ...kBall, center: [0.9, frame, 0.3, 0] }));
addRun(
    "moving",
    ',"obstacles":"moving"',
    Object.fromEntries(
        moving.map((ball, i) => [`obstacles/00000${i}.json`, obstaclesFile([ball])]),
    ),
    3,
);
addRun("torn", kStill, { "obstacles.json": '{"pent_obstacles": 1, "dimen' });
addRun("newer", kStill, {
    "obstacles.json": obstaclesFile([{ kind: "torus" } as unknown as Obstacle]),
});
addRun(
    "gaps",
    ',"obstacles":"moving"',
    {
        "obstacles/000000.json": obstaclesFile([kBall]),
        "obstacles/000001.json": obstaclesFile([{ ...kBall, radius: -1 } as Obstacle]),
        "obstacles/000002.json": obstaclesFile([kBall]),
    },
    3,
);
// Two bowls of the same place and a ball within: the rim hides it and shows it.
for (const [name, radius] of [
    ["bowl", 1.2],
    ["cavity", 1.4],
] as const) {
    const up = name === "bowl" ? { up: [0, 1, 0, 0] } : {};
    const obstacle = { kind: name, center: [0, 0.4, 0, 0], radius, ...up } as Obstacle;
    addRun(name, kStill, { "obstacles.json": obstaclesFile([obstacle]) });
}

const browser = useBrowser();
const server = useServer(files);
const open = (query: string, options = {}) =>
    openPage(browser.get(), server.address() + query, options);
const errorText = (page: Page) => page.locator(".message.error").first().innerText();

/** Vertices of what the card draws: of a box by its number behind the bodies, or of a ball. */
function captured(page: Page, what: "ball" | "box"): Promise<number[]> {
    return page.evaluate((what) => {
        const { viewer } = window.pentimento!;
        const picture = viewer.makePicture(32, 32, 1);
        const slice = picture.tiles[0]!.slices[0]!;
        return [
            ...(what === "ball"
                ? viewer.renderer.captureRevolved(picture, slice.balls[0]!)
                : viewer.renderer.captureSlice(picture, 1, slice.w)),
        ];
    }, what);
}

/** Volume within triangles, and edges that have not two of them. */
function measure(numbers: number[]): { volume: number; open: number } {
    let volume = 0;
    const edges = new Map<string, number>();
    for (let i = 0; i < numbers.length; i += 9) {
        const [a, b, c, d, e, f, g, h, k] = numbers.slice(i, i + 9) as [
            number,
            number,
            number,
            number,
            number,
            number,
            number,
            number,
            number,
        ];
        volume += (a * (e * k - f * h) - b * (d * k - f * g) + c * (d * h - e * g)) / 6;
        const corners = [`${a} ${b} ${c}`, `${d} ${e} ${f}`, `${g} ${h} ${k}`];
        corners.forEach((corner, j) => {
            const next = corners[(j + 1) % 3]!;
            if (corner !== next) {
                const [key, way] = corner < next ? [corner + next, 1] : [next + corner, -1];
                edges.set(key, (edges.get(key) ?? 0) + way);
            }
        });
    }
    return { volume, open: [...edges.values()].filter((count) => count !== 0).length };
}

test("the card draws balls and boxes of obstacles closed, outward and where they are", async () => {
    const { page, said, close } = await open("?run=all#w=0.1&shade=off");
    const ball = await captured(page, "ball");
    const radius = Math.sqrt(0.6 ** 2 - 0.1 ** 2);
    for (let i = 0; i < ball.length; i += 3) {
        const away = [0.9, 0.2, 0.3].map((x, axis) => ball[i + axis]! - x);
        assert.ok(Math.abs(Math.hypot(...away) - radius) < 1e-6); // floats near 1
    }
    const round = measure(ball);
    assert.equal(round.open, 0);
    // A polyhedron within the ball: 64 around and 32 upright, 0.4 percent each.
    const whole = (4 / 3) * Math.PI * radius ** 3;
    assert.ok(round.volume < whole && round.volume > 0.99 * whole, `${round.volume} of ${whole}`);
    const box = measure(await captured(page, "box"));
    assert.equal(box.open, 0);
    assert.ok(Math.abs(box.volume - 0.6 * 0.8 * 0.5) < 1e-6);
    assert.deepEqual(
        said.filter((text) => /thrown|error/i.test(text)),
        [],
    );
    await close();
});

test("the slice of a turned box has the volume that it must have, and none where it misses", async () => {
    const { page, close } = await open("?run=all#w=0.2&rotate=xw:90&shade=off");
    // x has become w: the box has 0.7 along the new x, for -1.3 < w < -0.7.
    assert.equal((await captured(page, "box")).length, 0);
    await page.evaluate(() => window.pentimento!.viewer.update({ w: -1 }));
    const box = measure(await captured(page, "box"));
    assert.ok(Math.abs(box.volume - 0.7 * 0.8 * 0.5) < 1e-6, `${box.volume}`);
    await close();
});

test("obstacles are seen, in all layouts and themes, and not where they are switched off", async () => {
    const { page, close } = await open("?run=all#w=0.1&shade=off");
    for (const view of [
        "&shade=off",
        "&shade=off&theme=dark",
        "&shade=off&layout=side&slices=2&spacing=0.2",
        "&shade=off&layout=onion&spacing=0.2",
        "&shade=off&ghost=perspective",
        "&shade=on",
    ]) {
        // The address as one changes it by hand.
        await page.evaluate((view) => void (location.hash = view), `w=0.1${view}`);
        await page.waitForFunction(() => window.pentimento!.viewer.state.obstacles);
        const on = await pixels(page);
        await page.evaluate(() => window.pentimento!.viewer.update({ obstacles: false }));
        const off = await pixels(page);
        assert.ok(difference(on, off, 8) > 0.2, `${view}: ${difference(on, off, 8)}`);
    }
    await close();
});

test("a switch in the panel hides obstacles, the address has it, and runs without any have none", async () => {
    const { page, close } = await open("?run=all#shade=off");
    const toggle = page.locator("#panel label", { hasText: "Obstacles" });
    assert.ok(await toggle.locator("input").isChecked());
    await toggle.click();
    await page.waitForFunction(() => location.hash.includes("obstacles=off"));
    assert.equal(await page.evaluate(() => window.pentimento!.viewer.state.obstacles), false);
    await close();
    const bare = await open("?run=none#shade=off");
    assert.equal(
        await bare.page.locator("#panel label", { hasText: "Obstacles" }).isVisible(),
        false,
    );
    await bare.close();
});

test("one looks into hollows, and what their rim hides shows through", async () => {
    // Pixels of the body's color, red over blue, also where a veil is before it.
    const orange = (picture: number[]) => {
        let count = 0;
        for (let i = 0; i < picture.length; i += 3) {
            count += picture[i]! > 1.1 * picture[i + 2]! ? 1 : 0;
        }
        return count;
    };
    for (const name of ["bowl", "cavity"]) {
        const { page, close } = await open(`?run=${name}#shade=off`);
        const on = await pixels(page);
        await page.evaluate(() => window.pentimento!.viewer.update({ obstacles: false }));
        const off = await pixels(page);
        assert.ok(difference(on, off, 8) > 0.2, name);
        // None of the body is lost, but what mixes with the rim at edges.
        assert.ok(orange(on) > 0.95 * orange(off), `${orange(on)} of ${orange(off)}`);
        await close();
    }
});

test("where a slice lies in the solid that is said", async () => {
    const { page, close } = await open("?run=inside#w=-0.3&shade=off");
    assert.equal(await page.locator(".labels span").innerText(), "all solid");
    await page.locator("input.w").fill("500");
    await page.waitForFunction(() => document.querySelector(".labels span") === null);
    await close();
});

test("obstacles that move are where they are at each frame", async () => {
    const { page, close } = await open("?run=moving#shade=off");
    const height = () =>
        page.evaluate(() => {
            const [ball] = window.pentimento!.viewer.makePicture(8, 8, 1).tiles[0]!.slices[0]!
                .balls;
            return ball!.center[1];
        });
    for (const frame of [0, 2, 1]) {
        await page.locator("input.time").fill(String(frame));
        await page.waitForFunction(
            (frame) => window.pentimento!.viewer.moment!.frame === frame,
            frame,
        );
        assert.equal(await height(), frame);
    }
    await close();
});

test("a folder without a list of its obstacles is looked into", async () => {
    const { page, close } = await open("?run=unlisted#shade=off");
    const count = () => page.evaluate(() => window.pentimento!.viewer.moment!.obstacles.length);
    assert.equal(await count(), 1);
    await close();
});

test("obstacles that are damaged or not known are said, and the page stays usable", async () => {
    for (const [name, expected] of [
        ["torn", /^obstacles\.json: is not the list of a run's obstacles; expected JSON with/],
        [
            "newer",
            /^obstacles\.json: obstacle 1: found an obstacle of kind "torus"; expected half_/,
        ],
    ] as const) {
        const { page, close } = await open(`?run=${name}#shade=off`);
        assert.match(await errorText(page), expected);
        assert.ok((await pixels(page)).some((value) => value > 0));
        await close();
    }
    const { page, close } = await open("?run=gaps#shade=off");
    await page.waitForSelector(".message.error");
    assert.match(
        await errorText(page),
        /^obstacles\/000001\.json: obstacle 1: "radius" is missing or out of range; expected a/,
    );
    await close();
});

test("the obstacles of a dropped folder are shown", async () => {
    const { page, close } = await open("?run=none#shade=off");
    await page.evaluate(
        ([mesh, frame, list]) => {
            const all = new Map<string, BlobPart>([
                ["r/meshes/cube.pent", Uint8Array.from(mesh as number[])],
                ["r/frames/cube_000000.pent", Uint8Array.from(frame as number[])],
                ["r/obstacles/000000.json", list as string],
            ]);
            // As a person does who chooses a folder in the dialog.
            const input = document.querySelector<HTMLInputElement>("input[webkitdirectory]")!;
            const transfer = new DataTransfer();
            for (const [path, bytes] of all) {
                const file = new File([bytes], path);
                Object.defineProperty(file, "webkitRelativePath", { value: path });
                transfer.items.add(file);
            }
            Object.defineProperty(input, "files", { value: transfer.files });
            input.dispatchEvent(new Event("change"));
        },
        [[...kMesh], [...kFrame], obstaclesFile([kBall, kBox])] as const,
    );
    await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "r");
    await page.waitForFunction(() => window.pentimento!.viewer.moment?.obstacles.length === 2);
    await close();
});
