import { PentError } from "../format/error.ts";
import { cellName } from "../format/header.ts";
import type { Mesh } from "../format/mesh.ts";
import { matchFacets, outwardFacet } from "./facets.ts";

/** The closed boundary of a body, made once: what every slice of every frame is cut from. */
export interface Boundary {
    facetCount: number;
    /** Four numbers a facet: tetrahedra in four dimensions, triangles and a zero in three. Outward,
     * ordered by cell, as in the C++ viewer. */
    facets: Uint32Array;
    /** The facets at vertex v: vertexFacets[vertexBegin[v] .. vertexBegin[v + 1]). */
    vertexBegin: Uint32Array;
    vertexFacets: Uint32Array;
    /** Where the outline of a projection may run: eight numbers for each triangle a b c between two
     * boundary tetrahedra: a b c, the corner of the first that it lacks, that of the second, 0 0 0.
     * a b c is outward for the first. Empty in three dimensions. */
    folds: Uint32Array;
}

/** The boundary of a valid mesh. Throws a PentError where cells do not fit together. */
export function makeBoundary(mesh: Mesh, path: string): Boundary {
    const size = mesh.dimension + 1;
    const found: number[] = []; // cell * size + corner
    let oneSided = 0;
    let overfull = 0;
    let firstFault = Infinity;
    matchFacets(mesh.cells, size, mesh.vertexCount, {
        onBoundary(cell, apex) {
            found.push(cell * size + mesh.cells.indexOf(apex, cell * size) - cell * size);
        },
        onFault(cell, count) {
            firstFault = Math.min(firstFault, cell);
            oneSided += count === 2 ? 1 : 0;
            overfull += count > 2 ? 1 : 0;
        },
    });
    if (firstFault !== Infinity) {
        throw new PentError(
            `${path}: ${cellName(mesh.dimension)} ${firstFault}: does not fit its ` +
                `neighbors (${oneSided} facets seen twice from one side, ${overfull} shared by more ` +
                "than two cells); expected a conforming mesh, see pent-check",
        );
    }
    const order = Float64Array.from(found).sort();
    const facets = new Uint32Array(4 * order.length);
    order.forEach((place, i) => {
        outwardFacet(mesh.cells, size, Math.floor(place / size), place % size, facets, 4 * i);
    });
    return indexBoundary(facets, mesh.dimension, mesh.vertexCount);
}

/** The same for outward facets found elsewhere. */
export function indexBoundary(
    facets: Uint32Array,
    dimension: number,
    vertexCount: number,
): Boundary {
    const vertexBegin = new Uint32Array(vertexCount + 1);
    const facetCount = facets.length / 4;
    for (let f = 0; f < facetCount; ++f) {
        for (let k = 0; k < dimension; ++k) {
            ++vertexBegin[facets[4 * f + k]! + 1]!;
        }
    }
    for (let v = 0; v < vertexCount; ++v) {
        vertexBegin[v + 1]! += vertexBegin[v]!;
    }
    const next = vertexBegin.slice(0, vertexCount);
    const vertexFacets = new Uint32Array(dimension * facetCount);
    for (let f = 0; f < facetCount; ++f) {
        for (let k = 0; k < dimension; ++k) {
            vertexFacets[next[facets[4 * f + k]!]!++] = f;
        }
    }
    const folds = dimension === 4 ? findFolds(facets, vertexCount) : new Uint32Array(0);
    return { facetCount, facets, vertexBegin, vertexFacets, folds };
}

// At an edge where four or more tetrahedra share a triangle there is no pair, and no fold is drawn.
function findFolds(tets: Uint32Array, vertexCount: number): Uint32Array {
    const pairs: number[] = [];
    matchFacets(tets, 4, vertexCount, {
        onBoundary: () => {},
        onFault: () => {},
        onInterior: (cellA, apexA, _cellB, apexB) => pairs.push(cellA, apexA, apexB),
    });
    const folds = new Uint32Array((8 * pairs.length) / 3);
    for (let i = 0, at = 0; i < pairs.length; i += 3, at += 8) {
        const cell = pairs[i]!;
        const k = tets.indexOf(pairs[i + 1]!, 4 * cell) - 4 * cell;
        outwardFacet(tets, 4, cell, k, folds, at);
        folds[at + 3] = pairs[i + 1]!;
        folds[at + 4] = pairs[i + 2]!;
    }
    return folds;
}
