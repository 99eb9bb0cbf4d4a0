import { PentError } from "../format/error.ts";
import { JsonEntry } from "../format/json_entry.ts";
import { readObstacles } from "../format/obstacles.ts";
import type { Obstacle } from "../format/obstacles.ts";
import { indexBoundary } from "../mesh/boundary.ts";
import { narrowed } from "../mesh/quantities.ts";
import type { Body, BodyFrame } from "./decode.ts";
import type { Quantities } from "./quantities.ts";
import type { Moment, Run } from "./run.ts";

const kMaxVertices = 1 << 24; // what a graphics card takes
const kAgain = "export the page again";

/** What 8 bits of a quantity range over. */
interface Coded {
    name: string;
    low: number;
    high: number;
}

/** What pent-view --export writes into a page beside the frames. */
interface Description {
    title: string;
    dimension: 3 | 4;
    low: number[]; // of all positions, m
    high: number[];
    quantities: Coded[]; // of every frame
    fields: Coded[]; // of the meshes, once
    bodies: { name: string; vertices: number; cells: number; facets: number }[];
    frames: { frame: number; time: number }[];
    obstacles: Obstacle[][]; // of each frame, or once where none of them moves; none where there are none
}

function readDescription(text: string): Description {
    const json = JsonEntry.parse(text, "this page", `run of pent-view; ${kAgain}`);
    const version = json.at("version");
    if (version.value !== 2) {
        version.expected("2");
    }
    const dimension = json.at("dimension").whole() as 3 | 4;
    if (dimension !== 3 && dimension !== 4) {
        json.at("dimension").expected("3 or 4");
    }
    const ends = (key: string) => json.at(key).reals(dimension);
    const coded = (key: string) =>
        json
            .at(key)
            .list()
            .map((entry) => ({
                name: entry.at("name").text(),
                low: entry.at("low").real(),
                high: entry.at("high").real(),
            }));
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
        quantities: coded("quantities"),
        fields: coded("fields"),
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

function checkLength(bytes: Uint8Array, expected: number, what: string): void {
    if (bytes.length !== expected) {
        throw new PentError(
            `this page: ${what} has ${bytes.length} bytes, expected ${expected}; ${kAgain}`,
        );
    }
}

// One after the other, a byte a vertex.
function decoded(coded: Coded[], bytes: Uint8Array, vertexCount: number): Quantities {
    return new Map(
        coded.map(({ name, low, high }, i) => [
            name,
            narrowed(
                Float64Array.from(
                    bytes.subarray(i * vertexCount, (i + 1) * vertexCount),
                    (value) => (1 - value / 255) * low + (value / 255) * high,
                ),
            ),
        ]),
    );
}

/** A run that lies in the page itself: boundaries with fields of meshes in 8 bits, and frames of positions in 16 bits a
 * coordinate and quantities in 8. */
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
        const ofMeshes = description.fields;
        const values = ofMeshes.length > 0 ? bytesOf("pent-fields") : new Uint8Array();
        const all = bodies.reduce((sum, { vertices }) => sum + vertices, 0);
        checkLength(values, ofMeshes.length * all, "part pent-fields of the run");
        let at = 0;
        let atValue = 0;
        this.bodies = bodies.map(({ name, vertices, cells, facets }) => {
            const part = corners.slice(at, (at += 4 * facets));
            if (part.length !== 4 * facets || part.some((vertex) => vertex >= vertices)) {
                throw new PentError(`this page: the surface of ${name} is damaged; ${kAgain}`);
            }
            const boundary = indexBoundary(part, dimension, vertices);
            const size = ofMeshes.length * vertices;
            const own = values.subarray(atValue, (atValue += size));
            const fields = decoded(ofMeshes, own, vertices);
            return { name, dimension, vertexCount: vertices, cellCount: cells, boundary, fields };
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
        const vertices = this.bodies.reduce((sum, body) => sum + body.vertexCount, 0);
        const each = 2 * this.dimension + this.description.quantities.length;
        checkLength(bytes, vertices * each, `frame ${frame}`);
        let at = 0;
        const view = new DataView(bytes.buffer);
        const bodies = this.bodies.map(({ vertexCount }): BodyFrame => {
            const { low, high, quantities } = this.description;
            const positions = new Float32Array(4 * vertexCount);
            for (let v = 0; v < vertexCount; ++v) {
                for (let axis = 0; axis < this.dimension; ++axis, at += 2) {
                    const t = view.getUint16(at, true) / 65535;
                    positions[4 * v + axis] = low[axis]! + t * (high[axis]! - low[axis]!);
                }
            }
            const values = bytes.subarray(at, (at += quantities.length * vertexCount));
            return { positions, quantities: decoded(quantities, values, vertexCount) };
        });
        const { obstacles } = this.description;
        return {
            frame,
            time: this.description.frames[place]!.time,
            bodies,
            obstacles: obstacles[place] ?? obstacles[0] ?? [],
        };
    }

    refresh(): Promise<boolean> {
        return Promise.resolve(false);
    }

    close(): void {}
}
