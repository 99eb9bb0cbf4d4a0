import type { Camera } from "../view/camera.ts";
import type { Color } from "../view/colors.ts";
import type { Vector } from "../view/matrix.ts";
import type { Rotation } from "../view/rotation.ts";

/** One slice through all bodies, solid or as a ghost. */
export interface SliceView {
    w: number; // m, after turning
    ghost: Color | null; // its color where it is a ghost
}

/** One picture of the view: several stand side by side. */
export interface Tile {
    slices: SliceView[];
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
