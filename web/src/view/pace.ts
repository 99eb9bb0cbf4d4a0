const kSlow = 70; // ms from picture to picture: then pictures are coarser while they move
const kCoarse = 0.5;
const kPause = 1000; // ms: what is further apart is no movement
const kRest = 220; // ms after which a picture is drawn sharp again

/** Measures how fast pictures come: where that is slowly, they are coarser while things move, and
 * sharp when they rest. */
export class Pace {
    private last = -Infinity;
    private slowness = 0; // ms, of the last pictures
    private timer = 0;
    private isCoarse = false;

    /** @param redraw  Called when things have come to rest after a coarse picture. */
    constructor(private redraw: () => void) {}

    /** What to multiply the sides of a picture by. */
    get scale(): number {
        return this.isCoarse ? kCoarse : 1;
    }

    /** To be called at each picture with the time in ms. */
    measure(now: number): void {
        const gap = now - this.last;
        this.last = now;
        if (gap < kPause) {
            this.slowness += 0.3 * (gap - this.slowness);
        }
        this.isCoarse = this.slowness > kSlow && gap < kPause;
        clearTimeout(this.timer);
        if (this.isCoarse) {
            this.timer = window.setTimeout(() => {
                this.slowness = 0;
                this.redraw();
            }, kRest);
        }
    }
}
