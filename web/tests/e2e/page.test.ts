import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { gridMesh } from "../../src/mesh/grid.ts";
import { dropOn, kPage, openPage, pixels, useBrowser, useServer } from "../support/browser.ts";
import { kRoot } from "../support/native.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

// Twelve frames of a bar that wanders off along x, with contact forces; made here, 300 kB in all.
const kBar = gridMesh([3, 1, 1, 1], ([x, y, z, w]) => [1.5 * x, 0.5 * y, 0.5 * z, 0.5 * w]);
const kMesh = writeMesh(kBar);
const kFrames = 12;

function frameOf(frame: number): Uint8Array {
    const moved = [...kBar.positions].map((value, i) => value + (i % 4 === 0 ? 0.02 * frame : 0));
    const velocities = moved.map((_, i) => (i % 4 === 0 ? 0.6 : 0));
    const forces = moved.map((_, i) => (i % 4 === 1 ? moved[i - 1]! : 0));
    return writeFrame(kMesh, frame, frame / 30, moved, velocities, forces);
}

function runFiles(prefix: string, frames = kFrames): Map<string, Uint8Array | string> {
    const files = new Map<string, Uint8Array | string>([[`${prefix}meshes/bar.pent`, kMesh]]);
    for (let frame = 0; frame < frames; ++frame) {
        files.set(`${prefix}frames/bar_${String(frame).padStart(6, "0")}.pent`, frameOf(frame));
    }
    files.set(
        `${prefix}report.json`,
        JSON.stringify({
            verdict: "finished",
            bodies: [{ name: "bar" }],
            frames: Array.from({ length: frames }, (_, frame) => ({ frame })),
        }),
    );
    return files;
}

const kTet = writeMesh({
    dimension: 3,
    positions: Float64Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1),
    cells: Uint32Array.of(0, 1, 2, 3),
});

const files = runFiles("run/");
files.set("tet.pent", kTet);
files.set("notes.pent", "these are notes");
files.set("cut.pent", kMesh.subarray(0, kMesh.length - 100));
for (const [path, bytes] of runFiles("damaged/")) {
    files.set(path, path.endsWith("_000003.pent") ? bytes.slice(0, 900) : bytes);
}
files.set("growing/meshes/bar.pent", kMesh);
for (let frame = 0; frame < 4; ++frame) {
    files.set(`growing/frames/bar_00000${frame}.pent`, frameOf(frame));
}
files.set("growing/run.json", '{"meshes":["bar"],"frames":{"bar":[[0,1]]},"follow":true}');

const browser = useBrowser();
const server = useServer(files);
const open = (query: string, options = {}) =>
    openPage(browser.get(), server.address() + query, options);

const errorText = (page: Page) => page.locator(".message.error").first().innerText();
const state = (page: Page) =>
    page.evaluate(() => {
        const { state, moment, place } = window.pentimento!.viewer;
        return { ...state, rotation: [...state.rotation], shown: moment!.frame, place };
    });

test("without a run there is an example, a welcome and no error", async () => {
    const { page, said, close } = await open("");
    assert.match(await page.locator("#welcome").innerText(), /Drop a run folder/);
    assert.equal(await page.locator(".message.error").count(), 0);
    assert.match(
        (await page.locator("#canvas").getAttribute("aria-label"))!,
        /^Slice at w = 0 m of Tess/,
    );
    const picture = await pixels(page);
    assert.ok(new Set(picture).size > 50, "the picture is not blank");
    assert.deepEqual(
        said.filter((text) => /thrown|error/i.test(text)),
        [],
    );
    await close();
});

test("a run on a server opens, its slider of time brings frames, play goes on and loops", async () => {
    const { page, said, close } = await open("?run=run#shade=off");
    assert.equal(await page.title(), "run \u2013 Pentimento");
    assert.match(
        await page.locator("#facts").innerText(),
        /1 body, 32 vertices, 72 pentachora, 12 frames/,
    );
    await page.locator("input.time").fill("7");
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 7);
    await page.keyboard.press("Escape");
    await page.locator("#canvas").focus();
    await page.keyboard.press("ArrowLeft");
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 6);
    await page.locator("button[title=Play]").click();
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame < 6);
    await page.locator("button[title=Pause]").click();
    assert.equal(await page.evaluate(() => window.pentimento!.viewer.isPlaying), false);
    assert.deepEqual(
        said.filter((text) => text.startsWith("thrown")),
        [],
    );
    await close();
});

