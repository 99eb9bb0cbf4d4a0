import { PentError } from "../format/error.ts";
import { multiply } from "../view/matrix.ts";
import type { Gl, Program } from "./gl.ts";
import { makeLight } from "./light.ts";
import type { Light } from "./light.ts";
import { tileRect } from "./picture.ts";
import type { Picture, Revolved, SliceView, Tile } from "./picture.ts";
import { LineDrawer } from "./lines.ts";
import { makePrograms } from "./programs.ts";
import { Surfaces } from "./surfaces.ts";
import { ShadowMap, Targets } from "./targets.ts";

const kMapSize = 256; // colors of a color map
const kShadowPixels = 2048;
const kGhostSlope = 2; // that ghosts are drawn further away, in depth from pixel to pixel
const kGhostSteps = 16; // and in the least that depths can differ
const kPushed = 0.02; // that sides seen from behind are drawn deeper, in normalized depth
const kVeil = 0.4; // of the rim of a hollow before what it hides

/** Draws pictures of bodies with WebGL 2. Knows nothing of the page around the canvas. */
export class Renderer {
    /** What is drawn. */
    readonly surfaces: Surfaces;
    private gl: Gl;
    private targets: Targets | null = null;
    private shadows: ShadowMap;
    private programs;
    private colorMap: WebGLTexture;
    private lines: LineDrawer;
    private plainArray: WebGLVertexArrayObject;
    private canDrawFloats: boolean;

    /** Whether the graphics card has stopped. */
    get isLost(): boolean {
        return this.gl.isContextLost();
    }

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
        this.surfaces = new Surfaces(gl, this.canDrawFloats);
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
            this.surfaces.makeNormals(this.programs, 100 / picture.radius);
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

    captureSlice(picture: Picture, body: number, w: number): Float32Array {
        this.gl.bindVertexArray(this.plainArray);
        return this.surfaces.captureSlice(this.programs.capture, picture, body, w);
    }

    captureRevolved(picture: Picture, surface: Revolved): Float32Array {
        this.gl.bindVertexArray(this.plainArray);
        return this.surfaces.captureRevolved(this.programs.capture, picture, surface);
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

    private drawShadows(picture: Picture, slice: SliceView, light: Light): void {
        const gl = this.gl;
        gl.disable(gl.SCISSOR_TEST);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadows.framebuffer);
        gl.viewport(0, 0, kShadowPixels, kShadowPixels);
        gl.enable(gl.DEPTH_TEST);
        gl.clear(gl.DEPTH_BUFFER_BIT);
        const nothing = () => {};
        const { shadow } = this.programs;
        this.surfaces.drawBodies(shadow, picture, slice.w, light.viewProjection, nothing);
        this.surfaces.drawObstacles(shadow, picture, slice, light.viewProjection, nothing);
    }

    private drawSolid(picture: Picture, tile: Tile, rect: readonly number[], light: Light): void {
        const gl = this.gl;
        const { camera, coloring } = picture;
        const slice = solidOf(tile);
        gl.enable(gl.DEPTH_TEST);
        gl.depthMask(true);
        gl.disable(gl.BLEND);
        gl.disable(gl.CULL_FACE);
        this.enter(rect);
        const prepare = (program: Program, body: number) =>
            lit(program, picture, light)
                .float("pushed", kPushed)
                .texture("colorMap", 4, this.colorMap)
                .float(
                    "bodyColor",
                    ...(body < 0
                        ? picture.obstacles!
                        : coloring.bodies[body % coloring.bodies.length]!),
                )
                .float("range", ...coloring.range);
        const { solid } = this.programs;
        const drawBodies = () =>
            this.surfaces.drawBodies(solid, picture, slice.w, camera.viewProjection, prepare);
        if (tile.rims.length > 0) {
            this.drawGround(picture, tile.rims, light);
            this.showThrough(drawBodies);
        }
        drawBodies();
        this.surfaces.drawObstacles(solid, picture, slice, camera.viewProjection, prepare);
        this.drawGround(picture, tile.surfaces, light);
        if (picture.floor !== null && tile.hasFloor && camera.eye[1] > picture.floor) {
            this.programs
                .floor()
                .use()
                .matrix("viewProjection", camera.viewProjection)
                .float(
                    "floorDisk",
                    picture.center[0],
                    picture.floor,
                    picture.center[2],
                    picture.ground,
                )
                .float("floorGlow", ...picture.background.glow);
            gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
        }
    }

