import { PentError } from "../format/error.ts";
import type { Body, BodyFrame } from "../run/decode.ts";
import { multiply } from "../view/matrix.ts";
import type { Matrix } from "../view/matrix.ts";
import { BodyBuffers } from "./body_buffers.ts";
import type { Gl, Program } from "./gl.ts";
import { captureTriangles } from "./capture.ts";
import { makeLight } from "./light.ts";
import type { Light } from "./light.ts";
import { tileRect } from "./picture.ts";
import type { Picture, SliceView, Tile } from "./picture.ts";
import { LineDrawer } from "./lines.ts";
import { makePrograms } from "./programs.ts";
import type { Lazy } from "./programs.ts";
import { ShadowMap, Targets } from "./targets.ts";

const kMapSize = 256; // colors of a color map
const kShadowPixels = 2048;

/** Draws pictures of bodies with WebGL 2. Knows nothing of the page around the canvas. */
export class Renderer {
    private gl: Gl;
    private bodies: BodyBuffers[] = [];
    private targets: Targets | null = null;
    private shadows: ShadowMap;
    private programs;
    private colorMap: WebGLTexture;
    private lines: LineDrawer;
    private plainArray: WebGLVertexArrayObject;
    private canDrawFloats: boolean;

    /** Throws a PentError where WebGL 2 is not there. */
    constructor(readonly canvas: HTMLCanvasElement | OffscreenCanvas) {
        const gl = canvas.getContext("webgl2", {
            antialias: false,
            depth: false,
            alpha: false,
            powerPreference: "high-performance",
        }) as Gl | null;
        if (!gl) {
            throw new PentError(
                "graphics: this browser has no WebGL 2, which draws the slices; " +
                    "switch hardware acceleration on, or try another browser",
            );
        }
        this.gl = gl;
        this.canDrawFloats = gl.getExtension("EXT_color_buffer_float") !== null;
        this.programs = makePrograms(gl);
        this.shadows = new ShadowMap(gl, kShadowPixels);
        this.colorMap = gl.createTexture()!;
        gl.bindTexture(gl.TEXTURE_2D, this.colorMap);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, kMapSize, 1);
        for (const [key, value] of [
            [gl.TEXTURE_MIN_FILTER, gl.NEAREST],
            [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
            [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
            [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
        ] as const) {
            gl.texParameteri(gl.TEXTURE_2D, key, value);
        }
        this.plainArray = gl.createVertexArray()!;
        this.lines = new LineDrawer(gl);
    }

    /** Whether smooth normals are possible here. */
    get hasSmoothNormals(): boolean {
        return this.canDrawFloats;
    }

    /** The bodies to draw from now on. Throws a PentError where they do not fit on the card. */
    setBodies(bodies: Body[]): void {
        this.bodies.forEach((body) => body.dispose());
        this.bodies = [];
        while (this.gl.getError() !== this.gl.NO_ERROR) {
            // of earlier calls
            if (this.gl.isContextLost()) {
                break;
            }
        }
        this.bodies = bodies.map((body) => new BodyBuffers(this.gl, body, this.canDrawFloats));
        if (this.gl.getError() === this.gl.OUT_OF_MEMORY) {
            throw new PentError(
                "graphics: the memory of the graphics card is not enough for this " +
                    "mesh; open a coarser one",
            );
        }
    }

    /** The moment to draw, and one value a vertex of each body to color by, if asked for. */
    setFrame(frames: BodyFrame[], scalars: (Float32Array | null)[]): void {
        this.bodies.forEach((body, i) => {
            body.setFrame(frames[i]!);
            const values = scalars[i];
            if (values) {
                body.setScalars(values);
            }
        });
    }

    draw(picture: Picture): void {
        const gl = this.gl;
        if (gl.isContextLost()) {
            return;
        }
        this.resize(picture.width, picture.height);
        this.fillColorMap(picture);
        gl.bindVertexArray(this.plainArray);
        gl.disable(gl.SCISSOR_TEST);
        if (picture.isSmooth) {
            this.bodies.forEach((body) => body.makeNormals(this.programs, 100 / picture.radius));
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets!.sampled);
        gl.clearColor(0, 0, 0, 0);
        gl.clearDepth(1);
        gl.depthMask(true);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        const light = makeLight(picture);
        picture.tiles.forEach((tile, i) =>
            this.drawSolid(picture, tile, tileRect(picture, i), light),
        );
        gl.disable(gl.SCISSOR_TEST);
        const targets = this.targets!;
        targets.resolve(
            targets.sampled,
            0,
            targets.solid,
            gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT,
        );
        targets.resolve(targets.sampled, 1, targets.lamp, gl.COLOR_BUFFER_BIT);
        // Into a color buffer of its own: some drivers let what is cleared after a resolve take
        // part in it.
        gl.bindFramebuffer(gl.FRAMEBUFFER, targets.sampledGhosts);
        gl.clear(gl.COLOR_BUFFER_BIT);
        picture.tiles.forEach((tile, i) => this.drawGhosts(picture, tile, tileRect(picture, i)));
        gl.disable(gl.SCISSOR_TEST);
        targets.resolve(targets.sampledGhosts, 0, targets.ghosts, gl.COLOR_BUFFER_BIT);
        picture.tiles.forEach((tile, i) => {
            const rect = tileRect(picture, i);
            if (picture.isShaded) {
                this.occlude(picture, tile, rect, light);
            }
            this.compose(picture, rect);
        });
        const places = Math.ceil(picture.tiles.length / picture.columns) * picture.columns;
        for (let i = picture.tiles.length; i < places; ++i) {
            // a gap in the last row
            this.compose(picture, tileRect(picture, i));
        }
    }

    /** The triangles of a slice through a body, nine numbers each, in the order of the boundary, as
     * the shader makes them: caught by transform feedback. */
    captureSlice(picture: Picture, body: number, w: number): Float32Array {
        const buffers = this.bodies[body]!;
        const { slice, skin } = this.programs.capture;
        const is4 = buffers.body.dimension === 4;
        const program = (is4 ? slice : skin)().use();
        this.gl.bindVertexArray(this.plainArray);
        this.setBody(program, picture, buffers, w, picture.camera.viewProjection);
        program.int("isSmooth", 0);
        return captureTriangles(this.gl, is4 ? 6 : 3, buffers.body.boundary.facetCount);
    }

    private resize(width: number, height: number): void {
        if (this.targets?.width !== width || this.targets.height !== height) {
            this.targets?.dispose();
            this.targets = new Targets(this.gl, width, height);
        }
        if (this.canvas.width !== width || this.canvas.height !== height) {
            this.canvas.width = width;
            this.canvas.height = height;
        }
    }

    private fillColorMap({ coloring: { map } }: Picture): void {
        const texels = new Float32Array(4 * kMapSize);
        map.slice(0, kMapSize).forEach((color, i) => texels.set([...color, 1], 4 * i));
        const gl = this.gl;
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D, this.colorMap);
        gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, kMapSize, 1, gl.RGBA, gl.FLOAT, texels);
    }

