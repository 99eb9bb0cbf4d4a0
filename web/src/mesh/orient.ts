import { determinant } from "../format/mesh.ts";
import { matchFacets } from "./facets.ts";

/** How tetrahedra meet at their triangles. */
interface Joints {
    isClosed: boolean; // each triangle has two
    neighbors: number[][]; // pairs: a tetrahedron, and 1 where it sees their triangle from the same side
}

function jointsOf(tetrahedra: Uint32Array, pointCount: number): Joints {
    const neighbors = Array.from({ length: tetrahedra.length / 4 }, (): number[] => []);
    let isClosed = true;
    const join = (a: number, b: number, disagree: 0 | 1) => {
        neighbors[a]!.push(b, disagree);
        neighbors[b]!.push(a, disagree);
    };
    matchFacets(tetrahedra, 4, pointCount, {
        onBoundary() {
            isClosed = false;
        },
        onInterior: (a, _apexA, b) => join(a, b, 0),
        onFault(cell, count, last) {
            isClosed &&= count === 2;
            join(cell, last, 1);
        },
    });
    return { isClosed, neighbors };
}

function turnOver(tetrahedra: Uint32Array, one: number): void {
    const corner = tetrahedra[4 * one + 2]!;
    tetrahedra[4 * one + 2] = tetrahedra[4 * one + 3]!;
    tetrahedra[4 * one + 3] = corner;
}

// The pieces of a surface, each as its tetrahedra, turned over so that neighbors agree; null where one has one side
// only.
function agreeing(tetrahedra: Uint32Array, neighbors: number[][]): number[][] | null {
    const isTurned = new Int8Array(neighbors.length).fill(-1); // -1: not reached
    const pieces: number[][] = [];
    for (let seed = 0; seed < neighbors.length; ++seed) {
        if (isTurned[seed]! >= 0) {
            continue;
        }
        const piece = [seed];
        isTurned[seed] = 0;
        for (let i = 0; i < piece.length; ++i) {
            const now = piece[i]!;
            const around = neighbors[now]!;
            for (let k = 0; k < around.length; k += 2) {
                const next = around[k]!;
                const expected = isTurned[now]! ^ around[k + 1]!;
                if (isTurned[next]! < 0) {
                    isTurned[next] = expected;
                    piece.push(next);
                } else if (isTurned[next] !== expected) {
                    return null;
                }
            }
        }
        pieces.push(piece);
    }
    isTurned.forEach((turned, one) => turned && turnOver(tetrahedra, one));
    return pieces;
}

/** Turns tetrahedra over until they face outward, as pent-convert does: where neighbors agree all of them or none, else
 * piece by piece, each of which is then taken for the outside of something. What is not closed, or has one side only,
 * stays as it is.
 *
 * @param points  Four numbers each. */
export function orientOutward(points: Float64Array, tetrahedra: Uint32Array): void {
    const { isClosed, neighbors } = jointsOf(tetrahedra, points.length / 4);
    if (!isClosed) {
        return;
    }
    const areTold = neighbors.every((around) => around.every((value, k) => k % 2 === 0 || !value));
    const all = Array.from(neighbors, (_, one) => one);
    for (const piece of areTold ? [all] : (agreeing(tetrahedra, neighbors) ?? [])) {
        const enclosed = piece.reduce((sum, one) => {
            const corners = [...tetrahedra.subarray(4 * one, 4 * one + 4)];
            const rows = corners.flatMap((v) => [...points.subarray(4 * v, 4 * v + 4)]);
            return sum + determinant(rows, 4);
        }, 0);
        if (enclosed < 0) {
            piece.forEach((one) => turnOver(tetrahedra, one));
        }
    }
}
