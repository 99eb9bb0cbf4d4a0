import type { Column } from "./body.ts";
import { PentError } from "./error.ts";
import type { PlyElement } from "./ply.ts";

/** A quantity of vertices or cells, by its name: a number for each, or a vector of the dimension. */
export interface Field {
    name: string;
    size: number; // numbers for each
    values: Float64Array;
}

/** Every property of doubles that is none of those known, with no values yet: a vector where all axes follow one
 * another, else a number.
 *
 * @param prefixes  Of known vectors: "" is x, y and so on. */
export function fieldsOf(element: PlyElement, dimension: number, prefixes: string[]): Field[] {
    const axes = [..."xyzw"].slice(0, dimension);
    const known = new Set(prefixes.flatMap((prefix) => axes.map((axis) => prefix + axis)));
    const isDouble = (i: number) => {
        const property = element.properties[i];
        return property?.type === "double" && property.countType === null;
    };
    const fields: Field[] = [];
    for (let i = 0; i < element.properties.length; ) {
        const { name } = element.properties[i]!;
        if (!isDouble(i) || known.has(name)) {
            ++i;
            continue;
        }
        const stem = name.slice(0, -2);
        const isVector =
            stem !== "" &&
            axes.every(
                (axis, k) =>
                    isDouble(i + k) && element.properties[i + k]!.name === `${stem}_${axis}`,
            );
        const size = isVector ? dimension : 1;
        const values = new Float64Array(size * Number(element.count));
        fields.push({ name: isVector ? stem : name, size, values });
        i += size;
    }
    return fields;
}

/** Where the numbers of a field go. */
export function fieldColumns({ name, size, values }: Field): Column[] {
    return Array.from({ length: size }, (_, k) => ({
        name: size === 1 ? name : `${name}_${"xyzw"[k]}`,
        values,
        first: k,
        stride: size,
    }));
}

/** @param of  What they are quantities of: "vertex". */
export function checkFields(fields: Field[], of: string, path: string): void {
    for (const { name, size, values } of fields) {
        const bad = values.findIndex((value) => !Number.isFinite(value));
        if (bad >= 0) {
            throw new PentError(
                `${path}: ${of} ${Math.floor(bad / size)}: ${name} is not finite, ` +
                    "expected finite numbers",
            );
        }
    }
}
