import { PentError } from "../format/error.ts";
import type { Mesh } from "../format/mesh.ts";
import { readMesh } from "../format/pent_file.ts";
import { makeBoundary } from "../mesh/boundary.ts";
import { lengths, makeRestCells, toFloat4, vertexFields } from "../mesh/quantities.ts";
import type { BodyFrame } from "../run/decode.ts";
import { namedFields } from "../run/quantities.ts";
import type { Quantities } from "../run/quantities.ts";
import type { Moment } from "../run/run.ts";
import { makeEmpty, write } from "./folders.ts";
import type { Hit, Library, Ray, Simulation, StepReport } from "./library.ts";
import { Pace } from "./pace.ts";
import type { OpenedScene, PlayFacts, PlayStats, RunFiles, SceneFiles } from "./protocol.ts";
import { Recording } from "./recording.ts";

const kFolder = "/scene"; // of the module's file system
// A hand pulls as a spring does that lets the body's whole mass swing two times a second, well damped.
const kHandStiffness = 160; // N/m for each kg
const kHandDamping = 12; // N s/m for each kg
const kUsualRate = 60; // steps a second

type Notice = (text: string, isError: boolean) => void;

/** A simulation that a person plays with: one scene, one hand. Knows nothing of threads and pages. */
export class Playground {
    private simulation: Simulation | null = null;
    private path = "";
    private files: SceneFiles = new Map();
    private pace = new Pace();
    private settings = { stiffness: 1, damping: 0, stepsPerSecond: kUsualRate };
    private isAutomatic = true;
    private gravity: number[] = [];
    private hand: number | null = null;
    private refusals = 0; // in a row
    private report: StepReport | null = null;
    private frame = 0;
    private cells = 0;
    private recording: Recording | null = null;

    constructor(
        private library: Library,
        private notice: Notice,
    ) {}

    /** Opens a scene in place of the one before, which stays if that fails.
     *
     * @param files  The scene file and its meshes, by path. */
    open(files: SceneFiles, path: string): OpenedScene {
        const simulation = this.openFiles(files, path);
        this.simulation?.close();
        this.path = path;
        this.files = files;
        this.forget();
        this.begin(simulation);
        return {
            dimension: simulation.dimension,
            bodies: this.meshes().map((mesh, body) => ({
                name: simulation.name(body),
                dimension: simulation.dimension,
                vertexCount: mesh.vertexCount,
                cellCount: mesh.cellCount,
                boundary: makeBoundary(mesh, simulation.name(body)),
                fields: this.fieldsOf(body),
            })),
            rests: this.meshes(),
            moment: this.moment(),
            facts: this.facts,
        };
    }

    get isOpen(): boolean {
        return this.simulation !== null;
    }

    get facts(): PlayFacts {
        const { gravity, settings, isAutomatic } = this;
        return { ...settings, gravity, isAutomatic };
    }

    get time(): number {
        return this.held.time;
    }

    /** s, of one step. */
    get timeStep(): number {
        return 1 / this.settings.stepsPerSecond;
    }

    /** Back to the start of the scene; what was set stays, and what is recorded begins anew. */
    reset(): void {
        const isRecording = this.recording !== null;
        this.reopen(null);
        this.forget();
        this.held.setGravity(this.gravity);
        if (isRecording) {
            this.startRecording();
        }
    }

    grab(ray: Ray): Hit | null {
        this.release();
        const hit = this.held.pick(ray);
        if (hit) {
            const mass = this.held.mass(hit.body);
            const stiffness = kHandStiffness * mass;
            const damping = kHandDamping * mass;
            this.hand = this.held.addGrab({ hit, anchor: hit.place, stiffness, damping });
        }
        return hit;
    }

    move(anchor: number[]): void {
        if (this.hand !== null) {
            this.held.moveGrab(this.hand, anchor);
        }
    }

    release(): void {
        if (this.hand !== null) {
            this.held.removeGrab(this.hand);
            this.hand = null;
        }
    }

    setGravity(gravity: number[]): void {
        this.held.setGravity(gravity);
        this.gravity = gravity;
    }

    /** Changes settings and goes on from the state there is. Null: steps adapt to the machine. */
    tune(stiffness: number, damping: number, stepsPerSecond: number | null): PlayFacts {
        const before = { settings: this.settings, isAutomatic: this.isAutomatic };
        this.isAutomatic = stepsPerSecond === null;
        this.settings = {
            stiffness,
            damping,
            stepsPerSecond: stepsPerSecond ?? before.settings.stepsPerSecond,
        };
        try {
            this.reopen(this.held);
        } catch (error) {
            Object.assign(this, before);
            throw error;
        }
        return this.facts;
    }

    /** One time step. A step that cannot be solved is said, and what may have been too much ends: the hand lets
     * go, then all bodies stop, then the scene begins anew.
     *
     * @return  Whether it was taken. */
    step(now: () => number): boolean {
        const begin = now();
        try {
            this.report = this.held.step();
        } catch (error) {
            if (!(error instanceof PentError)) {
                throw error; // the module itself has failed
            }
            this.recover(error);
            return false;
        }
        this.refusals = 0;
        this.pace.add(now() - begin);
        this.record();
        return true;
    }