test("the slider of w, keys and drags move the view, and the address follows", async () => {
    const { page, close } = await open("?run=run#shade=off");
    await page.locator("input.w").fill("250");
    assert.equal((await state(page)).w, -0.25); // a quarter from -0.5 to 0.5
    await page.locator("#canvas").focus();
    await page.keyboard.press("Digit4");
    await page.keyboard.press("Shift+Digit3");
    await page.waitForFunction(() => location.hash.includes("rotate="));
    assert.match(
        await page.evaluate(() => location.hash),
        /^#w=-0.25&rotate=(xw:5,yz:-5|yz:-5,xw:5)/,
    );
    await page.keyboard.press("Digit0");
    assert.equal((await state(page)).w, null);

    const box = (await page.locator("#canvas").boundingBox())!;
    const drag = async (dx: number, dy: number, key?: string) => {
        if (key) {
            await page.keyboard.down(key);
        }
        await page.mouse.move(box.x + 200, box.y + 150);
        await page.mouse.down();
        await page.mouse.move(box.x + 200 + dx, box.y + 150 + dy);
        await page.mouse.up();
        if (key) {
            await page.keyboard.up(key);
        }
    };
    await drag(40, 0);
    assert.equal((await state(page)).orbit.azimuth, 30 - 40 * 0.35);
    await drag(100, 0, "Shift"); // 35 degrees in xw: cosine and sine in the corners of the matrix
    let { rotation } = await state(page);
    assert.ok(Math.abs(rotation[0]! - Math.cos((35 * Math.PI) / 180)) < 1e-9);
    assert.ok(Math.abs(rotation[12]! - Math.sin((35 * Math.PI) / 180)) < 1e-9);
    await page.keyboard.press("Digit0");
    await page.locator("#tools label", { hasText: "zw xy" }).click();
    await drag(0, -100);
    ({ rotation } = await state(page));
    assert.ok(Math.abs(rotation[14]! - Math.sin((35 * Math.PI) / 180)) < 1e-9);
    await page.mouse.move(box.x + 200, box.y + 150);
    await page.mouse.wheel(0, -300);
    await page.waitForFunction(() => window.pentimento!.viewer.state.orbit.zoom > 1.5);
    await close();
});

test("the six sliders of turning are the angles of the rotation", async () => {
    const { page, close } = await open("?run=run#shade=off");
    for (const [plane, degrees] of [
        ["xw", 30],
        ["yz", -20],
        ["zw", 75],
    ] as const) {
        await page.locator(`.turns input[aria-label="${plane}"]`).fill(String(degrees));
    }
    await page.waitForFunction(() => location.hash.includes("rotate=zw:75,yz:-20,xw:30"));
    await page.locator("#canvas").focus();
    await page.keyboard.press("Digit4"); // turns after all others, so angles change together
    const angles = await page
        .locator(".turns input[type=range]")
        .evaluateAll((inputs) =>
            (inputs as HTMLInputElement[]).map((input) => Number(input.value)),
        );
    assert.equal(angles.length, 6);
    assert.equal(angles[3], 35);
    await close();
});

test("a view comes back from its address", async () => {
    const hash =
        "#w=0.1&rotate=xw:40&frame=5&layout=side&slices=4&color=strain&theme=dark&shade=off";
    const { page, close } = await open(`?run=run${hash}`);
    const { w, shown, slices, theme } = await state(page);
    assert.deepEqual({ w, shown, slices, theme }, { w: 0.1, shown: 5, slices: 4, theme: "dark" });
    assert.equal(await page.locator(".labels span").count(), 4);
    assert.equal(await page.evaluate(() => document.documentElement.dataset["theme"]), "dark");
    await close();
});

test("colors by force, speed and strain have a legend; a mesh says what it lacks", async () => {
    const { page, close } = await open("?run=run&#shade=off");
    for (const [color, title] of [
        ["force", "contact force, N"],
        ["speed", "speed, m/s"],
        ["strain", "strain"],
        ["w", "w, m"],
    ] as const) {
        await page.locator("select[aria-label='Color by']").selectOption(color);
        await page.waitForFunction(
            (title) => document.querySelector(".legend .title")?.textContent === title,
            title,
        );
    }
    const ends = await page.locator(".legend .ends span").allInnerTexts();
    assert.deepEqual(ends, ["-0.5", "0.5"]);
    await close();
    const mesh = await open("?run=tet.pent#color=force&shade=off");
    assert.match(
        await errorText(mesh.page),
        /^frame 0 of "tet" has no contact forces to color by; run the scene/,
    );
    assert.equal((await state(mesh.page)).color, "body");
    await mesh.close();
});

