import type { Mesh } from "../format/mesh.ts";
import type { Body } from "../run/decode.ts";
import type { Moment } from "../run/run.ts";
import type { Hit, Ray } from "./library.ts";

/** Files of a scene by path, relative to one folder. */
export type SceneFiles = Map<string, Uint8Array>;

/** A scene that was opened. */
export interface OpenedScene {
    dimension: 3 | 4;
    bodies: Body[];
    rests: Mesh[]; // of each body, as placed
    moment: Moment;
    facts: PlayFacts;
}

/** What may be changed, as it is now. */
export interface PlayFacts {
    stiffness: number; // what moduli are multiplied by
    damping: number; // of stiffness, s
    gravity: number[]; // m/s^2, four numbers
    stepsPerSecond: number;
    isAutomatic: boolean; // whether steps adapt to the machine
}

/** What the page says of the steps that were taken. */
export interface PlayStats {
    milliseconds: number; // of a step
    speed: number; // time of the simulation over that of the clock
    stepsPerSecond: number;
    cells: number;
    iterations: number;
    touching: number; // pairs in contact and vertices at obstacles
    inverted: number;
    energies: [string, number][]; // J, of all that is stored
}

export interface PlayFrame {
    moment: Moment;
    stats: PlayStats;
    recorded: number; // frames
}

export type RunFiles = Map<string, Uint8Array>;

/** What the page asks of the worker, and what comes back. */
export interface PlayCalls {
    /** The module of WebAssembly, packed, and its size. */
    boot(packed: Uint8Array, size: number): void;
    openGallery(name: string): OpenedScene;
    openFiles(files: SceneFiles, scene: string): OpenedScene;
    reset(): void;
    /** Takes hold of what a ray meets; null where it meets nothing. */
    grab(ray: Ray): Hit | null;
    move(anchor: number[]): void;
    release(): void;
    setGravity(gravity: number[]): void;
    /** `stepsPerSecond` null: as the machine has it. */
    tune(settings: {
        stiffness: number;
        damping: number;
        stepsPerSecond: number | null;
    }): PlayFacts;
    setRunning(isRunning: boolean): void;
    step(): void;
    setRecording(isOn: boolean): RunFiles | null;
    /** The page has shown a frame, and takes another one. */
    taken(): void;
}

export type PlayRequest = {
    [Name in keyof PlayCalls]: { id: number; name: Name; values: Parameters<PlayCalls[Name]> };
}[keyof PlayCalls];

export type PlayMessage =
    | { kind: "answer"; id: number; result: unknown }
    | { kind: "failure"; id: number; text: string; isOurs: boolean }
    | { kind: "frame"; frame: PlayFrame }
    | { kind: "facts"; facts: PlayFacts }
    | { kind: "notice"; text: string; isError: boolean };
