import { PentError } from "../format/error.ts";
import { readObstacles } from "../format/obstacles.ts";
import type { Obstacle } from "../format/obstacles.ts";
import type { Module } from "playground-module";

/** What a person may change of a scene while it runs. */
export interface Settings {
    stiffness: number; // what all moduli are multiplied by
    damping: number | null; // of stiffness, s; null: as the scene has it
    stepsPerSecond: number | null; // null: as the scene has it
}

export interface Facts {
    timeStep: number; // s
    damping: number; // of stiffness, s
    gravity: number[]; // four numbers, m/s^2
}

export interface StepReport {
    substeps: number;
    refused: number;
    newtonIterations: number;
    iterations: number; // of the linear solver
    unknowns: number;
    inverted: number; // cells
    contacts: number; // pairs of bodies
    obstacles: number; // vertices at obstacles
}

/** A point of a body, and where it is. */
export interface Hit {
    body: number;
    cell: number;
    weights: number[]; // barycentric, dimension + 1
    place: number[];
}

export interface Ray {
    origin: number[];
    direction: number[];
    slice: { normal: number[]; offset: number } | null; // null in three dimensions
}

export interface Grab {
    hit: Hit;
    anchor: number[];
    stiffness: number; // N/m
    damping: number; // N s/m
}

type Argument = number | bigint;

/** The C interface of the simulator in a module of WebAssembly. What fails throws a PentError with the
 * sentence of the library. web/wasm/src/playground.cpp checks the places of members. */
export class Library {
    private scratch: number; // of the module's memory: arguments and results

    constructor(readonly module: Module) {
        this.scratch = module._malloc!(1024);
    }

    /** Reads a scene file of the module's file system.
     *
     * @param before  A simulation of the same scene whose state is taken over. */
    open(path: string, settings: Settings, before: Simulation | null): Simulation {
        const { stiffness, damping, stepsPerSecond } = settings;
        this.putDoubles(0, [stiffness, damping ?? -1, stepsPerSecond ?? 0]);
        const handle = this.withText(path, (text) =>
            this.call("play_open", text, this.scratch, before?.handle ?? 0),
        );
        return new Simulation(this, handle);
    }

    /** Calls a function; NULL and -1 are failures. */
    call(name: string, ...values: Argument[]): number {
        const result = Number(this.module[`_${name}`]!(...values));
        if (result === -1 || (result === 0 && kGivesAddress.has(name))) {
            throw new PentError(this.text(this.module._pent_last_error!()));
        }
        return result;
    }

    withText<Value>(text: string, action: (address: number) => Value): Value {
        const bytes = new TextEncoder().encode(text);
        const address: number = this.module._malloc!(bytes.length + 1);
        this.module.HEAPU8.set(bytes, address);
        this.module.HEAPU8[address + bytes.length] = 0;
        try {
            return action(address);
        } finally {
            this.module._free!(address);
        }
    }

    text(address: number): string {
        return this.module.UTF8ToString(address);
    }

    /** The address of a place in the scratch memory. */
    at(offset: number): number {
        return this.scratch + offset;
    }

    get view(): DataView {
        return new DataView(this.module.HEAPU8.buffer);
    }

    putDoubles(offset: number, values: readonly number[]): number {
        const view = this.view;
        values.forEach((value, i) => view.setFloat64(this.scratch + offset + 8 * i, value, true));
        return this.scratch + offset;
    }

    doubles(address: number, count: number): Float64Array {
        return new Float64Array(this.module.HEAPU8.buffer, address, count);
    }

    numbers(address: number, count: number): Uint32Array {
        return new Uint32Array(this.module.HEAPU8.buffer, address, count);
    }
}

const kGivesAddress = new Set([
    "play_open",
    "play_contact_forces",
    "play_mesh_path",
    "play_obstacles",
    "pent_cells",
    "pent_rest_positions",
    "pent_positions",
    "pent_velocities",
    "pent_masses",
    "pent_energies",
    "pent_body_name",
]);

/** A simulation that is open. Arrays that it gives are views that hold until the next step. */
export class Simulation {
    readonly dimension: 3 | 4;
    readonly bodyCount: number;

    constructor(
        private library: Library,
        readonly handle: number,
    ) {
        this.dimension = library.call("pent_dimension", handle) as 3 | 4;
        this.bodyCount = library.call("pent_body_count", handle);
    }

    close(): void {
        this.library.call("pent_close", this.handle);
    }

    get time(): number {
        return this.library.module._pent_time!(this.handle);
    }

    get facts(): Facts {
        const at = this.library.at(0);
        this.library.call("play_get_facts", this.handle, at);
        const values = [...this.library.doubles(at, 6)];
        return {
            timeStep: values[0]!,
            damping: values[1]!,
            gravity: values.slice(2),
        };
    }

    /** Where they are now. */
    get obstacles(): Obstacle[] {
        const text = this.library.text(this.library.call("play_obstacles", this.handle));
        return readObstacles(text, "obstacles", this.dimension);
    }

    name(body: number): string {
        return this.library.text(this.library.call("pent_body_name", this.handle, body));
    }

    /** The file of its mesh, as seen from the current folder. */
    meshPath(body: number): string {
        return this.library.text(this.library.call("play_mesh_path", this.handle, body));
    }

