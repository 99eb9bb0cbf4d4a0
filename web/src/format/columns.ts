import type { Column } from "./body.ts";
import { PentError } from "./error.ts";
import type { Dimension } from "./header.ts";
import type { PlyElement, PlyType } from "./ply.ts";

const kAxes = "xyzw";

/** Whether an element has a property; one of another type is refused. */
export function hasProperty(
    element: PlyElement,
    name: string,
    type: PlyType,
    path: string,
): boolean {
    const property = element.properties.find((known) => known.name === name);
    if (property && property.type !== type) {
        throw new PentError(
            `${path}: header: property ${name} of element ${element.name} is ` +
                `${property.type}, expected ${type}`,
        );
    }
    return property !== undefined;
}

/** Where the numbers of a vector of each row go: those of x, y and so on behind a prefix. */
export function vectorColumns(values: Float64Array, dimension: number, prefix: string): Column[] {
    return [...kAxes.slice(0, dimension)].map((axis, i) => ({
        name: prefix + axis,
        values,
        first: i,
        stride: dimension,
    }));
}

/** Room for a vector of each row; null where there is none. It has all its components or none. */
export function vectorOf(
    element: PlyElement,
    dimension: Dimension,
    prefix: string,
    what: string,
    path: string,
): Float64Array | null {
    const found = [...kAxes.slice(0, dimension)].filter((axis) =>
        hasProperty(element, prefix + axis, "double", path),
    ).length;
    if (found !== 0 && found !== dimension) {
        throw new PentError(
            `${path}: header: ${found} ${what} properties, ` +
                `expected none or all of ${dimension}`,
        );
    }
    return found ? new Float64Array(dimension * Number(element.count)) : null;
}
