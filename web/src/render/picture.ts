import type { Camera } from "../view/camera.ts";
import type { Color } from "../view/colors.ts";
import type { Vector } from "../view/matrix.ts";
import type { Rotation } from "../view/rotation.ts";

/** A surface of revolution, which the renderer makes itself: of the arc of a circle, or of a straight line across the
 * axis. Its front is where the arc turns left or the axis points to. */
export interface Revolved {
    center: Vector;
    axes: [Vector, Vector, Vector]; // right-handed, the last one that of revolution; half axes of an arc, else units
    isArc: boolean;
    span: [number, number]; // from and to: angles from straight below, or distances from the center
    nearest: number; // of ground: distance of the whole of it from the center of the scene, m
}

/** One slice through all bodies, solid or as a ghost. */
export interface SliceView {
    w: number; // m, after turning
    ghost: Color | null; // its color where it is a ghost
    balls: Revolved[]; // drawn as bodies are
}

/** One picture of the view: several stand side by side. */
export interface Tile {
    slices: SliceView[];
    surfaces: Revolved[]; // ground: seen from its front alone, fading away around the scene
    rims: Revolved[]; // the same; what they hide of bodies shows through
    outlines: Revolved[]; // of balls, whole
    hasFloor: boolean;
    isAllSolid: boolean; // the solid slice lies within an obstacle
    away: [number, number] | null; // from where to where bodies are along w, if no slice meets any
    lines: Segment[]; // box and the like, in the space that is seen
}

export interface Segment {
    a: Vector;
    b: Vector;
    color: Color;
    alpha: number;
}

/** How bodies are colored. */
export interface Coloring {
    valueOf: "nothing" | "w" | "scalar";
    bodies: Color[]; // for "nothing"
    map: Color[]; // for the others, from the low end of the range to the high one
    range: [number, number];
}

/** All that the renderer is told of one picture. */
export interface Picture {
    width: number; // pixels, of all tiles together
    height: number;
    pixelRatio: number;
    columns: number; // of tiles
    tiles: Tile[];
    camera: Camera; // of each tile
    rotation: Rotation;
    shift: [number, number, number, number]; // what is seen of p is R p + shift
    center: Vector; // of the scene, as it is seen
    radius: number;
    floor: number | null; // its height y
    ground: number; // how far from the center it has faded, m
    obstacles: Color | null; // their color; null: not shown
    outline: { eye: [number, number, number, number]; color: Color } | null; // w: 0 orthographic
    coloring: Coloring;
    isSmooth: boolean;
    isShaded: boolean; // shadows and ambient occlusion
    background: { top: Color; bottom: Color; glow: Color };
    lineWidth: number;
}

/** Where tile i stands: x and y from the left and the bottom, width and height, pixels. */
export function tileRect(
    picture: Pick<Picture, "width" | "height" | "columns" | "tiles">,
    i: number,
) {
    const rows = Math.ceil(picture.tiles.length / picture.columns);
    const column = i % picture.columns;
    const row = Math.floor(i / picture.columns);
    const left = Math.floor((picture.width * column) / picture.columns);
    const right = Math.floor((picture.width * (column + 1)) / picture.columns);
    const top = Math.floor((picture.height * row) / rows);
    const bottom = Math.floor((picture.height * (row + 1)) / rows);
    return [left, picture.height - bottom, right - left, bottom - top] as const;
}
