import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import makeModule from "playground-module";
import { Library } from "../../src/play/library.ts";
import type { SceneFiles } from "../../src/play/protocol.ts";
import { kRoot } from "./native.ts";

const kWasm = join(kRoot, "build/wasm/web/wasm/playground.wasm");

/** The simulator for browsers in node, or null where it is not built. */
export async function library(): Promise<Library | null> {
    if (!existsSync(kWasm)) {
        if (process.env["PENT_NATIVE"] === "required") {
            throw new Error("the simulator for browsers is not built; run scripts/web.sh");
        }
        return null;
    }
    // It was built for a worker; this is what it looks for in one.
    Object.assign(globalThis, { self: globalThis, location: { href: "" } });
    return new Library(await makeModule({ wasmBinary: readFileSync(kWasm) }));
}

/** Gives a folder with files in it, removed in the end. */
export function withFiles<Value>(files: SceneFiles, action: (folder: string) => Value): Value {
    const folder = mkdtempSync(join(tmpdir(), "pent-play-"));
    try {
        files.forEach((bytes, name) => writeFileSync(join(folder, name), bytes));
        return action(folder);
    } finally {
        rmSync(folder, { recursive: true });
    }
}

/** A scene of the gallery with another text. */
export function edited(files: SceneFiles, edit: (text: string) => string): SceneFiles {
    const text = edit(new TextDecoder().decode(files.get("scene.toml")));
    return new Map(files).set("scene.toml", new TextEncoder().encode(text));
}
