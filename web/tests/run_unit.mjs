// Runs the unit tests: npm test [-- ARGUMENTS FOR node --test]
import { spawnSync } from "node:child_process";
import { bundle } from "./bundle.mjs";

const files = await bundle("unit");
const options = [
    "--enable-source-maps",
    "--test",
    "--test-reporter=spec",
    ...process.argv.slice(2),
];
const { status } = spawnSync(process.execPath, [...options, ...files], { stdio: "inherit" });
process.exit(status ?? 1);
