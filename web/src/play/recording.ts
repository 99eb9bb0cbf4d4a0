import type { FileSystem } from "playground-module";
import { entries, makeEmpty } from "./folders.ts";
import type { Simulation } from "./library.ts";
import type { RunFiles } from "./protocol.ts";

const kFolder = "/run"; // of the module's file system
const kEvery = 1 / 30; // s between frames
const kMaxBytes = 400e6;

/** A run that is being recorded: the files that the library writes, taken out of the module's file system as soon as
 * they are there. */
export class Recording {
    readonly files: RunFiles = new Map();
    frames = 0;
    private bytes = 0;
    private next: number; // s, time of the next frame
    private isFull = false;

    constructor(
        private FS: FileSystem,
        simulation: Simulation,
    ) {
        makeEmpty(FS, kFolder);
        simulation.beginRun(kFolder);
        this.collect(kFolder);
        this.next = simulation.time;
        this.add(simulation);
    }

    /** Adds a frame if it is time for one; false where there is no more room, once. */
    add(simulation: Simulation): boolean {
        if (this.isFull || simulation.time < this.next - 1e-9) {
            return true;
        }
        this.next = Math.max(this.next + kEvery, simulation.time);
        simulation.addFrame(kFolder, this.frames++);
        this.collect(kFolder);
        this.isFull = this.bytes > kMaxBytes;
        return !this.isFull;
    }

    // Frames read their mesh's checksum from its file, which therefore stays.
    private collect(folder: string): void {
        for (const { path, isFolder } of entries(this.FS, folder)) {
            if (isFolder) {
                this.collect(path);
                continue;
            }
            const name = path.slice(kFolder.length + 1);
            if (!this.files.has(name)) {
                const bytes = this.FS.readFile(path);
                this.files.set(name, bytes);
                this.bytes += bytes.length;
            }
            if (!name.startsWith("meshes/")) {
                this.FS.unlink(path);
            }
        }
    }
}
