import { PentError } from "../format/error.ts";
import { G4mfModel } from "../format/g4mf.ts";
import type { ModelFrame } from "../format/g4mf.ts";
import { G4mfDocument } from "../format/g4mf_document.ts";
import { readFrame, readMesh } from "../format/pent_file.ts";
import { indexBoundary, makeBoundary } from "../mesh/boundary.ts";
import type { Boundary } from "../mesh/boundary.ts";
import { lengths, makeRestCells, strains, toFloat4, vertexFields } from "../mesh/quantities.ts";
import type { RestCells } from "../mesh/quantities.ts";
import { orientOutward } from "../mesh/orient.ts";
import { namedFields } from "./quantities.ts";
import type { Quantities } from "./quantities.ts";

/** A body, ready for the graphics card. */
export interface Body {
    name: string;
    dimension: 3 | 4;
    vertexCount: number;
    cellCount: number; // 0 where its boundary is all that is known
    boundary: Boundary;
    fields: Quantities; // of its mesh
}

/** What a body is at one moment. */
export interface BodyFrame {
    positions: Float32Array; // four a vertex
    quantities: Quantities;
}

export interface DecodedMesh {
    body: Body;
    start: BodyFrame;
}

export interface DecodedFrame {
    time: number; // s
    frame: BodyFrame;
}

export interface DecodedModel {
    bodies: Body[];
    frames: ModelFrame[];
}

interface Kept {
    path: string;
    dimension: number;
    vertexCount: number;
    crc: number;
    rest: ReturnType<typeof readMesh>;
    restCells: RestCells | null; // made when strain is first asked for
}

/** Decodes the files of one run; keeps of each body what its frames are checked against. */
export class Decoder {
    private kept = new Map<string, Kept>();

    mesh(bytes: Uint8Array, name: string, path: string): DecodedMesh {
        const mesh = readMesh(bytes, path);
        if (mesh.dimension === 2) {
            throw new PentError(`${path}: has dimension 2; expected 3 or 4`);
        }
        const boundary = makeBoundary(mesh, path);
        this.kept.set(name, {
            path,
            dimension: mesh.dimension,
            vertexCount: mesh.vertexCount,
            crc: mesh.crc,
            rest: mesh,
            restCells: null,
        });
        const fields = namedFields(vertexFields(mesh, () => this.restCells(name)));
        return {
            body: {
                name,
                dimension: mesh.dimension,
                vertexCount: mesh.vertexCount,
                cellCount: mesh.cellCount,
                boundary,
                fields,
            },
            start: {
                positions: toFloat4(mesh.positions, mesh.dimension),
                quantities: new Map(),
            },
        };
    }

    frame(bytes: Uint8Array, name: string, path: string): DecodedFrame {
        const frame = readFrame(bytes, path);
        const mesh = this.kept.get(name)!;
        if (
            frame.meshCrc !== mesh.crc ||
            frame.vertexCount !== mesh.vertexCount ||
            frame.dimension !== mesh.dimension
        ) {
            throw new PentError(
                `${path}: belongs to another mesh than ${mesh.path}; expected both from one run`,
            );
        }
        const quantities = namedFields(frame.fields);
        const vectors = { speed: frame.velocities, force: frame.contactForces };
        for (const [quantity, values] of Object.entries(vectors)) {
            if (values) {
                quantities.set(quantity, lengths(values, frame.dimension));
            }
        }
        return {
            time: frame.time,
            frame: {
                positions: toFloat4(frame.positions, frame.dimension),
                quantities,
            },
        };
    }

    /** @param positions  Four floats a vertex. */
    strain(name: string, positions: Float32Array): Float32Array {
        return strains(this.restCells(name), positions);
    }

    private restCells(name: string): RestCells {
        const mesh = this.kept.get(name)!;
        mesh.restCells ??= makeRestCells(mesh.rest);
        return mesh.restCells;
    }
}

/** Decodes a G4MF file: boundaries of bodies, and blend shapes as frames. */
export class ModelDecoder {
    private document: G4mfDocument | null = null;
    private model: G4mfModel | null = null;

    /** @return  The files beside it that it has buffers in. */
    open(bytes: Uint8Array, path: string): string[] {
        this.document = new G4mfDocument(bytes, path);
        return this.document.uris();
    }

    bodies(beside: ReadonlyMap<string, Uint8Array>): DecodedModel {
        beside.forEach((bytes, uri) => this.document!.put(uri, bytes));
        this.model = new G4mfModel(this.document!);
        const bodies = this.model.bodies.map(({ name, points, tetrahedra }): Body => {
            orientOutward(points, tetrahedra);
            const vertexCount = points.length / 4;
            const boundary = indexBoundary(tetrahedra, 4, vertexCount);
            const fields: Quantities = new Map();
            return { name, dimension: 4, vertexCount, cellCount: 0, boundary, fields };
        });
        return { bodies, frames: this.model.frames };
    }

    frame(place: number): BodyFrame[] {
        const { model } = this;
        return model!.points(model!.frames[place]!).map((points) => ({
            positions: Float32Array.from(points),
            quantities: new Map(),
        }));
    }
}
