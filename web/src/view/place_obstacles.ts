import { axesOf } from "../format/obstacles.ts";
import type { Obstacle } from "../format/obstacles.ts";
import type { Tile } from "../render/picture.ts";
import {
    ballOutline,
    ballSurface,
    groundOf,
    isAllSolid,
    isGroundBelow,
    sliceObstacle,
} from "./obstacles.ts";
import type { Box, GroundView, Round } from "./obstacles.ts";
import { apply } from "./rotation.ts";
import type { Rotation } from "./rotation.ts";

/** Puts what slices meet of obstacles into the tiles of a picture; boxes are cut by the renderer, as bodies are.
 *
 * @param view  `largest`: the radius of balls that are shown whole, as bodies are, m.
 * @param eye   Of the projection, if there is one.
 * @return      The lowest height of what is shown whole, m. */
export function placeObstacles(
    tiles: Tile[],
    obstacles: Obstacle[],
    { rotation, shift, is4 }: { rotation: Rotation; shift: readonly number[]; is4: boolean },
    view: GroundView & { largest: number },
    eye: [number, number, number, number] | null,
): number {
    let lowest = Infinity;
    for (const box of obstacles.filter((one): one is Box => one.kind === "box")) {
        const middle = apply(rotation, [...box.center, 0])[1] + shift[1]!;
        const half = axesOf(box).reduce((sum, axis, k) => {
            const rise = apply(rotation, [...axis, 0])[1] * box.sides[k]!;
            return sum + Math.abs(rise) / 2;
        }, 0);
        lowest = Math.min(lowest, middle - half);
    }
    const rounds = obstacles.filter((one): one is Round => one.kind !== "box");
    for (const tile of tiles) {
        for (const slice of tile.slices) {
            const section = { rotation, shift, w: is4 ? slice.w : null };
            for (const obstacle of rounds) {
                const met = sliceObstacle(obstacle, section);
                if (met.ball && met.ball.radius <= view.largest) {
                    slice.balls.push(ballSurface(met.ball));
                    lowest = Math.min(lowest, met.ball.center[1] - met.ball.radius);
                } else if (slice.ghost === null && !met.isEmpty) {
                    const { surfaces, rims } = groundOf(met, view);
                    tile.surfaces.push(...surfaces);
                    tile.rims.push(...rims);
                    tile.hasFloor &&= !isGroundBelow(met, view.center);
                    tile.isAllSolid ||= isAllSolid(met);
                }
                if (slice.ghost === null && eye && is4 && obstacle.kind === "ball") {
                    const outline = ballOutline(obstacle, section, eye);
                    tile.outlines.push(...(outline ? [outline] : []));
                }
            }
        }
    }
    return lowest;
}