    private enter(rect: readonly number[]): void {
        const [x, y, width, height] = rect as [number, number, number, number];
        this.gl.viewport(x, y, width, height);
        this.gl.scissor(x, y, width, height);
        this.gl.enable(this.gl.SCISSOR_TEST);
    }

    private setBody(
        program: Program,
        picture: Picture,
        buffers: BodyBuffers,
        w: number,
        m: Matrix,
    ) {
        const [x, y, z, ownW] = picture.shift;
        const valueOf = { nothing: 0, w: 1, scalar: 2 }[picture.coloring.valueOf];
        const isSmooth = picture.isSmooth && buffers.cornerNormals !== null;
        program
            .matrix("viewProjection", m)
            .matrix("rotation", columnsOf(picture))
            .float("shift", x, y, z, ownW - w)
            .int("valueOf", valueOf)
            .int("isSmooth", isSmooth ? 1 : 0)
            .texture("positions", 0, buffers.positions)
            .texture("facets", 1, buffers.facets)
            .texture("scalars", 2, buffers.scalars)
            .texture("cornerNormals", 3, buffers.cornerNormals ?? buffers.positions);
    }

    private drawBody(
        program: { slice: Lazy; skin: Lazy },
        picture: Picture,
        buffers: BodyBuffers,
        w: number,
        viewProjection: Matrix,
        prepare: (p: Program) => void,
    ): void {
        const is4 = buffers.body.dimension === 4;
        const chosen = (is4 ? program.slice : program.skin)().use();
        this.setBody(chosen, picture, buffers, w, viewProjection);
        prepare(chosen);
        this.gl.drawArraysInstanced(
            this.gl.TRIANGLES,
            0,
            is4 ? 6 : 3,
            buffers.body.boundary.facetCount,
        );
    }

