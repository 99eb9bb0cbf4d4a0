import type { BodyReader, Column } from "./body.ts";
import { hasProperty, vectorColumns } from "./columns.ts";
import { PentError } from "./error.ts";
import { cellName, cellNamePlural } from "./header.ts";
import type { Dimension, Header } from "./header.ts";
import { determinant, validate } from "./mesh.ts";
import type { Mesh } from "./mesh.ts";
import { allOrders } from "./orders.ts";
import type { PlyElement, PlyType } from "./ply.ts";

// Base and layers of an extruded body (docs/pent-format.md): the mesh that <pent/extrusion.h> makes of them, vertex by
// vertex and cell by cell.

const kAxes = "xyzw";
const kMaxRows = 0xffffffff;
const kMaxBytes = 2e9; // of positions and cells

interface Layers {
    count: number;
    rows: number; // numbers of each layer: D times D - 1 of the matrix, row by row, then D of the offset
    values: Float64Array;
    hasFirstPoint: boolean;
    hasLastPoint: boolean;
    height: number; // of those that are no points
    alternate: boolean; // whether every second slab takes corners from the last to the first
}

/** Cells with their corners in the order in which the extrusion takes them. */
interface OrderedCells {
    corners: Uint32Array;
    isOdd: boolean[];
}

/** Whether a file has base and layers in place of a mesh. */
export function isExtrusion({ mesh, dimension, elements }: Header): boolean {
    return !mesh && dimension < 4 && elements[2]?.name === "layer";
}

/** Reads base and layers, and extrudes them. Throws a PentError with the words of the C++ reader. */
export function readExtrusion(header: Header, reader: BodyReader, path: string): Mesh {
    const base: Mesh = {
        dimension: header.dimension,
        vertexCount: Number(header.elements[0]!.count),
        cellCount: Number(header.elements[1]!.count),
        positions: new Float64Array(header.dimension * Number(header.elements[0]!.count)),
        cells: new Uint32Array((header.dimension + 1) * Number(header.elements[1]!.count)),
        crc: header.crc32c ?? 0,
        createdBy: header.createdBy,
    };
    const [, cellElement, layerElement] = header.elements as [PlyElement, PlyElement, PlyElement];
    hasProperty(cellElement, "region", "ushort", path);
    const corners = base.dimension + 1;
    const orders = new Uint32Array(base.cellCount);
    require(cellElement, [["order", "uchar"]], path);
    const layerNames = namesOfLayer(base.dimension);
    const kDouble = layerNames.map((name): [string, PlyType] => [name, "double"]);
    require(layerElement, [...kDouble, ["reversed", "uchar"]], path);
    const count = Number(layerElement.count);
    const rows = layerNames.length;
    const values = new Float64Array(rows * count);
    const reversed = new Uint32Array(count);
    reader.read(vectorColumns(base.positions, base.dimension, ""));
    reader.read([
        ...Array.from({ length: corners }, (_, k) => ({
            name: `v${k}`,
            values: base.cells,
            first: k,
            stride: corners,
        })),
        { name: "order", values: orders, first: 0, stride: 1 },
    ]);
    reader.read([
        ...layerNames.map((name, first): Column => ({ name, values, first, stride: rows })),
        { name: "reversed", values: reversed, first: 0, stride: 1 },
    ]);
    reader.finish();
    validate(base, null, path);
    const ordered = orderCorners(base, orders, path);
    const layers = checkedLayers({ values, rows, count }, path);
    checkEdges(ordered, corners, path);
    checkReversed(layers, reversed, path);
    const mesh = extrude(base, ordered, layers, path);
    validate(mesh, null, path);
    return mesh;
}

// Of the matrix xx xy xz, yx and so on; then of the offset.
function namesOfLayer(base: Dimension): string[] {
    const to = [...kAxes.slice(0, base + 1)];
    const from = [...kAxes.slice(0, base)];
    return [...to.flatMap((row) => from.map((column) => row + column)), ...to];
}

function require(element: PlyElement, columns: [string, PlyType][], path: string): void {
    for (const [name, type] of columns) {
        if (!hasProperty(element, name, type, path)) {
            throw new PentError(
                `${path}: header: element ${element.name} has no ${name}, which an extrusion needs`,
            );
        }
    }
}

function orderCorners(base: Mesh, codes: Uint32Array, path: string): OrderedCells {
    const size = base.dimension + 1;
    const orders = allOrders(size);
    const corners = new Uint32Array(base.cells.length);
    codes.forEach((code, cell) => {
        const chosen = orders[code];
        if (!chosen) {
            throw new PentError(
                `${path}: ${cellName(base.dimension)} ${cell}: order is ${code}, ` +
                    `expected at most ${orders.length - 1}`,
            );
        }
        chosen.order.forEach((corner, k) => {
            corners[size * cell + k] = base.cells[size * cell + corner]!;
        });
    });
    return { corners, isOdd: Array.from(codes, (code) => orders[code]!.isOdd) };
}

