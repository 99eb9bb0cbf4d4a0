import { PentError } from "../format/error.ts";
import { readObstacles } from "../format/obstacles.ts";
import type { Obstacle } from "../format/obstacles.ts";
import type { Body, BodyFrame, DecodedFrame } from "./decode.ts";
import { DecodeClient } from "./decode_client.ts";
import {
    commonFrames,
    framePath,
    kStillObstacles,
    meshPath,
    movedObstaclesPath,
} from "./listing.ts";
import type { FileSource, Listing } from "./listing.ts";

/** All bodies at one moment. */
export interface Moment {
    frame: number;
    time: number; // s
    bodies: BodyFrame[];
    obstacles: Obstacle[];
}

/** What there is to look at: bodies, and their frames in time. At least one of each. */
export interface Run {
    readonly title: string;
    readonly dimension: 3 | 4;
    readonly bodies: Body[];
    /** Numbers of frames, ascending. */
    readonly frames: number[];
    /** Whether more frames may come; see refresh(). */
    readonly isGrowing: boolean;
    /** A moment that is never shown, and that the picture takes in as well: of a simulation, whose frames are not
     * known before. */
    readonly stage?: Moment;
    load(frame: number): Promise<Moment>;
    /** Fills the strain of a moment in; not there where this run cannot know it, or has it. */
    addStrain?(moment: Moment): Promise<void>;
    /** Looks for new frames; true if there are some. */
    refresh(): Promise<boolean>;
    close(): void;
}

export function bytesOf(moment: Moment): number {
    return moment.bodies
        .flatMap(({ positions, quantities }) => [positions, ...quantities.values()])
        .reduce((sum, values) => sum + values.byteLength, 0);
}

/** A run folder, or a single .pent mesh, read by a worker. */
export class PentRun implements Run {
    bodies: Body[] = [];
    frames: number[] = [0];
    dimension: 3 | 4 = 4;
    isGrowing = false;
    private decoder = new DecodeClient();
    private start: BodyFrame[] = [];
    private isMesh = false;
    private obstacles: Obstacle[] | null = []; // null where they move

    private constructor(private source: FileSource) {}

    get title(): string {
        return this.source.title;
    }

    /** Reads the meshes. Rejects with a PentError for what is not a run. */
    static async open(
        source: FileSource,
        listing: Listing,
        onProgress: (text: string) => void,
    ): Promise<PentRun> {
        const run = new PentRun(source);
        try {
            await run.readMeshes(listing, onProgress);
            await run.lookForObstacles(listing);
            return run;
        } catch (error) {
            run.close();
            throw error;
        }
    }

    async load(frame: number): Promise<Moment> {
        if (this.isMesh) {
            return { frame: 0, time: 0, bodies: this.start, obstacles: [] };
        }
        const obstacles = this.obstacles ?? (await this.loadObstacles(movedObstaclesPath(frame)));
        const decoded = await Promise.all(this.bodies.map((body) => this.loadBody(body, frame)));
        const bodies = decoded.map((one) => one.frame);
        return { frame, time: decoded[0]!.time, bodies, obstacles };
    }

    async addStrain(moment: Moment): Promise<void> {
        await Promise.all(
            this.bodies.map(async ({ name }, i) => {
                const { positions, quantities } = moment.bodies[i]!;
                quantities.set("strain", await this.decoder.strain(name, positions));
            }),
        );
    }

    async refresh(): Promise<boolean> {
        const listing = await this.source.list();
        const frames = commonFrames(listing);
        const hasMore = frames.length > this.frames.length;
        this.frames = frames;
        this.isGrowing = listing.isGrowing;
        return hasMore;
    }

    close(): void {
        this.decoder.close();
    }

    private async readMeshes(listing: Listing, onProgress: (text: string) => void): Promise<void> {
        this.isMesh = listing.mesh !== undefined;
        this.frames = this.isMesh ? [0] : commonFrames(listing);
        this.isGrowing = listing.isGrowing;
        const names = this.isMesh ? [this.title] : listing.meshes;
        for (const name of names) {
            const path = listing.mesh ?? meshPath(name);
            onProgress(`reading ${path}`);
            const { body, start } = await this.decoder.mesh(
                await this.source.read(path),
                name,
                path,
            );
            if (this.bodies.length > 0 && body.dimension !== this.dimension) {
                throw new PentError(
                    `${path}: has dimension ${body.dimension}; expected ` +
                        `${this.dimension} as the other bodies have`,
                );
            }
            this.dimension = body.dimension;
            this.bodies.push(body);
            this.start.push(start);
        }
    }

    private async lookForObstacles({ obstacles }: Listing): Promise<void> {
        const { source } = this;
        if (
            obstacles === "still" ||
            (obstacles === "unknown" && (await source.has(kStillObstacles)))
        ) {
            this.obstacles = await this.loadObstacles(kStillObstacles);
        } else if (
            obstacles === "moving" ||
            (obstacles === "unknown" && (await source.has(movedObstaclesPath(this.frames[0]!))))
        ) {
            this.obstacles = null;
        }
    }

    private async loadObstacles(path: string): Promise<Obstacle[]> {
        const text = new TextDecoder().decode(await this.source.read(path));
        return readObstacles(text, path, this.dimension);
    }

    private async loadBody(body: Body, frame: number): Promise<DecodedFrame> {
        const path = framePath(body.name, frame);
        return this.decoder.frame(await this.source.read(path), body.name, path);
    }
}
