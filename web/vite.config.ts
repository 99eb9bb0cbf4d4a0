import { defineConfig } from "vite";
import type { Plugin } from "vite";

// Puts script and style into the page, so that it is one file: it opens by a double click, too, and
// pent-view can put a run into it. What a browser refuses in a page from a file (modules, fetch and
// workers by address) is not needed then.
function oneFile(): Plugin {
    return {
        name: "one-file",
        enforce: "post",
        generateBundle(_, bundle) {
            const page = bundle["index.html"];
            if (page?.type !== "asset") {
                throw new Error("one-file: there is no index.html");
            }
            let html = String(page.source);
            const put = (pattern: RegExp, text: string) => {
                if (!pattern.test(html)) {
                    throw new Error(`one-file: ${pattern} is not in index.html`);
                }
                html = html.replace(pattern, () => text);
            };
            for (const [name, part] of Object.entries(bundle)) {
                if (part.type === "chunk" && part.isEntry) {
                    put(/<script type="module"[^>]*src="[^"]*"[^>]*><\/script>\s*/, "");
                    const code = part.code.replaceAll("</script", "<\\/script");
                    put(/<\/body>/, `<script type="module">${code}</script>\n</body>`);
                    delete bundle[name];
                } else if (part.type === "asset" && name.endsWith(".css")) {
                    put(
                        /<link rel="stylesheet"[^>]*>\s*/,
                        `<style>${String(part.source)}</style>\n`,
                    );
                    delete bundle[name];
                }
            }
            // Where pent-view --export puts a run.
            put(/<\/body>/, "<!-- run -->\n</body>");
            page.source = html;
        },
    };
}

export default defineConfig({
    base: "./", // works from any folder of a host
    build: { target: "es2022", outDir: "dist", modulePreload: false, assetsInlineLimit: 1 << 20 },
    worker: { format: "iife" },
    plugins: [oneFile()],
});
