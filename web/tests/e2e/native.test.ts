import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { test } from "node:test";
import type { Obstacle } from "../../src/format/obstacles.ts";
import { gridMesh } from "../../src/mesh/grid.ts";
import { kPage, openPage, useBrowser } from "../support/browser.ts";
import { obstaclesFile } from "../support/obstacles.ts";
import { native } from "../support/native.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

const browser = useBrowser();
const kGrid = gridMesh([2, 2, 1, 2], (p) => p);

function positionsAt(frame: number): number[] {
    return [...kGrid.positions].map((value, i) => value * (1 + 0.05 * frame) + (i % 4) * 0.01);
}

function obstaclesAt(frame: number): Obstacle[] {
    return [
        { kind: "half_space", normal: [0, 1, 0, 0], offset: -1.1 },
        { kind: "ball", center: [2, 0.1 * frame, 0, 0], radius: 0.5 },
    ];
}

function writeFrameOf(run: string, mesh: Uint8Array, frame: number): void {
    const positions = positionsAt(frame);
    const bytes = writeFrame(mesh, frame, frame / 10, positions, positions);
    writeFileSync(join(run, `frames/body_00000${frame}.pent`), bytes);
    writeFileSync(join(run, `obstacles/00000${frame}.json`), obstaclesFile(obstaclesAt(frame)));
}

/** A run of three frames in a folder that is removed in the end. */
async function withRun(action: (folder: string, view: string) => Promise<void>): Promise<boolean> {
    const view = native("pent-view");
    if (!view) {
        return false;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    const mesh = writeMesh(kGrid);
    mkdirSync(join(folder, "run/meshes"), { recursive: true });
    mkdirSync(join(folder, "run/frames"));
    mkdirSync(join(folder, "run/obstacles"));
    writeFileSync(join(folder, "run/meshes/body.pent"), mesh);
    for (let frame = 0; frame < 3; ++frame) {
        writeFrameOf(join(folder, "run"), mesh, frame);
    }
    try {
        await action(folder, view);
    } finally {
        rmSync(folder, { recursive: true });
    }
    return true;
}

test("pent-view shows its run, and ends by Ctrl-C", async (t) => {
    const isThere = await withRun(async (folder, view) => {
        const program = spawn(view, [join(folder, "run"), "--no-open", "--page", kPage]);
        const ended = new Promise<number | null>((resolve) => program.on("close", resolve));
        const address = await new Promise<string>((resolve) =>
            program.stdout.once("data", (text) => resolve(/http:\S+/.exec(String(text))![0])),
        );
        const { page, said, close } = await openPage(browser.get(), `${address}#shade=off&frame=2`);
        await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 2);
        assert.equal(await page.title(), "run \u2013 Pentimento");
        const obstacles = await page.evaluate(() => window.pentimento!.viewer.moment!.obstacles);
        assert.deepEqual(obstacles, obstaclesAt(2));
        await page.locator("select[aria-label='Color by']").selectOption("strain");
        await page.waitForSelector(".legend .title");
        assert.deepEqual(said, []); // nothing that its own policy of content forbids
        await close();
        program.kill("SIGINT");
        assert.equal(await ended, 0);
    });
    if (!isThere) {
        t.skip("pent-view is not built");
    }
});

test("pent-view shows runs and meshes of any name", async (t) => {
    const isThere = await withRun(async (folder, view) => {
        for (const [from, name] of [
            ["run", "50% of #1, \u00fc?"],
            ["run/meshes/body.pent", "mesh 100% #2?"],
        ] as const) {
            cpSync(join(folder, from), join(folder, name), { recursive: true });
            const program = spawn(view, [join(folder, name), "--no-open", "--page", kPage]);
            const address = await new Promise<string>((resolve) =>
                program.stdout.once("data", (text) => resolve(/http:\S+/.exec(String(text))![0])),
            );
            const { page, close } = await openPage(browser.get(), `${address}#shade=off`);
            await page.waitForFunction(() => document.title.includes("Pentimento"));
            assert.equal(await page.title(), `${name} \u2013 Pentimento`);
            assert.equal(await page.locator(".message.error").count(), 0);
            await close();
            program.kill("SIGINT");
        }
    });
    if (!isThere) {
        t.skip("pent-view is not built");
    }
});

test("pent-view follows a run while it is written, and no longer than that", async (t) => {
    const isThere = await withRun(async (folder, view) => {
        const run = join(folder, "run");
        const program = spawn(view, [run, "--no-open", "--page", kPage]);
        const address = await new Promise<string>((resolve) =>
            program.stdout.once("data", (text) => resolve(/http:\S+/.exec(String(text))![0])),
        );
        const { page, close } = await openPage(browser.get(), `${address}#shade=off`);
        const last = (frame: string) =>
            page.waitForFunction(
                (frame) => (document.querySelector("input.time") as HTMLInputElement).max === frame,
                frame,
            );
        await last("2");
        writeFrameOf(run, writeMesh(kGrid), 3);
        await last("3");
        await page.locator("input.time").fill("3");
        await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 3);
        writeFileSync(join(run, "report.json"), '{ "verdict": "finished" }');
        await page.waitForFunction(() => !window.pentimento!.viewer.run!.isGrowing);
        await close();
        program.kill("SIGINT");
    });
    if (!isThere) {
        t.skip("pent-view is not built");
    }
});

test("an exported page opens from a file and shows what the run has", async (t) => {
    const isThere = await withRun(async (folder, view) => {
        const path = join(folder, "page.html");
        execFileSync(view, [join(folder, "run"), "--page", kPage, "--export", path, "--quiet"]);
        const { page, said, close } = await openPage(
            browser.get(),
            `${pathToFileURL(path)}#shade=off&frame=2&color=strain`,
        );
        await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 2);
        const { positions, strain, time, obstacles } = await page.evaluate(() => {
            const { moment } = window.pentimento!.viewer;
            const [body] = moment!.bodies;
            return {
                positions: [...body!.positions],
                strain: [...body!.quantities.get("strain")!],
                time: moment!.time,
                obstacles: moment!.obstacles,
            };
        });
        assert.ok(Math.abs(time - 0.2) < 1e-12);
        assert.deepEqual(obstacles, obstaclesAt(2));
        // Vertices inside are left out: those left are each near one of the run, in order.
        const expected = positionsAt(2);
        let at = 0;
        for (let v = 0; v < positions.length; v += 4) {
            // Half a step of 2.2 m in 65535, and floats.
            const isNear = () =>
                [0, 1, 2, 3].every((k) => Math.abs(positions[v + k]! - expected[at + k]!) < 2e-5);
            while (at < expected.length && !isNear()) {
                at += 4;
            }
            assert.ok(at < expected.length, `vertex ${v / 4}`);
        }
        // Grown by 1.1 along each axis: E = (1.21 - 1) / 2 four times, to a step of 255.
        assert.ok(strain.every((value) => Math.abs(value - 0.21) < 0.21 / 255));
        assert.deepEqual(said, []);
        await close();
    });
    if (!isThere) {
        t.skip("pent-view is not built");
    }
});
