import { sliceLabel } from "../view/compose.ts";
import { rounded, timeText } from "../view/digits.ts";
import type { Viewer } from "../view/viewer.ts";
import { button } from "./controls.ts";
import { element, icon } from "./dom.ts";
import { kIcons } from "./icons.ts";

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4];
const kSteps = 1000; // of the slider of w

/** The bar under the picture: w, and time. */
export class Bottom {
    // The sliders say their values themselves; said as they change, they would never end.
    private w: HTMLInputElement;
    private wValue: HTMLOutputElement;
    private wRow: HTMLElement;
    private time: HTMLInputElement;
    private timeValue: HTMLOutputElement;
    private timeRow: HTMLElement;
    private play: HTMLButtonElement;
    private loop: HTMLButtonElement;
    private speed: HTMLSelectElement;

    constructor(
        root: HTMLElement,
        private viewer: Viewer,
    ) {
        this.w = element("input", {
            type: "range",
            min: 0,
            max: kSteps,
            step: 1,
            class: "w",
            "aria-label": "slice at w",
            input: () => viewer.update({ w: this.toW(Number(this.w.value)) }),
        });
        this.wValue = element("output", { class: "value", "aria-live": "off" });
        this.wRow = element(
            "div",
            { class: "bar" },
            button("Slice through the middle", kIcons.reset, () => viewer.update({ w: null })),
            element("span", { class: "letter", "aria-hidden": "true" }, "w"),
            this.w,
            this.wValue,
        );
        this.play = button("Play", kIcons.play, () =>
            viewer.isPlaying ? viewer.pause() : viewer.play(),
        );
        this.time = element("input", {
            type: "range",
            min: 0,
            max: 1,
            step: 1,
            class: "time",
            "aria-label": "frame",
            input: () => {
                viewer.pause();
                viewer.update({ frame: viewer.run!.frames[Number(this.time.value)]! });
            },
        });
        this.timeValue = element("output", { class: "value", "aria-live": "off" });
        this.loop = button("Loop", kIcons.loop, () => viewer.update({ loop: !viewer.state.loop }));
        this.speed = element("select", {
            "aria-label": "speed of playing",
            change: () => viewer.update({ speed: Number(this.speed.value) }),
        });
        this.timeRow = element(
            "div",
            { class: "bar" },
            this.play,
            this.time,
            this.timeValue,
            this.speed,
            this.loop,
        );
        root.append(this.wRow, this.timeRow);
        viewer.on("state", () => this.show());
        viewer.on("run", () => this.show());
        viewer.on("moment", () => this.show());
        viewer.on("playing", (isPlaying) => {
            this.play.replaceChildren(icon(isPlaying ? kIcons.pause : kIcons.play));
            this.play.ariaLabel = this.play.title = isPlaying ? "Pause" : "Play";
        });
    }

    private toW(step: number): number {
        const [low, high] = this.viewer.bounds.reach(this.viewer.state.rotation, 3);
        return rounded(low + ((high - low) * step) / kSteps, high - low);
    }

    private show(): void {
        const { state, run, bounds, moment } = this.viewer;
        this.wRow.hidden = run?.dimension !== 4;
        this.timeRow.hidden = !run || run.frames.length < 2;
        if (!run) {
            return;
        }
        const [low, high] = bounds.reach(state.rotation, 3);
        const w = state.w ?? bounds.pivot[3];
        this.w.value = String(Math.round(((w - low) / (high - low || 1)) * kSteps));
        const label = sliceLabel(w, bounds.size);
        this.wValue.textContent = `${label.slice(4)} m`;
        this.w.ariaValueText = `${label} meters`;
        this.time.max = String(run.frames.length - 1);
        this.time.value = String(this.viewer.place);
        const seconds = timeText(moment?.time ?? 0, this.viewer.secondsPerFrame);
        this.timeValue.textContent = seconds;
        this.time.ariaValueText = `frame ${state.frame ?? run.frames[0]}, ${seconds}`;
        this.loop.ariaPressed = String(state.loop);
        const speeds = [...new Set([...kSpeeds, state.speed])].sort((a, b) => a - b);
        this.speed.replaceChildren(
            ...speeds.map((speed) => element("option", { value: speed }, `${speed}\u00d7`)),
        );
        this.speed.value = String(state.speed);
    }
}
