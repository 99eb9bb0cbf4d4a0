// Bundles tests in TypeScript for node, each into one file.
import { build } from "esbuild";
import { mkdirSync, readdirSync, rmSync } from "node:fs";
import { dirname, join } from "node:path";
import { options as playground, web } from "../playground_module.mjs";

export { web };
process.env.PENT_ROOT = dirname(web);

// In node there is no page to start a worker from; what needs one is tested in the browser.
const noWorkers = {
    name: "no-workers",
    setup(setup) {
        setup.onResolve({ filter: /\?worker&inline$/ }, ({ path }) => ({
            path,
            namespace: "none",
        }));
        setup.onLoad({ filter: /.*/, namespace: "none" }, () => ({
            contents: "export default class { postMessage() {} terminate() {} }",
        }));
    },
};

/** @returns {Promise<string[]>} The paths of the bundled tests of a folder under tests/. */
export async function bundle(folder) {
    const from = join(web, "tests", folder);
    const to = join(web, "build", folder);
    rmSync(to, { recursive: true, force: true });
    mkdirSync(to, { recursive: true });
    const tests = readdirSync(from).filter((name) => name.endsWith(".test.ts"));
    await build({
        entryPoints: tests.map((name) => join(from, name)),
        outdir: to,
        bundle: true,
        platform: "node",
        format: "esm",
        target: "node18",
        outExtension: { ".js": ".mjs" },
        packages: "external",
        loader: playground.loader,
        plugins: [noWorkers, ...playground.plugins],
        sourcemap: "inline",
        logLevel: "warning",
    });
    return tests.map((name) => join(to, name.replace(/\.ts$/, ".mjs")));
}
