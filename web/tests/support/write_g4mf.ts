const kAxes = [0, 1, 2, 3];

// The corners of the 16-cell, +x -x +y -y and so on, and its 16 tetrahedra, outward as the format has it or not.
const kCorners = kAxes
    .flatMap((axis) => [1, -1].map((sign) => kAxes.map((k) => (k === axis ? sign : 0))))
    .flat();
const kTetrahedra = Array.from({ length: 16 }, (_, bits) => {
    const corners = kAxes.map((axis) => 2 * axis + ((bits >> axis) & 1));
    const isOdd = kAxes.reduce((sum, axis) => sum + ((bits >> axis) & 1), 0) % 2 === 1;
    return isOdd ? [corners[0]!, corners[1]!, corners[3]!, corners[2]!] : corners;
}).flat();

function bytesOf(array: ArrayBufferView): Uint8Array {
    return new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
}

/** A 16-cell with its buffers in two files beside it. */
export const kSixteenCell = {
    points: bytesOf(Float32Array.from(kCorners)),
    indices: bytesOf(Uint16Array.from(kTetrahedra)),
    json: {
        asset: { dimension: 4 },
        buffers: [
            { byteLength: 128, uri: "points.bin" },
            { byteLength: 128, uri: "indices.bin" },
        ],
        bufferViews: [
            { buffer: 0, byteLength: 128 },
            { buffer: 1, byteLength: 128 },
        ],
        accessors: [
            { bufferView: 0, primitiveType: "float32", vectorSize: 4 },
            { bufferView: 1, primitiveType: "uint16", vectorSize: 4 },
        ],
        meshes: [{ vertices: 0, surfaces: [{ cells: 1 }] }],
    },
};

/** A 16-cell as text, with blend shapes that move its first point by 1/4, 2/4 and so on along every axis. */
export function textModel({
    shapes = [],
    amounts,
    base = 1,
}: {
    shapes?: string[];
    amounts?: number[];
    base?: number; // how large
}): Uint8Array {
    const views: { byteLength: number; byteOffset: number; buffer: number }[] = [];
    const accessors: { bufferView: number; componentType: string; vectorSize: number }[] = [];
    let all: number[] = [];
    const add = (array: ArrayBufferView, componentType: string, vectorSize: number) => {
        const bytes = bytesOf(array);
        views.push({ buffer: 0, byteOffset: all.length, byteLength: bytes.length });
        accessors.push({ bufferView: views.length - 1, componentType, vectorSize });
        all = [...all, ...bytes];
        return accessors.length - 1;
    };
    const vertices = add(
        Float32Array.from(kCorners, (x) => base * x),
        "float32",
        4,
    );
    const simplexes = add(Uint32Array.from(kTetrahedra), "uint32", 4);
    const blend = {
        ...(amounts ? { amounts } : {}),
        shapes: shapes.map((name, i) => ({
            name,
            position: {
                indices: add(Uint8Array.of(0), "uint8", 1),
                offsets: add(
                    Float64Array.from(kAxes, () => (i + 1) / 4),
                    "float64",
                    4,
                ),
            },
        })),
    };
    const mesh = { vertices, surfaces: [{ simplexes }], ...(shapes.length > 0 ? { blend } : {}) };
    const uri = `data:application/octet-stream;base64,${Buffer.from(all).toString("base64")}`;
    return new TextEncoder().encode(
        JSON.stringify({
            asset: { dimension: 4 },
            buffers: [{ byteLength: all.length, uri }],
            bufferViews: views,
            accessors,
            meshes: [mesh],
            nodes: [{ children: [1] }, { name: "cell", meshInstance: { mesh: 0 } }],
        }),
    );
}
