import { axesOf } from "../format/obstacles.ts";
import type { Moment } from "../run/run.ts";
import { apply } from "./rotation.ts";
import type { Rotation } from "./rotation.ts";

// Of a box from its center along an axis of space, m.
function halfExtent(
    box: { center: number[]; sides: number[]; axes?: number[][] },
    row: number,
): number {
    return axesOf(box).reduce((sum, axis, k) => sum + Math.abs(axis[row]! * box.sides[k]!) / 2, 0);
}

// How far from its middle bodies may be, in parts of the box: on the ground they lie at its lower end, and along w it is
// where the slider has it.
const kRoom = [0.25, 0.5, 0.25];

function meanOf(positions: Float32Array[]): number[] {
    const sum = [0, 0, 0, 0];
    let count = 0;
    for (const p of positions) {
        p.forEach((x, i) => {
            sum[i % 4]! += x;
        });
        count += p.length / 4;
    }
    return sum.map((x) => x / count);
}

/** Where the bodies are, over the frames looked at so far. */
export class Bounds {
    low = [Infinity, Infinity, Infinity, Infinity];
    high = [-Infinity, -Infinity, -Infinity, -Infinity];
    /** What bodies are turned about: the middle of the box, zero where it is nearly that. */
    pivot: [number, number, number, number] = [0, 0, 0, 0];
    /** Of a ball about the pivot that the bodies stay in however they are turned, m. */
    radius = 1;
    /** Balls and boxes of obstacles that are no larger are in the picture whole: the diagonal of the box. */
    size = 1;
    private home: Pick<Bounds, "low" | "high" | "pivot"> | null = null; // before follow() moved it
    /** The box at the start. */
    start: Bounds = this;

    get isEmpty(): boolean {
        return !(this.low[0]! <= this.high[0]!);
    }

    /** Takes more frames in. */
    add(moments: Moment[]): void {
        for (const body of moments.flatMap((moment) => moment.bodies)) {
            const p = body.positions;
            for (let v = 0; v < p.length; v += 4) {
                for (let axis = 0; axis < 4; ++axis) {
                    this.low[axis] = Math.min(this.low[axis]!, p[v + axis]!);
                    this.high[axis] = Math.max(this.high[axis]!, p[v + axis]!);
                }
            }
        }
    }

    /** The box of one moment alone. */
    static of(moment: Moment): Bounds {
        const bounds = new Bounds();
        bounds.add([moment]);
        return bounds;
    }

    /** Places the pivot in the middle and measures the ball about it. */
    settle(moments: Moment[]): void {
        this.start = Bounds.of(moments[0]!);
        this.size = Math.hypot(...this.low.map((low, axis) => this.high[axis]! - low)) || 1;
        const extent = this.size / 2;
        const digit = 10 ** (Math.floor(Math.log10(extent)) - 1);
        const middle = (axis: number) => {
            const value = (this.low[axis]! + this.high[axis]!) / 2;
            return Math.abs(value) < 0.1 * extent
                ? 0
                : Number((Math.round(value / digit) * digit).toPrecision(12));
        };
        this.pivot = [middle(0), middle(1), middle(2), middle(3)];
        let square = 0;
        for (const body of moments.flatMap((moment) => moment.bodies)) {
            const p = body.positions;
            for (let v = 0; v < p.length; v += 4) {
                square = Math.max(
                    square,
                    (p[v]! - this.pivot[0]) ** 2 +
                        (p[v + 1]! - this.pivot[1]) ** 2 +
                        (p[v + 2]! - this.pivot[2]) ** 2 +
                        (p[v + 3]! - this.pivot[3]) ** 2,
                );
            }
        }
        this.radius = Math.max(Math.sqrt(square) || 1, this.farthestObstacle(moments));
    }

    // Of those that the picture has whole, from the pivot.
    private farthestObstacle(moments: Moment[]): number {
        let farthest = 0;
        for (const obstacle of moments.flatMap((moment) => moment.obstacles)) {
            if (obstacle.kind !== "box" && obstacle.kind !== "ball") {
                continue;
            }
            const away = obstacle.center.map((x, axis) => Math.abs(x - this.pivot[axis]!));
            const [radius, reach] =
                obstacle.kind === "ball"
                    ? [obstacle.radius, Math.hypot(...away) + obstacle.radius]
                    : [
                          Math.hypot(...obstacle.sides) / 2,
                          Math.hypot(...away.map((x, axis) => x + halfExtent(obstacle, axis))),
                      ];
            farthest = radius <= this.size ? Math.max(farthest, reach) : farthest;
        }
        return farthest;
    }

    /** Moves the box along space as far as the bodies, in the mean of their vertices, have left the middle of it: what
     * crawls away stays in the picture. Comes back with them. */
    follow({ bodies }: Moment): void {
        const home = (this.home ??= { low: this.low, high: this.high, pivot: this.pivot });
        const mean = meanOf(bodies.map(({ positions }) => positions));
        const by = [0, 1, 2].map((axis) => {
            const middle = (home.low[axis]! + home.high[axis]!) / 2;
            const room = (home.high[axis]! - home.low[axis]!) * kRoom[axis]!;
            const away = mean[axis]! - middle;
            return Math.max(away - room, 0) + Math.min(away + room, 0);
        });
        const moved = (p: number[]) => p.map((x, axis) => x + (by[axis] ?? 0));
        this.low = moved(home.low);
        this.high = moved(home.high);
        this.pivot = moved(home.pivot) as [number, number, number, number];
    }

    /** Of a ball about the pivot with what is seen of the box itself before it is turned, m. */
    get boxRadius(): number {
        const { low, high, pivot } = this;
        return Math.hypot(
            ...[0, 1, 2].map((k) => Math.max(pivot[k]! - low[k]!, high[k]! - pivot[k]!)),
        );
    }

    /** Lowest and highest coordinate along an axis that is seen, as the box is turned. */
    reach(rotation: Rotation, axis: number): [number, number] {
        const center = this.low.map((low, k) => (low + this.high[k]!) / 2 - this.pivot[k]!);
        const middle = apply(rotation, center)[axis]! + this.pivot[axis]!;
        let half = 0;
        for (let k = 0; k < 4; ++k) {
            half += (Math.abs(rotation[4 * axis + k]!) * (this.high[k]! - this.low[k]!)) / 2;
        }
        return [middle - half, middle + half];
    }

    /** What is seen of p is R p + this: turned about the pivot. */
    shift(rotation: Rotation): [number, number, number, number] {
        const turned = apply(rotation, this.pivot);
        return [
            this.pivot[0] - turned[0],
            this.pivot[1] - turned[1],
            this.pivot[2] - turned[2],
            this.pivot[3] - turned[3],
        ];
    }
}

/** From where to where the bodies of a moment reach along w, as they are seen. */
export function reachAlongW(
    { bodies }: Moment,
    rotation: Rotation,
    shift: number,
): [number, number] {
    const [x, y, z, w] = rotation.subarray(12, 16) as unknown as [number, number, number, number];
    let low = Infinity;
    let high = -Infinity;
    for (const { positions: p } of bodies) {
        for (let v = 0; v < p.length; v += 4) {
            const place = x * p[v]! + y * p[v + 1]! + z * p[v + 2]! + w * p[v + 3]! + shift;
            low = Math.min(low, place);
            high = Math.max(high, place);
        }
    }
    return [low, high];
}
