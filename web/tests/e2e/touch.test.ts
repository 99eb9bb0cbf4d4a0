import assert from "node:assert/strict";
import { test } from "node:test";
import type { Page } from "playwright-core";
import { openPage, useBrowser, useServer } from "../support/browser.ts";

const browser = useBrowser();
const server = useServer(new Map());

type Finger = { x: number; y: number };

/** Fingers on the picture that go straight from places to others, in pixels from its middle. */
async function drag(page: Page, from: Finger[], to: Finger[]): Promise<void> {
    const box = (await page.locator("#canvas").boundingBox())!;
    const session = await page.context().newCDPSession(page);
    const send = (type: "touchStart" | "touchMove" | "touchEnd", fingers: Finger[]) =>
        session.send("Input.dispatchTouchEvent", {
            type,
            touchPoints: fingers.map(({ x, y }, id) => ({
                x: box.x + box.width / 2 + x,
                y: box.y + box.height / 2 + y,
                id,
            })),
        });
    await send("touchStart", from);
    for (const part of [0.5, 1]) {
        const between = (a: number, b: number) => a + part * (b - a);
        await send(
            "touchMove",
            from.map(({ x, y }, i) => ({ x: between(x, to[i]!.x), y: between(y, to[i]!.y) })),
        );
    }
    await page.waitForTimeout(100); // else Chromium takes it for a fling, and the tap behind it for its end
    await send("touchEnd", []);
}

test("one finger does what its button says, two pinch and move the picture", async () => {
    const { page, close } = await openPage(browser.get(), `${server.address()}#shade=off`, {
        viewport: { width: 390, height: 844 },
        hasTouch: true,
        isMobile: true,
    });
    await page.locator("#welcome button[title=Close]").tap();
    const state = () =>
        page.evaluate(() => {
            const { orbit, rotation } = window.pentimento!.viewer.state;
            return { ...orbit, xx: rotation[0]!, zz: rotation[10]! };
        });
    const start = await state();
    await drag(page, [{ x: 0, y: 0 }], [{ x: 60, y: 0 }]);
    const looked = await state();
    assert.notEqual(looked.azimuth, start.azimuth);
    assert.equal(looked.xx, 1);

    await page.locator("label, button", { hasText: /^xw yw$/ }).tap();
    await page.locator("input[value=xw]:checked").waitFor({ state: "attached" }); // a click follows
    await drag(page, [{ x: 0, y: 0 }], [{ x: 60, y: 0 }]);
    const turned = await state();
    assert.equal(turned.azimuth, looked.azimuth);
    const angle = (60 * 0.35 * Math.PI) / 180; // as the mouse: 0.35 degrees a pixel
    assert.ok(Math.abs(turned.xx - Math.cos(angle)) < 1e-6, `${turned.xx}`);
    assert.equal(turned.zz, 1);

    const apart = (by: number, up = 0) => [
        { x: -by, y: up },
        { x: by, y: up },
    ];
    await drag(page, apart(40), apart(80));
    const nearer = await state();
    assert.ok(Math.abs(nearer.zoom / turned.zoom - 2) < 1e-6, `${nearer.zoom}`);
    assert.equal(nearer.xx, turned.xx, "what turns bodies is one finger");
    await drag(page, apart(40), apart(40, 50));
    assert.ok((await state()).panY !== nearer.panY);
    await close();
});
