import { ByteCache } from "./byte_cache.ts";
import { bytesOf } from "./run.ts";
import type { Moment, Run } from "./run.ts";

/** Brings frames in the order in which they are wanted, and keeps those used last.
 *
 * At most a few are under way at once; when what is wanted changes, what has not begun is dropped.
 */
export class FrameStream {
    private cache: ByteCache<number, Moment>;
    private wanted: number[] = []; // places in run.frames, the most urgent first
    private first = -1; // of these, the last time
    private underWay = new Set<number>();
    private failures = new Map<number, Error>();

    /** @param onArrival  Called when a frame has come or failed.
     *  @param limit      Bytes of decoded frames to keep. */
    constructor(
        private run: Run,
        private onArrival: (place: number) => void,
        limit = 256 * 1024 * 1024,
        private atOnce = 3,
    ) {
        this.cache = new ByteCache(limit);
    }

    /** The frame at a place in run.frames, if it is here. */
    get(place: number): Moment | undefined {
        return this.cache.get(place);
    }

    failure(place: number): Error | undefined {
        return this.failures.get(place);
    }

    /** Bytes kept now. */
    get bytes(): number {
        return this.cache.bytes;
    }

    /** How many frames from a place on, in one direction, are here without a gap. */
    readyFrom(place: number, direction: 1 | -1): number {
        let count = 0;
        while (this.cache.has(place + direction * count)) {
            ++count;
        }
        return count;
    }

    /** Asks for the frame at a place and then for those that follow it.
     *
     * @param ahead   How many to read ahead; no more than half of what can be kept.
     * @param isLoop  Whether the first follows the last. */
    want(place: number, ahead: number, isLoop: boolean): void {
        const count = this.run.frames.length;
        const one = this.cache.size > 0 ? this.cache.bytes / this.cache.size : 0;
        const room = one > 0 ? Math.floor(this.cache.limit / 2 / one) : 1;
        this.wanted = [];
        for (let i = 0; i <= Math.min(ahead, room, count - 1); ++i) {
            const next = place + i;
            if (next < count || isLoop) {
                this.wanted.push(next % count);
            }
        }
        if (place !== this.first) {
            this.failures.delete(place); // what could not be read is tried again when it is come back to
        }
        this.first = place;
        this.pump();
    }

    /** Counts the bytes of a frame again, which has got more quantities. */
    recount(place: number, moment: Moment): void {
        this.cache.set(place, moment, bytesOf(moment));
    }

    private pump(): void {
        for (const place of this.wanted) {
            if (this.underWay.size >= this.atOnce) {
                return;
            }
            if (!this.cache.has(place) && !this.underWay.has(place) && !this.failures.has(place)) {
                void this.bring(place);
            }
        }
    }

    private async bring(place: number): Promise<void> {
        this.underWay.add(place);
        try {
            const moment = await this.run.load(this.run.frames[place]!);
            this.cache.set(place, moment, bytesOf(moment));
        } catch (error) {
            this.failures.set(place, error as Error);
        }
        this.underWay.delete(place);
        this.onArrival(place);
        this.pump();
    }
}
