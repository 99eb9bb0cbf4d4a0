import type { PlayFrame } from "../../play/protocol.ts";
import { button } from "../controls.ts";
import { element, icon } from "../dom.ts";
import { kIcons } from "../icons.ts";

/** What the buttons under the picture do. */
export interface PlayActions {
    toggleRunning(): void;
    step(): void;
    reset(): void;
    toggleRecording(): void;
}

const kShowEvery = 250; // ms, of numbers that are to be read

/** The bar under the picture while a simulation runs. */
export class PlayBar {
    readonly root: HTMLElement;
    private run: HTMLButtonElement;
    private record: HTMLButtonElement;
    private numbers = element("output", { class: "numbers", "aria-live": "off" });
    private lastShown = 0;

    constructor(actions: PlayActions) {
        this.run = button("Pause", kIcons.pause, () => actions.toggleRunning());
        this.record = button("Record", kIcons.record, () => actions.toggleRecording(), "Record");
        this.root = element(
            "div",
            { class: "bar play", role: "toolbar", "aria-label": "Simulation" },
            button("Back to the start", kIcons.begin, () => actions.reset()),
            this.run,
            button("One step", kIcons.step, () => actions.step()),
            this.numbers,
            this.record,
        );
    }

    showRunning(isRunning: boolean): void {
        this.run.replaceChildren(icon(isRunning ? kIcons.pause : kIcons.play));
        this.run.ariaLabel = this.run.title = isRunning ? "Pause" : "Go on";
    }

    /** @param frames  That were recorded; null: it is not recording. */
    showRecording(frames: number | null): void {
        const text = frames === null ? "Record" : `${frames}`;
        const label = frames === null ? "Record" : "End the recording and save it";
        this.record.classList.toggle("recording", frames !== null);
        this.record.replaceChildren(
            icon(frames === null ? kIcons.record : kIcons.stop),
            element("span", {}, text),
        );
        this.record.ariaLabel = this.record.title = label;
    }

    show({ moment, stats }: PlayFrame, isRunning: boolean): void {
        const now = performance.now();
        if (isRunning && now - this.lastShown < kShowEvery) {
            return;
        }
        this.lastShown = now;
        const speed =
            isRunning && stats.speed > 0 && stats.speed < 0.93
                ? `${stats.speed.toFixed(2)}\u00d7 real time`
                : "";
        const energy = stats.energies.reduce((sum, [, value]) => sum + value, 0);
        const cost = stats.milliseconds > 0 ? `${stats.milliseconds.toFixed(1)} ms a step` : "";
        const texts = [
            ["time", `${moment.time.toFixed(2)} s`],
            ["cost", cost],
            ["energy", joules(energy)],
            ["speed", speed],
        ].filter(([, text]) => text !== "");
        this.numbers.replaceChildren(
            ...texts.map(([name, text]) => element("span", { class: name! }, text!)),
        );
    }
}

/** "12.3 J", with four digits at most. */
export function joules(value: number): string {
    const size = Math.abs(value);
    const digits = size >= 100 ? 0 : size >= 10 ? 1 : size >= 0.01 || size < 5e-5 ? 2 : 4;
    return `${value.toFixed(digits)} J`.replace("-", "\u2212");
}
