import type { Segment } from "../render/picture.ts";
import type { Bounds } from "./bounds.ts";
import { mapColor } from "./colors.ts";
import type { Color } from "./colors.ts";
import type { Vector } from "./matrix.ts";
import { apply } from "./rotation.ts";
import type { Rotation } from "./rotation.ts";

type Point4 = [number, number, number, number];

/** How a point of the space that is seen comes to the film: straight along w, or from an eye. */
export type Film = (p: Point4) => Vector;

function mix(a: Point4, b: Point4, t: number): Vector {
    return [0, 1, 2].map((k) => (1 - t) * a[k]! + t * b[k]!) as Vector;
}

/** The box about all bodies, with corners in four dimensions: its 32 edges on the film, colored by
 * the side of the slice that they are on, and, stronger, the polyhedron in which the slice cuts it.
 */
export function tesseract(bounds: Bounds, rotation: Rotation, w: number, film: Film, ink: Color) {
    const shift = bounds.shift(rotation);
    const corners = Array.from({ length: 16 }, (_, i): Point4 => {
        const p = [0, 1, 2, 3].map((axis) => ((i >> axis) & 1 ? bounds.high : bounds.low)[axis]!);
        const seen = apply(rotation, p);
        return seen.map((value, k) => value + shift[k]!) as Point4;
    });
    const [low, high] = bounds.reach(rotation, 3);
    const segments: Segment[] = [];
    for (let i = 0; i < 16; ++i) {
        for (let axis = 0; axis < 4; ++axis) {
            if (!((i >> axis) & 1)) {
                const a = corners[i]!;
                const b = corners[i | (1 << axis)]!;
                const side = (a[3] + b[3]) / 2 - w;
                const color = mapColor("w", 0.5 + side / (high - low || 1));
                segments.push({ a: film(a), b: film(b), color, alpha: 0.45 });
            }
        }
    }
    for (const face of squares()) {
        const ends: Vector[] = [];
        face.forEach((corner, k) => {
            const a = corners[corner]!;
            const b = corners[face[(k + 1) % 4]!]!;
            if (a[3] < w !== b[3] < w) {
                ends.push(mix(a, b, (w - a[3]) / (b[3] - a[3])));
            }
        });
        for (let k = 0; k + 1 < ends.length; k += 2) {
            segments.push({ a: ends[k]!, b: ends[k + 1]!, color: ink, alpha: 0.75 });
        }
    }
    return segments;
}

// The 24 squares of a tesseract, corners around each.
function squares(): number[][] {
    const found: number[][] = [];
    for (let a = 0; a < 4; ++a) {
        for (let b = a + 1; b < 4; ++b) {
            for (let i = 0; i < 16; ++i) {
                if (!((i >> a) & 1) && !((i >> b) & 1)) {
                    found.push([i, i | (1 << a), i | (1 << a) | (1 << b), i | (1 << b)]);
                }
            }
        }
    }
    return found;
}
