import type { Gl, Program } from "./gl.ts";
import type { Picture, Segment } from "./picture.ts";

/** Draws segments of some pixels across, whose ends and colors are attributes of instances. */
export class LineDrawer {
    private buffer: WebGLBuffer;
    private array: WebGLVertexArrayObject;

    constructor(private gl: Gl) {
        this.buffer = gl.createBuffer()!;
        this.array = gl.createVertexArray()!;
        gl.bindVertexArray(this.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
        [3, 3, 4].forEach((size, i) => {
            gl.enableVertexAttribArray(i);
            gl.vertexAttribPointer(i, size, gl.FLOAT, false, 40, 12 * i);
            gl.vertexAttribDivisor(i, 1);
        });
        gl.bindVertexArray(null);
    }

    /** Leaves its own vertex array bound.
     *
     * @param rect  Of the tile: left, bottom, width, height, pixels. */
    draw(program: Program, picture: Picture, lines: Segment[], rect: readonly number[]): void {
        const gl = this.gl;
        const data = lines.flatMap(({ a, b, color, alpha }) => [...a, ...b, ...color, alpha]);
        gl.bindVertexArray(this.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
        gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(data), gl.STREAM_DRAW);
        program
            .use()
            .matrix("viewProjection", picture.camera.viewProjection)
            .float("pixels", rect[2]!, rect[3]!)
            .float("width", picture.lineWidth);
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.length);
    }
}
