import type { Gl } from "./gl.ts";

/** Draws with the program in use into a buffer, and gives the triangles that it does not leave out:
 * nine numbers each, in order. The program captures `kCaptured`, four floats a vertex. */
export function captureTriangles(gl: Gl, perInstance: number, instances: number): Float32Array {
    const all = new Float32Array(4 * perInstance * instances);
    const target = gl.createBuffer()!;
    gl.bindBuffer(gl.TRANSFORM_FEEDBACK_BUFFER, target);
    gl.bufferData(gl.TRANSFORM_FEEDBACK_BUFFER, all.byteLength, gl.STREAM_READ);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, target);
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.beginTransformFeedback(gl.TRIANGLES);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, perInstance, instances);
    gl.endTransformFeedback();
    gl.disable(gl.RASTERIZER_DISCARD);
    gl.getBufferSubData(gl.TRANSFORM_FEEDBACK_BUFFER, 0, all);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, null);
    gl.deleteBuffer(target);
    const kept: number[] = [];
    for (let at = 0; at < all.length; at += 12) {
        if (all[at + 3] === 1) {
            for (const k of [0, 1, 2, 4, 5, 6, 8, 9, 10]) {
                kept.push(all[at + k]!);
            }
        }
    }
    return Float32Array.from(kept);
}
