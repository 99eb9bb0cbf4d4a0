import { add, cross, multiply, normalized, perspective, scale, viewMatrix } from "./matrix.ts";
import type { Matrix, Vector } from "./matrix.ts";

/** Where the picture is taken from: about the target, in degrees. */
export interface Orbit {
    azimuth: number; // about y; 0 looks along -z
    elevation: number; // -89..89, up
    zoom: number; // 1: the whole scene fits
    panX: number; // of the target, in radii of the scene, to the right
    panY: number; // and up
}

export interface Camera {
    eye: Vector;
    target: Vector;
    right: Vector;
    up: Vector;
    back: Vector;
    near: number;
    far: number;
    slope: number; // tangent of half the angle upright
    view: Matrix;
    projection: Matrix;
    viewProjection: Matrix;
}

const kFieldOfView = 28; // degrees upright, as pent-render has it

/** The camera that sees a ball of this center and radius at zoom 1, with a little room around it. */
export function makeCamera(orbit: Orbit, center: Vector, radius: number, aspect: number): Camera {
    const azimuth = (orbit.azimuth * Math.PI) / 180;
    const elevation = (orbit.elevation * Math.PI) / 180;
    const back: Vector = [
        Math.sin(azimuth) * Math.cos(elevation),
        Math.sin(elevation),
        Math.cos(azimuth) * Math.cos(elevation),
    ];
    const right = normalized(cross([0, 1, 0], back));
    const up = cross(back, right);
    const half = (kFieldOfView * Math.PI) / 360;
    const slope = Math.tan(half);
    const across = Math.atan(slope * aspect);
    const fitting = 1.02 / Math.sin(Math.min(half, across));
    const distance = (fitting * radius) / orbit.zoom;
    const target = add(add(center, right, orbit.panX * radius), up, orbit.panY * radius);
    const eye = add(target, scale(back, distance));
    const reach = radius * (4 + Math.hypot(orbit.panX, orbit.panY));
    const near = Math.max(distance - reach, distance * 0.02);
    const far = distance + 3 * reach; // obstacles may be large
    const view = viewMatrix(right, up, back, eye);
    const projection = perspective(slope * aspect, slope, near, far);
    const viewProjection = multiply(projection, view);
    return { eye, target, right, up, back, near, far, slope, view, projection, viewProjection };
}
