import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { openPage, useBrowser, useServer } from "../support/browser.ts";

// The page without a mouse, without eyes, with the colors of the system, on the narrowest of phones.

const browser = useBrowser();
const server = useServer(new Map());
const open = (query: string, options = {}) =>
    openPage(browser.get(), server.address() + query, options);

const orbit = (page: Page) => page.evaluate(() => ({ ...window.pentimento!.viewer.state.orbit }));

test("the tab key comes to every control, shows where it is, and out again", async () => {
    const { page, close } = await open("");
    const { all, visited, unseen } = await page.evaluate(() => {
        const isThere = (one: Element) => one.getClientRects().length > 0;
        // Of a group of radio buttons the tab key takes the one that is chosen.
        const all = [...document.querySelectorAll("button, input, select, summary, canvas")]
            .filter((one) => isThere(one) && !one.matches("[type=radio]:not(:checked)"))
            .map((one, i) => (one.setAttribute("data-place", String(i)), i));
        return { all: all.length, visited: [] as string[], unseen: [] as string[] };
    });
    for (let i = 0; i < all + 2; ++i) {
        await page.keyboard.press("Tab");
        const seen = await page.evaluate(() => {
            const one = document.activeElement!;
            const shown = one.matches(".segments input") ? one.nextElementSibling! : one;
            const { outlineStyle, outlineWidth } = getComputedStyle(shown);
            const isSeen = outlineStyle !== "none" && parseFloat(outlineWidth) >= 1;
            return { place: one.getAttribute("data-place"), isSeen };
        });
        if (seen.place !== null) {
            visited.push(seen.place);
            unseen.push(...(seen.isSeen ? [] : [seen.place]));
        }
    }
    assert.equal(new Set(visited).size, all);
    assert.deepEqual(unseen, []);
    await close();
});

test("what can be dragged keys do, too, and what they have done is said", async () => {
    const { page, close } = await open("#shade=off");
    const before = await orbit(page);
    await page.keyboard.press("l");
    await page.keyboard.press("i");
    const turned = await orbit(page);
    assert.equal(turned.azimuth, before.azimuth + 10);
    assert.equal(turned.elevation, before.elevation + 10);
    await page.keyboard.press("Shift+L");
    await page.keyboard.press("Shift+I");
    const moved = await orbit(page);
    assert.ok(
        moved.panX < turned.panX && moved.panY < turned.panY,
        "the picture to the right and up",
    );
    await page.keyboard.press("Shift+J");
    await page.keyboard.press("Shift+K");
    await page.keyboard.press("j");
    await page.keyboard.press("k");
    assert.deepEqual(await orbit(page), before);
    await page.keyboard.press("Shift+ArrowUp");
    const said = page.locator("#status", { hasText: /^Slice at w = 0\.\d+ m of Tesseract/ });
    await said.waitFor({ state: "attached" });
    await close();
});

test("sliders say what they stand at in words, nothing is said while it plays", async () => {
    const { page, close } = await open("");
    await page.locator(".turns input[aria-label='xw'][type=range]").fill("30");
    const turn = page.locator(".turns input[aria-label='xw'][type=range]");
    assert.equal(await turn.getAttribute("aria-valuetext"), "30 \u00b0");
    const live = await page.locator("output:not([aria-live=off])").count();
    assert.equal(live, 0);
    const panel = page.locator("button[title=Controls]");
    assert.equal(await panel.getAttribute("aria-expanded"), "true");
    await panel.click();
    await page.waitForFunction(
        () => document.querySelector("button[title=Controls]")!.ariaExpanded === "false",
    );
    await close();
});

test("in colors of the system what is chosen differs from what is not", async () => {
    const { page, close } = await open("", { forcedColors: "active" });
    const shades = await page
        .locator("#panel .segments span")
        .evaluateAll((spans) => spans.map((span) => getComputedStyle(span).backgroundColor));
    assert.notEqual(shades[0], shades[1]);
    assert.equal(shades[1], shades[2]);
    const loop = page.locator("button[title=Loop]");
    const shade = () => loop.evaluate((one) => getComputedStyle(one).backgroundColor);
    const pressed = await shade();
    await loop.click();
    await page.mouse.move(1, 1);
    assert.notEqual(await shade(), pressed);
    await close();
});

test("on the narrowest phone the legend is beside the bodies, and nothing is wider than the page", async () => {
    const { page, close } = await open("#layout=side&color=speed", {
        viewport: { width: 320, height: 640 },
        isMobile: true,
        hasTouch: true,
    });
    await page.locator(".legend .colorbar").waitFor();
    const { left, wide } = await page.evaluate(() => ({
        left: document.querySelector(".legend")!.getBoundingClientRect().left,
        wide: document.documentElement.scrollWidth,
    }));
    assert.ok(left > 0.66 * 320, `${left}`); // the cube in the middle of its tile takes a third
    assert.equal(wide, 320);
    await close();
});
