import { crc32c, hex8 } from "../../src/format/crc32c.ts";
import { bytesOf, join, rowsOf } from "../../src/format/write_pent.ts";

export { writeMesh } from "../../src/format/write_pent.ts";

/** The checksum that a file states. */
export function crcOf(file: Uint8Array): string {
    return /crc32c ([0-9a-f]{8})/.exec(Buffer.from(file).toString("latin1"))![1]!;
}

/** A binary frame of four dimensions, with velocities and, if given, contact forces and numbers of vertices by name. */
export function writeFrame(
    mesh: Uint8Array,
    frame: number,
    time: number,
    positions: number[],
    velocities: number[],
    forces: number[] = [],
    fields: Record<string, number[]> = {},
): Uint8Array {
    const columns = [positions, velocities, ...(forces.length > 0 ? [forces] : [])].map((values) =>
        rowsOf(values, 4),
    );
    const body = bytesOf(
        columns[0]!.map((_, v) => ({
            doubles: [
                ...columns.flatMap((column) => column[v]!),
                ...Object.values(fields).map((values) => values[v]!),
            ],
            whole: [],
        })),
    );
    const prefixes = ["", "v", "f"].slice(0, columns.length);
    return join(
        [
            "ply",
            "format binary_little_endian 1.0",
            "comment pent 1.0",
            "comment dimension 4",
            `comment mesh body.pent ${crcOf(mesh)}`,
            `comment frame ${frame}`,
            `comment step ${frame}`,
            `comment time ${time}`,
            `comment crc32c ${hex8(crc32c(body))}`,
            `element vertex ${positions.length / 4}`,
            ...prefixes.flatMap((prefix) =>
                [..."xyzw"].map((axis) => `property double ${prefix}${axis}`),
            ),
            ...Object.keys(fields).map((name) => `property double ${name}`),
            "end_header",
        ],
        body,
    );
}
