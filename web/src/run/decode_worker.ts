import { PentError } from "../format/error.ts";
import { Decoder, ModelDecoder } from "./decode.ts";
import type { DecodeAnswer, DecodeRequest } from "./decode_client.ts";

// The far side of DecodeClient: one decoder of each kind, one request after the other.
const decoder = new Decoder();
const model = new ModelDecoder();

function answer(request: DecodeRequest): unknown {
    switch (request.kind) {
        case "mesh":
            return decoder.mesh(request.bytes, request.name, request.path);
        case "frame":
            return decoder.frame(request.bytes, request.name, request.path);
        case "strain":
            return decoder.strain(request.name, request.positions);
        case "model":
            return model.open(request.bytes, request.path);
        case "modelBodies":
            return model.bodies(request.beside);
        case "modelFrame":
            return model.frame(request.place);
    }
}

function buffersOf(value: unknown, found: Set<ArrayBuffer> = new Set()): Set<ArrayBuffer> {
    if (ArrayBuffer.isView(value)) {
        found.add(value.buffer as ArrayBuffer);
    } else if (value && typeof value === "object") {
        const parts = value instanceof Map ? [...value.values()] : Object.values(value);
        parts.forEach((part) => buffersOf(part, found));
    }
    return found;
}

self.onmessage = (event: MessageEvent<{ id: number; request: DecodeRequest }>) => {
    const { id, request } = event.data;
    const post = (message: DecodeAnswer, transfer: Transferable[] = []) =>
        (self as unknown as Worker).postMessage(message, transfer);
    try {
        const result = answer(request);
        post({ id, result }, [...buffersOf(result)]);
    } catch (error) {
        post({ id, error: (error as Error).message, isOurs: error instanceof PentError });
    }
};
