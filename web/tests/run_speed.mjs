// Measures steps of the playground beside native ones: npm run speed
import { spawnSync } from "node:child_process";
import { bundle } from "./bundle.mjs";

const files = await bundle("speed");
const { status } = spawnSync(
    process.execPath,
    ["--enable-source-maps", "--test", "--test-reporter=spec", ...files],
    {
        stdio: "inherit",
    },
);
process.exit(status ?? 1);
