/** A file of text. */
export function lines(...text: string[]): Uint8Array {
    return new TextEncoder().encode(`${text.join("\n")}\n`);
}

/** How a file of three dimensions begins. */
export const kTetHead = ["ply", "format ascii 1.0", "comment pent 1.0", "comment dimension 3"];
/** Where its vertices are. */
export const kPlaces = ["x", "y", "z"].map((axis) => `property double ${axis}`);

/** Two tetrahedra, the second twice as large, with quantities of vertices and of cells, two of them of one name. */
export function twoTets(heat = "1"): Uint8Array {
    return lines(
        ...kTetHead,
        "element vertex 5",
        ...kPlaces,
        "property double heat",
        "property double strain",
        "element tetrahedron 2",
        ...[0, 1, 2, 3].map((k) => `property uint v${k}`),
        "property double phase",
        "property double heat",
        ...["x", "y", "z"].map((axis) => `property double flow_${axis}`),
        "end_header",
        `0 0 0 ${heat} 9`,
        "1 0 0 2 9",
        "0 1 0 3 9",
        "0 0 1 4 9",
        "0 0 -2 -5 9",
        "0 1 2 3 3 7 0 0 3",
        "0 2 1 4 6 7 0 3 0",
    );
}
