import assert from "node:assert/strict";
import { test } from "node:test";
import { openPage, useBrowser, useServer } from "../support/browser.ts";

const browser = useBrowser();
const server = useServer(new Map());
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
