import { PentError } from "./error.ts";
import { cellName, cellNamePlural } from "./header.ts";
import type { Dimension } from "./header.ts";

const kAxes = "xyzw";
const kDegenerate = 1e-14; // of the product of edge lengths: below, rounding may decide the sign

/** A mesh of simplices: positions of `dimension` numbers a vertex, cells of one corner more. */
export interface Mesh {
    dimension: Dimension;
    vertexCount: number;
    cellCount: number;
    positions: Float64Array; // m, axes in the order x y z w
    cells: Uint32Array;
    crc: number; // as the header states it; 0 where it states none
    createdBy: string;
}

function shown(value: number): string {
    return Number.isNaN(value) ? "nan" : value < 0 ? "-inf" : "inf";
}

/** @param prefix  Of the names of the axes: "v" of velocities. */
export function checkFinite(
    values: Float64Array | null,
    dimension: number,
    prefix: string,
    path: string,
    what = "vertex",
) {
    const bad = values?.findIndex((value) => !Number.isFinite(value)) ?? -1;
    if (values && bad >= 0) {
        throw new PentError(
            `${path}: ${what} ${Math.floor(bad / dimension)}: ` +
                `${prefix}${kAxes[bad % dimension]} is ${shown(values[bad]!)}, ` +
                "expected a finite number",
        );
    }
}

/** Determinant of a square matrix of 2 to 4 rows, stored one row after the other. */
export function determinant(m: ArrayLike<number>, size: number): number {
    if (size === 2) {
        return m[0]! * m[3]! - m[1]! * m[2]!;
    }
    if (size === 3) {
        return (
            m[0]! * (m[4]! * m[8]! - m[5]! * m[7]!) -
            m[1]! * (m[3]! * m[8]! - m[5]! * m[6]!) +
            m[2]! * (m[3]! * m[7]! - m[4]! * m[6]!)
        );
    }
    // By pairs of minors of the upper and the lower two rows.
    const minor = (row: number, i: number, j: number) =>
        m[4 * row + i]! * m[4 * row + 4 + j]! - m[4 * row + j]! * m[4 * row + 4 + i]!;
    return (
        minor(0, 0, 1) * minor(2, 2, 3) -
        minor(0, 0, 2) * minor(2, 1, 3) +
        minor(0, 0, 3) * minor(2, 1, 2) +
        minor(0, 1, 2) * minor(2, 0, 3) -
        minor(0, 1, 3) * minor(2, 0, 2) +
        minor(0, 2, 3) * minor(2, 0, 1)
    );
}

function validateIndices(mesh: Mesh, cell: number, where: () => string): void {
    const corners = mesh.dimension + 1;
    const at = cell * corners;
    for (let i = 0; i < corners; ++i) {
        const vertex = mesh.cells[at + i]!;
        if (vertex >= mesh.vertexCount) {
            throw new PentError(
                `${where()}vertex ${vertex} of ${mesh.vertexCount}, ` +
                    `expected at most ${mesh.vertexCount - 1}`,
            );
        }
        for (let j = 0; j < i; ++j) {
            if (mesh.cells[at + j] === vertex) {
                throw new PentError(
                    `${where()}vertex ${vertex} appears twice, ` +
                        `expected ${corners} different vertices`,
                );
            }
        }
    }
}

function validateOrientation(
    mesh: Mesh,
    cell: number,
    edges: Float64Array,
    where: () => string,
): void {
    const { dimension, positions, cells } = mesh;
    const at = cell * (dimension + 1);
    const first = cells[at]! * dimension;
    let scale = 0; // so that neither tiny nor huge bodies leave the range of double
    for (let k = 0; k < dimension; ++k) {
        const corner = cells[at + k + 1]! * dimension;
        for (let axis = 0; axis < dimension; ++axis) {
            const edge = positions[corner + axis]! - positions[first + axis]!;
            edges[k * dimension + axis] = edge;
            scale = Math.max(scale, Math.abs(edge));
        }
    }
    let bound = 1;
    for (let k = 0; k < dimension; ++k) {
        let square = 0;
        for (let axis = 0; axis < dimension; ++axis) {
            edges[k * dimension + axis]! /= scale > 0 ? scale : 1;
            square += edges[k * dimension + axis]! ** 2;
        }
        bound *= Math.sqrt(square);
    }
    const value = determinant(edges, dimension);
    if (value > kDegenerate * bound) {
        return;
    }
    throw new PentError(
        `${where()}` +
            (value < -kDegenerate * bound
                ? "inverted (its determinant is negative), expected positive orientation: " +
                  "swap two of its vertices"
                : "degenerate (flat to rounding error), expected a positive volume"),
    );
}

/** Holds a mesh to docs/pent-format.md, in its order. */
export function validate(mesh: Mesh, fibers: Float64Array | null, path: string): void {
    if (mesh.cellCount === 0) {
        throw new PentError(`${path}: no ${cellNamePlural(mesh.dimension)}, expected at least one`);
    }
    checkFinite(mesh.positions, mesh.dimension, "", path);
    checkFinite(fibers, mesh.dimension, "fiber_", path, cellName(mesh.dimension));
    const edges = new Float64Array(mesh.dimension ** 2);
    for (let cell = 0; cell < mesh.cellCount; ++cell) {
        const where = () => `${path}: ${cellName(mesh.dimension)} ${cell}: `;
        validateIndices(mesh, cell, where);
        validateOrientation(mesh, cell, edges, where);
    }
}
