import { PentError } from "../format/error.ts";
import type { Picture } from "../render/picture.ts";
import { Renderer } from "../render/renderer.ts";
import { kColorings, quantityOf } from "../run/quantities.ts";
import type { Moment, Run } from "../run/run.ts";
import { FrameStream } from "../run/stream.ts";
import { Bounds, reachAlongW } from "./bounds.ts";
import { Boxes } from "./boxes.ts";
import type { Values } from "../mesh/quantities.ts";
import { inUnits, settled, suitableRange, unitOf } from "./colors.ts";
import { makeColoring, makePicture } from "./compose.ts";
import { Pace } from "./pace.ts";
import { orthonormalize, applyTurn } from "./rotation.ts";
import { defaultState } from "./state.ts";
import type { ViewState } from "./state.ts";

/** What a viewer tells those who listen. */
export interface ViewerEvents {
    state: ViewState; // it has changed
    run: Run; // another one is open, or it has more frames
    moment: Moment; // another one is shown
    picture: Picture; // one was drawn
    playing: boolean;
    waiting: number | null; // for this frame, to be shown next; null: no longer
    notice: { text: string; isError: boolean };
}

type Listeners = { [Kind in keyof ViewerEvents]: ((event: ViewerEvents[Kind]) => void)[] };

const kStopped = 3000; // ms that the graphics card may take to come back
const kSampledFrames = 5; // that bounds are taken from
const kAhead = 24; // frames to read ahead

/** A run, a view of it, and the canvas it is drawn on. Knows no controls. */
export class Viewer {
    state: ViewState = defaultState();
    run: Run | null = null;
    bounds = new Bounds();
    moment: Moment | null = null;
    isPlaying = false;
    theme: "light" | "dark" = "light";
    renderer: Renderer; // another one where the graphics card has come back
    private stream: FrameStream | null = null;
    private ranges = new Map<string, [number, number]>();
    private rangeDone = new Map<string, WeakSet<Moment>>();
    private unit = 1; // of the numbers that the renderer has
    private inUnits: { values: Values; floats: Float32Array }[] = []; // of each body
    private listeners: Listeners = {
        state: [],
        run: [],
        moment: [],
        picture: [],
        playing: [],
        waiting: [],
        notice: [],
    };
    private awaited: number | null = null; // frame
    private opening = 0; // counts, so that only the last of several openings counts
    private isDue = false;
    private size = { width: 1, height: 1, pixelRatio: 1 };
    private clock = 0; // place in time while playing, in frames
    private lastTick = 0;
    private boxes = new Boxes();
    private pace = new Pace(() => this.requestDraw());
    secondsPerFrame = 1 / 30; // of the run, in the mean

