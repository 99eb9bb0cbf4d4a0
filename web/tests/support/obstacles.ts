import type { Obstacle } from "../../src/format/obstacles.ts";
import type { Revolved } from "../../src/render/picture.ts";
import { add, scale } from "../../src/view/matrix.ts";
import type { Vector } from "../../src/view/matrix.ts";

/** The file of obstacles as pent-sim writes it. */
export function obstaclesFile(obstacles: readonly Obstacle[], dimension = 4): string {
    return JSON.stringify({ pent_obstacles: 1, dimension, obstacles });
}

/** The point of a surface of revolution at a part of its way and an angle around, as the shader has it. */
export function pointOf({ center, axes, isArc, span }: Revolved, part: number, turn: number) {
    const way = span[0] + part * (span[1] - span[0]);
    const [out, up] = isArc ? [Math.sin(way), -Math.cos(way)] : [way, 0];
    const [a, b, c] = axes.map((axis, i) =>
        scale(axis, [out * Math.cos(turn), out * Math.sin(turn), up][i]!),
    ) as [Vector, Vector, Vector];
    return add(add(add(center, a), b), c);
}
