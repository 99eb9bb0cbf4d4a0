import { PentError } from "../format/error.ts";
import type { Body, BodyFrame } from "../run/decode.ts";
import type { Matrix } from "../view/matrix.ts";
import { BodyBuffers } from "./body_buffers.ts";
import type { NormalPrograms } from "./body_buffers.ts";
import { captureTriangles } from "./capture.ts";
import type { Gl, Program } from "./gl.ts";
import type { Picture, Revolved, SliceView } from "./picture.ts";
import type { SurfacePrograms } from "./programs.ts";
import { profileOf } from "./revolved.ts";
import { kCircle } from "./shaders.ts";

/** Sets what is the same for a surface: of which body, or -1 for an obstacle. */
type Prepare = (program: Program, body: number) => void;

/** What a slice cuts - bodies, and obstacles that are boxes - and what is made by revolution. */
export class Surfaces {
    private bodies: BodyBuffers[] = [];
    private boxes: BodyBuffers[] = [];

    constructor(
        private gl: Gl,
        private canDrawFloats: boolean,
    ) {}

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

    /** Obstacles that are boxes, as bodies; all of them are drawn flat. */
    setBoxes(boxes: { body: Body; frame: BodyFrame }[]): void {
        this.boxes.splice(boxes.length).forEach((box) => box.dispose());
        boxes.forEach(({ body, frame }, i) => {
            if (this.boxes[i]?.body !== body) {
                this.boxes[i]?.dispose();
                this.boxes[i] = new BodyBuffers(this.gl, body, false);
            }
            this.boxes[i]!.setFrame(frame);
        });
    }

    makeNormals(programs: NormalPrograms, unit: number): void {
        this.bodies.forEach((body) => body.makeNormals(programs, unit));
    }

    /** Draws bodies. */
    drawBodies(
        programs: SurfacePrograms,
        picture: Picture,
        w: number,
        viewProjection: Matrix,
        prepare: Prepare,
    ): void {
        this.bodies.forEach((buffers, i) =>
            this.draw(programs, picture, buffers, w, viewProjection, (program) =>
                prepare(program, i),
            ),
        );
    }

    /** Draws obstacles that have an end. */
    drawObstacles(
        programs: SurfacePrograms,
        picture: Picture,
        slice: SliceView,
        viewProjection: Matrix,
        prepare: Prepare,
    ): void {
        const prepareIt = (program: Program) => {
            prepare(program, -1);
            program.int("valueOf", 0);
        };
        for (const box of picture.obstacles ? this.boxes : []) {
            this.draw(programs, picture, box, slice.w, viewProjection, prepareIt);
        }
        for (const ball of slice.balls) {
            prepareIt(programs.revolved().use());
            this.drawRevolved(programs.revolved(), ball, viewProjection);
        }
    }

    /** Draws with the program in use. */
    drawRevolved(program: Program, surface: Revolved, viewProjection: Matrix): void {
        const count = this.setRevolved(program, surface, viewProjection);
        this.gl.drawArrays(this.gl.TRIANGLES, 0, count);
    }

    /** Draws the outlines of bodies and boxes as an eye in the fourth dimension sees them.
     *
     * @param prepare  Sets all but the body's own. */
    drawFolds(program: Program, picture: Picture, film: number, prepare: (p: Program) => void) {
        const { camera, outline, shift } = picture;
        const distance = outline!.eye[3];
        const isBelowEye = (box: BodyBuffers) =>
            distance === 0 || box.highest(picture.rotation, 3) + shift[3] - film < distance;
        const boxes = picture.obstacles ? this.boxes.filter(isBelowEye) : [];
        for (const buffers of [...this.bodies, ...boxes]) {
            if (!buffers.folds) {
                continue;
            }
            prepare(
                program
                    .use()
                    .matrix("viewProjection", camera.viewProjection)
                    .matrix("rotation", columnsOf(picture))
                    .float("shift", shift[0], shift[1], shift[2], shift[3] - film)
                    .float("eye", ...outline!.eye)
                    .texture("positions", 0, buffers.positions)
                    .texture("folds", 1, buffers.folds),
            );
            this.gl.drawArraysInstanced(this.gl.TRIANGLES, 0, 3, buffers.foldCount);
        }
    }

    /** The triangles of a slice through a body, or through a box, which count behind the bodies: nine numbers each, in
     * the order of the boundary, as the shader makes them: caught by transform feedback. */
    captureSlice(programs: SurfacePrograms, picture: Picture, body: number, w: number) {
        const buffers = [...this.bodies, ...this.boxes][body]!;
        const is4 = buffers.body.dimension === 4;
        const program = (is4 ? programs.slice : programs.skin)().use();
        this.setBody(program, picture, buffers, w, picture.camera.viewProjection);
        program.int("isSmooth", 0);
        return captureTriangles(this.gl, is4 ? 6 : 3, buffers.body.boundary.facetCount);
    }

    captureRevolved(programs: SurfacePrograms, picture: Picture, surface: Revolved) {
        const program = programs.revolved().use();
        const count = this.setRevolved(program, surface, picture.camera.viewProjection);
        return captureTriangles(this.gl, count, 1);
    }

    private draw(
        programs: SurfacePrograms,
        picture: Picture,
        buffers: BodyBuffers,
        w: number,
        viewProjection: Matrix,
        prepare: (program: Program) => void,
    ): void {
        const is4 = buffers.body.dimension === 4;
        const program = (is4 ? programs.slice : programs.skin)().use();
        this.setBody(program, picture, buffers, w, viewProjection);
        prepare(program);
        this.gl.drawArraysInstanced(
            this.gl.TRIANGLES,
            0,
            is4 ? 6 : 3,
            buffers.body.boundary.facetCount,
        );
    }

    private setBody(
        program: Program,
        picture: Picture,
        buffers: BodyBuffers,
        w: number,
        viewProjection: Matrix,
    ) {
        const [x, y, z, ownW] = picture.shift;
        const valueOf = { nothing: 0, w: 1, scalar: 2 }[picture.coloring.valueOf];
        const isSmooth = picture.isSmooth && buffers.cornerNormals !== null;
        program
            .matrix("viewProjection", viewProjection)
            .matrix("rotation", columnsOf(picture))
            .float("shift", x, y, z, ownW - w)
            .int("valueOf", valueOf)
            .int("isSmooth", isSmooth ? 1 : 0)
            .texture("positions", 0, buffers.positions)
            .texture("facets", 1, buffers.facets)
            .texture("scalars", 2, buffers.scalars)
            .texture("cornerNormals", 3, buffers.cornerNormals ?? buffers.positions);
    }

    private setRevolved(program: Program, surface: Revolved, viewProjection: Matrix): number {
        const profile = profileOf(surface);
        program
            .matrix("viewProjection", viewProjection)
            .float("center", ...surface.center)
            .matrix3("axes", surface.axes)
            .int("isArc", surface.isArc ? 1 : 0)
            .float("side", Math.sign(surface.span[0] - surface.span[1]))
            .pairs("profile", profile);
        return 6 * kCircle * (profile.length / 2 - 1);
    }
}

// A rotation by rows, as WebGL takes it: by columns.
function columnsOf({ rotation }: Picture): Float32Array {
    return Float32Array.from(rotation, (_, i) => rotation[4 * (i % 4) + (i >> 2)]!);
}
