import type { Mesh } from "../format/mesh.ts";
import { makeBoundary } from "../mesh/boundary.ts";
import { gridMesh } from "../mesh/grid.ts";
import type { Point } from "../mesh/grid.ts";
import { makeRestCells, strains, toFloat4 } from "../mesh/quantities.ts";
import type { RestCells } from "../mesh/quantities.ts";
import type { Body } from "./decode.ts";
import type { Moment, Run } from "./run.ts";

interface Example {
    title: string;
    cells: [number, number, number, number]; // of the grid, along x y z w
    /** From the unit tesseract [-1, 1]^4 to the body at rest. */
    shape(p: Point): Point;
    /** Where a point of the body is at a time in s. The motion is told, not simulated. */
    motion(p: Point, time: number): Point;
}

/** From the largest coordinate to the length: a cube becomes a ball. */
export function toBall(p: number[]): number[] {
    const largest = Math.max(...p.map(Math.abs));
    const length = Math.hypot(...p);
    return length > 0 ? p.map((value) => (value * largest) / length) : p;
}

function turned(p: Point, a: number, b: number, angle: number): Point {
    const result: Point = [...p];
    result[a] = p[a]! * Math.cos(angle) - p[b]! * Math.sin(angle);
    result[b] = p[a]! * Math.sin(angle) + p[b]! * Math.cos(angle);
    return result;
}

const kPeriod = 4; // s
const wave = (time: number) => (2 * Math.PI * time) / kPeriod;

/** Bodies that the page makes by itself, to have something to look at. */
export const kExamples: Record<string, Example> = {
    tesseract: {
        title: "Tesseract, turning in xw and yz at once",
        cells: [3, 3, 3, 3],
        shape: (p) => p,
        motion: (p, time) => turned(turned(p, 0, 3, wave(time) / 4), 1, 2, wave(time) / 4),
    },
    twist: {
        title: "Bar, twisted in the plane zw",
        cells: [18, 3, 3, 3],
        shape: (p) => [2 * p[0], 0.5 * p[1], 0.5 * p[2], 0.5 * p[3]],
        motion: (p, time) => turned(p, 2, 3, (0.5 * Math.PI * Math.sin(wave(time)) * p[0]) / 2),
    },
    ball: {
        title: "Ball that swells and shrinks",
        cells: [6, 6, 6, 6],
        shape: (p) => toBall(p) as Point,
        motion(p, time) {
            const s = 0.25 * Math.sin(wave(time));
            return [p[0] * (1 + s), p[1] / (1 + s), p[2] * (1 + s), p[3] / (1 + s)];
        },
    },
    duocylinder: {
        title: "Duocylinder: a disk times a disk",
        cells: [7, 7, 7, 7],
        shape([x, y, z, w]) {
            const [a, b] = toBall([x, z]);
            const [c, d] = toBall([y, w]);
            return [0.9 * a!, 0.7 * c!, 0.9 * b!, 0.7 * d!];
        },
        motion: (p, time) =>
            turned(p, 1, 3, wave(time) / 2).map((value, k) =>
                k === 0 ? value + 0.2 * Math.sin(wave(time) + 1.5 * p[1]) : value,
            ) as Point,
    },
};

/** An example as a run of one body. */
export class ExampleRun implements Run {
    readonly title: string;
    readonly dimension = 4;
    readonly bodies: Body[];
    readonly frames = Array.from({ length: 120 }, (_, i) => i);
    readonly isGrowing = false;
    private mesh: Mesh;
    private rest: RestCells;

    constructor(
        private example: Example,
        name: string,
    ) {
        this.title = example.title;
        this.mesh = gridMesh(example.cells, example.shape);
        this.rest = makeRestCells(this.mesh);
        const { vertexCount, cellCount } = this.mesh;
        this.bodies = [
            {
                name,
                dimension: 4,
                vertexCount,
                cellCount,
                boundary: makeBoundary(this.mesh, name),
                fields: new Map(),
            },
        ];
    }

    load(frame: number): Promise<Moment> {
        const time = frame / 30;
        const at = (t: number) => {
            const p = this.mesh.positions;
            const moved = new Float64Array(p.length);
            for (let v = 0; v < p.length; v += 4) {
                moved.set(this.example.motion([p[v]!, p[v + 1]!, p[v + 2]!, p[v + 3]!], t), v);
            }
            return moved;
        };
        const kStep = 1e-4; // s, for speeds by differences
        const now = at(time);
        const soon = at(time + kStep);
        const speed = new Float32Array(this.mesh.vertexCount);
        for (let v = 0; v < speed.length; ++v) {
            const away = [0, 1, 2, 3].map((k) => soon[4 * v + k]! - now[4 * v + k]!);
            speed[v] = Math.hypot(...away) / kStep;
        }
        const positions = toFloat4(now, 4);
        return Promise.resolve({
            frame,
            time,
            bodies: [{ positions, quantities: new Map([["speed", speed]]) }],
            obstacles: [],
        });
    }

    addStrain(moment: Moment): Promise<void> {
        const { positions, quantities } = moment.bodies[0]!;
        quantities.set("strain", strains(this.rest, positions));
        return Promise.resolve();
    }

    refresh(): Promise<boolean> {
        return Promise.resolve(false);
    }

    close(): void {}
}
