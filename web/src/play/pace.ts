/** Steps a second that are chosen among, from the fewest to the most. */
export const kRates = [30, 60, 120, 240];

const kBusy = 0.8; // of the machine's time: above this, fewer and longer steps
const kIdle = 0.3; // below this, twice as many would still leave room
const kPatience = 90; // steps between two changes
const kWeight = 0.1; // of the newest step in the mean

/** Chooses how many steps a second the machine can take, by what steps have cost. */
export class Pace {
    private milliseconds = 0; // of a step, a running mean
    private steps = 0; // since the last change

    /** ms a step, a mean over the last few. */
    get cost(): number {
        return this.milliseconds;
    }

    /** Forgets what other steps have cost. */
    reset(): void {
        this.milliseconds = 0;
        this.steps = 0;
    }

    add(milliseconds: number): void {
        // The first of a simulation sets things up.
        const weight = this.steps < 3 ? 1 : kWeight;
        this.milliseconds += weight * (milliseconds - this.milliseconds);
        ++this.steps;
    }

    /** The rate to go on with. It changes by one, and seldom. */
    advise(rate: number): number {
        const load = (this.milliseconds / 1000) * rate;
        if (this.steps < kPatience || (load <= kBusy && load >= kIdle)) {
            return rate;
        }
        const next =
            load > kBusy
                ? kRates.filter((one) => one < rate).at(-1)
                : kRates.find((one) => one > rate);
        return next ?? rate;
    }
}
