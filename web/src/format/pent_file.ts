import { BodyReader } from "./body.ts";
import type { Column } from "./body.ts";
import { PentError } from "./error.ts";
import { checkFields, fieldColumns, fieldsOf } from "./fields.ts";
import type { Field } from "./fields.ts";
import { cellName, cellNamePlural, parseHeader } from "./header.ts";
import type { Dimension } from "./header.ts";
import type { PlyElement, PlyType } from "./ply.ts";

const kAxes = "xyzw";
const kVertexVectors = ["", "v", "f"]; // that are no fields
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

/** A mesh with the further quantities that its file has. */
export interface MeshFile extends Mesh {
    vertexFields: Field[];
    cellFields: Field[];
}

/** A moment of a mesh: positions, and velocities (m/s), contact forces (N) and further quantities of vertices if it
 * has them. */
export interface Frame {
    dimension: Dimension;
    vertexCount: number;
    positions: Float64Array;
    velocities: Float64Array | null;
    contactForces: Float64Array | null;
    fields: Field[];
    meshName: string;
    meshCrc: number;
    frame: number;
    step: number;
    time: number; // s
}

function hasProperty(element: PlyElement, name: string, type: PlyType, path: string): boolean {
    const property = element.properties.find((known) => known.name === name);
    if (property && property.type !== type) {
        throw new PentError(
            `${path}: header: property ${name} of element ${element.name} is ` +
                `${property.type}, expected ${type}`,
        );
    }
    return property !== undefined;
}

function vectorColumns(values: Float64Array, dimension: number, prefix: string): Column[] {
    return [...kAxes.slice(0, dimension)].map((axis, i) => ({
        name: prefix + axis,
        values,
        first: i,
        stride: dimension,
    }));
}

function shown(value: number): string {
    return Number.isNaN(value) ? "nan" : value < 0 ? "-inf" : "inf";
}

function checkFinite(
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

function validate(mesh: Mesh, fibers: Float64Array | null, path: string): void {
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

/** Reads and validates a mesh. Throws a PentError with the words of the C++ reader. */
export function readMesh(bytes: Uint8Array, path: string): MeshFile {
    const header = parseHeader(bytes, path);
    if (header.mesh) {
        throw new PentError(
            `${path}: header: this is a frame of the mesh ${header.mesh.name}, ` +
                "expected a mesh",
        );
    }
    const { dimension } = header;
    if (dimension < 4 && header.elements[2]?.name === "layer") {
        throw new PentError(
            `${path}: has base and layers of a body of dimension ${dimension + 1}, which this page ` +
                "does not extrude; expected the body, as pent-mesh writes it without --unextruded",
        );
    }
    const reader = new BodyReader(header, bytes, path);
    const [vertex, cell] = header.elements as [PlyElement, PlyElement];
    hasProperty(vertex, "column", "uint", path);
    hasProperty(vertex, "layer", "uint", path);
    hasProperty(cell, "region", "ushort", path);
    hasProperty(cell, "parent", "uint", path);
    const fibers = vectorOf(cell, dimension, "fiber_", "fiber", path);
    const corners = dimension + 1;
    const vertexFields = fieldsOf(vertex, dimension, kVertexVectors);
    const cellFields = fieldsOf(cell, dimension, ["fiber_"]);
    hasProperty(cell, "bisection_tag", "uchar", path);
    const mesh: MeshFile = {
        dimension,
        vertexCount: Number(vertex.count),
        cellCount: Number(cell.count),
        positions: new Float64Array(dimension * Number(vertex.count)),
        cells: new Uint32Array(corners * Number(cell.count)),
        crc: header.crc32c ?? 0,
        createdBy: header.createdBy,
        vertexFields,
        cellFields,
    };
    reader.read([
        ...vectorColumns(mesh.positions, dimension, ""),
        ...vertexFields.flatMap(fieldColumns),
    ]);
    reader.read([
        ...Array.from({ length: corners }, (_, k) => ({
            name: `v${k}`,
            values: mesh.cells,
            first: k,
            stride: corners,
        })),
        ...(fibers ? vectorColumns(fibers, dimension, "fiber_") : []),
        ...cellFields.flatMap(fieldColumns),
    ]);
    reader.finish();
    validate(mesh, fibers, path);
    checkFields(vertexFields, "vertex", path);
    checkFields(cellFields, cellName(dimension), path);
    return mesh;
}

// A vector has all its components or none.
function vectorOf(
    element: PlyElement,
    dimension: Dimension,
    prefix: string,
    what: string,
    path: string,
): Float64Array | null {
    const found = [...kAxes.slice(0, dimension)].filter((axis) =>
        hasProperty(element, prefix + axis, "double", path),
    ).length;
    if (found !== 0 && found !== dimension) {
        throw new PentError(
            `${path}: header: ${found} ${what} properties, ` +
                `expected none or all of ${dimension}`,
        );
    }
    return found ? new Float64Array(dimension * Number(element.count)) : null;
}

/** Reads and validates a frame. Throws a PentError with the words of the C++ reader. */
export function readFrame(bytes: Uint8Array, path: string): Frame {
    const header = parseHeader(bytes, path);
    if (!header.mesh) {
        throw new PentError(
            `${path}: header: no 'comment mesh NAME CRC', ` + "expected a frame (this is a mesh)",
        );
    }
    const reader = new BodyReader(header, bytes, path);
    const { dimension } = header;
    const vertexCount = Number(header.elements[0]!.count);
    const vertex = header.elements[0]!;
    const velocities = vectorOf(vertex, dimension, "v", "velocity", path);
    const contactForces = vectorOf(vertex, dimension, "f", "contact force", path);
    const fields = fieldsOf(vertex, dimension, kVertexVectors);
    const positions = new Float64Array(dimension * vertexCount);
    reader.read([
        ...vectorColumns(positions, dimension, ""),
        ...(velocities ? vectorColumns(velocities, dimension, "v") : []),
        ...(contactForces ? vectorColumns(contactForces, dimension, "f") : []),
        ...fields.flatMap(fieldColumns),
    ]);
    reader.finish();
    checkFinite(positions, dimension, "", path);
    checkFinite(velocities, dimension, "v", path);
    checkFinite(contactForces, dimension, "f", path);
    checkFields(fields, "vertex", path);
    return {
        dimension,
        vertexCount,
        positions,
        velocities,
        contactForces,
        fields,
        meshName: header.mesh.name,
        meshCrc: header.mesh.crc,
        frame: header.frame,
        step: header.step,
        time: header.time,
    };
}
