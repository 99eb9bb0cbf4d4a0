import { axesOf } from "../format/obstacles.ts";
import type { Obstacle } from "../format/obstacles.ts";
import { makeBoundary } from "../mesh/boundary.ts";
import { gridMesh } from "../mesh/grid.ts";
import { toFloat4 } from "../mesh/quantities.ts";
import type { Body, BodyFrame } from "../run/decode.ts";

/** Obstacles that are boxes as bodies, which the renderer slices as all others. */
export class Boxes {
    private body: Body | null = null; // the same for all boxes of a dimension

    /** Those among obstacles, where they are. */
    of(obstacles: Obstacle[], dimension: 3 | 4): { body: Body; frame: BodyFrame }[] {
        if (this.body?.dimension !== dimension) {
            this.body = null;
        }
        return obstacles.flatMap((obstacle) => {
            if (obstacle.kind !== "box") {
                return [];
            }
            const mesh = gridMesh(dimension === 3 ? [1, 1, 1] : [1, 1, 1, 1], (p) =>
                p.map((x) => x / 2),
            );
            this.body ??= {
                name: "box",
                dimension,
                vertexCount: mesh.vertexCount,
                cellCount: mesh.cellCount,
                boundary: makeBoundary(mesh, "box"),
                fields: new Map(),
            };
            const axes = axesOf(obstacle);
            const placed = mesh.positions.map((_, i) => {
                const row = i % dimension;
                return axes.reduce(
                    (sum, axis, k) =>
                        sum + axis[row]! * mesh.positions[i - row + k]! * obstacle.sides[k]!,
                    obstacle.center[row]!,
                );
            });
            const positions = toFloat4(placed, dimension);
            return [{ body: this.body, frame: { positions, quantities: new Map() } }];
        });
    }
}
