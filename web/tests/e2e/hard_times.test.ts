import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { gridMesh } from "../../src/mesh/grid.ts";
import { dropOn, openPage, pixels, useBrowser, useServer } from "../support/browser.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

const browser = useBrowser();
const kGrid = gridMesh([1, 1, 1, 1], (p) => p);

// A run of some frames in which the body is `size` times the tesseract, moved by `by` along all axes.
function runOf(frames: number, size: number, by: number, seconds: number) {
    const positions = kGrid.positions.map((x) => by + size * x);
    const mesh = writeMesh({ ...kGrid, positions });
    const files = new Map<string, Uint8Array | string>();
    files.set("run.json", `{"meshes":["a"],"frames":{"a":[[0,${frames - 1}]]}}`);
    files.set("meshes/a.pent", mesh);
    for (let frame = 0; frame < frames; ++frame) {
        const file = `frames/a_${String(frame).padStart(6, "0")}.pent`;
        files.set(file, writeFrame(mesh, frame, frame * seconds, [...positions], [...positions]));
    }
    return files;
}

const under = (folder: string, files: Map<string, Uint8Array | string>) =>
    [...files].map(([path, bytes]) => [`${folder}/${path}`, bytes] as const);
const server = useServer(
    new Map([
        ...under("small", runOf(3, 1e-3, 0, 1e-5)),
        ...under("far", runOf(3, 1, 1e4, 1)),
        ...under("usual", runOf(8, 1, 0, 0.1)),
    ]),
);
const open = (query: string) => openPage(browser.get(), server.address() + query);

/** What WebGL tells that a graphics card has stopped, or is there again. */
function card(page: Page, act: "loseContext" | "restoreContext"): Promise<void> {
    return page.evaluate((act) => {
        const held = window as unknown as { card?: WEBGL_lose_context };
        const gl = window.pentimento!.viewer.canvas.getContext("webgl2")!;
        held.card ??= gl.getExtension("WEBGL_lose_context")!;
        held.card[act]();
    }, act);
}

test("a graphics card that stops and comes back draws the same picture again", async () => {
    const { page, said, close } = await open(
        "?run=usual#shade=off&color=speed&frame=2&ghost=orthographic",
    );
    const before = await pixels(page);
    await card(page, "loseContext");
    // What is done meanwhile is there afterwards.
    await page.evaluate(() => window.pentimento!.viewer.update({ frame: 5, w: 0.25 }));
    await page.waitForTimeout(300);
    await card(page, "restoreContext");
    await page.waitForFunction(() => !window.pentimento!.viewer.renderer.isLost);
    await page.evaluate(() => window.pentimento!.viewer.update({ frame: 2, w: null }));
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 2);
    assert.deepEqual(await pixels(page), before);
    assert.equal(await page.locator(".message").count(), 0);
    assert.deepEqual(
        said.filter((text) => text.startsWith("thrown")),
        [],
    );
    await card(page, "loseContext");
    const message = page.locator(".message.error span").first();
    await message.waitFor();
    assert.match(await message.innerText(), /^graphics: the graphics card has stopped/);
    await close();
});

test("of two runs that are opened the last one is shown, however slow the first", async () => {
    const { page, close } = await open("?run=usual#shade=off");
    // Frames of the first come when the second is shown.
    let comeNow = () => {};
    const isShown = new Promise<void>((resolve) => (comeNow = resolve));
    await page.route("**/usual/frames/*", async (route) => {
        await isShown;
        await route.continue();
    });
    await page.goto("about:blank");
    const request = page.waitForRequest("**/usual/frames/*");
    await page.goto(`${server.address()}?run=usual#shade=off`, { waitUntil: "commit" });
    await request;
    await page.waitForFunction(() => window.pentimento);
    await dropOn(page, { "dropped.pent": writeMesh(kGrid) });
    await page.waitForFunction(() => window.pentimento!.viewer.run?.title === "dropped");
    comeNow();
    await page.waitForLoadState("networkidle");
    await page.waitForTimeout(700);
    assert.equal(await page.evaluate(() => window.pentimento!.viewer.run!.title), "dropped");
    await close();
});

