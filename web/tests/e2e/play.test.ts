import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { writeMesh } from "../../src/format/write_pent.ts";
import { gridMesh } from "../../src/mesh/grid.ts";
import { kPage, openPage, useBrowser, useServer } from "../support/browser.ts";
import { native } from "../support/native.ts";
import { unzip } from "../support/unzip.ts";

const kScript = join(dirname(kPage), "playground.js");
const skip = existsSync(kScript) ? false : "the simulator for browsers is not built";
const files = new Map<string, Uint8Array | string>();
if (!skip) {
    files.set("playground.js", readFileSync(kScript));
}

const browser = useBrowser();
const server = useServer(files);
const bare = useServer(new Map());
const open = (query: string, options = {}) =>
    openPage(browser.get(), server.address() + query, options);
const errorText = (page: Page) => page.locator(".message.error").first().innerText();
const thrown = (said: string[]) => said.filter((text) => text.startsWith("thrown"));
const time = (page: Page) => page.evaluate(() => window.pentimento!.viewer.moment!.time);

/** Waits until a simulation is open, and stops it at its start, with steps of 1/60 s. */
async function standStill(page: Page): Promise<void> {
    await page.waitForFunction(() => window.pentimento!.play.isOpen);
    await page.locator("select[aria-label='Time step']").selectOption("60");
    await page.waitForTimeout(300); // settings are taken when they rest
    await page.locator("button[title=Pause]").click();
    await page.locator("button[title='Back to the start']").click();
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.time === 0);
}

/** By the keyboard: the pointer may be holding something. */
async function step(page: Page, count: number): Promise<void> {
    for (let i = 0; i < count; ++i) {
        const before = await time(page);
        await page.evaluate(() =>
            window.pentimento!.viewer.canvas.dispatchEvent(
                new KeyboardEvent("keydown", { code: "ArrowRight", bubbles: true }),
            ),
        );
        await page.waitForFunction((t) => window.pentimento!.viewer.moment!.time > t, before);
    }
}

/** How far a body falls from rest by implicit Euler in so many steps. */
function fall(seconds: number, steps: number): number {
    return 0.5 * 9.8 * seconds * (seconds + seconds / steps);
}

/** The middle of the first body, and how far its vertices are from it in the mean. */
function shape(page: Page): Promise<{ middle: number[]; spread: number }> {
    return page.evaluate(() => {
        const { positions } = window.pentimento!.viewer.moment!.bodies[0]!;
        const count = positions.length / 4;
        const middle = [0, 1, 2, 3].map(
            (axis) => positions.reduce((sum, x, i) => sum + (i % 4 === axis ? x : 0), 0) / count,
        );
        const square = positions.reduce((sum, x, i) => sum + (x - middle[i % 4]!) ** 2, 0);
        return { middle, spread: Math.sqrt(square / count) };
    });
}

/** Where on the screen a point of the slice w = 0 is, while nothing is turned. */
function place(page: Page, p: number[]): Promise<{ x: number; y: number }> {
    return page.evaluate((p) => {
        const { viewer } = window.pentimento!;
        const box = viewer.canvas.getBoundingClientRect();
        const m = viewer.makePicture(box.width, box.height, 1).camera.viewProjection;
        const row = (i: number) =>
            m[i]! * p[0]! + m[4 + i]! * p[1]! + m[8 + i]! * p[2]! + m[12 + i]!;
        return {
            x: box.left + ((1 + row(0) / row(3)) / 2) * box.width,
            y: box.top + ((1 - row(1) / row(3)) / 2) * box.height,
        };
    }, p);
}

const drop = (page: Page, dropped: [string, number[] | string][]) =>
    page.evaluate((dropped) => {
        const transfer = new DataTransfer();
        for (const [name, bytes] of dropped) {
            const part = typeof bytes === "string" ? bytes : Uint8Array.from(bytes);
            transfer.items.add(new File([part], name));
        }
        document.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true }));
    }, dropped);