function checkedLayers(
    { values, rows, count }: Pick<Layers, "values" | "rows" | "count">,
    path: string,
): Layers {
    if (count < 2) {
        throw new PentError(`${path}: ${count} layers, expected two or more`);
    }
    const fail = (layer: number, what: string): never => {
        throw new PentError(`${path}: layer ${layer}: ${what}`);
    };
    const dimension = dimensionOf(rows);
    const isPoint = (layer: number) =>
        values
            .subarray(rows * layer, rows * (layer + 1) - dimension)
            .every((product) => product === 0);
    for (let layer = 0; layer < count; ++layer) {
        const row = values.subarray(rows * layer, rows * (layer + 1));
        if (!row.every((value) => Number.isFinite(value))) {
            fail(layer, "has a number that is not finite");
        }
        if (isPoint(layer) && layer > 0 && layer + 1 < count) {
            fail(layer, "is a point, which only the first and the last may be");
        }
    }
    const [hasFirstPoint, hasLastPoint] = [isPoint(0), isPoint(count - 1)];
    const height = count - Number(hasFirstPoint) - Number(hasLastPoint);
    if (height === 0) {
        fail(1, "is a point as the only other one is");
    }
    return { count, rows, values, hasFirstPoint, hasLastPoint, height, alternate: false };
}

// D (D - 1) + D numbers make a layer.
function dimensionOf(rows: number): Dimension {
    return Math.sqrt(rows) as Dimension;
}

// Prisms of neighbors are cut alike where each edge goes one way.
function checkEdges({ corners }: OrderedCells, size: number, path: string): void {
    const kHalf = 2 ** 26; // more base vertices than a file of a page has
    const up: number[] = [];
    const down: number[] = [];
    for (let at = 0; at < corners.length; at += size) {
        for (let i = 0; i < size; ++i) {
            for (let j = i + 1; j < size; ++j) {
                const [from, to] = [corners[at + i]!, corners[at + j]!];
                (from < to ? up : down).push(Math.min(from, to) * kHalf + Math.max(from, to));
            }
        }
    }
    const back = Float64Array.from(down).sort();
    let k = 0;
    const first = Float64Array.from(up)
        .sort()
        .find((edge) => {
            while (back[k]! < edge) {
                ++k;
            }
            return back[k] === edge;
        });
    if (first !== undefined) {
        throw new PentError(
            `${path}: the edge of vertices ${Math.floor(first / kHalf)} and ${first % kHalf} ` +
                "goes one way in one cell and back in another; expected orders in which neighbors agree",
        );
    }
}

function checkReversed(layers: Layers, reversed: Uint32Array, path: string): void {
    layers.alternate = reversed.some((one) => one !== 0);
    // The first layer that has vertices has a slab above it that is not reversed.
    const first = layers.hasFirstPoint ? 1 : 0;
    const expected = (layer: number) =>
        layers.alternate && layer > first && (layer - first) % 2 === 1 ? 1 : 0;
    if (reversed.some((one, layer) => one !== expected(layer))) {
        throw new PentError(
            `${path}: the layers that are reversed are not every second one; expected those, or none`,
        );
    }
}

function extrude(base: Mesh, ordered: OrderedCells, layers: Layers, path: string): Mesh {
    const dimension = (base.dimension + 1) as Dimension;
    const { height, hasFirstPoint, hasLastPoint } = layers;
    const points = Number(hasFirstPoint) + Number(hasLastPoint);
    const vertexCount = base.vertexCount * height + points;
    const perBase = dimension * (height - 1) + points;
    const cellCount = base.cellCount * perBase;
    checkSize(vertexCount, cellCount, { dimension, layers, path });
    const mesh: Mesh = {
        ...base,
        dimension,
        vertexCount,
        cellCount,
        positions: new Float64Array(dimension * vertexCount),
        cells: new Uint32Array((dimension + 1) * cellCount),
    };
    placeVertices(base, layers, mesh);
    const fill = (cell: number, isTurned: boolean, out: Uint32Array) =>
        fillColumn(ordered, cell, { base, layers, isTurned }, out);
    const size = (dimension + 1) * perBase;
    const firstOf = (cell: number) => {
        const column = new Uint32Array(size);
        fill(cell, false, column);
        const behindCone = hasFirstPoint && height > 1 ? dimension + 1 : 0;
        return column.subarray(behindCone, behindCone + dimension + 1);
    };
    const isBackward = proceedsBackward(mesh, base.cellCount, firstOf);
    for (let cell = 0; cell < base.cellCount; ++cell) {
        fill(cell, isBackward, mesh.cells.subarray(size * cell, size * (cell + 1)));
    }
    return mesh;
}

