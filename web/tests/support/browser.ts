import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before } from "node:test";
import { chromium } from "playwright-core";
import type { Browser, BrowserContextOptions, Page } from "playwright-core";
import type { App } from "../../src/ui/app.ts";
import { kRoot } from "./native.ts";

declare global {
    interface Window {
        pentimento?: App;
    }
}

const kPatience = 60_000; // ms; software draws slowly where other work goes on beside

export const kPage = join(kRoot, "web/dist/index.html");

/** Starts Debian's Chromium before the tests of a file, drawing in software so that pictures are
 * the same on every machine; ends it after them. */
export function useBrowser(): { get(): Browser } {
    let browser: Browser | null = null;
    before(async () => {
        browser = await chromium.launch({
            executablePath: process.env["PENT_CHROMIUM"] ?? "/usr/bin/chromium",
            args: [
                "--no-sandbox",
                "--use-gl=angle",
                "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader",
                "--force-color-profile=srgb",
            ],
        });
    });
    after(async () => {
        await browser?.close();
    });
    return { get: () => browser! };
}

/** Serves the page and files given by path, on any free port. */
export function useServer(files: Map<string, Uint8Array | string>) {
    const asked: string[] = [];
    const server = createServer((request, response) => {
        const path = decodeURIComponent(new URL(request.url!, "http://a").pathname).slice(1);
        asked.push(path);
        const body = path === "" ? readFileSync(kPage) : files.get(path);
        response.writeHead(body === undefined ? 404 : 200, {
            "content-type": path === "" ? "text/html" : "application/octet-stream",
        });
        response.end(body ?? "not found");
    });
    before(() => new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve)));
    after(() => {
        server.close();
        server.closeAllConnections();
    });
    return { address: () => `http://127.0.0.1:${(server.address() as AddressInfo).port}/`, asked };
}

/** Opens the page in a small window, since software draws it, and waits until a body is shown.
 *
 * @return  The page, and what its console and its errors said. */
export async function openPage(
    browser: Browser,
    address: string,
    options: BrowserContextOptions & { isBare?: boolean } = {},
) {
    const context = await browser.newContext({
        viewport: { width: 780, height: 420 },
        reducedMotion: "reduce",
        ...options,
    });
    context.setDefaultTimeout(kPatience);
    const page = await context.newPage();
    const said: string[] = [];
    page.on("console", (message) => said.push(message.text()));
    page.on("pageerror", (error) => said.push(`thrown: ${error.message}`));
    await page.goto(address, { waitUntil: "commit" });
    if (!options.isBare) {
        await page.waitForFunction(() => window.pentimento?.viewer.moment);
    }
    return { page, said, close: () => context.close() };
}

/** Drops files on the page, by their names. */
export function dropOn(page: Page, files: Record<string, Uint8Array>): Promise<void> {
    return page.evaluate(
        (files) => {
            const transfer = new DataTransfer();
            for (const [name, bytes] of files) {
                transfer.items.add(new File([Uint8Array.from(bytes)], name));
            }
            document.dispatchEvent(
                new DragEvent("drop", { dataTransfer: transfer, bubbles: true }),
            );
        },
        Object.entries(files).map(([name, bytes]) => [name, [...bytes]] as const),
    );
}

/** A picture of the canvas alone, as rows of red green blue from the top, of a size that is small
 * and the same in every window. */
export function pixels(page: Page, width = 160, height = 120): Promise<number[]> {
    return page.evaluate(
        ([width, height]) => {
            const { viewer } = window.pentimento!;
            const picture = viewer.makePicture(width!, height!, 1);
            viewer.renderer.draw(picture);
            const copy = document.createElement("canvas");
            copy.width = width!;
            copy.height = height!;
            const context = copy.getContext("2d")!;
            context.drawImage(viewer.canvas, 0, 0);
            const data = [...context.getImageData(0, 0, width!, height!).data];
            viewer.requestDraw();
            return data.filter((_, i) => i % 4 !== 3);
        },
        [width, height],
    );
}

/** Part of the pixels that differ by more than so many levels in a channel. */
export function difference(a: number[], b: number[], levels: number): number {
    let count = 0;
    for (let i = 0; i < a.length; i += 3) {
        const most = Math.max(...[0, 1, 2].map((k) => Math.abs(a[i + k]! - b[i + k]!)));
        count += most > levels ? 1 : 0;
    }
    return count / (a.length / 3);
}
