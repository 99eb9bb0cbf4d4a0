import { PentError } from "../format/error.ts";
import { kTextureWidth } from "./shaders.ts";

export type Gl = WebGL2RenderingContext;

/** A linked program, and its uniforms set by name. */
export class Program {
    private places = new Map<string, WebGLUniformLocation | null>();

    constructor(
        private gl: Gl,
        private program: WebGLProgram,
    ) {}

    use(): this {
        this.gl.useProgram(this.program);
        return this;
    }

    private at(name: string): WebGLUniformLocation | null {
        let place = this.places.get(name);
        if (place === undefined) {
            place = this.gl.getUniformLocation(this.program, name);
            this.places.set(name, place);
        }
        return place;
    }

    int(name: string, value: number): this {
        this.gl.uniform1i(this.at(name), value);
        return this;
    }

    int4(name: string, values: Int32List): this {
        this.gl.uniform4iv(this.at(name), values);
        return this;
    }

    /** One to four floats. */
    float(name: string, ...values: number[]): this {
        const place = this.at(name);
        const set = [
            this.gl.uniform1fv,
            this.gl.uniform2fv,
            this.gl.uniform3fv,
            this.gl.uniform4fv,
        ][values.length - 1]!;
        set.call(this.gl, place, values);
        return this;
    }

    matrix(name: string, value: Float32Array): this {
        this.gl.uniformMatrix4fv(this.at(name), false, value);
        return this;
    }

    /** An array of two floats each. */
    pairs(name: string, values: number[]): this {
        this.gl.uniform2fv(this.at(name), values);
        return this;
    }

    matrix3(name: string, columns: readonly (readonly number[])[]): this {
        this.gl.uniformMatrix3fv(this.at(name), false, columns.flat());
        return this;
    }

    texture(
        name: string,
        unit: number,
        texture: WebGLTexture,
        sampler: WebGLSampler | null = null,
    ) {
        this.gl.activeTexture(this.gl.TEXTURE0 + unit);
        this.gl.bindTexture(this.gl.TEXTURE_2D, texture);
        this.gl.bindSampler(unit, sampler);
        return this.int(name, unit);
    }
}

/** Compiles and links; throws a PentError with the compiler's words.
 *
 * @param captured  Outputs of the vertex shader for transform feedback. */
export function makeProgram(gl: Gl, vertex: string, fragment: string, captured: string[] = []) {
    const program = gl.createProgram()!;
    for (const [kind, text] of [
        [gl.VERTEX_SHADER, vertex],
        [gl.FRAGMENT_SHADER, fragment],
    ] as const) {
        const shader = gl.createShader(kind)!;
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
            throw new PentError(
                `graphics: a shader does not compile here: ` +
                    `${gl.getShaderInfoLog(shader)?.split("\n")[0]}`,
            );
        }
        gl.deleteShader(shader);
    }
    if (captured.length > 0) {
        gl.transformFeedbackVaryings(program, captured, gl.INTERLEAVED_ATTRIBS);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
        throw new PentError(`graphics: shaders do not fit here: ${gl.getProgramInfoLog(program)}`);
    }
    return new Program(gl, program);
}

export interface TextureKind {
    internal: number;
    format: number;
    type: number;
    perTexel: number;
}

export function textureKinds(gl: Gl) {
    return {
        float4: { internal: gl.RGBA32F, format: gl.RGBA, type: gl.FLOAT, perTexel: 4 },
        float1: { internal: gl.R32F, format: gl.RED, type: gl.FLOAT, perTexel: 1 },
        uint4: {
            internal: gl.RGBA32UI,
            format: gl.RGBA_INTEGER,
            type: gl.UNSIGNED_INT,
            perTexel: 4,
        },
        uint1: { internal: gl.R32UI, format: gl.RED_INTEGER, type: gl.UNSIGNED_INT, perTexel: 1 },
    };
}

function unfiltered(gl: Gl): void {
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
}

/** Rows of a texture that holds so many texels. */
export function rowsFor(gl: Gl, texels: number, what: string): number {
    const rows = Math.max(1, Math.ceil(texels / kTextureWidth));
    const most = gl.getParameter(gl.MAX_TEXTURE_SIZE) as number;
    if (rows > most) {
        throw new PentError(
            `graphics: ${texels} ${what} are more than the ${most * kTextureWidth} ` +
                "that this graphics card can hold; open a coarser mesh",
        );
    }
    return rows;
}

/** A texture to be read by index, empty. */
export function makeTexture(gl: Gl, kind: TextureKind, texels: number, what: string): WebGLTexture {
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, kind.internal, kTextureWidth, rowsFor(gl, texels, what));
    unfiltered(gl);
    return texture;
}

/** Fills such a texture from its start. */
export function fillTexture(
    gl: Gl,
    texture: WebGLTexture,
    kind: TextureKind,
    data: Float32Array | Uint32Array,
): void {
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    const perRow = kTextureWidth * kind.perTexel;
    const rows = Math.floor(data.length / perRow);
    if (rows > 0) {
        gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, kTextureWidth, rows, kind.format, kind.type, data);
    }
    const rest = data.subarray(rows * perRow);
    if (rest.length > 0) {
        gl.texSubImage2D(
            gl.TEXTURE_2D,
            0,
            0,
            rows,
            rest.length / kind.perTexel,
            1,
            kind.format,
            kind.type,
            rest,
        );
    }
}

/** A texture of the size of a picture, to draw into. */
export function makeTarget(gl: Gl, internal: number, width: number, height: number): WebGLTexture {
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, internal, width, height);
    unfiltered(gl);
    return texture;
}

export function makeFramebuffer(gl: Gl, color: WebGLTexture | null, depth: WebGLTexture | null) {
    const framebuffer = gl.createFramebuffer()!;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    if (color) {
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, color, 0);
    }
    if (depth) {
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
    }
    return framebuffer;
}
