import type { Mesh } from "../format/mesh.ts";
import { allOrders } from "../format/orders.ts";

export type Point = [number, number, number, number];
type Point3 = [number, number, number];

/** A box of cubes or tesseracts, each cut into simplices along its long diagonal, one for each order of the axes
 * [kuhn1960].
 *
 * @param counts  Of cubes along each axis.
 * @param shape   From the unit box [-1, 1]^n to the body. */
export function gridMesh<P extends Point | Point3>(counts: P, shape: (p: P) => number[]): Mesh {
    const dimension = counts.length;
    const sides = counts.map((count) => count + 1);
    const number = (at: number[]) => at.reduce((sum, k, axis) => sum * sides[axis]! + k, 0);
    const positions: number[] = [];
    const cells: number[] = [];
    const orders = allOrders(dimension);
    const visit = (at: number[], limit: readonly number[], action: (at: number[]) => void) => {
        if (at.length === dimension) {
            action(at);
            return;
        }
        for (let k = 0; k < limit[at.length]!; ++k) {
            visit([...at, k], limit, action);
        }
    };
    visit([], sides, (at) => {
        positions.push(...shape(at.map((k, axis) => (2 * k) / counts[axis]! - 1) as P));
    });
    visit([], counts, (at) => {
        for (const { order, isOdd } of orders) {
            const corner = [...at];
            const path = [number(corner)];
            for (const axis of order) {
                ++corner[axis]!;
                path.push(number(corner));
            }
            const [a, b] = path.splice(-2) as [number, number];
            cells.push(...path, ...(isOdd ? [b, a] : [a, b]));
        }
    });
    return {
        dimension: dimension as 3 | 4,
        vertexCount: positions.length / dimension,
        cellCount: cells.length / (dimension + 1),
        positions: Float64Array.from(positions),
        cells: Uint32Array.from(cells),
        crc: 0,
        createdBy: "",
    };
}