const kCube = writeMesh(gridMesh([1, 1, 1, 1], (p) => [p[0] / 2, p[1] / 2, p[2] / 2, p[3] / 2]));
const kScene =
    '[scene]\ngravity = [0, -9.8, 0, 0]\n[[body]]\nname = "cube"\nmesh = "cube.pent"\n' +
    "material = { young = 2e4, density = 100 }\n";

test(
    "the simulator is loaded when the playground is opened, and bodies fall",
    { skip },
    async () => {
        const { page, said, close } = await open("#shade=off");
        assert.ok(!server.asked.includes("playground.js"), "not before");
        await page.locator("label", { hasText: "Playground" }).click();
        await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "Octopus");
        await page.waitForFunction(() => window.pentimento!.viewer.moment!.time > 0.1);
        assert.ok(server.asked.includes("playground.js"));
        assert.match(page.url(), /\?play=octopus/);
        await page.waitForFunction(() =>
            /ms a step.* J/.test(document.querySelector(".numbers")?.textContent ?? ""),
        );
        await page.locator("select[aria-label=Scene]").selectOption("jelly");
        await page.waitForFunction(() => window.pentimento!.viewer.run!.title.includes("jelly"));
        await standStill(page);
        const before = await shape(page);
        await step(page, 12);
        const after = await shape(page);
        const fallen = before.middle[1]! - after.middle[1]!;
        // Positions are floats.
        assert.ok(Math.abs(fallen - fall(await time(page), 12)) < 1e-5, `${fallen} m`);
        await page.locator("label", { hasText: "Viewer" }).click();
        await page.waitForFunction(() => !window.pentimento!.play.isOpen);
        assert.equal(await page.locator(".bar.play").isVisible(), false);
        assert.deepEqual(thrown(said), []);
        await close();
    },
);

test("a body is pulled by the pointer and along w, and comes back", { skip }, async () => {
    const { page, said, close } = await open("?play=jelly#shade=off");
    await standStill(page);
    await page.locator("button[aria-label='gravity along \u2212y']").click(); // that was there: none
    const start = await shape(page);
    const at = await place(page, start.middle);
    const grab = async (dx: number, dy: number) => {
        await page.mouse.move(at.x, at.y);
        await page.mouse.down();
        await page.waitForSelector(".hand:not([hidden])");
        await page.mouse.move(at.x + dx, at.y + dy, { steps: 3 });
    };

    // Held and not pulled it stays: nothing else acts.
    await grab(0, 0);
    await step(page, 4);
    const still = await shape(page);
    still.middle.forEach((x, axis) => assert.ok(Math.abs(x - start.middle[axis]!) < 1e-3));
    await page.mouse.up();

    // The camera looks along -z and -x: to the right is +x and -z.
    await grab(50, 0);
    await step(page, 10);
    const right = await shape(page);
    const moved = right.middle.map((x, axis) => x - start.middle[axis]!);
    assert.ok(moved[0]! > 0.02 && moved[2]! < -0.01, `${moved}`);
    // It stands askew, so that a pull turns it a little, too.
    assert.ok(Math.abs(moved[3]!) < 0.1 * moved[0]!, `not along w: ${moved}`);

    // The wheel pulls along w, from the slice.
    await page.mouse.wheel(0, -400);
    await page.waitForFunction(() =>
        /^w \+/.test(document.querySelector(".depth")?.textContent ?? ""),
    );
    await step(page, 10);
    const along = await shape(page);
    assert.ok(along.middle[3]! - right.middle[3]! > 0.02, `${along.middle}`);
    assert.ok(Math.abs(along.spread - start.spread) < 0.3 * start.spread, "it is no further apart");

    // Let go, it is what it was, somewhere else.
    await page.mouse.up();
    await page.waitForSelector(".hand", { state: "hidden" });
    await page.locator("button[title='Go on']").click();
    const later = (await time(page)) + 2;
    await page.waitForFunction((t) => window.pentimento!.viewer.moment!.time > t, later);
    const free = await shape(page);
    assert.ok(Math.abs(free.spread - start.spread) < 0.01 * start.spread, `${free.spread}`);
    assert.deepEqual(thrown(said), []);
    await close();
});

