import { determinant } from "../format/mesh.ts";
import type { Mesh } from "../format/mesh.ts";

/** Extrudes tetrahedra along w, as pent-mesh does: each prism over a tetrahedron is cut into four pentachora
 * along the staircase of its corners in the order of their numbers, so that neighbors agree.
 *
 * @param heights  w of the layers, increasing. */
export function extrude(base: Mesh, heights: readonly number[]): Mesh {
    const n = base.vertexCount;
    const positions = new Float64Array(4 * n * heights.length);
    heights.forEach((w, layer) => {
        for (let v = 0; v < n; ++v) {
            const at = 4 * (layer * n + v);
            positions.set(base.positions.subarray(3 * v, 3 * v + 3), at);
            positions[at + 3] = w;
        }
    });
    const cells: number[] = [];
    for (let layer = 0; layer + 1 < heights.length; ++layer) {
        for (let cell = 0; cell < base.cellCount; ++cell) {
            const corners = [...base.cells.subarray(4 * cell, 4 * cell + 4)].sort((a, b) => a - b);
            for (let step = 0; step < 4; ++step) {
                const low = corners.slice(0, step + 1).map((v) => layer * n + v);
                const high = corners.slice(step).map((v) => (layer + 1) * n + v);
                cells.push(...oriented(positions, [...low, ...high]));
            }
        }
    }
    return {
        dimension: 4,
        vertexCount: n * heights.length,
        cellCount: cells.length / 5,
        positions,
        cells: Uint32Array.from(cells),
        crc: 0,
        createdBy: "",
    };
}

function oriented(positions: Float64Array, cell: number[]): number[] {
    const edges = [1, 2, 3, 4].flatMap((k) =>
        [0, 1, 2, 3].map(
            (axis) => positions[4 * cell[k]! + axis]! - positions[4 * cell[0]! + axis]!,
        ),
    );
    const [a, b, c, d, e] = cell as [number, number, number, number, number];
    return determinant(edges, 4) > 0 ? cell : [a, b, c, e, d];
}
