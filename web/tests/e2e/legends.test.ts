import assert from "node:assert/strict";
import { test } from "node:test";
import { gridMesh } from "../../src/mesh/grid.ts";
import { openPage, useBrowser, useServer } from "../support/browser.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

const browser = useBrowser();

// Ten bodies, one of a name as long as names may be.
const kMesh = writeMesh(gridMesh([1, 1, 1, 1], (p) => p));
const kPositions = [...gridMesh([1, 1, 1, 1], (p) => p).positions];
const kNames = ["a".repeat(100), ..."bcdefghij"];
const server = useServer(
    new Map<string, Uint8Array | string>([
        [
            "many/run.json",
            JSON.stringify({
                meshes: kNames,
                frames: Object.fromEntries(kNames.map((name) => [name, [[0, 0]]])),
            }),
        ],
        ...kNames.flatMap((name): [string, Uint8Array][] => [
            [`many/meshes/${name}.pent`, kMesh],
            [`many/frames/${name}_000000.pent`, writeFrame(kMesh, 0, 0, kPositions, kPositions)],
        ]),
    ]),
);
const open = (query: string) => openPage(browser.get(), server.address() + query);

test("where no body is in the slice that is said, in words as well", async () => {
    const { page, close } = await open("?example=tesseract#shade=off&w=1.1");
    const label = page.locator(".labels span");
    assert.equal(await label.innerText(), "no body here: from w = \u22121 to 1");
    const canvas = page.locator("#canvas");
    assert.match((await canvas.getAttribute("aria-label"))!, /^Slice at w = 1\.1 m, where no body/);
    await page.evaluate(() => window.pentimento!.viewer.update({ w: 0.4 }));
    await label.waitFor({ state: "detached" });
    assert.match((await canvas.getAttribute("aria-label"))!, /^Slice at w = 0\.4 m of Tesseract/);
    await close();
});

test("a legend of bodies is within the picture, whatever they are called and however many they are", async () => {
    const { page, close } = await openPage(
        browser.get(),
        `${server.address()}?run=many#shade=off`,
        {
            viewport: { width: 390, height: 600 },
        },
    );
    const entries = page.locator(".legend .entry");
    await entries.first().waitFor();
    assert.equal(await entries.count(), 8);
    assert.match(await page.locator(".legend").innerText(), /\nand 2 more$/);
    const { x, width } = (await entries.first().boundingBox())!;
    assert.ok(x >= 195 && x + width <= 390, `${x} ${width}`);
    assert.equal(await entries.first().getAttribute("title"), kNames[0]);
    await close();
});

test("an onion skin has a legend of its slices", async () => {
    const { page, close } = await open(
        "?example=tesseract#shade=off&layout=onion&slices=4&spacing=0.2",
    );
    const entries = page.locator(".skins .entry");
    // From above to below; the solid one has no color.
    const expected = [0.3, 0.1, -0.1, -0.3].map((w) => `w = ${w}`.replace("-", "\u2212"));
    assert.deepEqual(await entries.allInnerTexts(), expected);
    assert.equal(await page.locator(".skins .swatch.none").count(), 1);
    await close();
});
