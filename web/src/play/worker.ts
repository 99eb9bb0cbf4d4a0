import makeModule from "playground-module";
import { PentError } from "../format/error.ts";
import { galleryFiles, kSceneName } from "./gallery.ts";
import { Library } from "./library.ts";
import { unpack } from "./lzma.ts";
import { Playground } from "./playground.ts";
import type { PlayCalls, PlayMessage, PlayRequest } from "./protocol.ts";

// The simulator on a thread of its own: takes steps as the clock asks for, and sends a frame whenever the page has
// shown the one before.

const kMaxBehind = 0.1; // s of the clock that steps may lag; what is more is left out
const kSpeedWindow = 0.5; // s over which the speed is measured

let playground: Playground | null = null;
let isRunning = false;
let isFrameDue = true; // the page takes one
let isScheduled = false;
let debt = 0; // s of the simulation that the clock is ahead
let lastTick = 0; // ms
const window = { clock: 0, time: 0, speed: 0 };

function post(message: PlayMessage, transfer: Transferable[] = []): void {
    (self as unknown as Worker).postMessage(message, transfer);
}

function held(): Playground {
    if (!playground) {
        throw new PentError("the simulator has not started");
    }
    return playground;
}

function sendFrame(): void {
    isFrameDue = false;
    const moment = held().moment();
    const transfer = moment.bodies.flatMap(({ positions, quantities }) =>
        [positions, ...quantities.values()].map((values) => values.buffer as ArrayBuffer),
    );
    const stats = held().stats(window.speed);
    post({ kind: "frame", frame: { moment, stats, recorded: held().recorded } }, transfer);
}

function measureSpeed(now: number): void {
    const clock = (now - window.clock) / 1000;
    const { time } = held();
    if (clock > kSpeedWindow || time < window.time) {
        window.speed = clock < 4 * kSpeedWindow ? Math.max(0, time - window.time) / clock : 0;
        Object.assign(window, { clock: now, time });
    }
}

// A message channel comes back sooner than a timer, and lets what the page asks for in between.
const turns = new MessageChannel();
turns.port1.onmessage = () => {
    isScheduled = false;
    tick();
};

function schedule(milliseconds: number): void {
    if (isScheduled) {
        return;
    }
    isScheduled = true;
    if (milliseconds < 1) {
        turns.port2.postMessage(null);
    } else {
        setTimeout(() => turns.port1.onmessage!(new MessageEvent("message")), milliseconds);
    }
}

function tick(): void {
    if (!isRunning || !playground?.isOpen) {
        return;
    }
    const now = performance.now();
    debt = Math.min(debt + (now - lastTick) / 1000, kMaxBehind);
    lastTick = now;
    if (debt >= playground.timeStep) {
        debt -= playground.timeStep;
        playground.step(() => performance.now());
        measureSpeed(performance.now());
        if (playground.adapt()) {
            post({ kind: "facts", facts: playground.facts });
            lastTick = performance.now();
        }
        if (isFrameDue) {
            sendFrame();
        }
    }
    schedule(1000 * (playground.timeStep - debt));
}

function show(): void {
    debt = 0;
    lastTick = performance.now();
    Object.assign(window, { clock: lastTick, time: held().time, speed: 0 });
    sendFrame();
}

const calls: { [Name in keyof PlayCalls]: PlayCalls[Name] | unknown } = {
    async boot(packed: Uint8Array, size: number) {
        const library = new Library(await makeModule({ wasmBinary: unpack(packed, size) }));
        playground = new Playground(library, (text, isError) =>
            post({ kind: "notice", text, isError }),
        );
    },
    openGallery: (name: string) => held().open(galleryFiles(name), kSceneName),
    openFiles: (files: Map<string, Uint8Array>, scene: string) => held().open(files, scene),
    reset() {
        held().reset();
        show();
    },
    grab: (ray: Parameters<PlayCalls["grab"]>[0]) => held().grab(ray),
    move: (anchor: number[]) => held().move(anchor),
    release: () => held().release(),
    setGravity: (gravity: number[]) => held().setGravity(gravity),
    tune({ stiffness, damping, stepsPerSecond }: Parameters<PlayCalls["tune"]>[0]) {
        const facts = held().tune(stiffness, damping, stepsPerSecond);
        lastTick = performance.now();
        return facts;
    },
    setRunning(value: boolean) {
        isRunning = value;
        show();
        schedule(0);
    },
    step() {
        held().step(() => performance.now());
        sendFrame();
    },
    setRecording(isOn: boolean) {
        if (isOn) {
            held().startRecording();
            return null;
        }
        return held().stopRecording();
    },
    taken() {
        isFrameDue = true;
    },
};

// One request after the other, also where one takes its time.
let last: Promise<void> = Promise.resolve();

async function answer({ id, name, values }: PlayRequest): Promise<void> {
    try {
        const action = calls[name] as (...values: unknown[]) => unknown;
        post({ kind: "answer", id, result: await action(...values) });
    } catch (error) {
        const isOurs = error instanceof PentError;
        post({ kind: "failure", id, text: (error as Error).message, isOurs });
    }
}

self.onmessage = (event: MessageEvent<PlayRequest>) => {
    last = last.then(() => answer(event.data));
};
