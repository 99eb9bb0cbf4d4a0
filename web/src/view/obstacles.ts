import type { Obstacle } from "../format/obstacles.ts";
import type { Revolved } from "../render/picture.ts";
import { add, cross, dot, normalized, scale } from "./matrix.ts";
import type { Vector } from "./matrix.ts";
import { apply } from "./rotation.ts";
import type { Rotation } from "./rotation.ts";

/** Where a slice is: what is seen of p is R p + shift, and of that what has this w. */
export interface Section {
    rotation: Rotation;
    shift: readonly number[];
    w: number | null; // null in three dimensions
}

interface Sphere {
    center: Vector;
    radius: number;
}

interface Plane {
    normal: Vector;
    offset: number;
}

/** What a slice meets of an obstacle, in closed form: solid below the plane but in the hollow, solid everywhere but in
 * a hollow alone, or a solid ball. With none of the three all of the slice is solid, or, where it is empty, nothing. */
export interface ObstacleSlice {
    isEmpty: boolean;
    plane: Plane | null;
    ball: Sphere | null;
    hollow: Sphere | null;
}

/** Boxes are cut as bodies are. */
export type Round = Exclude<Obstacle, { kind: "box" }>;
export type Box = Extract<Obstacle, { kind: "box" }>;

const kParallel = 1e-12;
const kNothing: ObstacleSlice = { isEmpty: false, plane: null, ball: null, hollow: null };

const first3 = (p: ArrayLike<number>): Vector => [p[0]!, p[1]!, p[2]!];
const padded = (p: readonly number[]) => [p[0]!, p[1]!, p[2]!, p[3] ?? 0];
const length = (a: Vector) => Math.sqrt(dot(a, a));
const turned = (p: readonly number[], { rotation }: Section) => apply(rotation, padded(p));

function seen(p: readonly number[], section: Section): number[] {
    return turned(p, section).map((value, axis) => value + section.shift[axis]!);
}

function cutPlane(normal: readonly number[], offset: number, section: Section): ObstacleSlice {
    const { shift, w } = section;
    const n = turned(normal, section);
    let left = offset + n[0] * shift[0]! + n[1] * shift[1]! + n[2] * shift[2]!;
    left += w === null ? 0 : n[3] * (shift[3]! - w);
    const size = length(first3(n));
    return size < kParallel
        ? { ...kNothing, isEmpty: !(left > 0) }
        : { ...kNothing, plane: { normal: scale(first3(n), 1 / size), offset: left / size } };
}

// A ball's part in the slice is a ball, of square radius r^2 - h^2 at the height h over its center, or nothing.
function cutBall(center: readonly number[], radius: number, section: Section): Sphere | null {
    const middle = seen(center, section);
    const height = section.w === null ? 0 : section.w - middle[3]!;
    const square = (radius - height) * (radius + height);
    return square > 0 ? { center: first3(middle), radius: Math.sqrt(square) } : null;
}

export function sliceObstacle(obstacle: Round, section: Section): ObstacleSlice {
    switch (obstacle.kind) {
        case "half_space":
            return cutPlane(obstacle.normal, obstacle.offset, section);
        case "ball": {
            const ball = cutBall(obstacle.center, obstacle.radius, section);
            return { ...kNothing, ball, isEmpty: ball === null };
        }
        case "cavity":
            return { ...kNothing, hollow: cutBall(obstacle.center, obstacle.radius, section) };
        case "bowl": {
            const { center, radius, up } = obstacle;
            const rim = up.reduce((sum, value, axis) => sum + value * center[axis]!, 0);
            const ground = cutPlane(up, rim, section);
            const hollow = cutBall(center, radius, section);
            const { plane } = ground;
            const isAbove =
                hollow && plane && dot(plane.normal, hollow.center) - plane.offset >= hollow.radius;
            return { ...ground, hollow: ground.isEmpty || isAbove ? null : hollow };
        }
    }
}

export function isAllSolid({ isEmpty, plane, ball, hollow }: ObstacleSlice): boolean {
    return !isEmpty && !plane && !ball && !hollow;
}

/** Whether it is under what is looked at, as ground or as a hollow around it. */
export function isGroundBelow(slice: ObstacleSlice, center: Vector): boolean {
    const { plane, ball, hollow } = slice;
    const up = ball ? normalized(add(center, ball.center, -1)) : plane?.normal;
    return up ? up[1] > 0.5 : hollow !== null || isAllSolid(slice);
}

