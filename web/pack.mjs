import { execFileSync } from "node:child_process";

/** What src/play/lzma.ts unpacks. Matches of 150 bytes are taken without a look for longer ones: of what packs so, the smallest. */
export const pack = (bytes) =>
    execFileSync("xz", ["--format=raw", "--lzma1=preset=9e,lc=4,lp=0,pb=0,nice=150", "--stdout"], {
        input: bytes,
        maxBuffer: 1 << 28,
    });