test("a mesh of three dimensions is shown whole, without w", async () => {
    const { page, close } = await open("?run=tet.pent#shade=off");
    assert.equal(await page.locator("input.w").isVisible(), false);
    assert.equal(await page.locator(".turns .slider:visible").count(), 3);
    const triangles = await page.evaluate(() => {
        const { viewer } = window.pentimento!;
        return viewer.renderer.captureSlice(viewer.makePicture(8, 8, 1), 0, 0).length / 9;
    });
    assert.equal(triangles, 4);
    await close();
});

test("what cannot be read is said with its place, and the page stays usable", async () => {
    const cases = [
        ["?run=notes.pent", /^notes\.pent: header line 1: found 'these are notes', expected 'ply'/],
        [
            "?run=cut.pent",
            /^cut\.pent: element pentachoron: the header announces 72 of 20 bytes each/,
        ],
        ["?run=nothing", /^nothing\/: neither run\.json nor report\.json is there; expected a run/],
        ["?run=gone.pent", /^gone\.pent: cannot be read: the server says 404/],
        ["?example=klein", /^No example is called "klein"; there are tesseract/],
    ] as const;
    for (const [query, expected] of cases) {
        const { page, close } = await open(`${query}#shade=off`);
        assert.match(await errorText(page), expected);
        assert.ok((await pixels(page)).some((value) => value > 0));
        await close();
    }
    const note = await open("?run=run#nonsense=3&shade=off");
    await note.page.waitForSelector(".message");
    assert.match(
        await note.page.locator(".message").first().innerText(),
        /not understood: nonsense=3/,
    );
    await note.close();
});

test("a damaged frame is said when it is reached, and the others play on", async () => {
    const { page, close } = await open("?run=damaged#shade=off&frame=2");
    await page.locator("input.time").fill("3");
    await page.waitForSelector(".message.error");
    assert.match(
        await errorText(page),
        /^damaged.*|frames\/bar_000003\.pent: element vertex: the header/,
    );
    await page.locator("input.time").fill("4");
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 4);
    await close();
});

test("a run that is being written is followed", async () => {
    const { page, close } = await open("?run=growing#shade=off");
    assert.equal(await page.locator("input.time").getAttribute("max"), "1");
    files.set("growing/run.json", '{"meshes":["bar"],"frames":{"bar":[[0,3]]},"follow":false}');
    await page.waitForFunction(
        () => (document.querySelector("input.time") as HTMLInputElement).max === "3",
    );
    const polls = () => server.asked.filter((path) => path === "growing/run.json").length;
    const before = polls();
    await page.waitForTimeout(2500); // more than a round of asking
    assert.equal(polls(), before); // it is finished: nobody asks again
    await close();
});

function writeFolder(name: string): string {
    const folder = join(kRoot, "web/build", name);
    for (const [path, bytes] of runFiles("", 3)) {
        mkdirSync(join(folder, path, ".."), { recursive: true });
        writeFileSync(join(folder, path), bytes);
    }
    return folder;
}

test("the page opens from a file by a double click, and takes chosen folders", async () => {
    const { page, said, close } = await openPage(
        browser.get(),
        `${pathToFileURL(kPage)}#shade=off`,
    );
    const folder = writeFolder("chosen");
    await page.locator("input[webkitdirectory]").setInputFiles(folder);
    await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "chosen");
    assert.match(await page.locator("#facts").innerText(), /72 pentachora, 3 frames/);
    await page
        .locator("input[multiple]")
        .setInputFiles({ name: "mesh.pent", mimeType: "", buffer: Buffer.from(kMesh) });
    await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "mesh");
    assert.equal(await page.locator("input.time").isVisible(), false);
    // The same file, changed meanwhile, can be chosen again.
    assert.equal(await page.locator("input[multiple]").inputValue(), "");
    assert.deepEqual(
        said.filter((text) => /thrown|error/i.test(text)),
        [],
    );
    await close();
});

