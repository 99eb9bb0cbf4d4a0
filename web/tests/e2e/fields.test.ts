import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { gridMesh } from "../../src/mesh/grid.ts";
import { kPage, openPage, pixels, useBrowser, useServer } from "../support/browser.ts";
import { native } from "../support/native.ts";
import { rowsOf } from "../../src/format/write_pent.ts";
import { lines, twoTets } from "../support/two_tets.ts";
import { kSixteenCell } from "../support/write_g4mf.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

const kGrid = gridMesh([1, 1, 1, 1], (p) => p);
const kMesh = writeMesh(kGrid);
const kPositions = [...kGrid.positions];
const along = (axis: number, factor: number) =>
    kPositions.filter((_, i) => i % 4 === axis).map((x) => factor * x + 300);

// Of two bodies, one of which alone has a dose; heat of the second frame has twice the range.
const frameOf = (frame: number, fields: Record<string, number[]>) =>
    writeFrame(kMesh, frame, frame / 10, kPositions, kPositions, [], fields);
const kRun = new Map<string, Uint8Array | string>([
    ["run/run.json", '{"meshes":["a","b"],"frames":{"a":[[0,1]],"b":[[0,1]]}}'],
    ...["a", "b"].map((name): [string, Uint8Array] => [`run/meshes/${name}.pent`, kMesh]),
    ...[0, 1].flatMap((frame): [string, Uint8Array][] => [
        [
            `run/frames/a_00000${frame}.pent`,
            frameOf(frame, {
                heat: along(0, 1 + frame),
                "50%&a=#": along(1, 1),
                dose: along(2, 1),
            }),
        ],
        [
            `run/frames/b_00000${frame}.pent`,
            frameOf(frame, { heat: along(0, 0.5), "50%&a=#": along(1, 1) }),
        ],
    ]),
]);

// The same number of vertices over and over again, by units far beyond those of floats on either side.
const kUnits = { near: 1, huge: 1e200, full: 1.7e308, tiny: 1e-200, small: 1e-35 };
const kFar = lines(
    "ply",
    "format ascii 1.0",
    "comment pent 1.0",
    "comment dimension 4",
    `element vertex ${kGrid.vertexCount}`,
    ...["x", "y", "z", "w", ...Object.keys(kUnits)].map((name) => `property double ${name}`),
    `element pentachoron ${kGrid.cellCount}`,
    ...[0, 1, 2, 3, 4].map((k) => `property uint v${k}`),
    "end_header",
    ...rowsOf(kGrid.positions, 4).map((p) =>
        [...p, ...Object.values(kUnits).map((unit) => unit * p[0]!)].join(" "),
    ),
    ...rowsOf(kGrid.cells, 5).map((cell) => cell.join(" ")),
);

const browser = useBrowser();
const server = useServer(new Map([...kRun, ["two.pent", twoTets()], ["far.pent", kFar]]));
const open = (query: string) => openPage(browser.get(), server.address() + query);

const menuOf = (page: Page) => page.locator("select[aria-label='Color by']");
const color = (page: Page) => page.evaluate(() => window.pentimento!.viewer.state.color);
const ends = (page: Page) => page.locator(".legend .ends span").allInnerTexts();
const title = (page: Page) => page.locator(".legend .title").innerText();

test("quantities of a mesh are chosen by keys, and are in the address", async () => {
    const { page, said, close } = await open("?run=two.pent#shade=off");
    const offered = await menuOf(page).locator("option").allInnerTexts();
    // Of three dimensions: without w.
    assert.deepEqual(offered.slice(0, 4), ["body", "speed", "strain", "contact force"]);
    assert.deepEqual(offered.slice(4), ["reaction", "energy_density", "heat", "phase", "flow"]);
    await menuOf(page).focus();
    await page.keyboard.type("ph");
    await page.waitForSelector(".legend .title");
    assert.equal(await title(page), "phase");
    // Of 3 5 5 5 6 what is behind the lowest hundredth and before the highest.
    assert.deepEqual(await ends(page), ["3", "5"]);
    await page.waitForFunction(() => location.hash.includes("color=phase"));
    await page.reload();
    await page.waitForSelector(".legend .title");
    assert.equal(await title(page), "phase");
    // The next ones that there are, and over again: this has no frames, and a strain of zero.
    await page.locator("#canvas").focus();
    const passed: string[] = [];
    for (let i = 0; i < 4; ++i) {
        await page.keyboard.press("c");
        passed.push(await color(page));
    }
    assert.deepEqual(passed, ["flow", "body", "strain", "heat"]);
    await page.evaluate(() => window.pentimento!.viewer.update({ color: "strain" }));
    await page.waitForFunction(() => document.querySelectorAll(".legend .ends span").length === 1);
    assert.deepEqual(await ends(page), ["0"]);
    assert.equal(await page.locator(".message.error").count(), 0);
    assert.deepEqual(said, []);
    await close();
});

