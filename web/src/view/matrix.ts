/** Matrices of the camera: 4 x 4, one column after the other, as WebGL takes them. */
export type Matrix = Float32Array;
export type Vector = [number, number, number];

export const add = (a: Vector, b: Vector, s = 1): Vector => [
    a[0] + s * b[0],
    a[1] + s * b[1],
    a[2] + s * b[2],
];
export const scale = (a: Vector, s: number): Vector => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vector, b: Vector) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector, b: Vector): Vector => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];
export const normalized = (a: Vector): Vector => scale(a, 1 / Math.sqrt(dot(a, a)));

export function multiply(a: Matrix, b: Matrix): Matrix {
    const result = new Float32Array(16);
    for (let column = 0; column < 4; ++column) {
        for (let row = 0; row < 4; ++row) {
            let sum = 0;
            for (let k = 0; k < 4; ++k) {
                sum += a[4 * k + row]! * b[4 * column + k]!;
            }
            result[4 * column + row] = sum;
        }
    }
    return result;
}

export function transform(m: Matrix, p: Vector): [number, number, number, number] {
    const row = (i: number) => m[i]! * p[0] + m[4 + i]! * p[1] + m[8 + i]! * p[2] + m[12 + i]!;
    return [row(0), row(1), row(2), row(3)];
}

/** From the world to an eye with these unit axes: right, up, and back towards the viewer. */
export function viewMatrix(right: Vector, up: Vector, back: Vector, eye: Vector): Matrix {
    return Float32Array.of(
        right[0],
        up[0],
        back[0],
        0,
        right[1],
        up[1],
        back[1],
        0,
        right[2],
        up[2],
        back[2],
        0,
        -dot(right, eye),
        -dot(up, eye),
        -dot(back, eye),
        1,
    );
}

/** @param slopeX  Tangent of half the angle across; slopeY upright. */
export function perspective(slopeX: number, slopeY: number, near: number, far: number): Matrix {
    const m = new Float32Array(16);
    m[0] = 1 / slopeX;
    m[5] = 1 / slopeY;
    m[10] = (far + near) / (near - far);
    m[11] = -1;
    m[14] = (2 * far * near) / (near - far);
    return m;
}

export function orthographic(half: number, near: number, far: number): Matrix {
    const m = new Float32Array(16);
    m[0] = m[5] = 1 / half;
    m[10] = 2 / (near - far);
    m[14] = (far + near) / (near - far);
    m[15] = 1;
    return m;
}