test("gravity points along all eight directions, also out of the slice", { skip }, async () => {
    const { page, close } = await open("?play=jelly#shade=off");
    await standStill(page);
    for (const [axis, letter] of [..."xyzw"].entries()) {
        for (const [sign, mark] of [[1, "+"] as const, [-1, "\u2212"] as const]) {
            const button = page.locator(`button[aria-label='gravity along ${mark}${letter}']`);
            if ((await button.getAttribute("aria-pressed")) === "false") {
                await button.click();
            }
            await page.locator("button[title='Back to the start']").click();
            await page.waitForFunction(() => window.pentimento!.viewer.moment!.time === 0);
            const before = await shape(page);
            await step(page, 2);
            const { middle } = await shape(page);
            const expected = fall(await time(page), 2);
            middle.forEach((x, k) => {
                const moved = x - before.middle[k]!;
                const error = Math.abs(moved - (k === axis ? sign * expected : 0));
                assert.ok(error < 1e-5, `${mark}${letter}: ${moved} along ${k}`);
            });
        }
    }
    await close();
});

test("keys alone take hold of a body, pull it up and along w, and let go", { skip }, async () => {
    const { page, said, close } = await open("?play=jelly#shade=off");
    await standStill(page);
    const press = async (key: string, count: number) => {
        for (let i = 0; i < count; ++i) {
            await page.keyboard.press(key);
        }
    };
    await page.locator("#canvas").focus();
    await page.keyboard.press("p");
    await page.waitForSelector(".hand:not([hidden])");
    const before = await shape(page);
    await press("ArrowUp", 10);
    await press("Shift+ArrowUp", 10);
    assert.match((await page.locator(".hand .depth").textContent())!, /^w \+0\.\d+ m/);
    await page.locator("button[title='One step']").click();
    for (let i = 1; i < 10; ++i) {
        const last = await time(page);
        await page.locator("button[title='One step']").click();
        await page.waitForFunction((t) => window.pentimento!.viewer.moment!.time > t, last);
    }
    const after = await shape(page);
    const fallen = fall(10 / 60, 10);
    assert.ok(after.middle[1]! > before.middle[1]! - 0.5 * fallen, "held against gravity");
    assert.ok(after.middle[3]! > before.middle[3]! + 0.001, "pulled along w");
    await page.locator("#canvas").focus();
    await page.keyboard.press("Escape");
    await page.waitForSelector(".hand", { state: "hidden" });
    assert.deepEqual(thrown(said), []);
    await close();
});

test(
    "a simulation that is opened where nobody looks waits until someone does",
    { skip },
    async () => {
        const { page, said, close } = await open("");
        const look = (isHidden: boolean) =>
            page.evaluate((isHidden) => {
                Object.defineProperty(document, "hidden", { value: isHidden, configurable: true });
                document.dispatchEvent(new Event("visibilitychange"));
            }, isHidden);
        await look(true);
        await page.evaluate(() => window.pentimento!.openScene("jelly"));
        await page.waitForTimeout(1000);
        assert.equal(await time(page), 0);
        await look(false);
        await page.waitForFunction(() => window.pentimento!.viewer.moment!.time > 0.1);
        await look(true);
        await page.waitForTimeout(300); // frames that are under way
        const before = await time(page);
        await page.waitForTimeout(700);
        assert.equal(await time(page), before);
        assert.deepEqual(thrown(said), []);
        await close();
    },
);