    vertexCount(body: number): number {
        return this.library.call("pent_vertex_count", this.handle, body);
    }

    cellCount(body: number): number {
        return this.library.call("pent_cell_count", this.handle, body);
    }

    cells(body: number): Uint32Array {
        const address = this.library.call("pent_cells", this.handle, body);
        return this.library.numbers(address, (this.dimension + 1) * this.cellCount(body));
    }

    restPositions(body: number): Float64Array {
        return this.vectors("pent_rest_positions", body);
    }

    positions(body: number): Float64Array {
        return this.vectors("pent_positions", body);
    }

    velocities(body: number): Float64Array {
        return this.vectors("pent_velocities", body);
    }

    contactForces(body: number): Float64Array {
        return this.vectors("play_contact_forces", body);
    }

    /** kg. */
    mass(body: number): number {
        const address = this.library.call("pent_masses", this.handle, body);
        return this.library
            .doubles(address, this.vertexCount(body))
            .reduce((sum, value) => sum + value, 0);
    }

    /** One time step; throws a PentError where it cannot be solved, and the state is as before. */
    step(): StepReport {
        const at = this.library.at(0);
        this.library.call("pent_step", this.handle, at);
        const { view } = this.library;
        const long = (offset: number) => Number(view.getBigInt64(at + offset, true));
        return {
            substeps: view.getInt32(at + 24, true),
            refused: view.getInt32(at + 28, true),
            newtonIterations: view.getInt32(at + 32, true),
            iterations: view.getInt32(at + 36, true),
            unknowns: long(48),
            inverted: long(56),
            contacts: long(72) + long(80),
            obstacles: long(88),
        };
    }

    /** Parts of the energy that can be had back, J, by name. */
    energies(): Map<string, number> {
        const count = this.library.at(0);
        const at = this.library.call("pent_energies", this.handle, count);
        const { view } = this.library;
        const energies = new Map<string, number>();
        for (let i = 0; i < Number(view.getBigInt64(count, true)); ++i) {
            if (view.getInt32(at + 24 * i + 16, true) !== 0) {
                const name = this.library.text(view.getUint32(at + 24 * i, true));
                energies.set(name, view.getFloat64(at + 24 * i + 8, true));
            }
        }
        return energies;
    }

    pick({ origin, direction, slice }: Ray): Hit | null {
        const { library } = this;
        const normal = slice ? library.putDoubles(0, slice.normal) : 0;
        const at = library.at(128);
        const found = library.call(
            "pent_pick",
            this.handle,
            normal,
            slice?.offset ?? 0,
            library.putDoubles(32, origin),
            library.putDoubles(64, direction),
            at,
        );
        if (found === 0) {
            return null;
        }
        const { view } = library;
        return {
            body: view.getInt32(at, true),
            cell: Number(view.getBigInt64(at + 8, true)),
            weights: [...library.doubles(at + 16, this.dimension + 1)],
            place: [...library.doubles(at + 56, this.dimension)],
        };
    }

    /** @return  The number of the grab. */
    addGrab({ hit, anchor, stiffness, damping }: Grab): number {
        const at = this.library.at(0);
        this.library.module.HEAPU8.fill(0, at, at + 112);
        const { view } = this.library;
        view.setInt32(at, hit.body, true);
        view.setBigInt64(at + 8, BigInt(hit.cell), true);
        this.library.putDoubles(16, hit.weights);
        this.library.putDoubles(56, anchor);
        this.library.putDoubles(88, [stiffness, damping]);
        return this.library.call("pent_add_grab", this.handle, at);
    }

    moveGrab(grab: number, anchor: readonly number[]): void {
        const at = this.library.putDoubles(0, anchor);
        this.library.call("pent_move_grab", this.handle, BigInt(grab), at);
    }

    removeGrab(grab: number): void {
        this.library.call("pent_remove_grab", this.handle, BigInt(grab));
    }

    setGravity(gravity: readonly number[]): void {
        this.library.call("pent_set_gravity", this.handle, this.library.putDoubles(0, gravity));
    }

    /** Stops all bodies where they are. */
    halt(): void {
        for (let body = 0; body < this.bodyCount; ++body) {
            const positions = this.positions(body).slice();
            const address: number = this.library.module._malloc!(2 * positions.byteLength);
            this.library.doubles(address, positions.length).set(positions);
            const still = address + positions.byteLength;
            this.library.doubles(still, positions.length).fill(0);
            try {
                this.library.call("pent_set_state", this.handle, body, address, still);
            } finally {
                this.library.module._free!(address);
            }
        }
    }

    /** Begins a run in an empty folder of the module's file system. */
    beginRun(folder: string): void {
        this.library.withText(folder, (text) =>
            this.library.call("play_begin_run", this.handle, text),
        );
    }

    addFrame(folder: string, frame: number): void {
        this.library.withText(folder, (text) =>
            this.library.call("play_add_frame", this.handle, text, frame),
        );
    }

    private vectors(name: string, body: number): Float64Array {
        const address = this.library.call(name, this.handle, body);
        return this.library.doubles(address, this.dimension * this.vertexCount(body));
    }
}
