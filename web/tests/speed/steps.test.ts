import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { readMesh } from "../../src/format/pent_file.ts";
import { writeMesh } from "../../src/format/write_pent.ts";
import { extrude } from "../../src/mesh/extrude.ts";
import { galleryFiles } from "../../src/play/gallery.ts";
import { kPage, openPage, useBrowser, useServer } from "../support/browser.ts";
import { kRoot, native } from "../support/native.ts";
import { edited, library, withFiles } from "../support/play.ts";

// Milliseconds of a step of 1/60 s on ground, in the browser's worker, in node and in native code of one thread, in turns,
// so that all see the same machine. On a machine that others use the best tenth says most.

const kSteps = 120;
const kRounds = 3;

/** The octopus of the gallery with more layers: 1,176 pentachora each. */
function octopus(layers: number) {
    const base = readMesh(readFileSync(join(kRoot, "web/gallery/octopus.pent")), "octopus.pent");
    const heights = Array.from({ length: layers + 1 }, (_, i) => -0.4 + (0.8 * i) / layers);
    const mesh = extrude(base, heights);
    const files = edited(galleryFiles("octopus"), (text) =>
        text.replace("[scene]\n", `[scene]\nframes = ${kSteps}\n`),
    );
    return { cells: mesh.cellCount, files: files.set("octopus.pent", writeMesh(mesh)) };
}

function best(values: number[]): string {
    const sorted = [...values].sort((a, b) => a - b);
    const at = (part: number) => sorted[Math.floor(part * (sorted.length - 1))]!.toFixed(2);
    return `${at(0.1)} ms (median ${at(0.5)})`;
}

const browser = useBrowser();
const server = useServer(
    new Map([["playground.js", readFileSync(join(dirname(kPage), "playground.js"))]]),
);

for (const layers of [4, 9]) {
    test(`octopus of ${layers} layers`, async () => {
        const { cells, files } = octopus(layers);
        const held = (await library())!;
        const settings = { stiffness: 1, damping: null, stepsPerSecond: null };
        files.forEach((bytes, name) => held.module.FS.writeFile(name, bytes));
        const times: Record<string, number[]> = {};
        const add = (name: string, value: number) => (times[name] ??= []).push(value);
        for (let round = 0; round < kRounds; ++round) {
            const simulation = held.open("scene.toml", settings, null);
            for (let i = 0; i < kSteps; ++i) {
                const begin = process.cpuUsage();
                simulation.step();
                const { user, system } = process.cpuUsage(begin);
                add("node, processor", (user + system) / 1000);
            }
            simulation.close();
            for (const isa of ["avx512", "avx2", "baseline"]) {
                withFiles(files, (folder) => {
                    const run = join(folder, "run");
                    const scene = join(folder, "scene.toml");
                    const sim = native("pent-sim")!;
                    try {
                        execFileSync(sim, [
                            ...[scene, "-o", run, "--quiet", "--threads", "1", "--isa", isa],
                        ]);
                    } catch {
                        return; // this machine has no such instructions
                    }
                    const report = JSON.parse(readFileSync(join(run, "report.json"), "utf8")) as {
                        steps: { seconds: number }[];
                    };
                    report.steps.forEach(({ seconds }) => add(`native ${isa}`, 1000 * seconds));
                });
            }
        }
        const { page, close } = await openPage(
            browser.get(),
            `${server.address()}?play=bar#shade=off`,
            {
                viewport: { width: 320, height: 200 },
            },
        );
        await page.waitForFunction(() => window.pentimento!.play.isOpen);
        await page.evaluate(
            (dropped) => {
                const transfer = new DataTransfer();
                for (const [name, bytes] of dropped) {
                    transfer.items.add(new File([Uint8Array.from(bytes)], name));
                }
                document.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer }));
            },
            [...files].map(([name, bytes]) => [name, [...bytes]] as const),
        );
        await page.waitForFunction(() => window.pentimento!.viewer.run!.title === "scene");
        for (let i = 0; i < 40; ++i) {
            await page.waitForTimeout(250);
            const text = await page.locator(".numbers").innerText();
            const shown = /([\d.]+) ms/.exec(text);
            if (shown) {
                add("Chromium, clock, while it draws in software", Number(shown[1]));
            }
        }
        await close();
        console.log(`${cells} pentachora`);
        for (const [name, values] of Object.entries(times)) {
            console.log(`  ${name}: ${best(values)}`);
        }
    });
}
