import type { FileSystem } from "playground-module";

/** What is in a folder of the module's file system. */
export function entries(FS: FileSystem, folder: string): { path: string; isFolder: boolean }[] {
    return FS.readdir(folder)
        .filter((name) => name !== "." && name !== "..")
        .map((name) => `${folder}/${name}`)
        .map((path) => ({ path, isFolder: FS.isDir(FS.stat(path).mode) }));
}

/** Makes a folder with nothing in it. */
export function makeEmpty(FS: FileSystem, folder: string): void {
    FS.mkdirTree(folder);
    for (const { path, isFolder } of entries(FS, folder)) {
        if (isFolder) {
            makeEmpty(FS, path);
            FS.rmdir(path);
        } else {
            FS.unlink(path);
        }
    }
}

/** Writes a file into a folder that need not be there. */
export function write(FS: FileSystem, path: string, bytes: Uint8Array): void {
    FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    FS.writeFile(path, bytes);
}
