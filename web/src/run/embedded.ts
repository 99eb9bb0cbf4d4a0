import { PentError } from "../format/error.ts";
import { readObstacles } from "../format/obstacles.ts";
import type { Obstacle } from "../format/obstacles.ts";
import { indexBoundary } from "../mesh/boundary.ts";
import type { Body, BodyFrame } from "./decode.ts";
import type { Moment, Run } from "./run.ts";

/** What pent-view --export writes into a page beside the frames. */
interface Description {
    version: number;
    title: string;
    dimension: 3 | 4;
    low: number[]; // of all positions, m
    high: number[];
    maxima: { speed: number | null; strain: number | null; force: number | null };
    bodies: { name: string; vertices: number; cells: number; facets: number }[];
    frames: { frame: number; time: number }[];
    obstacles?: unknown[]; // files of each frame, or one where none of them moves; none where there are none
}

const kQuantities = ["speed", "strain", "force"] as const;

function bytesOf(id: string): Uint8Array {
    const text = document.getElementById(id)?.textContent;
    if (text === undefined || text === null) {
        throw new PentError(`this page: part ${id} of the run is missing; export the page again`);
    }
    try {
        return Uint8Array.from(atob(text.trim()), (character) => character.charCodeAt(0));
    } catch {
        throw new PentError(`this page: part ${id} of the run is damaged; export the page again`);
    }
}

/** A run that lies in the page itself: boundaries, and frames of positions in 16 bits a coordinate
 * and quantities in 8. */
export class EmbeddedRun implements Run {
    readonly title: string;
    readonly dimension: 3 | 4;
    readonly bodies: Body[];
    readonly frames: number[];
    readonly isGrowing = false;
    private obstacles: Obstacle[][];

    private constructor(private description: Description) {
        const { bodies, dimension, frames, title } = description;
        this.title = title;
        this.dimension = dimension;
        this.frames = frames.map((frame) => frame.frame);
        this.obstacles = (description.obstacles ?? []).map((file) =>
            readObstacles(file, "this page: its list of obstacles", dimension),
        );
        const bytes = bytesOf("pent-facets");
        const corners = new Uint32Array(bytes.buffer);
        let at = 0;
        this.bodies = bodies.map(({ name, vertices, cells, facets }) => {
            const part = corners.slice(at, (at += 4 * facets));
            if (part.length !== 4 * facets || part.some((vertex) => vertex >= vertices)) {
                throw new PentError(
                    `this page: the surface of ${name} is damaged; export it again`,
                );
            }
            const boundary = indexBoundary(part, dimension, vertices);
            return { name, dimension, vertexCount: vertices, cellCount: cells, boundary };
        });
    }

    /** The run of this page, or null where it has none. */
    static find(): EmbeddedRun | null {
        const text = document.getElementById("pent-run")?.textContent;
        if (!text) {
            return null;
        }
        let description: Description;
        try {
            description = JSON.parse(text) as Description;
        } catch {
            throw new PentError("this page: its run cannot be understood; export it again");
        }
        if (description.version !== 1) {
            throw new PentError(
                `this page: its run has version ${description.version}, expected 1`,
            );
        }
        return new EmbeddedRun(description);
    }

    async load(frame: number): Promise<Moment> {
        const place = this.frames.indexOf(frame);
        const bytes = bytesOf(`pent-frame-${place}`);
        this.checkLength(bytes, frame);
        let at = 0;
        const view = new DataView(bytes.buffer);
        const bodies = this.bodies.map(({ vertexCount }): BodyFrame => {
            const { low, high, maxima } = this.description;
            const positions = new Float32Array(4 * vertexCount);
            for (let v = 0; v < vertexCount; ++v) {
                for (let axis = 0; axis < this.dimension; ++axis, at += 2) {
                    const t = view.getUint16(at, true) / 65535;
                    positions[4 * v + axis] = low[axis]! + t * (high[axis]! - low[axis]!);
                }
            }
            const made: BodyFrame = { positions, speed: null, force: null, strain: null };
            for (const key of kQuantities) {
                const most = maxima[key];
                if (most !== null) {
                    made[key] = Float32Array.from(
                        bytes.subarray(at, (at += vertexCount)),
                        (value) => (value / 255) * most,
                    );
                }
            }
            return made;
        });
        const { obstacles } = this;
        return {
            frame,
            time: this.description.frames[place]!.time,
            bodies,
            obstacles: obstacles[place] ?? obstacles[0] ?? [],
        };
    }

    private checkLength(bytes: Uint8Array, frame: number): void {
        const { maxima } = this.description;
        const quantities = kQuantities.filter((key) => maxima[key] !== null).length;
        const vertices = this.bodies.reduce((sum, body) => sum + body.vertexCount, 0);
        const expected = vertices * (2 * this.dimension + quantities);
        if (bytes.length !== expected) {
            throw new PentError(
                `this page: frame ${frame} has ${bytes.length} bytes, expected ` +
                    `${expected}; export the page again`,
            );
        }
    }

    addStrain(moment: Moment): Promise<boolean> {
        return Promise.resolve(moment.bodies.every((body) => body.strain !== null));
    }

    refresh(): Promise<boolean> {
        return Promise.resolve(false);
    }

    close(): void {}
}
