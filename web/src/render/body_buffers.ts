import type { Body, BodyFrame } from "../run/decode.ts";
import { fillTexture, makeFramebuffer, makeTexture, rowsFor, textureKinds } from "./gl.ts";
import type { Gl, Program, TextureKind } from "./gl.ts";
import { kTextureWidth } from "./shaders.ts";

/** The programs that make smooth normals. */
export interface NormalPrograms {
    facets(): Program;
    corners(): Program;
}

/** A body on the graphics card: its boundary, and positions and a scalar of the frame shown. */
export class BodyBuffers {
    readonly facets: WebGLTexture;
    readonly folds: WebGLTexture | null;
    readonly foldCount: number;
    readonly positions: WebGLTexture;
    readonly scalars: WebGLTexture;
    /** Null where the card cannot draw into textures of floats: then normals are flat. */
    readonly cornerNormals: WebGLTexture | null;
    private facetNormals: WebGLTexture | null = null;
    private vertexBegin: WebGLTexture;
    private vertexFacets: WebGLTexture;
    private targets: WebGLFramebuffer[] = [];
    private hasNormals = false;
    private shown: BodyFrame | null = null;
    private scalar: Float32Array | null = null;

    constructor(
        private gl: Gl,
        readonly body: Body,
        canDrawFloats: boolean,
    ) {
        const kinds = textureKinds(gl);
        const { boundary, vertexCount } = body;
        const filled = (kind: TextureKind, data: Uint32Array, what: string) => {
            const texture = makeTexture(gl, kind, data.length / kind.perTexel, what);
            fillTexture(gl, texture, kind, data);
            return texture;
        };
        this.facets = filled(kinds.uint4, boundary.facets, "boundary facets");
        this.foldCount = boundary.folds.length / 8;
        this.folds = this.foldCount > 0 ? filled(kinds.uint4, boundary.folds, "folds") : null;
        this.vertexBegin = filled(kinds.uint1, boundary.vertexBegin, "vertices");
        this.vertexFacets = filled(kinds.uint1, boundary.vertexFacets, "corners");
        this.positions = makeTexture(gl, kinds.float4, vertexCount, "vertices");
        this.scalars = makeTexture(gl, kinds.float1, vertexCount, "vertices");
        this.cornerNormals = null;
        if (canDrawFloats) {
            this.facetNormals = makeTexture(gl, kinds.float4, boundary.facetCount, "facets");
            this.cornerNormals = makeTexture(gl, kinds.float4, 4 * boundary.facetCount, "corners");
            this.targets = [this.facetNormals, this.cornerNormals].map((texture) =>
                makeFramebuffer(gl, texture, null),
            );
        }
    }

    /** Shows the body at another moment. */
    setFrame(frame: BodyFrame): void {
        if (this.shown !== frame) {
            fillTexture(this.gl, this.positions, textureKinds(this.gl).float4, frame.positions);
            this.shown = frame;
            this.hasNormals = false;
        }
    }

    setScalars(values: Float32Array): void {
        if (this.scalar !== values) {
            fillTexture(this.gl, this.scalars, textureKinds(this.gl).float1, values);
            this.scalar = values;
        }
    }

    /** The highest coordinate along an axis after turning. */
    highest(rotation: ArrayLike<number>, axis: number): number {
        const p = this.shown!.positions;
        let highest = -Infinity;
        for (let v = 0; v < p.length; v += 4) {
            let place = 0;
            for (let k = 0; k < 4; ++k) {
                place += rotation[4 * axis + k]! * p[v + k]!;
            }
            highest = Math.max(highest, place);
        }
        return highest;
    }

    /** Makes the smooth normals of the frame shown, unless they are there.
     *
     * @param unit  1 / a usual length. */
    makeNormals(programs: NormalPrograms, unit: number): void {
        if (this.hasNormals || !this.cornerNormals) {
            return;
        }
        const gl = this.gl;
        const count = this.body.boundary.facetCount;
        gl.disable(gl.DEPTH_TEST);
        gl.disable(gl.BLEND);
        gl.disable(gl.CULL_FACE);
        const draw = (target: number, texels: number) => {
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[target]!);
            gl.viewport(0, 0, kTextureWidth, rowsFor(gl, texels, "facets"));
            gl.drawArrays(gl.TRIANGLES, 0, 3);
        };
        programs
            .facets()
            .use()
            .int("count", count)
            .int("dimension", this.body.dimension)
            .float("unit", unit)
            .texture("facets", 0, this.facets)
            .texture("positions", 1, this.positions);
        draw(0, count);
        programs
            .corners()
            .use()
            .int("count", count)
            .texture("facets", 0, this.facets)
            .texture("vertexBegin", 1, this.vertexBegin)
            .texture("vertexFacets", 2, this.vertexFacets)
            .texture("facetNormals", 3, this.facetNormals!);
        draw(1, 4 * count);
        this.hasNormals = true;
    }

    dispose(): void {
        const textures = [
            this.facets,
            this.folds,
            this.positions,
            this.scalars,
            this.cornerNormals,
            this.facetNormals,
            this.vertexBegin,
            this.vertexFacets,
        ];
        textures.forEach((texture) => this.gl.deleteTexture(texture));
        this.targets.forEach((target) => this.gl.deleteFramebuffer(target));
    }
}