test(
    "stiffness, damping and time step change what is there, and it goes on",
    { skip },
    async () => {
        const { page, said, close } = await open("?play=jelly#shade=off");
        await standStill(page);
        await step(page, 3);
        const before = await shape(page);
        // Its places are powers of ten; what is said is the factor.
        const stiffness = page.locator("input[aria-label='stiffness \u00d7'][type=range]");
        assert.equal(await stiffness.getAttribute("aria-valuetext"), "1");
        await page.locator("input[aria-label='stiffness \u00d7, number']").fill("4");
        await page.locator("select[aria-label='Time step']").selectOption("120");
        await page.locator("input[aria-label='damping, ms']").fill("30");
        await page.keyboard.press("Tab");
        await page.waitForTimeout(1000); // sliders are taken when they rest
        const t = await time(page);
        assert.ok(Math.abs(t - 0.05) < 1e-9);
        await step(page, 1);
        assert.ok(Math.abs((await time(page)) - t - 1 / 120) < 1e-9);
        const after = await shape(page);
        // It falls on: 9.8 * 0.05 m/s.
        const fallen = before.middle[1]! - after.middle[1]!;
        assert.ok(Math.abs(fallen - (9.8 * 0.05 + 9.8 / 120) / 120) < 1e-4, `${fallen}`);
        assert.equal(await page.locator("select[aria-label='Time step']").inputValue(), "120");
        assert.deepEqual(thrown(said), []);
        await close();
    },
);

test(
    "a scene of one's own opens, and what is wrong in one is told by line and column",
    { skip },
    async () => {
        const { page, close } = await open("?play=jelly#shade=off");
        await standStill(page);
        await drop(page, [["scene.toml", kScene.replace("gravity", "gravitty")]]);
        await page.waitForSelector(".message.error");
        assert.match(
            await errorText(page),
            /^scene\.toml:2:1: unknown key "gravitty".*did you mean "gravity"\?/,
        );
        await drop(page, [["scene.toml", kScene]]);
        await page.waitForFunction(() =>
            /^scene\.toml:5:8: .*cube\.pent/.test(
                document.querySelector(".message.error")?.textContent ?? "",
            ),
        );
        assert.equal(
            await page.evaluate(() => window.pentimento!.viewer.run!.title.length > 5),
            true,
        );
        await step(page, 1); // what was there is there
        await drop(page, [
            ["mine.toml", kScene],
            ["cube.pent", [...kCube]],
        ]);
        await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "mine");
        await page.waitForFunction(() => window.pentimento!.viewer.moment!.time > 0.1);
        assert.equal(await page.locator(".message.error").count(), 0);
        assert.match(await page.locator("#facts").innerText(), /16 vertices, 24 pentachora$/);
        await close();
    },
);

test(
    "a step that cannot be solved is said, the hand lets go, and the body goes on",
    { skip },
    async () => {
        const { page, close } = await open("?play=jelly#shade=off");
        await standStill(page);
        // At rest nothing has to be solved; a pull takes more than the one iteration that is allowed.
        const strict =
            kScene.replace("-9.8", "0") +
            '[solver]\nmax_iterations = 1\ntolerance = 1e-9\nprecision = "double"\npreconditioner = "block-jacobi"\n' +
            "max_halvings = 0\n";
        await drop(page, [
            ["strict.toml", strict],
            ["cube.pent", [...kCube]],
        ]);
        await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "strict");
        await standStill(page);
        await step(page, 1);
        const at = await place(page, [0.1, 0.1, 0]);
        await page.mouse.move(at.x, at.y);
        await page.mouse.down();
        await page.waitForSelector(".hand:not([hidden])");
        await page.mouse.move(at.x + 80, at.y - 30, { steps: 3 });
        await page.keyboard.press("ArrowRight");
        await page.waitForSelector(".message.error");
        assert.match(await errorText(page), /^This step cannot be solved \(.+\): the hand lets go/);
        assert.equal(await page.locator(".hand").isVisible(), false);
        await page.mouse.up();
        await step(page, 2);
        await close();
    },
);

