import { tileRect } from "../render/picture.ts";
import type { Picture } from "../render/picture.ts";
import { add, dot, normalized, scale, transform } from "./matrix.ts";
import type { Vector } from "./matrix.ts";
import type { Rotation } from "./rotation.ts";
import { apply } from "./rotation.ts";

type Four = [number, number, number, number];

/** A line of sight in the space of the slice that is pointed at. */
export interface Sight {
    eye: Vector;
    direction: Vector;
    w: number; // of the slice, after turning, m
}

/** Transposed: the inverse. */
function applyInverse(R: Rotation, p: ArrayLike<number>): Four {
    const column = (i: number) =>
        R[i]! * p[0]! + R[4 + i]! * p[1]! + R[8 + i]! * p[2]! + R[12 + i]! * p[3]!;
    return [column(0), column(1), column(2), column(3)];
}

/** Where a point of the bodies is seen, as x y z and w. */
export function toSeen(picture: Picture, p: ArrayLike<number>): Four {
    const turned = apply(picture.rotation, p);
    return turned.map((value, axis) => value + picture.shift[axis]!) as Four;
}

/** The point of the bodies that is seen at a place. */
export function fromSeen(picture: Picture, q: ArrayLike<number>): Four {
    return applyInverse(
        picture.rotation,
        picture.shift.map((value, axis) => q[axis]! - value),
    );
}

/** What is seen at a place of the picture.
 *
 * @param x, y  Parts of its width from the left and of its height from the top, 0 to 1. */
export function sightAt(picture: Picture, x: number, y: number): Sight {
    const { camera } = picture;
    const across = x * picture.width;
    const upright = (1 - y) * picture.height;
    const at = picture.tiles.findIndex((_, i) => {
        const [left, bottom, width, height] = tileRect(picture, i);
        return (
            across >= left &&
            across <= left + width &&
            upright >= bottom &&
            upright <= bottom + height
        );
    });
    const i = Math.max(at, 0);
    const [left, bottom, width, height] = tileRect(picture, i);
    const nx = (2 * (across - left)) / width - 1;
    const ny = (2 * (upright - bottom)) / height - 1;
    const aspect = width / height;
    const ahead = scale(camera.back, -1);
    const direction = add(
        add(ahead, camera.right, nx * camera.slope * aspect),
        camera.up,
        ny * camera.slope,
    );
    const solid = picture.tiles[i]!.slices.find(({ ghost }) => ghost === null);
    return { eye: camera.eye, direction: normalized(direction), w: solid?.w ?? 0 };
}

/** Where a line of sight meets the plane through a point that faces the camera; null behind the eye. */
export function onPlane(picture: Picture, sight: Sight, through: Vector): Vector | null {
    const { back } = picture.camera;
    const along = dot(sight.direction, back);
    const t = dot(add(through, sight.eye, -1), back) / along;
    return along < -1e-6 && t > 0 ? add(sight.eye, sight.direction, t) : null;
}

/** Where a point is seen in the first tile, in parts of its width from the left and of its height from the
 * top. */
export function project(picture: Picture, p: Vector): [number, number] {
    const [x, y, , w] = transform(picture.camera.viewProjection, p);
    return [(1 + x / w) / 2, (1 - y / w) / 2];
}
