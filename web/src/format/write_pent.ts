import { crc32c, hex8 } from "./crc32c.ts";
import type { Mesh } from "./mesh.ts";

const kCells = { 2: "triangle", 3: "tetrahedron", 4: "pentachoron" } as const;

/** Numbers of one vertex or cell. */
export interface Row {
    doubles: number[];
    whole: number[];
}

/** The body of a binary file. */
export function bytesOf(rows: Row[]): Uint8Array {
    const size = rows.reduce((sum, row) => sum + 8 * row.doubles.length + 4 * row.whole.length, 0);
    const view = new DataView(new ArrayBuffer(size));
    let at = 0;
    for (const row of rows) {
        for (const value of row.doubles) {
            view.setFloat64(at, value, true);
            at += 8;
        }
        for (const value of row.whole) {
            view.setUint32(at, value, true);
            at += 4;
        }
    }
    return new Uint8Array(view.buffer);
}

/** A file of header and body, with the checksum of the header behind the comment at which that of the body
 * stands. */
export function join(header: string[], body: Uint8Array): Uint8Array {
    const encode = (lines: string[]) => new TextEncoder().encode(`${lines.join("\n")}\n`);
    const at = header.findIndex((line) => line.startsWith("comment crc32c ")) + 1;
    const sum = `comment header_crc32c ${hex8(crc32c(encode(header)))}`;
    const head = encode([...header.slice(0, at), sum, ...header.slice(at)]);
    const all = new Uint8Array(head.length + body.length);
    all.set(head);
    all.set(body, head.length);
    return all;
}

/** A row of `size` numbers for each vertex or cell. */
export function rowsOf(values: ArrayLike<number>, size: number): number[][] {
    return Array.from({ length: values.length / size }, (_, i) =>
        Array.from({ length: size }, (__, k) => values[i * size + k]!),
    );
}

/** A binary .pent mesh. */
export function writeMesh(mesh: Pick<Mesh, "dimension" | "positions" | "cells">): Uint8Array {
    const { dimension: n, positions, cells } = mesh;
    const body = bytesOf([
        ...rowsOf(positions, n).map((doubles) => ({ doubles, whole: [] })),
        ...rowsOf(cells, n + 1).map((whole) => ({ doubles: [], whole })),
    ]);
    return join(
        [
            "ply",
            "format binary_little_endian 1.0",
            "comment pent 1.0",
            `comment dimension ${n}`,
            `comment crc32c ${hex8(crc32c(body))}`,
            `element vertex ${positions.length / n}`,
            ...[..."xyzw"].slice(0, n).map((axis) => `property double ${axis}`),
            `element ${kCells[n]} ${cells.length / (n + 1)}`,
            ...Array.from({ length: n + 1 }, (_, k) => `property uint v${k}`),
            "end_header",
        ],
        body,
    );
}
