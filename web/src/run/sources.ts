import { PentError } from "../format/error.ts";
import { kObstacleFiles, kSingleFile, listPaths } from "./listing.ts";
import type { FileSource, Listing, ObstacleFiles } from "./listing.ts";

/** Files that were dropped on the page or chosen in a dialog. */
export class LocalFiles implements FileSource {
    readonly title: string;
    private prefix = "";

    /** @param files  By path, as in "run/frames/octopus_000012.pent".
     *  @param title  Default: the name of the folder or file. */
    constructor(
        private files: Map<string, File>,
        title?: string,
    ) {
        const first = title ?? [...files.keys()][0] ?? "nothing";
        this.title = first.split("/")[0]!.replace(kSingleFile, "");
    }

    list(): Promise<Listing> {
        try {
            const { listing, prefix } = listPaths([...this.files.keys()]);
            this.prefix = prefix;
            return Promise.resolve(listing);
        } catch (error) {
            return Promise.reject(error as Error);
        }
    }

    has(path: string): Promise<boolean> {
        return Promise.resolve(this.files.has(this.prefix + path));
    }

    async read(path: string): Promise<Uint8Array> {
        const file = this.files.get(this.prefix + path);
        if (!file) {
            throw new PentError(`${this.prefix}${path}: no such file among those that were opened`);
        }
        return new Uint8Array(await readOrSay(path, file.arrayBuffer()));
    }
}

/** Rejects with a PentError where a browser cannot read a file: it is gone, or must not be read. */
export async function readOrSay<Value>(path: string, reading: Promise<Value>): Promise<Value> {
    try {
        return await reading;
    } catch (error) {
        throw new PentError(`${path}: cannot be read: ${(error as Error).message}`);
    }
}

function listMesh(mesh: string): Listing {
    return { mesh, meshes: [], frames: new Map(), isGrowing: false, obstacles: "none" };
}

// Ranges [first, last] of frame numbers, as pent-view lists them.
function toNumbers(ranges: unknown, where: string): number[] {
    const kMaxFrames = 1_000_000; // of frames; pent-sim writes fewer
    const numbers: number[] = [];
    for (const range of ranges as [number, number][]) {
        const [first, last] = range;
        if (
            !Number.isSafeInteger(first) ||
            !Number.isSafeInteger(last) ||
            first < 0 ||
            last < first ||
            numbers.length + last - first > kMaxFrames
        ) {
            throw new PentError(
                `${where}: found frames ${JSON.stringify(range).slice(0, 60)}; ` +
                    "expected [FIRST, LAST]",
            );
        }
        for (let frame = first; frame <= last; ++frame) {
            numbers.push(frame);
        }
    }
    return numbers;
}

function obstacleFiles(text: unknown): ObstacleFiles {
    return kObstacleFiles.find((one) => one === text) ?? "unknown";
}

// What either has, as long as it is what it seems.
interface Told {
    mesh?: unknown;
    meshes?: unknown[];
    frames?: object; // ranges by body, or a list of frames
    follow?: unknown;
    obstacles?: unknown;
    bodies?: { name: string }[];
    verdict?: unknown;
}

/** Understands run.json, what pent-view says of a run, or a report.json of pent-sim. */
export function parseListing(text: string, where: string): Listing {
    try {
        const json = JSON.parse(text) as Told;
        if (typeof json.mesh === "string") {
            return listMesh(json.mesh);
        }
        if (json.meshes) {
            const frames = new Map<string, number[]>();
            for (const [body, ranges] of Object.entries(json.frames ?? {})) {
                frames.set(body, toNumbers(ranges, where));
            }
            return {
                meshes: json.meshes.map(String),
                frames,
                isGrowing: json.follow === true,
                obstacles: obstacleFiles(json.obstacles),
            };
        }
        const bodies = json.bodies!.map((body) => body.name);
        const numbers = (json.frames as { frame: number }[]).map((frame) => frame.frame);
        return {
            meshes: bodies.sort(),
            frames: new Map(bodies.map((body) => [body, numbers])),
            isGrowing: json.verdict === "running",
            obstacles: "unknown",
        };
    } catch (error) {
        if (error instanceof PentError) {
            throw error;
        }
        throw new PentError(
            `${where}: cannot be understood; expected the list of a run, as ` +
                "pent-view or pent-sim writes it",
        );
    }
}

