import type { Mesh } from "../format/mesh.ts";

/** A unit box about the origin: bit k of a vertex's number says on which side along axis k it is. Cut into simplices
 * along its diagonal, one for each order of the axes [kuhn1960]. */
export function boxMesh(dimension: 3 | 4): Mesh {
    const cells: number[] = [];
    const visit = (path: number[], rest: number[], isEven: boolean) => {
        if (rest.length === 0) {
            const [a, b] = path.slice(-2);
            cells.push(...path.slice(0, -2), ...(isEven ? [a!, b!] : [b!, a!]));
        }
        rest.forEach((axis, i) =>
            visit(
                [...path, path.at(-1)! | (1 << axis)],
                rest.filter((other) => other !== axis),
                isEven === (i % 2 === 0),
            ),
        );
    };
    visit([0], [0, 1, 2, 3].slice(0, dimension), true);
    const count = 1 << dimension;
    return {
        dimension,
        vertexCount: count,
        cellCount: cells.length / (dimension + 1),
        positions: Float64Array.from({ length: count * dimension }, (_, i) => {
            const vertex = Math.floor(i / dimension);
            return (vertex >> i % dimension) & 1 ? 0.5 : -0.5;
        }),
        cells: Uint32Array.from(cells),
        crc: 0,
        createdBy: "",
    };
}
