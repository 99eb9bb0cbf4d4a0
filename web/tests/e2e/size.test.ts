import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { gzipSync } from "node:zlib";
import { test } from "node:test";
import { kPage } from "../support/browser.ts";

const kScript = join(dirname(kPage), "playground.js");
const skip = existsSync(kScript) ? false : "the simulator for browsers is not built";

test("page and simulator are small", { skip }, () => {
    const script = readFileSync(kScript, "utf8");
    const parts = JSON.parse(script.slice(script.indexOf("{"), script.lastIndexOf(";"))) as {
        worker: string;
        wasm: string;
    };
    const page = gzipSync(readFileSync(kPage)).length + gzipSync(parts.worker).length;
    assert.ok(page <= 400_000, `page and worker: ${page} bytes compressed`);
    const wasm = gzipSync(Buffer.from(parts.wasm, "base64")).length;
    assert.ok(wasm <= 600_000, `WebAssembly: ${wasm} bytes compressed`);
});
