/** Rotations of four-dimensional space: 4 x 4, one row after the other; a point p goes to R p. */
export type Rotation = Float64Array;

/** The six planes of rotation. "xw" takes x towards w. */
export const kPlanes = ["xy", "xz", "yz", "xw", "yw", "zw"] as const;
export type Plane = (typeof kPlanes)[number];

/** One turn, as in "xw:30". */
export interface Turn {
    from: number; // an axis, 0 to 3
    to: number;
    degrees: number;
}

const kAxes = "xyzw";

export function identity(): Rotation {
    return Float64Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
}

/** Turns R in place: the new rotation is first R, then the turn. */
export function applyTurn(R: Rotation, from: number, to: number, degrees: number): void {
    const c = Math.cos((degrees * Math.PI) / 180);
    const s = Math.sin((degrees * Math.PI) / 180);
    for (let k = 0; k < 4; ++k) {
        const a = R[4 * from + k]!;
        const b = R[4 * to + k]!;
        R[4 * from + k] = c * a - s * b;
        R[4 * to + k] = s * a + c * b;
    }
}

/** The turns one after the other, in the order written. */
export function fromTurns(turns: Turn[]): Rotation {
    const R = identity();
    for (const turn of turns) {
        applyTurn(R, turn.from, turn.to, turn.degrees);
    }
    return R;
}

export function axesOf(plane: Plane): [number, number] {
    return [kAxes.indexOf(plane[0]!), kAxes.indexOf(plane[1]!)];
}

/** At most six turns whose product R is, each in one of the six planes, found by turning R back to
 * the identity column by column. Angles in degrees, (-180, 180]. */
export function toTurns(R: Rotation): Turn[] {
    const rest = R.slice();
    const back: Turn[] = [];
    for (let column = 0; column < 3; ++column) {
        for (let row = column + 1; row < 4; ++row) {
            // Turns the entry of `row` into that of the diagonal, which ends not negative.
            const degrees =
                (Math.atan2(rest[4 * row + column]!, rest[4 * column + column]!) * 180) / Math.PI;
            if (degrees !== 0) {
                applyTurn(rest, column, row, -degrees);
                back.push({ from: column, to: row, degrees });
            }
        }
    }
    return back.reverse();
}

/** Takes rounding out: rows of length one, at right angles. */
export function orthonormalize(R: Rotation): void {
    for (let i = 0; i < 4; ++i) {
        for (let j = 0; j < i; ++j) {
            const along = dotRows(R, i, j);
            for (let k = 0; k < 4; ++k) {
                R[4 * i + k]! -= along * R[4 * j + k]!;
            }
        }
        const length = Math.sqrt(dotRows(R, i, i));
        for (let k = 0; k < 4; ++k) {
            R[4 * i + k]! /= length;
        }
    }
}

function dotRows(R: Rotation, i: number, j: number): number {
    let sum = 0;
    for (let k = 0; k < 4; ++k) {
        sum += R[4 * i + k]! * R[4 * j + k]!;
    }
    return sum;
}

export function apply(R: Rotation, p: ArrayLike<number>): [number, number, number, number] {
    const row = (i: number) =>
        R[4 * i]! * p[0]! + R[4 * i + 1]! * p[1]! + R[4 * i + 2]! * p[2]! + R[4 * i + 3]! * p[3]!;
    return [row(0), row(1), row(2), row(3)];
}

/** "xw:30,yz:-12.5", which pent-slice understands after --rotate; "" for the identity. */
export function formatTurns(turns: Turn[], digits = 2): string {
    return turns
        .map((turn) => ({ ...turn, degrees: Number(turn.degrees.toFixed(digits)) }))
        .filter((turn) => turn.degrees !== 0)
        .map((turn) => `${kAxes[turn.from]}${kAxes[turn.to]}:${turn.degrees}`)
        .join(",");
}

/** The reverse of formatTurns; null where it is not understood. */
export function parseTurns(text: string): Turn[] | null {
    const turns: Turn[] = [];
    for (const part of text.split(",").filter((word) => word !== "")) {
        const match = /^([xyzw])([xyzw]):(-?\d+(?:\.\d*)?(?:e[+-]?\d+)?)$/.exec(part);
        if (!match || match[1] === match[2] || !Number.isFinite(Number(match[3]))) {
            return null;
        }
        turns.push({
            from: kAxes.indexOf(match[1]!),
            to: kAxes.indexOf(match[2]!),
            degrees: Number(match[3]),
        });
    }
    return turns;
}
