import { PentError } from "../format/error.ts";
import type { BodyFrame, DecodedFrame, DecodedMesh, DecodedModel } from "./decode.ts";
import DecodeWorker from "./decode_worker.ts?worker&inline";

export type DecodeRequest =
    | { kind: "mesh"; bytes: Uint8Array; name: string; path: string }
    | { kind: "frame"; bytes: Uint8Array; name: string; path: string }
    | { kind: "strain"; name: string; positions: Float32Array }
    | { kind: "model"; bytes: Uint8Array; path: string }
    | { kind: "modelBodies"; beside: Map<string, Uint8Array> }
    | { kind: "modelFrame"; place: number };

export type DecodeAnswer =
    | { id: number; result: unknown }
    | { id: number; error: string; isOurs: boolean };

interface Waiting {
    resolve(value: unknown): void;
    reject(error: Error): void;
}

/** A Decoder on a thread of its own, so that the page stays quick while files are read. */
export class DecodeClient {
    private worker = new DecodeWorker();
    private waiting = new Map<number, Waiting>();
    private nextId = 0;

    constructor() {
        this.worker.onmessage = (event: MessageEvent<DecodeAnswer>) => {
            const answer = event.data;
            const waiting = this.waiting.get(answer.id);
            this.waiting.delete(answer.id);
            if ("result" in answer) {
                waiting?.resolve(answer.result);
            } else {
                waiting?.reject(
                    answer.isOurs
                        ? new PentError(answer.error)
                        : new PentError(
                              `the reader failed: ${answer.error}; is the file too large?`,
                          ),
                );
            }
        };
        this.worker.onerror = (event) => {
            this.waiting.forEach((waiting) =>
                waiting.reject(
                    new PentError(
                        `the reader failed: ${event.message || "its thread did not start"}`,
                    ),
                ),
            );
            this.waiting.clear();
        };
    }

    mesh(bytes: Uint8Array, name: string, path: string): Promise<DecodedMesh> {
        return this.ask({ kind: "mesh", bytes, name, path }, [
            bytes.buffer,
        ]) as Promise<DecodedMesh>;
    }

    frame(bytes: Uint8Array, name: string, path: string): Promise<DecodedFrame> {
        return this.ask({ kind: "frame", bytes, name, path }, [
            bytes.buffer,
        ]) as Promise<DecodedFrame>;
    }

    strain(name: string, positions: Float32Array): Promise<Float32Array> {
        return this.ask({ kind: "strain", name, positions }, []) as Promise<Float32Array>;
    }

    /** @return  The files beside it that it needs, for modelBodies(). */
    model(bytes: Uint8Array, path: string): Promise<string[]> {
        return this.ask({ kind: "model", bytes, path }, [bytes.buffer]) as Promise<string[]>;
    }

    modelBodies(beside: Map<string, Uint8Array>): Promise<DecodedModel> {
        return this.ask({ kind: "modelBodies", beside }, []) as Promise<DecodedModel>;
    }

    /** @param place  Among the frames of modelBodies(). */
    modelFrame(place: number): Promise<BodyFrame[]> {
        return this.ask({ kind: "modelFrame", place }, []) as Promise<BodyFrame[]>;
    }

    close(): void {
        this.worker.terminate();
        this.waiting.forEach((waiting) => waiting.reject(new PentError("closed")));
        this.waiting.clear();
    }

    private ask(request: DecodeRequest, transfer: ArrayBufferLike[]): Promise<unknown> {
        const id = this.nextId++;
        return new Promise((resolve, reject) => {
            this.waiting.set(id, { resolve, reject });
            this.worker.postMessage({ id, request }, transfer as Transferable[]);
        });
    }
}