test("bodies that are small, quick or far away have places and moments told apart", async () => {
    const small = await open("?run=small#shade=off&w=0.0011");
    assert.equal(
        await small.page.locator(".labels span").innerText(),
        "no body here: from w = \u22120.001 to 0.001",
    );
    const time = small.page.locator("input.time");
    await time.fill("1");
    await small.page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 1);
    assert.equal(await time.getAttribute("aria-valuetext"), "frame 1, 0.00001 s");
    await small.close();

    const far = await open("?run=far#shade=off&layout=side&slices=3&spacing=0.1");
    const labels = ["9999.9", "10000", "10000.1"].map((w) => `w = ${w}`);
    assert.deepEqual(await far.page.locator(".labels span").allInnerTexts(), labels);
    await far.page.locator("input.w").fill("600");
    assert.equal(await far.page.evaluate(() => window.pentimento!.viewer.state.w), 10000.2);
    assert.match(
        (await far.page.locator("#canvas").getAttribute("aria-label"))!,
        /^Slice at w = 10000\.1, 10000\.2, 10000\.3 m of/,
    );
    await far.close();
});

test("an address without a frame is that of the first one", async () => {
    const { page, close } = await open("?run=usual#shade=off&frame=5");
    await page.waitForTimeout(1000); // all frames are here
    await page.evaluate(() => {
        location.hash = "#shade=off";
    });
    await page.waitForFunction(() => window.pentimento!.viewer.state.frame === null);
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 0);
    // And one with another frame while it plays goes on from there.
    await page.evaluate(() => window.pentimento!.viewer.update({ speed: 0.01 }));
    await page.locator("button[title=Play]").click();
    await page.evaluate(() => {
        location.hash = "#shade=off&frame=6&speed=0.01";
    });
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 6);
    await page.waitForTimeout(500);
    assert.equal(await page.evaluate(() => window.pentimento!.viewer.moment!.frame), 6);
    await close();
});

test("a phone on its side shows the whole greeting, and the panel beside the picture", async () => {
    const { page, close } = await openPage(browser.get(), `${server.address()}#shade=off`, {
        viewport: { width: 568, height: 320 },
        hasTouch: true,
        isMobile: true,
    });
    const boxOf = async (selector: string) => (await page.locator(selector).boundingBox())!;
    const stage = await boxOf("#stage");
    const card = await boxOf("#welcome");
    assert.ok(card.y >= stage.y && card.y + card.height <= stage.y + stage.height);
    await page.locator("#welcome button[title=Close]").tap();
    await page.locator("button[title=Controls]").tap();
    const panel = await boxOf("#panel");
    assert.ok(panel.x > 300 && panel.height > 150, `${panel.x} ${panel.height}`);
    await close();
});

test("where the network is slow it is said what is waited for, and what failed is tried again", async () => {
    const { page, close } = await open("?run=usual#shade=off&loop=off");
    // What was read ahead is here; a run that is opened anew asks again.
    let isDown = true;
    let letGo = () => {};
    const said = new Promise<void>((resolve) => (letGo = resolve));
    await page.route("**/a_000006.pent", async (route) => {
        await (isDown ? null : said); // slow: until the page has said so
        await (isDown ? route.abort() : route.continue());
    });
    await page.reload({ waitUntil: "commit" });
    await page.waitForFunction(() => window.pentimento?.viewer.moment);
    const go = (frame: number) =>
        page.evaluate((frame) => window.pentimento!.viewer.update({ frame }), frame);
    await go(6);
    await page.locator(".message.error", { hasText: "a_000006.pent: cannot be reached" }).waitFor();
    isDown = false;
    await go(3);
    await go(6);
    const wait = page.locator(".message.busy", { hasText: "Loading frame 6" });
    await wait.waitFor();
    letGo();
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 6);
    await wait.waitFor({ state: "detached" });
    await close();
});