function checkSize(
    vertexCount: number,
    cellCount: number,
    { dimension, layers, path }: { dimension: Dimension; layers: Layers; path: string },
): void {
    const what =
        `${path}: its base and ${layers.count} layers make ${vertexCount} vertices and ` +
        `${cellCount} ${cellNamePlural(dimension)}`;
    if (vertexCount > kMaxRows || cellCount > kMaxRows) {
        throw new PentError(
            `${what}; at most ${kMaxRows} of each can be numbered: take fewer layers`,
        );
    }
    const bytes = 8 * dimension * vertexCount + 4 * (dimension + 1) * cellCount;
    if (bytes > kMaxBytes) {
        throw new PentError(
            `${what}, which take ${(bytes / 1e9).toPrecision(3)} GB; this page takes at most ` +
                `${kMaxBytes / 1e9}: take fewer layers, or look at it by pent-slice or pent-render`,
        );
    }
}

function placeVertices(base: Mesh, layers: Layers, mesh: Mesh): void {
    const { values, rows, hasFirstPoint, hasLastPoint, height } = layers;
    const [from, to] = [base.dimension, mesh.dimension];
    let at = 0;
    for (let column = 0; column < base.vertexCount; ++column) {
        for (let k = 0; k < height; ++k) {
            const layer = rows * (k + Number(hasFirstPoint));
            for (let row = 0; row < to; ++row) {
                let sum = values[layer + from * row]! * base.positions[from * column]!;
                for (let axis = 1; axis < from; ++axis) {
                    sum +=
                        values[layer + from * row + axis]! * base.positions[from * column + axis]!;
                }
                mesh.positions[at++] = sum + values[layer + from * to + row]!;
            }
        }
    }
    for (const layer of [
        ...(hasFirstPoint ? [0] : []),
        ...(hasLastPoint ? [layers.count - 1] : []),
    ]) {
        mesh.positions.set(values.subarray(rows * layer + from * to, rows * (layer + 1)), at);
        at += to;
    }
}

// The simplices of a prism over ordered corners, one after the other.
function prism(low: number[], isOddCell: boolean): number[] {
    const n = low.length;
    return low.flatMap((_, k) => {
        const high = low.slice(k).map((vertex) => vertex + 1); // the next layer of the same column
        return turned([...low.slice(0, k + 1), ...high], ((n - 1 - k) % 2 === 1) !== isOddCell);
    });
}

function turned(simplex: number[], isTurned: boolean): number[] {
    const [a, b] = simplex.slice(-2) as [number, number];
    return isTurned ? [...simplex.slice(0, -2), b, a] : simplex;
}

// All cells over one base cell, one after the other.
function fillColumn(
    { corners, isOdd: areOdd }: OrderedCells,
    cell: number,
    { base, layers, isTurned }: { base: Mesh; layers: Layers; isTurned: boolean },
    out: Uint32Array,
): void {
    const n = base.dimension + 1; // corners of the base cell, and the dimension of the body
    const { height, hasFirstPoint, hasLastPoint, alternate } = layers;
    const bottom = Array.from(
        corners.subarray(n * cell, n * (cell + 1)),
        (vertex) => vertex * height,
    );
    const isOddCell = areOdd[cell]! !== isTurned;
    const firstPoint = base.vertexCount * height;
    const kCone = n + 1;
    let at = 0;
    if (hasFirstPoint) {
        out.set(turned([firstPoint, ...bottom], ((n - 1) % 2 === 1) !== isOddCell), at);
        at += kCone;
    }
    const isReversalOdd = Math.floor(n / 2) % 2 === 1;
    const even = prism(bottom, isOddCell);
    const odd = prism([...bottom].reverse(), isOddCell !== isReversalOdd);
    for (let slab = 0; slab + 1 < height; ++slab) {
        const simplices = alternate && slab % 2 === 1 ? odd : even;
        for (const vertex of simplices) {
            out[at++] = vertex + slab;
        }
    }
    if (hasLastPoint) {
        const top = bottom.map((vertex) => vertex + height - 1);
        out.set(turned([...top, firstPoint + Number(hasFirstPoint)], isOddCell), at);
    }
}

// Whether the layers proceed to the negative side, told by the clearest of a few simplices.
function proceedsBackward(
    { dimension, positions }: Mesh,
    baseCells: number,
    firstOf: (cell: number) => Uint32Array,
): boolean {
    const kFew = 64;
    let clearest = 0;
    for (let cell = 0; cell < Math.min(baseCells, kFew); ++cell) {
        const [first, ...others] = [...firstOf(cell)].map((vertex) =>
            positions.subarray(dimension * vertex, dimension * (vertex + 1)),
        );
        const edges = others.flatMap((corner) => [...corner].map((x, axis) => x - first![axis]!));
        const volume = determinant(edges, dimension);
        clearest = Math.abs(volume) > Math.abs(clearest) ? volume : clearest;
    }
    return clearest < 0;
}