    private drawShadows(picture: Picture, slice: SliceView, light: Light): void {
        const gl = this.gl;
        gl.disable(gl.SCISSOR_TEST);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadows.framebuffer);
        gl.viewport(0, 0, kShadowPixels, kShadowPixels);
        gl.enable(gl.DEPTH_TEST);
        gl.clear(gl.DEPTH_BUFFER_BIT);
        for (const buffers of this.bodies) {
            this.drawBody(
                this.programs.shadow,
                picture,
                buffers,
                slice.w,
                light.viewProjection,
                () => {},
            );
        }
    }

    private drawSolid(picture: Picture, tile: Tile, rect: readonly number[], light: Light): void {
        const gl = this.gl;
        const { camera, coloring } = picture;
        const solid = tile.slices.find((slice) => slice.ghost === null);
        gl.enable(gl.DEPTH_TEST);
        gl.depthMask(true);
        gl.disable(gl.BLEND);
        gl.disable(gl.CULL_FACE);
        this.enter(rect);
        if (solid) {
            this.bodies.forEach((buffers, i) => {
                this.drawBody(
                    this.programs.solid,
                    picture,
                    buffers,
                    solid.w,
                    camera.viewProjection,
                    (program) =>
                        program
                            .texture("colorMap", 4, this.colorMap)
                            .float("bodyColor", ...coloring.bodies[i % coloring.bodies.length]!)
                            .float("range", ...coloring.range)
                            .float("cameraEye", ...camera.eye)
                            .float("toKey", ...light.toKey)
                            .float("toFill", ...light.toFill),
                );
            });
        }
        if (picture.floor !== null && camera.eye[1] > picture.floor) {
            this.programs
                .floor()
                .use()
                .matrix("viewProjection", camera.viewProjection)
                .float(
                    "floorDisk",
                    picture.center[0],
                    picture.floor,
                    picture.center[2],
                    2.6 * picture.radius,
                )
                .float("floorGlow", ...picture.background.glow);
            gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
        }
    }

    private drawGhosts(picture: Picture, tile: Tile, rect: readonly number[]): void {
        const gl = this.gl;
        const { camera, outline } = picture;
        this.enter(rect);
        gl.enable(gl.DEPTH_TEST);
        gl.depthMask(false);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        for (const slice of tile.slices.filter((one) => one.ghost !== null)) {
            for (const buffers of this.bodies) {
                this.drawBody(
                    this.programs.ghost,
                    picture,
                    buffers,
                    slice.w,
                    camera.viewProjection,
                    (program) =>
                        program
                            .float("ghostColor", ...slice.ghost!)
                            .float("opacity", 0.1, 0.5)
                            .float("cameraEye", ...camera.eye),
                );
            }
        }
        if (outline) {
            this.drawOutline(picture, tile);
        }
        if (tile.lines.length > 0) {
            this.lines.draw(this.programs.line(), picture, tile.lines, rect);
            gl.bindVertexArray(this.plainArray);
        }
        gl.depthMask(true);
        gl.disable(gl.BLEND);
    }

    // The film is the solid slice, so points of the slice keep their place.
    private drawOutline(picture: Picture, tile: Tile): void {
        const gl = this.gl;
        const { camera, outline, shift } = picture;
        const film = tile.slices.find((slice) => slice.ghost === null)?.w ?? 0;
        for (const buffers of this.bodies) {
            if (!buffers.folds) {
                continue;
            }
            this.programs
                .fold()
                .use()
                .matrix("viewProjection", camera.viewProjection)
                .matrix("rotation", columnsOf(picture))
                .float("shift", shift[0], shift[1], shift[2], shift[3] - film)
                .float("eye", ...outline!.eye)
                .float("ghostColor", ...outline!.color)
                .float("opacity", 0.05, 0.16)
                .float("cameraEye", ...camera.eye)
                .texture("positions", 0, buffers.positions)
                .texture("folds", 1, buffers.folds);
            gl.drawArraysInstanced(gl.TRIANGLES, 0, 3, buffers.foldCount);
        }
    }

    private setDepth(program: Program, { camera }: Picture, rect: readonly number[]): Program {
        const [x, y, width, height] = rect as [number, number, number, number];
        return program
            .use()
            .texture("depths", 0, this.targets!.depth)
            .int4("tile", [x, y, width, height])
            .float("lens", (camera.slope * width) / height, camera.slope, camera.near, camera.far);
    }

    // The shadow map is that of the tile.
    private occlude(picture: Picture, tile: Tile, rect: readonly number[], light: Light): void {
        const gl = this.gl;
        const { camera } = picture;
        this.drawShadows(picture, tile.slices.find((slice) => slice.ghost === null)!, light);
        gl.disable(gl.DEPTH_TEST);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets!.occlusion);
        this.enter(rect);
        const toWorld = Float32Array.of(
            ...camera.right,
            0,
            ...camera.up,
            0,
            ...camera.back,
            0,
            ...camera.eye,
            1,
        );
        this.setDepth(this.programs.occlusion(), picture, rect)
            .float("reach", 0.16 * picture.radius)
            .float("perMeter", rect[3]! / (2 * camera.slope))
            .matrix("lightMatrix", multiply(light.toMap, toWorld))
            .float("lightSize", light.width / kShadowPixels, light.depth, light.width)
            .texture("shadowMap", 5, this.shadows.texture, this.shadows.compared)
            .texture("shadowDepths", 6, this.shadows.texture, this.shadows.plain);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    private compose(picture: Picture, rect: readonly number[]): void {
        const gl = this.gl;
        const targets = this.targets!;
        gl.disable(gl.DEPTH_TEST);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        this.enter(rect);
        this.setDepth(this.programs.compose(), picture, rect)
            .texture("sky", 1, targets.skyColor)
            .texture("lamp", 2, targets.lampColor)
            .texture("ghosts", 3, targets.ghostColor)
            .texture("occlusion", 4, targets.occlusionColor)
            .int("hasOcclusion", picture.isShaded ? 1 : 0)
            .float("top", ...picture.background.top)
            .float("bottom", ...picture.background.bottom);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
}

// A rotation by rows, as WebGL takes it: by columns.
function columnsOf({ rotation }: Picture): Float32Array {
    return Float32Array.from(rotation, (_, i) => rotation[4 * (i % 4) + (i >> 2)]!);
}
