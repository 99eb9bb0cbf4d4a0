import type { Obstacle } from "../format/obstacles.ts";
import { makeRestCells, strains } from "../mesh/quantities.ts";
import type { RestCells } from "../mesh/quantities.ts";
import type { Body } from "../run/decode.ts";
import type { Moment, Run } from "../run/run.ts";
import type { OpenedScene } from "./protocol.ts";

/** A simulation as a run of one frame, the start; later moments are presented to the viewer as they come. */
export class LiveRun implements Run {
    readonly dimension: 3 | 4;
    readonly bodies: Body[];
    readonly frames = [0];
    readonly isGrowing = false;
    readonly stage: Moment;
    private rests: RestCells[] | null = null; // made when strain is first asked for

    /** @param low, high  The box that the picture takes in beside the bodies; null: what is suitable. */
    constructor(
        readonly title: string,
        private scene: OpenedScene,
        box: { low: number[]; high: number[] } | null,
    ) {
        this.dimension = scene.dimension;
        this.bodies = scene.bodies;
        const { low, high } = box ?? roomFor(scene.moment);
        this.stage = corners(low, high);
    }

    load(): Promise<Moment> {
        return Promise.resolve(this.scene.moment);
    }

    addStrain(moment: Moment): Promise<void> {
        const rests = (this.rests ??= this.scene.rests.map((mesh) => makeRestCells(mesh)));
        moment.bodies.forEach(({ positions, quantities }, i) => {
            quantities.set("strain", strains(rests[i]!, positions));
        });
        return Promise.resolve();
    }

    refresh(): Promise<boolean> {
        return Promise.resolve(false);
    }

    close(): void {}
}

/** Room to move in: half as much again to all sides, and down to the floor. */
export function roomFor({ bodies, obstacles }: Pick<Moment, "bodies" | "obstacles">) {
    const low = [Infinity, Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity, -Infinity];
    for (const { positions } of bodies) {
        positions.forEach((value, i) => {
            low[i % 4] = Math.min(low[i % 4]!, value);
            high[i % 4] = Math.max(high[i % 4]!, value);
        });
    }
    const reach = Math.max(...high.map((value, axis) => value - low[axis]!));
    for (let axis = 0; axis < 4; ++axis) {
        const more = high[axis] === low[axis] ? 0 : 0.2 * reach;
        low[axis]! -= more;
        high[axis]! += more;
    }
    const floor = Math.max(...obstacles.map(floorOf));
    if (floor < high[1]! && floor > low[1]! - 3 * reach) {
        low[1] = floor;
    }
    return { low, high };
}

// The height of level ground.
function floorOf(obstacle: Obstacle): number {
    return obstacle.kind === "half_space" && obstacle.normal[1]! > 0.999
        ? obstacle.offset
        : -Infinity;
}

// All corners of a box, as one body.
function corners(low: number[], high: number[]): Moment {
    const positions = Float32Array.from({ length: 64 }, (_, i) =>
        (i >> 2) & (1 << i % 4) ? high[i % 4]! : low[i % 4]!,
    );
    const body = { positions, quantities: new Map() };
    return { frame: 0, time: 0, bodies: [body], obstacles: [] };
}
