import { existsSync } from "node:fs";
import { resolve } from "node:path";

/** The repository. */
export const kRoot = process.env["PENT_ROOT"]!;

/** A program of a native build, or null: then what compares with it is skipped. */
export function native(name: string): string | null {
    const folders = [
        process.env["PENT_BIN"], // from the repository, wherever npm runs
        "build/dev/bin",
        "build/release/bin",
    ].filter((folder) => folder !== undefined);
    const found = folders
        .map((folder) => resolve(kRoot, folder, name))
        .find((path) => existsSync(path));
    if (!found && process.env["PENT_NATIVE"] === "required") {
        throw new Error(`${name} is not built; build the preset dev`);
    }
    return found ?? null;
}

// Other numbers each time, to look longer: PENT_SEED=5 npm test.
const kShift = 1000 * Number(process.env["PENT_SEED"] ?? 0);

/** Random numbers that are the same every time: 0 up to 1. */
export function randomFrom(seed: number): () => number {
    let state = seed + kShift;
    return () => {
        state = (state + 0x6d2b79f5) | 0;
        let t = Math.imul(state ^ (state >>> 15), 1 | state);
        t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
        return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
    };
}