test("dropped files open, and a dropped text is refused without losing what is open", async () => {
    const { page, close } = await open("?run=run#shade=off");
    const drop = (name: string, bytes: number[]) =>
        dropOn(page, { [name]: Uint8Array.from(bytes) });
    await drop("notes.txt", [104, 105]);
    await page.waitForSelector(".message.error");
    assert.match(await errorText(page), /^notes\.txt: found no \.pent file; expected a run folder/);
    assert.equal(await page.evaluate(() => window.pentimento!.viewer.run!.title), "run");
    await drop("bar.pent", [...kMesh]);
    await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "bar");
    assert.equal(await page.locator(".message.error").count(), 0);
    // What is gone before it is read.
    await page.evaluate(() => {
        const gone = {
            isFile: true,
            name: "a.pent",
            file: (_: unknown, no: (e: Error) => void) => no(new Error("gone")),
        };
        DataTransferItem.prototype.webkitGetAsEntry = () => gone as unknown as FileSystemEntry;
    });
    await drop("a.pent", []);
    await page.waitForSelector(".message.error");
    assert.match(await errorText(page), /^a\.pent: cannot be read: gone/);
    await close();
});

test("pictures, slices and videos are saved", async () => {
    const { page, close } = await open("?run=run#shade=off");
    const save = async (name: string) => {
        await page.locator("button[title=Save]").click();
        const [download] = await Promise.all([
            page.waitForEvent("download"),
            page.locator("[role=menuitem]", { hasText: name }).click(),
        ]);
        return {
            name: download.suggestedFilename(),
            bytes: readFileSync((await download.path())!),
        };
    };
    const picture = await save("Picture");
    assert.equal(picture.name, "run_000000.png");
    assert.deepEqual([...picture.bytes.subarray(1, 4)], [0x50, 0x4e, 0x47]); // PNG
    const slice = await save("Slice");
    const count = Number(/element face (\d+)/.exec(slice.bytes.toString("latin1"))![1]);
    assert.ok(count > 0);
    assert.equal(
        slice.bytes.length,
        slice.bytes.indexOf("end_header\n") + "end_header\n".length + count * (36 + 13),
    );
    const video = await save("Video");
    assert.match(video.name, /^run\.(webm|mp4)$/);
    const start = video.bytes.subarray(0, 8).toString("latin1");
    assert.ok(start.includes("ftyp") || start.startsWith("\x1aE\xdf\xa3"), "MP4 or WebM");
    assert.ok(video.bytes.length > 500, `${video.bytes.length} bytes`);
    await close();
});

test("without WebGL 2 there are words in place of a picture", async () => {
    const context = await browser.get().newContext();
    const page = await context.newPage();
    await page.addInitScript(() => {
        HTMLCanvasElement.prototype.getContext = () => null;
    });
    await page.goto(server.address());
    const words = await page.locator(".failure").innerText();
    assert.match(words, /this browser has no WebGL 2/);
    assert.match(words, /need no graphics card: pent-render/); // what works all the same
    assert.equal(await page.locator("button, input").count(), 0); // nothing that does not
    await context.close();
});

test("every control has a name, and the help opens and closes by keys", async () => {
    const { page, close } = await open("?run=run#shade=off");
    const nameless = await page.evaluate(() =>
        [...document.querySelectorAll("button, input, select")]
            .filter((one) => {
                const input = one as HTMLInputElement;
                return (
                    !input.hidden &&
                    !input.ariaLabel &&
                    !input.labels?.length &&
                    !input.textContent!.trim()
                );
            })
            .map((one) => one.outerHTML),
    );
    assert.deepEqual(nameless, []);
    await page.locator("#canvas").focus();
    await page.keyboard.press("?");
    assert.ok(await page.locator("#help").isVisible());
    assert.match(await page.locator("#help").innerText(), /turn in xw/);
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#help").isVisible(), false);
    await close();
});

test("on a phone the picture has the window, and controls slide over it", async () => {
    const { page, close } = await open("?run=run#shade=off", {
        viewport: { width: 360, height: 640 },
        hasTouch: true,
        isMobile: true,
    });
    assert.equal(await page.locator("#panel").isVisible(), false);
    await page.locator("button[title=Controls]").click();
    assert.ok(await page.locator("#panel").isVisible());
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 360, `${wide} pixels across`);
    await close();
});
