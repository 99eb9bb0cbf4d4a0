import type { Field } from "../format/fields.ts";
import type { Mesh } from "../format/mesh.ts";
import type { MeshFile } from "../format/pent_file.ts";

/** A number a vertex: floats, or doubles where these would leave the range of floats. */
export type Values = Float32Array | Float64Array;

/** As floats where these have the digits. */
export function narrowed(values: Float64Array): Values {
    const kLargest = 1e20; // so that quotients of two of them are in range, too
    let largest = 0;
    for (const value of values) {
        largest = Math.max(largest, Math.abs(value));
    }
    const isInRange = largest === 0 || (largest > 1 / kLargest && largest < kLargest);
    return isInRange ? Float32Array.from(values) : values;
}

/** Length of the vector of every vertex, for speeds and forces. */
export function lengths(vectors: Float64Array, dimension: number): Values {
    const result = new Float64Array(vectors.length / dimension);
    const kSmall = 1e-150; // below, squares lose digits
    for (let v = 0; v < result.length; ++v) {
        const at = v * dimension;
        let square = 0;
        for (let axis = 0; axis < dimension; ++axis) {
            square += vectors[at + axis]! ** 2;
        }
        const length = Math.sqrt(square);
        result[v] =
            length > kSmall && length < Infinity
                ? length
                : Math.hypot(...vectors.subarray(at, at + dimension));
    }
    return narrowed(result);
}

/** What every vertex is colored by, by the name of the quantity: a number as it is, vectors by their length. Where two
 * have one name it is the first. */
export function scalarsOf(fields: Field[]): Map<string, Values> {
    const scalars = new Map<string, Values>();
    for (const { name, size, values } of fields) {
        if (!scalars.has(name)) {
            scalars.set(name, size === 1 ? narrowed(values) : lengths(values, size));
        }
    }
    return scalars;
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

/** What strain and means need of the mesh at rest, made once: the inverse edge matrix and the volume
 * (times dimension!) of every cell. */
export interface RestCells {
    dimension: number;
    vertexCount: number;
    cells: Uint32Array;
    farthest: number; // of the coordinates, from zero
    inverses: Float32Array;
    volumes: Float64Array;
}

function farthestOf(coordinates: Float32Array | Float64Array): number {
    let farthest = 0;
    for (const value of coordinates) {
        farthest = Math.max(farthest, Math.abs(value));
    }
    return farthest;
}

export function makeRestCells(mesh: Mesh): RestCells {
    const n = mesh.dimension;
    const inverses = new Float32Array(n * n * mesh.cellCount);
    const volumes = new Float64Array(mesh.cellCount);
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
    const farthest = farthestOf(mesh.positions);
    const { vertexCount, cells } = mesh;
    return { dimension: n, vertexCount, cells, farthest, inverses, volumes };
}

/** Means at every vertex over its cells by their volume at rest; zero for a vertex of none.
 *
 * @param values  `size` numbers a cell. */
export function vertexMeans(rest: RestCells, values: Float64Array, size: number): Float64Array {
    const means = new Float64Array(size * rest.vertexCount);
    const weight = new Float64Array(rest.vertexCount);
    rest.volumes.forEach((volume, cell) => {
        for (let k = 0; k <= rest.dimension; ++k) {
            const vertex = rest.cells[cell * (rest.dimension + 1) + k]!;
            weight[vertex]! += volume;
            for (let i = 0; i < size; ++i) {
                means[size * vertex + i]! += volume * values[size * cell + i]!;
            }
        }
    });
    return means.map((sum, i) => (sum === 0 ? 0 : sum / weight[Math.floor(i / size)]!));
}

/** The quantities of a mesh at its vertices: its own, and those of cells under other names as means. */
export function vertexFields(mesh: MeshFile, rest: () => RestCells): Field[] {
    const ofCells = mesh.cellFields.map(({ name, size, values }) => ({
        name,
        size,
        values: vertexMeans(rest(), values, size),
    }));
    return [...mesh.vertexFields, ...ofCells];
}

// |F^T F - I| / 2 for F = Ds Dm^-1; zero where it is below what rounding makes of it.
function cellStrain(
    rest: RestCells,
    cell: number,
    positions: Float32Array,
    rounding: number,
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
    let inverse = 0;
    for (let i = n * n * cell; i < n * n * (cell + 1); ++i) {
        inverse += rest.inverses[i]! ** 2;
    }
    const strain = Math.sqrt(square) / 2;
    return strain > rounding * Math.sqrt(inverse) ? strain : 0;
}

/** |E| of every vertex, the Frobenius norm of the Green strain, averaged over its cells by their
 * volume at rest. Positions are floats, so that of a cell at rest it would be a little above zero.
 *
 * @param positions  Four floats a vertex. */
export function strains(rest: RestCells, positions: Float32Array): Float32Array {
    const kFloat = 2 ** -23; // a float differs from the next one by no more than that part of it
    const rounding = kFloat * Math.max(rest.farthest, farthestOf(positions));
    const F = new Float64Array(rest.dimension ** 2);
    const values = Float64Array.from(rest.volumes, (_, cell) =>
        cellStrain(rest, cell, positions, rounding, F),
    );
    return Float32Array.from(vertexMeans(rest, values, 1));
}
