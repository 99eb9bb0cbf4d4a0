import { PentError } from "../format/error.ts";
import { JsonEntry } from "../format/json_entry.ts";
import { readObstacles } from "../format/obstacles.ts";
import type { Obstacle } from "../format/obstacles.ts";
import { indexBoundary } from "../mesh/boundary.ts";
import type { Body, BodyFrame } from "./decode.ts";
import type { Moment, Run } from "./run.ts";

const kQuantities = ["speed", "strain", "force"] as const;
const kMaxVertices = 1 << 24; // what a graphics card takes
const kAgain = "export the page again";

/** What pent-view --export writes into a page beside the frames. */
interface Description {
    title: string;
    dimension: 3 | 4;
    low: number[]; // of all positions, m
    high: number[];
    maxima: Record<(typeof kQuantities)[number], number | null>;
    bodies: { name: string; vertices: number; cells: number; facets: number }[];
    frames: { frame: number; time: number }[];
    obstacles: Obstacle[][]; // of each frame, or once where none of them moves; none where there are none
}

function readDescription(text: string): Description {
    const json = JsonEntry.parse(text, "this page", `run of pent-view; ${kAgain}`);
    const version = json.at("version");
    if (version.value !== 1) {
        version.expected("1");
    }
    const dimension = json.at("dimension").whole() as 3 | 4;
    if (dimension !== 3 && dimension !== 4) {
        json.at("dimension").expected("3 or 4");
    }
    const ends = (key: string) => json.at(key).reals(dimension);
    const most = (key: string) => {
        const entry = json.at("maxima").at(key);
        return entry.value === null ? null : entry.real();
    };
    const bodies = json
        .at("bodies")
        .list()
        .map((body) => ({
            name: body.at("name").text(),
            vertices: body.at("vertices").whole(kMaxVertices),
            cells: body.at("cells").whole(),
            facets: body.at("facets").whole(),
        }));
    const frames = json
        .at("frames")
        .list()
        .map((frame) => ({ frame: frame.at("frame").whole(), time: frame.at("time").real() }));
    const isAscending = frames.every(({ frame }, i) => i === 0 || frame > frames[i - 1]!.frame);
    if (bodies.length === 0 || frames.length === 0 || !isAscending) {
        throw new PentError(
            `this page: its run has no body, no frame, or frames in disorder; ${kAgain}`,
        );
    }
    const files = json.has("obstacles") ? json.at("obstacles").list() : [];
    return {
        title: json.at("title").text(),
        dimension,
        low: ends("low"),
        high: ends("high"),
        maxima: { speed: most("speed"), strain: most("strain"), force: most("force") },
        bodies,
        frames,
        obstacles: files.map(({ value, where }) => readObstacles(value, where, dimension)),
    };
}

function bytesOf(id: string): Uint8Array {
    const text = document.getElementById(id)?.textContent;
    if (text === undefined || text === null) {
        throw new PentError(`this page: part ${id} of the run is missing; ${kAgain}`);
    }
    try {
        return Uint8Array.from(atob(text.trim()), (character) => character.charCodeAt(0));
    } catch {
        throw new PentError(`this page: part ${id} of the run is damaged; ${kAgain}`);
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

    private constructor(private description: Description) {
        const { bodies, dimension, frames, title } = description;
        this.title = title;
        this.dimension = dimension;
        this.frames = frames.map((frame) => frame.frame);
        const bytes = bytesOf("pent-facets");
        // What is no whole number is missed below.
        const corners = new Uint32Array(bytes.buffer, 0, bytes.length >> 2);
        let at = 0;
        this.bodies = bodies.map(({ name, vertices, cells, facets }) => {
            const part = corners.slice(at, (at += 4 * facets));
            if (part.length !== 4 * facets || part.some((vertex) => vertex >= vertices)) {
                throw new PentError(`this page: the surface of ${name} is damaged; ${kAgain}`);
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
        return new EmbeddedRun(readDescription(text));
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
        const { obstacles } = this.description;
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
                    `${expected}; ${kAgain}`,
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
