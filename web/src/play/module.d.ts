/** What emscripten makes of web/wasm; see web/playground.mjs. */
declare module "playground-module" {
    export interface FileSystem {
        mkdirTree(path: string): void;
        writeFile(path: string, data: Uint8Array | string): void;
        readFile(path: string): Uint8Array;
        readdir(path: string): string[];
        unlink(path: string): void;
        rmdir(path: string): void;
        chdir(path: string): void;
        isDir(mode: number): boolean;
        stat(path: string): { mode: number };
    }
    export interface Module {
        FS: FileSystem;
        HEAPU8: Uint8Array; // another one when memory has grown
        UTF8ToString(address: number): string;
        [name: `_${string}`]: (...values: (number | bigint)[]) => number & bigint;
    }
    const make: (options: { wasmBinary: Uint8Array }) => Promise<Module>;
    export default make;
}

declare module "*.pent" {
    const bytes: Uint8Array;
    export default bytes;
}