test(
    "the end of the simulator is said once, and another scene can be opened",
    { skip },
    async () => {
        const { page, said, close } = await open("?play=jelly#shade=off");
        await standStill(page);
        await page.evaluate(() => {
            // What is asked for is not there: an error that is none of ours. Another question waits meanwhile.
            const play = window.pentimento!.play as unknown as {
                ask(name: string): Promise<unknown>;
            };
            void play.ask("nonsense");
            void play.ask("step");
        });
        await page.waitForSelector(".message.error");
        await page.locator("button[title='Go on']").click();
        await page.waitForTimeout(200); // what else is said comes at once
        const texts = await page.locator(".message").allInnerTexts();
        assert.equal(texts.length, 1, texts.join(" | "));
        assert.match(texts[0]!, /^The simulator has failed: .+\. Open a scene again;/);
        await page.locator("select[aria-label='Scene']").selectOption("heap");
        await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "Heap of three");
        await page.waitForFunction(() => window.pentimento!.viewer.moment!.time > 0.05);
        assert.equal(await page.locator(".message").count(), 0);
        assert.deepEqual(thrown(said), []);
        await close();
    },
);

test("what is recorded is a run that the other programs take", { skip }, async (t) => {
    const { page, close } = await open("?play=jelly#shade=off");
    await standStill(page);
    await page.locator("button[title=Record]").click();
    await page.waitForSelector(".button.recording");
    await step(page, 5);
    const [download] = await Promise.all([
        page.waitForEvent("download"),
        page.locator("button.recording").click(),
    ]);
    assert.equal(download.suggestedFilename(), "tesseract-of-jelly.zip");
    const run = unzip(readFileSync((await download.path())!));
    assert.deepEqual(
        [...run.keys()].filter((name) => !name.includes("/frames/")).sort(),
        ["meshes/jelly.pent", "obstacles.json", "scene.toml"].map(
            (name) => `tesseract-of-jelly/${name}`,
        ),
    );
    assert.equal([...run.keys()].filter((name) => name.includes("/frames/")).length, 3); // 30 a second
    await page.locator("button", { hasText: "Watch it here" }).click();
    await page.waitForFunction(() => window.pentimento!.viewer.run!.frames.length === 3);
    assert.equal(
        await page.locator("label", { hasText: "Viewer" }).locator("input").isChecked(),
        true,
    );
    await close();
    const programs = ["pent-render", "pent-sim"].map((name) => native(name));
    if (programs.includes(null)) {
        t.skip("pent-render and pent-sim are not built");
        return;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-play-"));
    for (const [path, bytes] of run) {
        mkdirSync(dirname(join(folder, path)), { recursive: true });
        writeFileSync(join(folder, path), bytes);
    }
    const at = join(folder, "tesseract-of-jelly");
    const picture = join(folder, "picture.png");
    execFileSync(programs[0]!, [at, "-o", picture, "--frames", "last", "--size", "64x48"]);
    assert.ok(existsSync(picture));
    const again = join(folder, "again"); // its scene is one to simulate, too
    execFileSync(programs[1]!, [join(at, "scene.toml"), "--explain"], { cwd: folder });
    assert.ok(!existsSync(again));
    rmSync(folder, { recursive: true });
});

test("the playground runs in a page that was opened from a file", { skip }, async () => {
    const { page, said, close } = await openPage(
        browser.get(),
        `${pathToFileURL(kPage)}?play=jelly#shade=off`,
    );
    await page.waitForFunction(() => window.pentimento!.play.isOpen);
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.time > 0.1);
    assert.deepEqual(thrown(said), []);
    await close();
});

test("where the simulator is not beside the page that is said, and the viewer is there", async () => {
    const { page, close } = await openPage(browser.get(), `${bare.address()}?play=jelly#shade=off`);
    await page.waitForSelector(".message.error");
    assert.match(await errorText(page), /^playground\.js: is not beside this page/);
    assert.equal(
        await page.locator("label", { hasText: "Viewer" }).locator("input").isChecked(),
        true,
    );
    await close();
});

test("on a phone the playground fits its window", { skip }, async () => {
    const { page, close } = await open("?play=jelly#shade=off", {
        viewport: { width: 360, height: 640 },
        hasTouch: true,
        isMobile: true,
    });
    await page.waitForFunction(() => window.pentimento!.play.isOpen);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 360, `${wide} pixels across`);
    for (const button of await page.locator("button:visible, .segments label:visible").all()) {
        const box = (await button.boundingBox())!;
        assert.ok(box.x >= 0 && box.x + box.width <= 360, await button.innerHTML());
    }
    await close();
});
