import type { ModelFrame } from "../format/g4mf.ts";
import type { Body, DecodedModel } from "./decode.ts";
import { DecodeClient } from "./decode_client.ts";
import type { FileSource } from "./listing.ts";
import type { Moment, Run } from "./run.ts";

/** A G4MF file, read by a worker: the boundaries in it, and its blend shapes as frames. */
export class ModelRun implements Run {
    readonly dimension = 4;
    readonly bodies: Body[];
    readonly frames: number[];
    readonly isGrowing = false;
    private shapes: ModelFrame[];

    private constructor(
        readonly title: string,
        private decoder: DecodeClient,
        { bodies, frames }: DecodedModel,
    ) {
        this.bodies = bodies;
        this.shapes = frames;
        this.frames = frames.map(({ frame }) => frame);
    }

    /** @param path  Of the file, in the source. */
    static async open(
        source: FileSource,
        path: string,
        onProgress: (text: string) => void,
    ): Promise<ModelRun> {
        const decoder = new DecodeClient();
        try {
            onProgress(`reading ${path}`);
            const uris = await decoder.model(await source.read(path), path);
            const folder = path.slice(0, path.lastIndexOf("/") + 1);
            const beside = new Map<string, Uint8Array>();
            for (const uri of uris) {
                onProgress(`reading ${folder}${uri}`);
                beside.set(uri, await source.read(folder + uri));
            }
            return new ModelRun(source.title, decoder, await decoder.modelBodies(beside));
        } catch (error) {
            decoder.close();
            throw error;
        }
    }

    async load(frame: number): Promise<Moment> {
        const place = this.frames.indexOf(frame);
        const bodies = await this.decoder.modelFrame(place);
        return { frame, time: this.shapes[place]!.time, bodies, obstacles: [] };
    }

    refresh(): Promise<boolean> {
        return Promise.resolve(false);
    }

    close(): void {
        this.decoder.close();
    }
}
