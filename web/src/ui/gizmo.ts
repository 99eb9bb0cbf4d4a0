import type { Camera } from "../view/camera.ts";
import { dot } from "../view/matrix.ts";
import type { Vector } from "../view/matrix.ts";
import type { Rotation } from "../view/rotation.ts";
import { svg } from "./dom.ts";

/** The four axes of the bodies as they are seen, with names: x y z and w. What of an axis points
 * out of the slice cannot be seen; the ring at its end is the larger the more that is. */
export function drawGizmo(target: SVGSVGElement, rotation: Rotation, camera: Camera, axes: number) {
    const kLength = 34;
    const items = Array.from({ length: axes }, (_, axis) => {
        const seen: Vector = [rotation[axis]!, rotation[4 + axis]!, rotation[8 + axis]!];
        const out = rotation[12 + axis]!;
        return {
            name: "xyzw"[axis]!,
            out,
            depth: dot(seen, camera.back),
            x: 50 + kLength * dot(seen, camera.right),
            y: 50 - kLength * dot(seen, camera.up),
        };
    });
    items.sort((a, b) => a.depth - b.depth);
    const names: [number, number][] = [];
    target.replaceChildren(
        ...items.flatMap(({ name, out, x, y }) => {
            const far = Math.hypot(x - 50, y - 50);
            const way = (far + 9 + 6 * Math.abs(out)) / far;
            const place: [number, number] =
                far > 6 ? [50 + (x - 50) * way, 50 + (y - 50) * way] : [50 + 13, 50 - 11];
            while (
                names.some((other) => Math.hypot(place[0] - other[0], place[1] - other[1]) < 12)
            ) {
                place[1] -= 4;
            }
            names.push(place);
            return [
                svg("line", { x1: 50, y1: 50, x2: x, y2: y, class: `axis ${name}` }),
                svg("circle", { cx: x, cy: y, r: 2 + 7 * Math.abs(out), class: `ring ${name}` }),
                svg("text", { x: place[0], y: place[1] + 4, class: `name ${name}` }, name),
            ];
        }),
    );
}
