import assert from "node:assert/strict";
import { test } from "node:test";
import { determinant } from "../../src/format/mesh.ts";
import type { Mesh } from "../../src/format/mesh.ts";
import { makeBoundary } from "../../src/mesh/boundary.ts";
import { makeRestCells, strains, toFloat4 } from "../../src/mesh/quantities.ts";
import { gridMesh } from "../../src/mesh/grid.ts";
import { fromTurns } from "../../src/view/rotation.ts";

const kGrid = gridMesh([2, 1, 1, 2], (p) => p);

/** A cube of six tetrahedra around a diagonal. */
function cube3(): Mesh {
    const cells: number[] = [];
    for (const [a, b, c, isEven] of [
        [1, 2, 4, 1],
        [2, 4, 1, 1],
        [4, 1, 2, 1],
        [2, 1, 4, 0],
        [1, 4, 2, 0],
        [4, 2, 1, 0],
    ] as const) {
        const path = [0, a, a + b, a + b + c];
        cells.push(...(isEven ? path : [path[0]!, path[1]!, path[3]!, path[2]!]));
    }
    return {
        dimension: 3,
        vertexCount: 8,
        cellCount: 6,
        cells: Uint32Array.from(cells),
        crc: 0,
        createdBy: "",
        positions: Float64Array.from({ length: 24 }, (_, i) => (Math.floor(i / 3) >> i % 3) & 1),
    };
}

function point(mesh: Mesh, vertex: number): number[] {
    return [...mesh.positions.subarray(mesh.dimension * vertex, mesh.dimension * (vertex + 1))];
}

// Measure of the inside by the divergence theorem: det[t0, t1, ..., ] / n! over outward facets.
function insideOf(mesh: Mesh, facets: Uint32Array): number {
    const n = mesh.dimension;
    let sum = 0;
    for (let f = 0; f < facets.length; f += 4) {
        sum += determinant(
            [...facets.subarray(f, f + n)].flatMap((v) => point(mesh, v)),
            n,
        );
    }
    return sum / (n === 4 ? 24 : 6);
}

test("cells of a grid are positively oriented and fill it", () => {
    let sum = 0;
    for (let c = 0; c < kGrid.cells.length; c += 5) {
        const corners = [...kGrid.cells.subarray(c, c + 5)].map((v) => point(kGrid, v));
        const edges = corners.slice(1).flatMap((p) => p.map((x, k) => x - corners[0]![k]!));
        const value = determinant(edges, 4);
        assert.ok(value > 0);
        sum += value / 24;
    }
    assert.ok(Math.abs(sum - 16) < 1e-12);
});

test("boundaries are outward and closed, in three and four dimensions", () => {
    for (const [mesh, size, inside] of [
        [kGrid, 4, 16],
        [cube3(), 3, 1],
    ] as const) {
        const { facets, facetCount } = makeBoundary(mesh, "a");
        assert.ok(Math.abs(insideOf(mesh, facets) - inside) < 1e-12);
        // Every ridge has two facets.
        const ridges = new Map<string, number>();
        for (let f = 0; f < facetCount; ++f) {
            const corners = [...facets.subarray(4 * f, 4 * f + size)];
            corners.forEach((apex) => {
                const key = corners
                    .filter((one) => one !== apex)
                    .sort()
                    .join();
                ridges.set(key, (ridges.get(key) ?? 0) + 1);
            });
        }
        assert.ok([...ridges.values()].every((count) => count === 2));
    }
});

test("a vertex lists just the facets that have it", () => {
    const { facets, facetCount, vertexBegin, vertexFacets } = makeBoundary(kGrid, "a");
    const expected = Array.from({ length: kGrid.vertexCount }, (_, v) =>
        Array.from({ length: facetCount }, (__, f) => f).filter((f) =>
            facets.subarray(4 * f, 4 * f + 4).includes(v),
        ),
    );
    expected.forEach((list, v) => {
        assert.deepEqual([...vertexFacets.subarray(vertexBegin[v], vertexBegin[v + 1])], list);
    });
});

test("folds are the triangles of the boundary, each once, between their two tetrahedra", () => {
    const { facets, facetCount, folds } = makeBoundary(kGrid, "a");
    assert.equal(folds.length / 8, (4 * facetCount) / 2);
    const tets = new Set(
        Array.from({ length: facetCount }, (_, f) =>
            [...facets.subarray(4 * f, 4 * f + 4)].sort().join(),
        ),
    );
    for (let at = 0; at < folds.length; at += 8) {
        const [a, b, c, first, other] = [...folds.subarray(at, at + 5)];
        assert.ok(tets.has([a, b, c, first].sort().join()));
        assert.ok(tets.has([a, b, c, other].sort().join()));
    }
});

test("a vertex may be the lowest of any number of cells", () => {
    // Each vertex of a grid in turn changes places with number 0; they have 1 to 120 cells.
    const grid = gridMesh([2, 2, 2, 2], (p) => p);
    const { facetCount } = makeBoundary(grid, "a");
    for (let other = 1; other < grid.vertexCount; ++other) {
        const swap = (v: number) => (v === 0 ? other : v === other ? 0 : v);
        const cells = grid.cells.map(swap);
        assert.equal(makeBoundary({ ...grid, cells }, "a").facetCount, facetCount);
    }
});

test("cells that do not fit together are refused with the number of the first", () => {
    const cells = Uint32Array.from([...kGrid.cells, ...kGrid.cells.subarray(0, 5)]);
    assert.throws(
        () => makeBoundary({ ...kGrid, cells }, "a.pent"),
        /^Error: a\.pent: pentachoron 0: does not fit its neighbors \(.*see pent-check$/,
    );
});

test("strain is zero for rigid motions, and known for a stretch", () => {
    const rest = makeRestCells(kGrid);
    const R = fromTurns([
        { from: 0, to: 3, degrees: 33 },
        { from: 1, to: 2, degrees: -70 },
    ]);
    const moved = (A: Float64Array) => {
        const positions = new Float64Array(kGrid.positions.length);
        for (let v = 0; v < positions.length; v += 4) {
            for (let i = 0; i < 4; ++i) {
                positions[v + i] =
                    1 +
                    [0, 1, 2, 3].reduce(
                        (sum, k) => sum + A[4 * i + k]! * kGrid.positions[v + k]!,
                        0,
                    );
            }
        }
        return toFloat4(positions, 4);
    };
    // What rounding of positions to floats makes of it is taken out.
    assert.ok(strains(rest, moved(R)).every((value) => value === 0));
    // Twice as long along x: E = diag(3/2, 0, 0, 0).
    const stretch = Float64Array.of(2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    assert.ok(strains(rest, moved(stretch)).every((value) => Math.abs(value - 1.5) < 1e-6));
    // By a part in 10^5, where rounding is 10^-7 or so of it.
    const little = stretch.map((value, i) => (i === 0 ? 1 + 1e-5 : value));
    assert.ok(strains(rest, moved(little)).every((value) => Math.abs(value - 1e-5) < 1e-6));
});