    constructor(readonly canvas: HTMLCanvasElement) {
        this.renderer = new Renderer(canvas);
        // Phones stop it when another page is looked at.
        canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault(); // so that it may come back
            setTimeout(() => this.sayStopped(), kStopped);
        });
        canvas.addEventListener("webglcontextrestored", () => this.restore());
    }

    on<Kind extends keyof ViewerEvents>(kind: Kind, listener: (event: ViewerEvents[Kind]) => void) {
        this.listeners[kind].push(listener);
    }

    /** Shows a run from now on. Rejects, and keeps the old one, where its first frames fail.
     *
     * @return  Whether it is shown: not where another one was to be opened meanwhile. */
    async open(run: Run, state: ViewState): Promise<boolean> {
        const turn = ++this.opening;
        const count = run.frames.length;
        const places = [
            ...new Set(
                Array.from({ length: kSampledFrames }, (_, i) =>
                    Math.round((i * (count - 1)) / (kSampledFrames - 1)),
                ),
            ),
        ];
        const moments: Moment[] = [];
        for (const place of places) {
            moments.push(await run.load(run.frames[place]!));
        }
        if (turn !== this.opening) {
            return false;
        }
        const bounds = new Bounds();
        const seen = run.stage ? [...moments, run.stage] : moments;
        bounds.add(seen);
        bounds.settle(seen);
        if (!this.renderer.isLost) {
            this.renderer.surfaces.setBodies(run.bodies);
        }
        this.run?.close();
        this.pause();
        this.run = run;
        this.bounds = bounds;
        this.moment = null;
        this.ranges.clear();
        this.rangeDone.clear();
        const last = moments.at(-1)!;
        this.secondsPerFrame =
            count > 1 && last.time > moments[0]!.time
                ? (last.time - moments[0]!.time) / (count - 1)
                : 1 / 30;
        this.stream = new FrameStream(run, (place) => this.onArrival(place));
        this.state = state;
        this.seek(this.placeOf(state.frame ?? run.frames[0]!));
        this.tell("run", run);
        this.tell("state", state);
        return true;
    }

    /** Changes the view. */
    update(patch: Partial<ViewState>): void {
        const needsFrame =
            (patch.color !== undefined && patch.color !== this.state.color) ||
            patch.range !== undefined;
        this.state = { ...this.state, ...patch };
        if (patch.frame !== undefined && !this.run?.stage) {
            const { place } = this;
            this.clock = Math.floor(this.clock) === place ? this.clock : place;
            this.seek(place);
        }
        if (needsFrame && this.moment) {
            this.show(this.moment);
        }
        this.tell("state", this.state);
        this.requestDraw();
    }

    /** Turns the bodies further in a plane, by degrees. */
    turn(from: number, to: number, degrees: number): void {
        const rotation = this.state.rotation.slice();
        applyTurn(rotation, from, to, degrees);
        orthonormalize(rotation);
        this.update({ rotation });
    }

    /** Place among the frames of the run of a frame's number, or of the one before it. */
    placeOf(frame: number): number {
        const frames = this.run?.frames ?? [0];
        const after = frames.findIndex((number) => number > frame);
        return Math.max(0, (after < 0 ? frames.length : after) - 1);
    }

    get place(): number {
        return this.placeOf(this.state.frame ?? this.run?.frames[0] ?? 0);
    }

    /** So many frames on, or back. */
    step(by: number): void {
        if (!this.run) {
            return;
        }
        const count = this.run.frames.length;
        const next = this.place + by;
        const place = this.state.loop
            ? ((next % count) + count) % count
            : Math.min(Math.max(next, 0), count - 1);
        this.pause();
        this.update({ frame: this.run.frames[place]! });
    }

    play(): void {
        if (this.isPlaying || !this.run || this.run.frames.length < 2) {
            return;
        }
        const isAtEnd = this.place === this.run.frames.length - 1;
        this.clock = isAtEnd && !this.run.isGrowing ? 0 : this.place;
        this.isPlaying = true;
        this.lastTick = performance.now();
        this.tell("playing", true);
        this.requestDraw();
    }

    pause(): void {
        if (this.isPlaying) {
            this.isPlaying = false;
            this.wait(null);
            this.tell("playing", false);
        }
    }

    /** How many frames from the one shown on are here. */
    get ready(): number {
        return this.stream?.readyFrom(this.place, 1) ?? 0;
    }

    /** Bytes of frames that are kept. */
    get bytes(): number {
        return this.stream?.bytes ?? 0;
    }

    /** Looks whether a run that is being written has got further. */
    async refresh(): Promise<void> {
        const run = this.run;
        if (run && (await run.refresh()) && run === this.run) {
            this.tell("run", run);
            this.stream!.want(this.place, kAhead, this.state.loop);
        }
    }

    /** Shows a moment that is no frame of the run: of a simulation that goes on. */
    present(moment: Moment): void {
        this.bounds.follow(moment);
        this.show(moment);
    }

    resize(width: number, height: number, pixelRatio: number): void {
        this.size = { width: Math.max(1, width), height: Math.max(1, height), pixelRatio };
        this.requestDraw();
    }

    setTheme(theme: "light" | "dark"): void {
        this.theme = theme;
        this.requestDraw();
    }

    /** The range of the colors shown. */
    get range(): [number, number] {
        const { bounds, state } = this;
        if (state.range) {
            return state.range;
        }
        return settled(
            state.color === "w"
                ? [bounds.low[3]!, bounds.high[3]!]
                : (this.ranges.get(state.color) ?? [0, 1]),
        );
    }

    // As the renderer has it.
    private get shownRange(): [number, number] {
        const [low, high] = this.range;
        return [low * this.unit, high * this.unit];
    }

    /** What the moment shown can be colored by, or could if its run had it, by the names that pent-render knows. */
    get colorings(): { name: string; isThere: boolean }[] {
        const bodies = this.moment?.bodies ?? [];
        const fields = bodies.flatMap(({ quantities }, i) => [
            ...quantities.keys(),
            ...this.run!.bodies[i]!.fields.keys(),
        ]);
        const ours = kColorings.filter((name) => name !== "w" || this.run?.dimension === 4);
        return [...new Set([...ours, ...fields])].map((name) => ({
            name,
            isThere:
                name === "body" ||
                name === "w" ||
                (name === "strain" && this.run?.addStrain !== undefined) ||
                bodies.every((_, i) => this.quantity(name, i)),
        }));
    }

    /** The picture of the view, of any size in pixels. */
    makePicture(width: number, height: number, pixelRatio: number): Picture {
        const { rotation } = this.state;
        const shift = this.bounds.shift(rotation)[3];
        return makePicture(this.state, {
            width,
            height,
            pixelRatio,
            theme: this.theme,
            dimension: this.run?.dimension ?? 4,
            bounds: this.bounds,
            obstacles: this.moment?.obstacles ?? [],
            reach: this.moment && reachAlongW(this.moment, rotation, shift),
            coloring: makeColoring(this.state, this.shownRange, this.run?.bodies.length ?? 1),
        });
    }

    requestDraw(): void {
        if (!this.isDue) {
            this.isDue = true;
            requestAnimationFrame((now) => this.tick(now));
        }
    }

    /** Draws at once. */
    drawNow(): Picture | null {
        if (!this.run || !this.moment || this.renderer.isLost) {
            return null;
        }
        const { width, height, pixelRatio } = this.size;
        const scale = this.pace.scale;
        const picture = this.makePicture(
            Math.round(width * pixelRatio * scale),
            Math.round(height * pixelRatio * scale),
            pixelRatio * scale,
        );
        this.renderer.draw(picture);
        this.tell("picture", picture);
        return picture;
    }

    private tell<Kind extends keyof ViewerEvents>(kind: Kind, event: ViewerEvents[Kind]): void {
        this.listeners[kind].forEach((listener) => listener(event));
    }

    private sayStopped(): void {
        if (this.renderer.isLost) {
            const text = "graphics: the graphics card has stopped; reload the page";
            this.tell("notice", { text, isError: true });
        }
    }

    // What is shown, on the graphics card that has come back.
    private restore(): void {
        this.renderer = new Renderer(this.canvas);
        if (this.run) {
            this.renderer.surfaces.setBodies(this.run.bodies);
        }
        if (this.moment) {
            this.show(this.moment);
        }
    }

    private tick(now: number): void {
        this.isDue = false;
        if (this.isPlaying) {
            this.advance(now);
        }
        this.pace.measure(now);
        this.drawNow();
        if (this.isPlaying) {
            this.requestDraw();
        }
    }

    private advance(now: number): void {
        const run = this.run!;
        const seconds = Math.min((now - this.lastTick) / 1000, 0.25) * this.state.speed;
        this.lastTick = now;
        const next = this.clock + seconds / this.secondsPerFrame;
        const count = run.frames.length;
        if (next >= count) {
            if (!this.state.loop && !run.isGrowing) {
                this.pause();
                return;
            }
            this.clock = this.state.loop && !run.isGrowing ? next % count : count - 1;
        } else if (this.stream!.get(Math.floor(next)) || this.stream!.failure(Math.floor(next))) {
            this.clock = next;
        } else {
            this.stream!.want(Math.floor(next), kAhead, this.state.loop);
            this.wait(run.frames[Math.floor(next)]!);
            return;
        }
        const place = Math.floor(this.clock);
        if (place !== this.place) {
            this.update({ frame: run.frames[place]! });
        }
    }

    private seek(place: number): void {
        if (!this.stream || !this.run) {
            return;
        }
        this.stream.want(place, this.run.frames.length > 1 ? kAhead : 0, this.state.loop);
        const moment = this.stream.get(place);
        if (moment && moment !== this.moment) {
            this.show(moment);
        }
        const failure = this.stream.failure(place);
        this.wait(moment || failure ? null : this.run.frames[place]!);
        if (failure) {
            this.tell("notice", { text: failure.message, isError: true });
        }
    }

    private wait(frame: number | null): void {
        if (frame !== this.awaited) {
            this.awaited = frame;
            this.tell("waiting", frame);
        }
    }

    private onArrival(place: number): void {
        if (place === this.place) {
            this.seek(place);
            this.requestDraw();
        }
    }

    private show(moment: Moment): void {
        const isNew = moment !== this.moment;
        this.moment = moment;
        const { color } = this.state;
        if (!this.colorings.find(({ name }) => name === color)?.isThere) {
            this.refuseColor(color);
        } else if (color === "strain" && moment.bodies.some((_, i) => !this.quantity(color, i))) {
            void this.addStrain(moment);
        }
        this.growRange(moment);
        if (!this.renderer.isLost) {
            const { surfaces } = this.renderer;
            surfaces.setBoxes(this.boxes.of(moment.obstacles, this.run!.dimension));
            surfaces.setFrame(moment.bodies, this.scalars());
        }
        if (isNew) {
            this.tell("moment", moment);
        }
        this.requestDraw();
    }

    // Of a body at the moment shown.
    private quantity(name: string, body: number): Values | undefined {
        return quantityOf(this.run!.bodies[body]!, this.moment!.bodies[body]!, name);
    }

    private refuseColor(color: string): void {
        this.tell("notice", { text: this.refusalOf(color), isError: true });
        this.state = { ...this.state, color: "body", range: null };
        this.tell("state", this.state);
    }

    private refusalOf(color: string): string {
        if (color === "w") {
            return "bodies of three dimensions have no w to color by";
        }
        if (color === "speed") {
            return "here is no speed to color by; open a run of pent-sim";
        }
        if (color === "strain") {
            return "here is no strain to color by: it needs the cells, and the mesh at rest";
        }
        const { bodies } = this.run!;
        const where = bodies.find((_, i) => !this.quantity(color, i))!;
        const frame = `frame ${this.moment!.frame} of "${where.name}" has`;
        if (kColorings.includes(color) && this.run!.stage) {
            return `the playground has no ${color} to color by; pent-sim writes it`;
        }
        if (kColorings.includes(color)) {
            const asked = color === "force" ? "contact_force" : color;
            return (
                `${frame} no ${color === "force" ? "contact forces" : color} to color by; ` +
                `run the scene with [output] vertex = ["${asked}"]`
            );
        }
        const names = this.colorings.filter(({ isThere }) => isThere).map(({ name }) => name);
        return `${frame} nothing called "${color}" to color by; there are ${names.join(", ")}`;
    }

    private async addStrain(moment: Moment): Promise<void> {
        try {
            await this.run!.addStrain!(moment);
            this.stream?.recount(this.placeOf(moment.frame), moment);
        } catch (error) {
            if (!(error instanceof PentError)) {
                throw error;
            }
            return; // another run was opened meanwhile
        }
        if (moment === this.moment && this.state.color === "strain") {
            this.show(moment);
        }
    }

    // What the renderer colors each body by, in units of the range: which may differ from frame to frame.
    private scalars(): (Float32Array | null)[] {
        const { color } = this.state;
        const bodies = this.run!.bodies;
        if (color === "body" || color === "w") {
            this.unit = 1;
            this.inUnits = [];
            return bodies.map(() => null);
        }
        const unit = unitOf(this.range);
        this.inUnits = bodies.map(({ vertexCount }, i) => {
            const values = this.quantity(color, i) ?? new Float32Array(vertexCount);
            const known = this.inUnits[i];
            return known?.values === values && unit === this.unit
                ? known
                : { values, floats: inUnits(values, unit) };
        });
        this.unit = unit;
        return this.inUnits.map(({ floats }) => floats);
    }

    private growRange(moment: Moment): void {
        const { color } = this.state;
        const done = this.rangeDone.get(color) ?? new WeakSet();
        this.rangeDone.set(color, done);
        const values = moment.bodies.map((_, i) => this.quantity(color, i));
        if (done.has(moment) || values.some((one) => !one)) {
            return;
        }
        done.add(moment);
        for (const one of values) {
            const [low, high] = suitableRange(one!, color);
            const known = this.ranges.get(color);
            this.ranges.set(
                color,
                known ? [Math.min(low, known[0]), Math.max(high, known[1])] : [low, high],
            );
        }
    }
}
