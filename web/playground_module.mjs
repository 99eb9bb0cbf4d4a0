// Where the simulator for browsers is once scripts/web.sh has built it, and how bundles find it.
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const web = dirname(fileURLToPath(import.meta.url));
const folder = join(web, "../build/wasm/web/wasm");
export const glue = join(folder, "playground.js");
export const wasm = join(folder, "playground.wasm");

export const isBuilt = () => existsSync(glue) && existsSync(wasm);

/** For esbuild: the module's own JavaScript, and meshes as bytes. */
export const options = {
    loader: { ".pent": "binary" },
    plugins: [
        {
            name: "playground-module",
            setup(setup) {
                setup.onResolve({ filter: /^playground-module$/ }, () =>
                    isBuilt() ? { path: glue } : { path: "none", namespace: "no-playground" },
                );
                setup.onLoad({ filter: /.*/, namespace: "no-playground" }, () => ({
                    contents: "export default null",
                }));
            },
        },
    ],
};
