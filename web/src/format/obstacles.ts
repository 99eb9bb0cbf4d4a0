import { PentError } from "./error.ts";

/** What bodies are kept out of, or in. All vectors have the dimension of the bodies; lengths in m. */
export type Obstacle =
    | { kind: "half_space"; normal: number[]; offset: number } // solid where normal . p < offset
    | { kind: "ball"; center: number[]; radius: number }
    | { kind: "cavity"; center: number[]; radius: number } // hollow, in a solid
    | { kind: "bowl"; center: number[]; radius: number; up: number[] } // dug into the ground below its rim
    | { kind: "box"; center: number[]; sides: number[]; axes?: number[][] }; // along those of space without `axes`

type Field = "point" | "direction" | "number" | "length" | "lengths" | "axes";

const kFields: Record<Obstacle["kind"], Record<string, Field>> = {
    half_space: { normal: "direction", offset: "number" },
    ball: { center: "point", radius: "length" },
    cavity: { center: "point", radius: "length" },
    bowl: { center: "point", radius: "length", up: "direction" },
    box: { center: "point", sides: "lengths", axes: "axes" },
};

const kKinds = Object.keys(kFields);
const kKnown = `${kKinds.slice(0, -1).join(", ")} or ${kKinds.at(-1)!}`;

function isFinite(value: unknown): value is number {
    return typeof value === "number" && Number.isFinite(value);
}

function determinant(rows: number[][]): number {
    return rows.length === 0
        ? 1
        : rows[0]!.reduce((sum, entry, k) => {
              const minor = rows.slice(1).map((row) => row.filter((_, i) => i !== k));
              return sum + (k % 2 === 0 ? entry : -entry) * determinant(minor);
          }, 0);
}

// Whether vectors have length 1, are across one another, and none mirrors the others.
function isRotation(axes: unknown, dimension: number): boolean {
    if (!Array.isArray(axes) || axes.length !== dimension) {
        return false;
    }
    const areVectors = axes.every(
        (axis) => Array.isArray(axis) && axis.length === dimension && axis.every(isFinite),
    );
    return (
        areVectors &&
        (axes as number[][]).every((a, i) =>
            (axes as number[][]).every((b, j) => {
                const product = a.reduce((sum, x, k) => sum + x * b[k]!, 0);
                return Math.abs(product - (i === j ? 1 : 0)) <= 1e-9;
            }),
        ) &&
        determinant(axes as number[][]) > 0
    );
}

// What a field must be where it is not; else null.
function faultOf(value: unknown, field: Field, dimension: number): string | null {
    if (field === "axes") {
        return value === undefined || isRotation(value, dimension)
            ? null
            : `${dimension} vectors of length 1 across one another`;
    }
    if (field === "number" || field === "length") {
        const isRight = isFinite(value) && (field === "number" || value > 0);
        return isRight ? null : field === "number" ? "a finite number" : "a number above 0";
    }
    if (!Array.isArray(value) || value.length !== dimension || !value.every(isFinite)) {
        return `${dimension} finite numbers`;
    }
    if (field === "direction" && !(Math.abs(Math.hypot(...value) - 1) <= 1e-9)) {
        return `${dimension} numbers, of length 1 together`;
    }
    return field === "lengths" && !value.every((length) => length > 0)
        ? `${dimension} numbers above 0`
        : null;
}

function readObstacle(entry: unknown, dimension: number, where: string): Obstacle {
    const json = (typeof entry === "object" && entry !== null ? entry : {}) as Record<
        string,
        unknown
    >;
    const { kind } = json;
    if (typeof kind !== "string") {
        throw new PentError(`${where}: found no kind; expected ${kKnown}`);
    }
    if (!Object.hasOwn(kFields, kind)) {
        throw new PentError(
            `${where}: found an obstacle of kind ${JSON.stringify(kind)}; expected ${kKnown}; ` +
                "a newer pent-sim may have made it",
        );
    }
    const fields = kFields[kind as Obstacle["kind"]];
    for (const [name, field] of Object.entries(fields)) {
        const fault = faultOf(json[name], field, dimension);
        if (fault) {
            throw new PentError(
                `${where}: "${name}" is missing or out of range; expected ${fault}`,
            );
        }
    }
    // A key more may say that it moves: drawn at rest it would be in the wrong place.
    const unknown = Object.keys(json).find((key) => key !== "kind" && !Object.hasOwn(fields, key));
    if (unknown !== undefined) {
        throw new PentError(
            `${where}: found the key ${JSON.stringify(unknown)}, which is not known; ` +
                "a newer pent-sim may have made it",
        );
    }
    return json as Obstacle;
}

/** Along which a box's sides go, of the dimension of its center. */
export function axesOf(box: { center: number[]; axes?: number[][] }): number[][] {
    return box.axes ?? box.center.map((_, i) => box.center.map((_, k) => (i === k ? 1 : 0)));
}

/** The obstacles of a run or of one of its frames: specified in docs/pent-format.md. Throws a PentError in the words
 * of the C++ reader.
 *
 * @param text  Of obstacles.json, or what JSON.parse makes of it. */
export function readObstacles(text: unknown, path: string, dimension: number): Obstacle[] {
    let json: Record<string, unknown> | null = null;
    try {
        json = (typeof text === "string" ? JSON.parse(text) : text) as Record<string, unknown>;
    } catch {
        // it is refused below
    }
    const list = json?.["obstacles"];
    if (json?.["pent_obstacles"] !== 1 || !Array.isArray(list)) {
        throw new PentError(
            `${path}: is not the list of a run's obstacles; expected JSON with ` +
                '"pent_obstacles": 1 and "obstacles"',
        );
    }
    if (json["dimension"] !== dimension) {
        throw new PentError(
            `${path}: has no dimension or another; expected ${dimension} as the bodies have`,
        );
    }
    return list.map((entry, i) => readObstacle(entry, dimension, `${path}: obstacle ${i + 1}`));
}