function axesAlong(axis: Vector): [Vector, Vector, Vector] {
    const other: Vector = Math.abs(axis[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0];
    const across = normalized(cross(other, axis));
    return [across, cross(axis, across), axis];
}

const kUp = axesAlong([0, 1, 0]);

/** The whole surface of an ellipsoid with these half axes. */
function ellipsoid(center: Vector, axes: [Vector, Vector, Vector]): Revolved {
    return { center, axes, isArc: true, span: [Math.PI, 0], nearest: 0 };
}

function scaled(axes: [Vector, Vector, Vector], across: number, along: number) {
    const [a, b, c] = axes;
    return [scale(a, across), scale(b, across), scale(c, along)] as [Vector, Vector, Vector];
}

export function ballSurface({ center, radius }: Sphere): Revolved {
    return ellipsoid(center, scaled(kUp, radius, radius));
}

/** The outline of a whole ball on the film, an ellipsoid: what tangents from the eye touch is a sphere across the way
 * to it, and its image is the outline. Null where the eye is not above the ball.
 *
 * @param section  The film.
 * @param eye      x y z: the point of the film under it; w: its distance, 0 for infinitely far. */
export function ballOutline(
    { center, radius }: Extract<Obstacle, { kind: "ball" }>,
    section: Section,
    eye: readonly [number, number, number, number],
): Revolved | null {
    const [x, y, z, w] = seen(center, section) as [number, number, number, number];
    const distance = eye[3];
    if (distance === 0) {
        return ballSurface({ center: [x, y, z], radius });
    }
    const foot = first3(eye);
    const off = add([x, y, z], foot, -1);
    const height = distance - (w - section.w!); // of the eye over the ball
    if (!(height > radius)) {
        return null;
    }
    // With c = off and q on the film: (c . q + height distance)^2 = (|c|^2 + a) (|q|^2 + distance^2).
    const a = (height - radius) * (height + radius);
    const across = (distance * radius) / Math.sqrt(a);
    const along = across * Math.sqrt(1 + dot(off, off) / a);
    const axis: Vector = length(off) > 0 ? normalized(off) : [0, 1, 0];
    const middle = add(foot, off, (height * distance) / a);
    return ellipsoid(middle, scaled(axesAlong(axis), across, along));
}

/** How ground is shown: around the scene, fading away. */
export interface GroundView {
    center: Vector; // of the scene
    reach: number; // m; where it has faded
}

/** Ground in a slice: planes, walls of hollows, large balls. */
export interface Ground {
    surfaces: Revolved[];
    rims: Revolved[]; // around hollows, which may hide what is in them
}

function disc(plane: Plane, view: GroundView, nearest: number): Revolved {
    const { normal, offset } = plane;
    const center = add(view.center, normal, offset - dot(normal, view.center));
    return { center, axes: axesAlong(normal), isArc: false, span: [0, view.reach], nearest };
}

// The part of a sphere about where it is nearest to the scene, out to where it has faded: of a point of it at the angle
// f from there the square distance is the nearest one's and 2 r d (1 - cos f).
function cap({ center, radius }: Sphere, view: GroundView, isHollow: boolean): Revolved {
    const away = add(view.center, center, -1);
    const distance = length(away);
    const axes = distance > 0 ? axesAlong(normalized(away)) : kUp;
    const cosine = 1 - view.reach ** 2 / (2 * radius * Math.max(distance, 1e-30));
    const low = Math.PI - Math.acos(Math.max(cosine, -1));
    const span: [number, number] = isHollow ? [low, Math.PI] : [Math.PI, low];
    const nearest = Math.abs(radius - distance);
    return { center, axes: scaled(axes, radius, radius), isArc: true, span, nearest };
}

/** The ground that a slice of an obstacle is. */
export function groundOf(slice: ObstacleSlice, view: GroundView): Ground {
    const { plane, ball, hollow } = slice;
    const surfaces: Revolved[] = [];
    if (ball) {
        surfaces.push(cap(ball, view, false));
    }
    if (!plane) {
        return { surfaces: hollow ? [cap(hollow, view, true)] : surfaces, rims: [] };
    }
    let nearest = Math.abs(dot(plane.normal, view.center) - plane.offset);
    if (!hollow) {
        return { surfaces: [disc(plane, view, nearest)], rims: [] };
    }
    const { center, radius } = hollow;
    nearest = Math.min(nearest, Math.abs(radius - length(add(view.center, center, -1))));
    const height = plane.offset - dot(plane.normal, center); // of the rim over the center
    if (height >= radius) {
        // the hollow is buried
        return { surfaces: [disc(plane, view, nearest), cap(hollow, view, true)], rims: [] };
    }
    const axes = axesAlong(plane.normal);
    const wall: Revolved = {
        center,
        axes: scaled(axes, radius, radius),
        isArc: true,
        span: [0, Math.acos(Math.min(Math.max(-height / radius, -1), 1))],
        nearest,
    };
    const opening = Math.sqrt((radius - height) * (radius + height));
    const middle = add(center, plane.normal, height);
    const off = add(view.center, middle, -1);
    const beside = length(add(off, plane.normal, -dot(off, plane.normal)));
    const span: [number, number] = [opening, Math.max(opening, beside + view.reach)];
    return { surfaces: [wall], rims: [{ center: middle, axes, isArc: false, span, nearest }] };
}
