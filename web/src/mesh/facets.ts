/** A facet of the cells of a mesh, as match() finds it. A facet lacks one corner, the apex. */
export interface FacetVisitor {
    /** One cell only has the facet that lacks its corner `apex` (a vertex). */
    onBoundary(cell: number, apex: number): void;
    /** Two cells have it and see it from opposite sides. */
    onInterior?(cellA: number, apexA: number, cellB: number, apexB: number): void;
    /** Two cells see it from the same side, or more than two have it: the first and the last of them. */
    onFault(cell: number, count: number, last: number): void;
}

const kCells = 0; // what a table holds of each facet
const kApex = 1;
const kOther = 2;
const kOtherApex = 3;
const kCount = 4;
const kFlags = 5; // bit 0: sorted order is outward in the first cell; bit 1: seen from one side
const kRest = 6; // corners without the lowest, ascending
const kStride = 9;

// Sorts in place; returns 1 where the permutation was odd.
function sortWithParity(values: Uint32Array): number {
    let parity = 0;
    for (let i = 1; i < values.length; ++i) {
        for (let j = i; j > 0 && values[j]! < values[j - 1]!; --j) {
            const value = values[j]!;
            values[j] = values[j - 1]!;
            values[j - 1] = value;
            parity ^= 1;
        }
    }
    return parity;
}

// For every vertex the cells where it is the lowest or the second lowest corner.
function cellsByLowestCorner(cells: Uint32Array, size: number, vertexCount: number) {
    const count = cells.length / size;
    const lowest = new Uint32Array(2 * count);
    const begin = new Uint32Array(vertexCount + 1);
    for (let cell = 0; cell < count; ++cell) {
        let first = 0xffffffff;
        let second = 0xffffffff;
        for (let k = 0; k < size; ++k) {
            const corner = cells[cell * size + k]!;
            second = Math.min(second, Math.max(first, corner));
            first = Math.min(first, corner);
        }
        lowest[2 * cell] = first;
        lowest[2 * cell + 1] = second;
        ++begin[first]!;
        ++begin[second]!;
    }
    let sum = 0;
    for (let v = 0; v <= vertexCount; ++v) {
        const here = begin[v]!;
        begin[v] = sum;
        sum += here;
    }
    const next = begin.slice(0, vertexCount);
    const list = new Uint32Array(2 * count);
    for (let i = 0; i < lowest.length; ++i) {
        list[next[lowest[i]!]!++] = i >> 1;
    }
    return { begin, list };
}

// The facets with one lowest corner, found by their other corners, by open addressing.
class FacetTable {
    size = 0;
    entries = new Uint32Array(0); // grows with the slots: there are never more
    private slots = new Int32Array(0);
    private mask = 0;

    constructor(private restSize: number) {}

    clear(mostEntries: number): void {
        this.size = 0;
        let slots = 16;
        while (slots < 2 * mostEntries + 1) {
            slots *= 2;
        }
        if (this.slots.length < slots) {
            this.slots = new Int32Array(slots);
            this.entries = new Uint32Array(slots * kStride);
        }
        this.mask = slots - 1;
        this.slots.fill(-1, 0, slots);
    }

    add(rest: Uint32Array, cell: number, apex: number, isOutward: number): void {
        let hash = 0;
        for (let k = 0; k < this.restSize; ++k) {
            hash = Math.imul(hash ^ rest[k]!, 0x9e3779b1);
            hash ^= hash >>> 15;
        }
        for (let slot = hash & this.mask; ; slot = (slot + 1) & this.mask) {
            const entry = this.slots[slot]!;
            if (entry < 0) {
                this.slots[slot] = this.size;
                const at = kStride * this.size++;
                this.entries[at + kCells] = cell;
                this.entries[at + kApex] = apex;
                this.entries[at + kCount] = 1;
                this.entries[at + kFlags] = isOutward;
                for (let k = 0; k < this.restSize; ++k) {
                    this.entries[at + kRest + k] = rest[k]!;
                }
                return;
            }
            const at = kStride * entry;
            let isSame = true;
            for (let k = 0; k < this.restSize; ++k) {
                isSame &&= this.entries[at + kRest + k] === rest[k];
            }
            if (isSame) {
                this.entries[at + kOther] = cell;
                this.entries[at + kOtherApex] = apex;
                ++this.entries[at + kCount]!;
                const wasOutward = this.entries[at + kFlags]! & 1;
                this.entries[at + kFlags] = wasOutward | (wasOutward === isOutward ? 2 : 0);
                return;
            }
        }
    }

    visit(visitor: FacetVisitor): void {
        const e = this.entries;
        for (let at = 0; at < kStride * this.size; at += kStride) {
            const count = e[at + kCount]!;
            if (count === 1) {
                visitor.onBoundary(e[at + kCells]!, e[at + kApex]!);
            } else if (count === 2 && !(e[at + kFlags]! & 2)) {
                visitor.onInterior?.(
                    e[at + kCells]!,
                    e[at + kApex]!,
                    e[at + kOther]!,
                    e[at + kOtherApex]!,
                );
            } else {
                visitor.onFault(e[at + kCells]!, count, e[at + kOther]!);
            }
        }
    }
}

/** Finds how the facets of positively oriented simplices meet, in linear time, by hashing them in
 * groups of one lowest corner.
 *
 * @param size  Corners of a cell, 4 or 5. */
export function matchFacets(
    cells: Uint32Array,
    size: number,
    vertexCount: number,
    visitor: FacetVisitor,
): void {
    const { begin, list } = cellsByLowestCorner(cells, size, vertexCount);
    const table = new FacetTable(size - 2);
    const corners = new Uint32Array(size);
    const rest = new Uint32Array(size - 2);
    for (let vertex = 0; vertex < vertexCount; ++vertex) {
        const from = begin[vertex]!;
        const to = begin[vertex + 1]!;
        table.clear((size - 1) * (to - from));
        for (let i = from; i < to; ++i) {
            const cell = list[i]!;
            corners.set(cells.subarray(cell * size, (cell + 1) * size));
            // The facet without corner j, in sorted order, is outward when j + parity is even.
            const isOdd = sortWithParity(corners);
            const isLowest = corners[0] === vertex;
            for (let j = isLowest ? 1 : 0; j < (isLowest ? size : 1); ++j) {
                for (let k = isLowest ? 1 : 2, to = 0; k < size; ++k) {
                    if (k !== j) {
                        rest[to++] = corners[k]!;
                    }
                }
                table.add(rest, cell, corners[j]!, (j + isOdd) % 2 === 0 ? 1 : 0);
            }
        }
        table.visit(visitor);
    }
}

/** Corners of the facet of a cell that lacks corner k, in an outward order, to target[at...]. */
export function outwardFacet(
    cells: Uint32Array,
    size: number,
    cell: number,
    k: number,
    target: Uint32Array,
    at: number,
): void {
    for (let i = 0, to = at; i < size; ++i) {
        if (i !== k) {
            target[to++] = cells[cell * size + i]!;
        }
    }
    if (k % 2 === 1) {
        const last = at + size - 2;
        const corner = target[last]!;
        target[last] = target[last - 1]!;
        target[last - 1] = corner;
    }
}
