import type { Mesh } from "../format/pent_file.ts";

/** Length of the vector of every vertex, for speeds and forces. */
export function lengths(vectors: Float64Array, dimension: number): Float32Array {
    const result = new Float32Array(vectors.length / dimension);
    for (let v = 0; v < result.length; ++v) {
        let square = 0;
        for (let axis = 0; axis < dimension; ++axis) {
            square += vectors[v * dimension + axis]! ** 2;
        }
        result[v] = Math.sqrt(square);
    }
    return result;
}

/** Positions as the graphics card takes them: four floats a vertex, w = 0 in three dimensions. */
export function toFloat4(positions: Float64Array, dimension: number): Float32Array {
    const result = new Float32Array((4 * positions.length) / dimension);
    for (let v = 0, from = 0; from < positions.length; v += 4) {
        for (let axis = 0; axis < dimension; ++axis) {
            result[v + axis] = positions[from++]!;
        }
    }
    return result;
}

// Inverse of a matrix of 3 or 4 rows, by Gauss and Jordan with pivots; gives |det|.
function invert(matrix: Float64Array, inverse: Float64Array, n: number): number {
    let determinant = 1;
    inverse.fill(0);
    for (let i = 0; i < n; ++i) {
        inverse[i * n + i] = 1;
    }
    for (let column = 0; column < n; ++column) {
        let pivot = column;
        for (let row = column + 1; row < n; ++row) {
            if (Math.abs(matrix[row * n + column]!) > Math.abs(matrix[pivot * n + column]!)) {
                pivot = row;
            }
        }
        const value = matrix[pivot * n + column]!;
        determinant *= Math.abs(value);
        for (let k = 0; k < n; ++k) {
            for (const m of [matrix, inverse]) {
                const kept = m[column * n + k]!;
                m[column * n + k] = m[pivot * n + k]! / value;
                m[pivot * n + k] = pivot === column ? m[column * n + k]! : kept;
            }
        }
        for (let row = 0; row < n; ++row) {
            const factor = matrix[row * n + column]!;
            if (row !== column && factor !== 0) {
                for (let k = 0; k < n; ++k) {
                    matrix[row * n + k]! -= factor * matrix[column * n + k]!;
                    inverse[row * n + k]! -= factor * inverse[column * n + k]!;
                }
            }
        }
    }
    return determinant;
}

/** What strain needs of the mesh at rest, made once: the inverse edge matrix and the volume (times
 * dimension!) of every cell. */
export interface RestCells {
    dimension: number;
    cells: Uint32Array;
    inverses: Float32Array;
    volumes: Float32Array;
}

export function makeRestCells(mesh: Mesh): RestCells {
    const n = mesh.dimension;
    const inverses = new Float32Array(n * n * mesh.cellCount);
    const volumes = new Float32Array(mesh.cellCount);
    const edges = new Float64Array(n * n);
    const inverse = new Float64Array(n * n);
    for (let cell = 0; cell < mesh.cellCount; ++cell) {
        const first = mesh.cells[cell * (n + 1)]! * n;
        for (let k = 0; k < n; ++k) {
            const corner = mesh.cells[cell * (n + 1) + k + 1]! * n;
            for (let axis = 0; axis < n; ++axis) {
                edges[axis * n + k] =
                    mesh.positions[corner + axis]! - mesh.positions[first + axis]!;
            }
        }
        volumes[cell] = invert(edges, inverse, n);
        inverses.set(inverse, n * n * cell);
    }
    return { dimension: n, cells: mesh.cells, inverses, volumes };
}

// |F^T F - I| / 2 for F = Ds Dm^-1.
function cellStrain(
    rest: RestCells,
    cell: number,
    positions: Float32Array,
    F: Float64Array,
): number {
    const n = rest.dimension;
    const at = cell * (n + 1);
    const first = 4 * rest.cells[at]!;
    for (let row = 0; row < n; ++row) {
        for (let column = 0; column < n; ++column) {
            let sum = 0;
            for (let k = 0; k < n; ++k) {
                const edge =
                    positions[4 * rest.cells[at + k + 1]! + row]! - positions[first + row]!;
                sum += edge * rest.inverses[n * n * cell + n * k + column]!;
            }
            F[row * n + column] = sum;
        }
    }
    let square = 0;
    for (let i = 0; i < n; ++i) {
        for (let j = i; j < n; ++j) {
            let sum = i === j ? -1 : 0;
            for (let k = 0; k < n; ++k) {
                sum += F[k * n + i]! * F[k * n + j]!;
            }
            square += (i === j ? 1 : 2) * sum * sum;
        }
    }
    return Math.sqrt(square) / 2;
}

/** |E| of every vertex, the Frobenius norm of the Green strain, averaged over its cells by their
 * volume at rest.
 *
 * @param positions  Four floats a vertex. */
export function strains(rest: RestCells, positions: Float32Array): Float32Array {
    const sum = new Float32Array(positions.length / 4);
    const weight = new Float32Array(positions.length / 4);
    const F = new Float64Array(rest.dimension ** 2);
    for (let cell = 0; cell < rest.volumes.length; ++cell) {
        const volume = rest.volumes[cell]!;
        const strain = cellStrain(rest, cell, positions, F) * volume;
        for (let k = 0; k <= rest.dimension; ++k) {
            const vertex = rest.cells[cell * (rest.dimension + 1) + k]!;
            sum[vertex]! += strain;
            weight[vertex]! += volume;
        }
    }
    return sum.map((value, v) => (weight[v]! > 0 ? value / weight[v]! : 0));
}
