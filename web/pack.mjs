import { execFileSync } from "node:child_process";

/** What src/play/lzma.ts unpacks. */
export const pack = (bytes) =>
    execFileSync("xz", ["--format=raw", "--lzma1=preset=9e,lc=4,lp=0,pb=0", "--stdout"], {
        input: bytes,
        maxBuffer: 1 << 28,
    });
