import { makeFramebuffer, makeTarget } from "./gl.ts";
import type { Gl } from "./gl.ts";

const kSamples = 4;

/** What a picture is drawn into, of one size: solid things, by light of the sky and of the lamp,
 * with many samples a pixel and depth; the same with one sample; ghosts; occlusion. */
export class Targets {
    readonly sampled: WebGLFramebuffer;
    readonly sampledGhosts: WebGLFramebuffer; // has the depths of the solid things, too
    readonly solid: WebGLFramebuffer;
    readonly ghosts: WebGLFramebuffer;
    readonly occlusion: WebGLFramebuffer;
    readonly lamp: WebGLFramebuffer;
    readonly skyColor: WebGLTexture;
    readonly lampColor: WebGLTexture;
    readonly depth: WebGLTexture;
    readonly ghostColor: WebGLTexture;
    readonly occlusionColor: WebGLTexture;
    private buffers: WebGLRenderbuffer[];

    constructor(
        private gl: Gl,
        readonly width: number,
        readonly height: number,
    ) {
        const samples = Math.min(kSamples, gl.getParameter(gl.MAX_SAMPLES) as number);
        const kinds = [gl.SRGB8_ALPHA8, gl.SRGB8_ALPHA8, gl.SRGB8_ALPHA8, gl.DEPTH_COMPONENT24];
        this.buffers = kinds.map((internal) => {
            const buffer = gl.createRenderbuffer()!;
            gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
            gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, internal, width, height);
            return buffer;
        });
        const [sky, lamp, ghosts, depth] = this.buffers;
        this.sampled = this.makeSampled([sky!, lamp!], depth!);
        this.sampledGhosts = this.makeSampled([ghosts!], depth!);
        this.skyColor = makeTarget(gl, gl.SRGB8_ALPHA8, width, height);
        this.lampColor = makeTarget(gl, gl.SRGB8_ALPHA8, width, height);
        this.depth = makeTarget(gl, gl.DEPTH_COMPONENT24, width, height);
        this.ghostColor = makeTarget(gl, gl.SRGB8_ALPHA8, width, height);
        this.occlusionColor = makeTarget(gl, gl.RG8, width, height);
        this.solid = makeFramebuffer(gl, this.skyColor, this.depth);
        this.lamp = makeFramebuffer(gl, this.lampColor, null);
        this.ghosts = makeFramebuffer(gl, this.ghostColor, null);
        this.occlusion = makeFramebuffer(gl, this.occlusionColor, null);
    }

    private makeSampled(colors: WebGLRenderbuffer[], depth: WebGLRenderbuffer): WebGLFramebuffer {
        const gl = this.gl;
        const framebuffer = gl.createFramebuffer()!;
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        const places = colors.map((_, i) => gl.COLOR_ATTACHMENT0 + i);
        colors.forEach((color, i) =>
            gl.framebufferRenderbuffer(gl.FRAMEBUFFER, places[i]!, gl.RENDERBUFFER, color),
        );
        gl.drawBuffers(places);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
        return framebuffer;
    }

    /** Takes the mean of the samples of each pixel of one of the colors. */
    resolve(source: WebGLFramebuffer, color: number, target: WebGLFramebuffer, mask: number): void {
        const gl = this.gl;
        gl.bindFramebuffer(gl.READ_FRAMEBUFFER, source);
        gl.readBuffer(gl.COLOR_ATTACHMENT0 + color);
        gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, target);
        gl.blitFramebuffer(
            0,
            0,
            this.width,
            this.height,
            0,
            0,
            this.width,
            this.height,
            mask,
            gl.NEAREST,
        );
    }

    dispose(): void {
        const gl = this.gl;
        for (const framebuffer of [
            this.sampled,
            this.sampledGhosts,
            this.solid,
            this.lamp,
            this.ghosts,
            this.occlusion,
        ]) {
            gl.deleteFramebuffer(framebuffer);
        }
        this.buffers.forEach((buffer) => gl.deleteRenderbuffer(buffer));
        for (const texture of [
            this.skyColor,
            this.lampColor,
            this.depth,
            this.ghostColor,
            this.occlusionColor,
        ]) {
            gl.deleteTexture(texture);
        }
    }
}

/** A depth map seen from the key light. */
export class ShadowMap {
    readonly framebuffer: WebGLFramebuffer;
    readonly texture: WebGLTexture;
    readonly compared: WebGLSampler;
    readonly plain: WebGLSampler;

    constructor(
        gl: Gl,
        readonly size: number,
    ) {
        this.texture = makeTarget(gl, gl.DEPTH_COMPONENT24, size, size);
        this.framebuffer = makeFramebuffer(gl, null, this.texture);
        this.compared = gl.createSampler()!;
        gl.samplerParameteri(this.compared, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
        gl.samplerParameteri(this.compared, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
        gl.samplerParameteri(this.compared, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
        this.plain = gl.createSampler()!;
        gl.samplerParameteri(this.plain, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.samplerParameteri(this.plain, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        for (const sampler of [this.compared, this.plain]) {
            gl.samplerParameteri(sampler, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
            gl.samplerParameteri(sampler, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
        }
    }
}