/** The last part of an address, as the file or folder is called. */
function nameIn(address: string): string {
    const part = address
        .replace(/[?#].*$/, "")
        .replace(/\/+$/, "")
        .split("/")
        .at(-1)!;
    try {
        return decodeURIComponent(part);
    } catch {
        return part; // a % that stands for itself, or bytes that are no text
    }
}

/** A run folder or a single file on a server. Without a server that lists it, a folder is known by
 * its report.json. */
export class WebFiles implements FileSource {
    readonly title: string;

    /** @param address  Of a folder or of a single file, relative to the page or absolute; encoded, as a part of an
     *                  address is. */
    constructor(private address: string) {
        this.title = nameIn(address).replace(kSingleFile, "") || "run";
    }

    async list(): Promise<Listing> {
        if (kSingleFile.test(this.address)) {
            return listMesh(nameIn(this.address));
        }
        for (const name of ["run.json", "report.json"]) {
            const response = await this.fetch(name);
            if (response.ok) {
                return parseListing(await response.text(), `${this.folder()}${name}`);
            }
        }
        throw new PentError(
            `${this.folder()}: neither run.json nor report.json is there; ` +
                "expected a run folder of pent-sim, or a .pent, .g4b or .g4tf file",
        );
    }

    async has(path: string): Promise<boolean> {
        return (await this.fetch(path)).ok;
    }

    async read(path: string): Promise<Uint8Array> {
        const response = await this.fetch(path);
        if (!response.ok) {
            throw new PentError(
                `${this.folder()}${path}: cannot be read: the server says ` +
                    `${response.status} ${response.statusText}`.trim(),
            );
        }
        return new Uint8Array(await response.arrayBuffer());
    }

    private folder(): string {
        return kSingleFile.test(this.address)
            ? this.address.replace(/[^/]*$/, "")
            : this.address.replace(/\/*$/, "/");
    }

    private async fetch(path: string): Promise<Response> {
        try {
            const address = this.folder() + path.split("/").map(encodeURIComponent).join("/");
            return await fetch(address, { cache: "no-cache" });
        } catch {
            throw new PentError(
                `${this.folder()}${path}: cannot be reached; is the server running? ` +
                    "A page opened from a file cannot load by address: drop the folder on it",
            );
        }
    }
}

/** All files of what was dropped, folders included. */
export async function droppedFiles(transfer: DataTransfer): Promise<Map<string, File>> {
    const files = new Map<string, File>();
    const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.() ?? null);
    if (entries.every((entry) => entry === null)) {
        for (const file of transfer.files) {
            files.set(file.name, file);
        }
        return files;
    }
    const visit = async (entry: FileSystemEntry, path: string): Promise<void> => {
        if (entry.isFile) {
            const reading = new Promise<File>((resolve, reject) =>
                (entry as FileSystemFileEntry).file(resolve, reject),
            );
            files.set(path, await readOrSay(path, reading));
            return;
        }
        const reader = (entry as FileSystemDirectoryEntry).createReader();
        for (;;) {
            // it gives some at a time
            const reading = new Promise<FileSystemEntry[]>((resolve, reject) =>
                reader.readEntries(resolve, reject),
            );
            const some = await readOrSay(path, reading);
            if (some.length === 0) {
                return;
            }
            for (const child of some) {
                await visit(child, `${path}/${child.name}`);
            }
        }
    };
    for (const entry of entries) {
        if (entry) {
            await visit(entry, entry.name);
        }
    }
    return files;
}

/** All files of an input element, those of a chosen folder with their paths in it. */
export function chosenFiles(list: FileList): Map<string, File> {
    return new Map([...list].map((file) => [file.webkitRelativePath || file.name, file]));
}
