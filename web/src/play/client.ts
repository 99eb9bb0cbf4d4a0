import { PentError } from "../format/error.ts";
import type { PlayCalls, PlayFacts, PlayFrame, PlayMessage } from "./protocol.ts";

/** What playground.js beside the page gives: the worker's code, and the module, packed, as base64. */
interface Parts {
    worker: string;
    wasm: string;
    size: number; // of the module, bytes
}

declare global {
    interface Window {
        pentimentoPlayground?: Parts;
    }
}

interface Waiting {
    resolve(value: unknown): void;
    reject(error: Error): void;
}

/** What a simulation tells those who look. */
export interface PlayListener {
    onFrame(frame: PlayFrame): void;
    onFacts(facts: PlayFacts): void;
    onNotice(text: string, isError: boolean): void;
    /** The simulator is gone. */
    onDeath(text: string): void;
}

/** Why a call gets no answer: the simulator has ended. Who listens was told, if it had started. */
export class SimulatorGone extends PentError {}

const kScript = "playground.js";

function load(): Promise<Parts> {
    return new Promise((resolve, reject) => {
        const script = document.createElement("script");
        script.src = new URL(kScript, document.baseURI).href;
        script.onload = () => resolve(window.pentimentoPlayground!);
        script.onerror = () =>
            reject(
                new PentError(
                    `${kScript}: is not beside this page; the playground needs it. scripts/web.sh builds ` +
                        "both into one folder, where emscripten is installed",
                ),
            );
        document.head.append(script);
    });
}

/** The simulator on a thread of its own, one request after the other. */
export class PlayClient {
    private waiting = new Map<number, Waiting>();
    private nextId = 0;
    private hasStarted = false;

    private constructor(
        private worker: Worker,
        private listener: PlayListener,
    ) {
        worker.onmessage = (event: MessageEvent<PlayMessage>) => this.receive(event.data);
        worker.onerror = (event) => {
            event.preventDefault();
            this.die(event.message || "its thread did not start");
        };
    }

    /** Loads the simulator. Rejects with a PentError where that cannot be. */
    static async start(listener: PlayListener): Promise<PlayClient> {
        if (typeof WebAssembly === "undefined") {
            throw new PentError("this browser is too old for the playground; update it");
        }
        const parts = window.pentimentoPlayground ?? (await load());
        const address = URL.createObjectURL(new Blob([parts.worker], { type: "text/javascript" }));
        const client = new PlayClient(new Worker(address), listener);
        URL.revokeObjectURL(address);
        const packed = Uint8Array.from(atob(parts.wasm), (letter) => letter.charCodeAt(0));
        try {
            await client.call("boot", packed, parts.size);
            client.hasStarted = true;
        } catch (error) {
            client.close();
            throw new PentError(
                "the simulator does not start: it needs WebAssembly with vectors and exceptions, " +
                    `which this browser may lack (${(error as Error).message})`,
            );
        }
        return client;
    }

    /** Calls a function of the worker. Rejects with what it throws. */
    call<Name extends keyof PlayCalls>(
        name: Name,
        ...values: Parameters<PlayCalls[Name]>
    ): Promise<ReturnType<PlayCalls[Name]>> {
        const id = this.nextId++;
        return new Promise((resolve, reject) => {
            this.waiting.set(id, { resolve: resolve as (value: unknown) => void, reject });
            this.worker.postMessage({ id, name, values });
        });
    }

    close(): void {
        this.end("the simulator was closed");
    }

    private receive(message: PlayMessage): void {
        if (message.kind === "frame") {
            this.listener.onFrame(message.frame);
        } else if (message.kind === "facts") {
            this.listener.onFacts(message.facts);
        } else if (message.kind === "notice") {
            this.listener.onNotice(message.text, message.isError);
        } else {
            const waiting = this.waiting.get(message.id);
            this.waiting.delete(message.id);
            if (message.kind === "answer") {
                waiting?.resolve(message.result);
            } else if (message.isOurs) {
                waiting?.reject(new PentError(message.text));
            } else {
                waiting?.reject(new SimulatorGone(message.text));
                this.die(message.text);
            }
        }
    }

    private end(text: string): void {
        this.worker.terminate();
        this.waiting.forEach(({ reject }) => reject(new SimulatorGone(text)));
        this.waiting.clear();
    }

    private die(text: string): void {
        this.end(text);
        if (this.hasStarted) {
            this.listener.onDeath(
                `The simulator has failed: ${text}. Open a scene again; if it is large, try a coarser mesh`,
            );
        }
    }
}