    /** Takes longer steps, or shorter ones, if the machine asks for it.
     *
     * @return  Whether something changed. */
    adapt(): boolean {
        const { stepsPerSecond } = this.settings;
        const rate = this.isAutomatic ? this.pace.advise(stepsPerSecond) : stepsPerSecond;
        if (rate === stepsPerSecond) {
            return false;
        }
        this.settings = { ...this.settings, stepsPerSecond: rate };
        this.reopen(this.held);
        return true;
    }

    /** All bodies as they are now. */
    moment(): Moment {
        const { held } = this;
        const size = (vectors: Float64Array) => lengths(vectors, held.dimension);
        const bodies = Array.from({ length: held.bodyCount }, (_, body): BodyFrame => {
            const positions = toFloat4(held.positions(body), held.dimension);
            const quantities = new Map([
                ["speed", size(held.velocities(body))],
                ["force", size(held.contactForces(body))],
            ]);
            return { positions, quantities };
        });
        return { frame: this.frame++, time: held.time, bodies, obstacles: held.obstacles };
    }

    /** @param speed  Of the simulation's time over that of the clock, as the caller has found it. */
    stats(speed: number): PlayStats {
        const { report } = this;
        return {
            milliseconds: this.pace.cost,
            speed,
            stepsPerSecond: this.settings.stepsPerSecond,
            cells: this.cells,
            iterations: report?.iterations ?? 0,
            touching: report ? report.contacts + report.obstacles : 0,
            inverted: report?.inverted ?? 0,
            energies: [...this.held.energies()],
        };
    }

    get recorded(): number {
        return this.recording?.frames ?? 0;
    }

    startRecording(): void {
        this.recording = new Recording(this.library.module.FS, this.held);
    }

    /** @return  The files of a run folder. */
    stopRecording(): RunFiles | null {
        const files = this.recording?.files ?? null;
        this.recording = null;
        return files;
    }

    private get held(): Simulation {
        if (!this.simulation) {
            throw new PentError("no scene is open");
        }
        return this.simulation;
    }

    private meshes(): Mesh[] {
        const { held } = this;
        return Array.from({ length: held.bodyCount }, (_, body) => ({
            dimension: held.dimension,
            vertexCount: held.vertexCount(body),
            cellCount: held.cellCount(body),
            positions: held.restPositions(body).slice(),
            cells: held.cells(body).slice(),
            crc: 0,
            createdBy: "",
        }));
    }

    // Files of a scene that cannot be opened make room again for those of the one that stays.
    private openFiles(files: SceneFiles, path: string): Simulation {
        const { FS } = this.library.module;
        const put = (some: SceneFiles) => {
            makeEmpty(FS, kFolder);
            some.forEach((bytes, name) => write(FS, `${kFolder}/${name}`, bytes));
        };
        put(files);
        FS.chdir(kFolder); // so that messages name files as the person does
        try {
            const asWritten = { stiffness: 1, damping: null, stepsPerSecond: null };
            return this.library.open(path, asWritten, null);
        } catch (error) {
            put(this.files);
            throw error;
        }
    }

    // What the file of a body's mesh has beside it.
    private fieldsOf(body: number): Quantities {
        const path = this.held.meshPath(body);
        const mesh = readMesh(this.library.module.FS.readFile(path), path);
        return namedFields(vertexFields(mesh, () => makeRestCells(mesh)));
    }

    private begin(simulation: Simulation): void {
        this.simulation = simulation;
        const start = simulation.facts;
        this.gravity = start.gravity;
        this.settings = {
            stiffness: 1,
            damping: start.damping,
            stepsPerSecond: Math.round(1 / start.timeStep),
        };
        this.cells = this.meshes().reduce((sum, mesh) => sum + mesh.cellCount, 0);
        this.pace.reset();
    }

    // What belongs to the time that is over.
    private forget(): void {
        this.hand = null;
        this.report = null;
        this.refusals = 0;
        this.recording = null;
    }

    private reopen(before: Simulation | null): void {
        const simulation = this.library.open(this.path, this.settings, before);
        this.simulation!.close();
        this.simulation = simulation;
        this.pace.reset();
    }

    private recover(error: Error): void {
        ++this.refusals;
        const said = `This step cannot be solved (${error.message}): `;
        if (this.hand !== null) {
            this.release();
            this.notice(`${said}the hand lets go`, true);
        } else if (this.refusals < 3) {
            this.held.halt();
            this.notice(`${said}all bodies stop where they are`, true);
        } else {
            this.reset();
            this.notice(`${said}the scene begins anew`, true);
        }
    }

    private record(): void {
        if (this.recording?.add(this.held) === false) {
            this.notice("The recording has become large: no more frames are added", false);
        }
    }
}
