import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { crc32c, hex8 } from "../../src/format/crc32c.ts";
import { readMesh } from "../../src/format/pent_file.ts";
import { join as joinFile } from "../../src/format/write_pent.ts";
import { galleryFiles } from "../../src/play/gallery.ts";
import { kPage, openPage, useBrowser, useServer } from "../support/browser.ts";
import { native } from "../support/native.ts";
import type { SceneFiles } from "../../src/play/protocol.ts";
import { edited, library, withFiles } from "../support/play.ts";

// Milliseconds of a step of 1/60 s on ground, in node and in native code of one thread, in turns, so that all see the same
// machine: processor time, which others on it disturb least. In the browser's worker by the clock.

const kSteps = 120;
const kRounds = 5;

/** The octopus of the gallery with more layers: 1,176 pentachora each. */
function octopus(layers: number) {
    const scene = galleryFiles("octopus");
    const file = Buffer.from(scene.get("octopus.pent")!);
    const [head, end] = [file.toString("latin1"), "end_header\n"];
    const header = head.slice(0, head.indexOf(end) + end.length - 1).split("\n");
    const kRow = 16 * 8 + 1; // bytes of a layer: matrix, offset, reversed
    const [, old] = /element layer (\d+)/.exec(head)!;
    const rows = Array.from({ length: layers + 1 }, (_, i) => {
        const row = Buffer.from(file.subarray(file.length - kRow));
        row.writeDoubleLE(-0.4 + (0.8 * i) / layers, kRow - 9); // w
        return row;
    });
    const base = file.subarray(header.join("\n").length + 1, file.length - kRow * Number(old));
    const body = Buffer.concat([base, ...rows]);
    const lines = header
        .filter((line) => !line.startsWith("comment header_crc32c"))
        .map((line) => line.replace(/^comment crc32c .*/, `comment crc32c ${hex8(crc32c(body))}`))
        .map((line) => line.replace(/^element layer .*/, `element layer ${rows.length}`));
    const made = joinFile(lines, body);
    return {
        cells: readMesh(made, "octopus.pent").cellCount,
        files: new Map(scene).set("octopus.pent", made),
    };
}

/** Processor time of pent-sim for so many steps, ms, all else included; null where it does not run. */
function processorTime(files: SceneFiles, steps: number, isa: string): number | null {
    const scene = edited(files, (text) =>
        text
            .replace("frames_per_second = 60", `frames_per_second = ${60 / steps}`)
            .replace("[scene]\n", `[scene]\nframes = 1\nsteps_per_frame = ${steps}\n`),
    );
    return withFiles(scene, (folder) => {
        const options = ["-o", join(folder, "run"), "--quiet", "--threads", "1", "--isa", isa];
        const command = [native("pent-sim")!, join(folder, "scene.toml"), ...options];
        try {
            // The second line is of what the shell has run: user and system.
            const said = execFileSync("bash", ["-c", '"$@" && times', "bash", ...command]);
            const times = said
                .toString()
                .split("\n")[1]!
                .matchAll(/(\d+)m([\d.]+)s/g);
            return [...times].reduce((sum, [, m, s]) => sum + 60_000 * +m! + 1000 * +s!, 0);
        } catch {
            return null; // this machine has no such instructions
        }
    });
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
            let sum = 0;
            for (let i = 0; i < kSteps; ++i) {
                const begin = process.cpuUsage();
                simulation.step();
                const { user, system } = process.cpuUsage(begin);
                add("node", (user + system) / 1000);
                sum += (user + system) / 1000;
            }
            simulation.close();
            add("node, mean", sum / kSteps);
            for (const isa of ["avx512", "avx2", "baseline"]) {
                const [one, all] = [1, kSteps + 1].map((steps) => processorTime(files, steps, isa));
                if (one !== null && all !== null) {
                    add(`native ${isa}, mean`, (all! - one!) / kSteps);
                }
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
        // Of each round, whose parts saw the same machine.
        const ratios = times["node, mean"]!.map((ms, i) => ms / times["native avx512, mean"]?.[i]!);
        console.log(`  node over avx512: ${ratios.map((ratio) => ratio.toFixed(2)).join(", ")}`);
    });
}