test("quantities of frames go over all that was seen, and those of one body are not offered", async () => {
    const { page, close } = await open("?run=run#shade=off&color=heat");
    await page.waitForSelector(".legend .title");
    assert.deepEqual(await ends(page), ["299", "301"]);
    await page.locator("input.time").fill("1");
    await page.waitForFunction(
        () => document.querySelector(".legend .ends span")!.textContent === "298",
    );
    assert.deepEqual(await ends(page), ["298", "302"]);
    const dose = menuOf(page).locator("option[value=dose]");
    assert.equal(await dose.innerText(), "dose (not of all bodies)");
    assert.ok(await dose.isDisabled());
    await menuOf(page).selectOption("50%&a=#");
    await page.waitForFunction(() => location.hash.includes("color=50%25%26a%3D%23"));
    await page.reload();
    await page.waitForSelector(".legend .title");
    assert.equal(await title(page), "50%&a=#");
    await close();
    const asked = await open("?run=run#shade=off&color=dose");
    assert.equal(
        await asked.page.locator(".message.error span").first().innerText(),
        'frame 0 of "b" has nothing called "dose" to color by; there are body, w, speed, strain, heat, 50%&a=#',
    );
    assert.equal(await color(asked.page), "body");
    await asked.close();
});

test("numbers beyond floats have the colors and the legend that they should", async () => {
    const { page, said, close } = await open("?run=far.pent#shade=off&floor=off&w=0.3");
    const seen = new Map<string, number[]>();
    for (const [name, unit] of Object.entries(kUnits)) {
        await menuOf(page).selectOption(name);
        const expected = [-unit, unit].map((end) => String(Number(end.toPrecision(3))));
        await page.waitForFunction(
            (title) => document.querySelector(".legend .title")?.textContent === title,
            name,
        );
        assert.deepEqual(await ends(page), expected);
        seen.set(name, await pixels(page));
        // A range of one's own goes with the numbers, too.
        await page.locator("input[aria-label='highest value']").fill(String(unit / 2));
        await page.locator("input[aria-label='highest value']").press("Tab");
        seen.set(`${name} to the half`, await pixels(page));
        // Far from the numbers: all of them have the last color.
        const low = page.locator("input[aria-label='lowest value']");
        await low.fill(String(-(name === "near" ? 1e6 : Math.min(1e60 * unit, 1.7e308))));
        await low.press("Tab");
        seen.set(`${name} from afar`, await pixels(page));
    }
    const levels = new Set(seen.get("near"));
    assert.ok(levels.size > 30, "there are colors from end to end");
    for (const name of Object.keys(kUnits)) {
        for (const more of ["", " to the half", ...(name === "full" ? [] : [" from afar"])]) {
            // Rounding of floats: a level of 256.
            const [a, b] = [seen.get(`near${more}`)!, seen.get(name + more)!];
            assert.ok(
                a.every((value, i) => Math.abs(value - b[i]!) <= 1),
                name + more,
            );
        }
    }
    assert.notDeepEqual(seen.get("near"), seen.get("near to the half"));
    assert.deepEqual(said, []);
    await close();
});

test("an exported page has the quantities of its mesh", async (t) => {
    const view = native("pent-view");
    if (!view) {
        t.skip("pent-view is not built");
        return;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    try {
        writeFileSync(join(folder, "two.pent"), twoTets());
        const path = join(folder, "page.html");
        execFileSync(view, [
            join(folder, "two.pent"),
            "--page",
            kPage,
            "--export",
            path,
            "--quiet",
        ]);
        const { page, said, close } = await openPage(
            browser.get(),
            `${pathToFileURL(path)}#shade=off&color=phase`,
        );
        await page.waitForSelector(".legend .title");
        const fields = await page.evaluate(() =>
            [...window.pentimento!.viewer.run!.bodies[0]!.fields].map(([name, values]) => ({
                name,
                values: [...values],
            })),
        );
        assert.deepEqual(
            fields.map(({ name }) => name),
            ["heat", "phase", "flow"],
        );
        // To half a step of 255 between least and most.
        [5, 5, 5, 3, 6].forEach((value, v) =>
            assert.ok(Math.abs(fields[1]!.values[v]! - value) <= 3 / 509),
        );
        assert.deepEqual(said, []);
        await close();
    } finally {
        rmSync(folder, { recursive: true });
    }
});

test("pent-view gives a model with the files of its buffers", async (t) => {
    const view = native("pent-view");
    if (!view) {
        t.skip("pent-view is not built");
        return;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    try {
        writeFileSync(join(folder, "cell.g4tf"), JSON.stringify(kSixteenCell.json));
        writeFileSync(join(folder, "points.bin"), kSixteenCell.points);
        writeFileSync(join(folder, "indices.bin"), kSixteenCell.indices);
        const program = spawn(view, [join(folder, "cell.g4tf"), "--no-open", "--page", kPage]);
        const address = await new Promise<string>((resolve) =>
            program.stdout.once("data", (text) => resolve(/http:\S+/.exec(String(text))![0])),
        );
        const { page, said, close } = await openPage(browser.get(), `${address}#shade=off`);
        assert.equal(await page.locator("#facts").innerText(), "1 body, 8 vertices, 1 frame");
        assert.deepEqual(said, []);
        await close();
        program.kill("SIGINT");
    } finally {
        rmSync(folder, { recursive: true });
    }
});
