import { PentError } from "../format/error.ts";

/** Where bytes come from: a server, files dropped on the page. Paths are relative, with slashes. */
export interface FileSource {
    /** What the page calls it: the name of the folder or file. */
    readonly title: string;
    /** Looks what is there; again each time. */
    list(): Promise<Listing>;
    has(path: string): Promise<boolean>;
    /** The bytes of a file. Rejects with a PentError that names it. */
    read(path: string): Promise<Uint8Array>;
}

/** What is in a run folder, or one mesh. */
export interface Listing {
    /** A single file; then there is nothing else. */
    mesh?: string;
    /** Names of meshes/NAME.pent. */
    meshes: string[];
    /** Numbers of frames/NAME_000123.pent, by name. */
    frames: Map<string, number[]>;
    /** Whether more frames may come. */
    isGrowing: boolean;
    /** In obstacles.json, or where they move in obstacles/000123.json of each frame; "unknown": one has to look. */
    obstacles: ObstacleFiles;
}

export const kObstacleFiles = ["none", "still", "moving", "unknown"] as const;
export type ObstacleFiles = (typeof kObstacleFiles)[number];

const kExpected =
    "expected a run folder of pent-sim, with meshes/ and frames/, or a .pent, .g4b or .g4tf file";

/** A file that is all there is to see, by its name. */
export const kSingleFile = /\.(pent|g4b|g4tf)$/i;

/** Whether it is a model of other programs, G4MF. */
export function isModel(path: string): boolean {
    return /\.(g4b|g4tf)$/i.test(path);
}

export function meshPath(body: string): string {
    return `meshes/${body}.pent`;
}

export function framePath(body: string, frame: number): string {
    return `frames/${body}_${String(frame).padStart(6, "0")}.pent`;
}

export const kStillObstacles = "obstacles.json";

export function movedObstaclesPath(frame: number): string {
    return `obstacles/${String(frame).padStart(6, "0")}.json`;
}

/** Sorts the paths of a dropped folder: the run is the shallowest folder that has meshes/.
 * Hidden files are temporary ones.
 *
 * @return  The listing, and what stands in front of its paths. */
export function listPaths(paths: string[]): { listing: Listing; prefix: string } {
    const isHidden = (path: string) => /(^|\/)\.[^/]*$/.test(path);
    const pent = paths.filter((path) => path.endsWith(".pent") && !isHidden(path));
    const roots = pent
        .map((path) => /^(.*\/)?meshes\/[^/]+$/.exec(path))
        .filter((match) => match !== null)
        .map((match) => match[1] ?? "")
        .sort((a, b) => a.split("/").length - b.split("/").length || (a < b ? -1 : 1));
    const listing: Listing = { meshes: [], frames: new Map(), isGrowing: false, obstacles: "none" };
    if (roots.length === 0) {
        const single = [...pent, ...paths.filter((path) => isModel(path) && !isHidden(path))];
        if (single.length !== 1) {
            const found =
                single.length === 0
                    ? "no .pent file"
                    : `${single.length} meshes but no folder meshes/`;
            const name = (paths[0] ?? "folder").replace(/[\r\n]/g, "?"); // a line, whatever it is
            throw new PentError(`${name}: found ${found}; ${kExpected}`);
        }
        listing.mesh = single[0]!;
        return { listing, prefix: "" };
    }
    const prefix = roots[0]!;
    const stems = (folder: string) =>
        pent
            .filter(
                (path) =>
                    path.startsWith(prefix + folder) &&
                    !path.slice(prefix.length + folder.length).includes("/"),
            )
            .map((path) => path.slice(prefix.length + folder.length, -".pent".length))
            .sort();
    listing.meshes = stems("meshes/");
    if (paths.includes(prefix + kStillObstacles)) {
        listing.obstacles = "still";
    } else if (paths.some((path) => path.startsWith(`${prefix}obstacles/`))) {
        listing.obstacles = "moving";
    }
    for (const stem of stems("frames/")) {
        const match = /^(.+)_(\d{6,})$/.exec(stem);
        if (match) {
            const numbers = listing.frames.get(match[1]!) ?? [];
            numbers.push(Number(match[2]));
            listing.frames.set(match[1]!, numbers);
        }
    }
    return { listing, prefix };
}

/** The frames that every body has, ascending. Throws a PentError where there is none. */
export function commonFrames(listing: Listing): number[] {
    if (listing.meshes.length === 0) {
        throw new PentError("meshes: no .pent mesh; expected one for every body");
    }
    let common: number[] | null = null;
    for (const body of listing.meshes) {
        const found = listing.frames.get(body);
        if (!found?.length) {
            throw new PentError(
                `${framePath(body, 0)}: no such frame nor a later one of this body; ` +
                    "did pent-sim run?",
            );
        }
        const numbers = new Set(found);
        common = common === null ? [...numbers] : common.filter((frame) => numbers.has(frame));
    }
    if (common!.length === 0) {
        throw new PentError("frames: no frame that all bodies have");
    }
    return common!.sort((a, b) => a - b);
}
