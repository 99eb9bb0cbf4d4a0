import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { difference, openPage, pixels, useBrowser, useServer } from "../support/browser.ts";
import { kRoot } from "../support/native.ts";

const browser = useBrowser();
const server = useServer(new Map());

// Pictures against references of 160 x 120. Software draws them alike everywhere but for rounding,
// which moves edges a little: of one pixel in fifty the difference may be large.
const kPictures = {
    solid: "?example=duocylinder#rotate=xw:30",
    onion: "?example=twist#frame=25&layout=onion&box=on&theme=dark",
    ghost: "?example=tesseract#rotate=xw:25,yw:15&ghost=perspective&w=0.2&color=w",
    side: "?example=ball#layout=side&slices=2&frame=30&color=speed&smooth=off&floor=off&shade=off",
};

// Whether a number is the red of a pixel near magenta, which nothing here is.
function isInsideOut(red: number, i: number, all: number[]): boolean {
    const [green, blue] = [all[i + 1]!, all[i + 2]!];
    return i % 3 === 0 && red > 1.6 * green && blue > 1.3 * green;
}

for (const [name, query] of Object.entries(kPictures)) {
    test(`the picture "${name}" is as it was`, async () => {
        const viewport = { width: 320, height: 240 }; // what is compared is of its own size
        const { page, close } = await openPage(browser.get(), server.address() + query, {
            viewport,
        });
        const found = await pixels(page);
        await close();
        const path = join(kRoot, `web/tests/e2e/references/${name}.ppm`);
        const header = "P6\n160 120\n255\n";
        if (process.env["PENT_NEW_PICTURES"]) {
            writeFileSync(path, Buffer.concat([Buffer.from(header), Buffer.from(found)]));
        }
        const expected = [...readFileSync(path).subarray(header.length)];
        assert.ok(difference(found, expected, 12) < 0.02, `${difference(found, expected, 12)}`);
        assert.equal(
            found.filter(isInsideOut).length,
            0,
            "no rim has the color of what is inside out",
        );
        // And a picture that is another one is told from it.
        const shifted = [...expected.slice(30), ...expected.slice(0, 30)];
        assert.ok(difference(shifted, expected, 12) > 0.02);
    });
}