    // Where it faces the eye, so that one looks into hollows and through walls from behind.
    private drawGround(picture: Picture, surfaces: Revolved[], light: Light): void {
        const gl = this.gl;
        gl.enable(gl.CULL_FACE);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        for (const surface of surfaces) {
            const program = lit(this.programs.ground().use(), picture, light)
                .float("bodyColor", ...picture.obstacles!)
                .float("scene", ...picture.center, picture.ground)
                .float("nearest", surface.nearest);
            this.surfaces.drawRevolved(program, surface, picture.camera.viewProjection);
        }
        gl.disable(gl.BLEND);
        gl.disable(gl.CULL_FACE);
    }

    // Draws what is behind something, through it.
    private showThrough(draw: () => void): void {
        const gl = this.gl;
        gl.depthFunc(gl.GREATER);
        gl.depthMask(false);
        gl.enable(gl.CULL_FACE);
        gl.enable(gl.BLEND);
        gl.blendColor(0, 0, 0, 1 - kVeil);
        gl.blendFunc(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA);
        draw();
        gl.disable(gl.BLEND);
        gl.disable(gl.CULL_FACE);
        gl.depthMask(true);
        gl.depthFunc(gl.LESS);
    }

    private drawGhosts(picture: Picture, tile: Tile, rect: readonly number[]): void {
        const gl = this.gl;
        const { camera, outline } = picture;
        this.enter(rect);
        gl.enable(gl.DEPTH_TEST);
        gl.depthMask(false);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        // What lies in the surface of a solid body, as sides along w do, would be seen in speckles.
        gl.enable(gl.POLYGON_OFFSET_FILL);
        gl.polygonOffset(kGhostSlope, kGhostSteps);
        const { ghost } = this.programs;
        for (const slice of tile.slices.filter((one) => one.ghost !== null)) {
            const prepare = (program: Program) =>
                program
                    .float("ghostColor", ...slice.ghost!)
                    .float("opacity", 0.1, 0.5)
                    .float("cameraEye", ...camera.eye);
            this.surfaces.drawBodies(ghost, picture, slice.w, camera.viewProjection, prepare);
            this.surfaces.drawObstacles(ghost, picture, slice, camera.viewProjection, prepare);
        }
        if (outline) {
            this.drawOutlines(picture, tile);
        }
        gl.disable(gl.POLYGON_OFFSET_FILL);
        if (tile.lines.length > 0) {
            this.lines.draw(this.programs.line(), picture, tile.lines, rect);
            gl.bindVertexArray(this.plainArray);
        }
        gl.depthMask(true);
        gl.disable(gl.BLEND);
    }

    // The film is the solid slice, so points of the slice keep their place.
    private drawOutlines(picture: Picture, tile: Tile): void {
        const { camera, outline } = picture;
        const prepare = (program: Program) =>
            program
                .float("ghostColor", ...outline!.color)
                .float("opacity", 0.05, 0.16)
                .float("cameraEye", ...camera.eye);
        this.surfaces.drawFolds(this.programs.fold(), picture, solidOf(tile).w, prepare);
        for (const ball of tile.outlines) {
            const program = prepare(this.programs.ghost.revolved().use());
            this.surfaces.drawRevolved(program, ball, camera.viewProjection);
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
        this.drawShadows(picture, solidOf(tile), light);
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

// Every tile has one.
function solidOf(tile: Tile): SliceView {
    return tile.slices.find((slice) => slice.ghost === null)!;
}

function lit(program: Program, { camera }: Picture, light: Light): Program {
    return program
        .float("cameraEye", ...camera.eye)
        .float("toKey", ...light.toKey)
        .float("toFill", ...light.toFill);
}
