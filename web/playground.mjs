// Makes dist/playground.js, which the page loads when its playground is opened: the simulator, compressed, and the
// worker it runs in, as texts. A plain script, so that it comes from a server and from a file alike.
import { build } from "esbuild";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pack } from "./pack.mjs";
import { isBuilt, options, wasm, web } from "./playground_module.mjs";

const target = join(web, "dist/playground.js");
if (!isBuilt()) {
    rmSync(target, { force: true });
    console.log(
        "playground: the simulator for browsers is not built; the page has its viewer alone",
    );
    process.exit();
}
const { outputFiles } = await build({
    ...options,
    entryPoints: [join(web, "src/play/worker.ts")],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    platform: "browser",
    logLevel: "warning",
    write: false,
});
const module = readFileSync(wasm);
const parts = {
    worker: outputFiles[0].text,
    wasm: pack(module).toString("base64"),
    size: module.length,
};
writeFileSync(target, `window.pentimentoPlayground = ${JSON.stringify(parts)};\n`);
