import { BodyReader } from "./body.ts";
import { hasProperty, vectorColumns, vectorOf } from "./columns.ts";
import { PentError } from "./error.ts";
import { isExtrusion, readExtrusion } from "./extrusion.ts";
import { checkFields, fieldColumns, fieldsOf } from "./fields.ts";
import type { Field } from "./fields.ts";
import { cellName, parseHeader } from "./header.ts";
import type { Dimension } from "./header.ts";
import { checkFinite, validate } from "./mesh.ts";
import type { Mesh } from "./mesh.ts";
import type { PlyElement } from "./ply.ts";

const kVertexVectors = ["", "v", "f"]; // that are no fields

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

/** Reads and validates a mesh; base and layers become the body that they make. Throws a PentError with the words of the C++ reader. */
export function readMesh(bytes: Uint8Array, path: string): MeshFile {
    const header = parseHeader(bytes, path);
    if (header.mesh) {
        throw new PentError(
            `${path}: header: this is a frame of the mesh ${header.mesh.name}, ` +
                "expected a mesh",
        );
    }
    const { dimension } = header;
    const reader = new BodyReader(header, bytes, path);
    if (isExtrusion(header)) {
        return { ...readExtrusion(header, reader, path), vertexFields: [], cellFields: [] };
    }
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
