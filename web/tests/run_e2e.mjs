// Runs the tests of the built page in Chromium: npm run e2e [-- ARGUMENTS FOR node --test]
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { bundle, web } from "./bundle.mjs";

if (!existsSync(join(web, "dist/index.html"))) {
    console.error("e2e: dist/index.html is not there; run scripts/web.sh first");
    process.exit(1);
}
const files = await bundle("e2e");
// Two at a time: a page waits for its own clock now and then.
const options = ["--enable-source-maps", "--test", "--test-concurrency=2", "--test-reporter=spec"];
const { status } = spawnSync(process.execPath, [...options, ...process.argv.slice(2), ...files], {
    stdio: "inherit",
});
process.exit(status ?? 1);
