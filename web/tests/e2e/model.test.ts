import assert from "node:assert/strict";
import { test } from "node:test";
import { dropOn, openPage, useBrowser, useServer } from "../support/browser.ts";
import { kSixteenCell, textModel } from "../support/write_g4mf.ts";

const kModel = textModel({ shapes: ["cell_000004 at 0 s", "cell_000009 at 0.5 s"] });
const kBeside = new TextEncoder().encode(JSON.stringify(kSixteenCell.json));

const browser = useBrowser();
const server = useServer(new Map([["cell.g4tf", kModel]]));
const open = (query: string) => openPage(browser.get(), server.address() + query);

test("G4MF models open from a server and dropped with their buffers, and shapes are frames", async () => {
    const { page, said, close } = await open("?run=cell.g4tf#shade=off&w=0.5");
    assert.equal(await page.locator("#facts").innerText(), "1 body, 8 vertices, 2 frames");
    const shown = () => page.evaluate(() => window.pentimento!.viewer.moment!.frame);
    const errorText = () => page.locator(".message.error").first().innerText();
    // The 16-cell cut at w = 1/2: an octahedron.
    const triangles = () =>
        page.evaluate(() => {
            const { viewer } = window.pentimento!;
            return viewer.renderer.captureSlice(viewer.makePicture(8, 8, 1), 0, 0).length / 9;
        });
    assert.equal(await triangles(), 8);
    await page.locator("input.time").fill("1");
    await page.waitForFunction(() => window.pentimento!.viewer.moment!.frame === 9);
    assert.equal(await shown(), 9);
    await page.locator("select[aria-label='Color by']").selectOption("strain");
    await page.waitForSelector(".message.error");
    assert.match(await errorText(), /^here is no strain to color by/);
    await dropOn(page, { "beside.g4tf": kBeside, "points.bin": kSixteenCell.points });
    await page.waitForFunction(() =>
        document.querySelector(".message.error span")?.textContent?.startsWith("indices.bin:"),
    );
    assert.match(await errorText(), /^indices\.bin: no such file among those that were opened/);
    const { points, indices } = kSixteenCell;
    await dropOn(page, { "beside.g4tf": kBeside, "points.bin": points, "indices.bin": indices });
    await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "beside");
    assert.equal(await page.locator(".message.error").count(), 0);
    assert.deepEqual(
        said.filter((text) => text.startsWith("thrown")),
        [],
    );
    await close();
});
