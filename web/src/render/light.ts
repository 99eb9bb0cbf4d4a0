import {
    add,
    cross,
    multiply,
    normalized,
    orthographic,
    scale,
    viewMatrix,
} from "../view/matrix.ts";
import type { Matrix, Vector } from "../view/matrix.ts";
import type { Picture } from "./picture.ts";

/** The lights of a picture, and the shadow map of the first. */
export interface Light {
    toKey: Vector;
    toFill: Vector;
    viewProjection: Matrix; // of the shadow map
    toMap: Matrix; // the same, to 0..1 each way
    width: number; // m, of the map
    depth: number; // m
}

/** A key light over the left shoulder and a weak one from the right, which go with the camera. */
export function makeLight({ camera, center, radius, floor }: Picture): Light {
    const flat: Vector = [camera.back[0], 0, camera.back[2]];
    const back = Math.hypot(...flat) > 1e-6 ? normalized(flat) : camera.up;
    const mix = (right: number, up: number, toEye: number) =>
        normalized(add(add(scale(camera.right, right), [0, 1, 0], up), back, toEye));
    const toKey = mix(-0.65, 1, 0.55);
    const right = normalized(cross([0, 1, 0], toKey));
    const half = 1.05 * radius;
    // Deep enough for the floor under the bodies.
    const below = floor === null ? radius : (center[1] - floor + 2 * radius) / toKey[1] + radius;
    const view = viewMatrix(right, cross(toKey, right), toKey, center);
    const viewProjection = multiply(orthographic(half, -half, below), view);
    const toUnit = Float32Array.of(0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0.5, 0.5, 0.5, 1);
    return {
        toKey,
        toFill: mix(0.8, 0.1, 0.6),
        viewProjection,
        toMap: multiply(toUnit, viewProjection),
        width: 2 * half,
        depth: below + half,
    };
}
