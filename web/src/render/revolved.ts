import type { Revolved } from "./picture.ts";
import { kArcSteps } from "./shaders.ts";

/** The points of what is turned about the axis, two numbers each: distance from it, and along it from the center. */
export function profileOf({ isArc, span: [from, to] }: Revolved): number[] {
    if (!isArc) {
        return [from, 0, to, 0];
    }
    return Array.from({ length: kArcSteps + 1 }, (_, i) => {
        const angle = i === kArcSteps ? to : from + ((to - from) * i) / kArcSteps;
        const isPole = angle <= 0 || angle >= Math.PI; // exactly, so that the surface is closed
        return [isPole ? 0 : Math.sin(angle), -Math.cos(angle)];
    }).flat();
}
