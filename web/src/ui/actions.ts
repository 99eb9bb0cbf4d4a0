import { reachAlongW } from "../view/bounds.ts";
import { slicePlaces } from "../view/compose.ts";
import { rounded, timeText } from "../view/digits.ts";
import { axesOf, identity, kPlanes } from "../view/rotation.ts";
import { defaultState, kGhosts, kLayouts } from "../view/state.ts";
import type { Viewer } from "../view/viewer.ts";

/** What keys do. `keys` are names of KeyboardEvent.code, so that a place on the keyboard counts. */
export interface Action {
    keys: string[];
    shown: string; // in the legend
    does: string;
    run(viewer: Viewer, isShift: boolean): void;
}

const kTurnDegrees = 5;

function next<Value>(values: readonly Value[], value: Value): Value {
    return values[(values.indexOf(value) + 1) % values.length]!;
}

/** A hundredth of the bodies along w. */
export function moveW(viewer: Viewer, by: number): void {
    const { state, bounds } = viewer;
    const [low, high] = bounds.reach(state.rotation, 3);
    const w = (state.w ?? bounds.pivot[3]) + (by * (high - low)) / 100;
    viewer.update({ w: rounded(Math.min(Math.max(w, low), high), (high - low) / 100) });
}

export function zoom(viewer: Viewer, factor: number): void {
    const { orbit } = viewer.state;
    viewer.update({ orbit: { ...orbit, zoom: Math.min(50, Math.max(0.1, orbit.zoom * factor)) } });
}

/** Turns the camera about the bodies, by degrees. */
export function look(viewer: Viewer, right: number, up: number): void {
    const { orbit } = viewer.state;
    const elevation = Math.min(89, Math.max(-89, orbit.elevation + up));
    viewer.update({ orbit: { ...orbit, azimuth: (orbit.azimuth + right) % 360, elevation } });
}

/** Moves the picture, by parts of the smaller of its width and height. */
export function pan(viewer: Viewer, right: number, up: number): void {
    const { orbit } = viewer.state;
    const radii = 2 / orbit.zoom;
    const [panX, panY] = [orbit.panX - radii * right, orbit.panY - radii * up];
    viewer.update({ orbit: { ...orbit, panX, panY } });
}

// The four keys under the right hand, as arrows lie.
const kLooks = [
    ["I", "above", 0, 1],
    ["J", "the left", -1, 0],
    ["K", "below", 0, -1],
    ["L", "the right", 1, 0],
] as const;
const kLookDegrees = 10;
const kPanPart = 1 / 20;

export const kActions: Action[] = [
    {
        keys: ["Space"],
        shown: "space",
        does: "play, pause",
        run: (viewer) => (viewer.isPlaying ? viewer.pause() : viewer.play()),
    },
    {
        keys: ["ArrowLeft"],
        shown: "\u2190",
        does: "a frame back (ten with shift)",
        run: (viewer, isShift) => viewer.step(isShift ? -10 : -1),
    },
    {
        keys: ["ArrowRight"],
        shown: "\u2192",
        does: "a frame on (ten with shift)",
        run: (viewer, isShift) => viewer.step(isShift ? 10 : 1),
    },
    {
        keys: ["ArrowUp"],
        shown: "\u2191",
        does: "slice up along w (ten times as far with shift)",
        run: (viewer, isShift) => moveW(viewer, isShift ? 10 : 1),
    },
    {
        keys: ["ArrowDown"],
        shown: "\u2193",
        does: "slice down along w",
        run: (viewer, isShift) => moveW(viewer, isShift ? -10 : -1),
    },
    ...kPlanes.map(
        (plane, i): Action => ({
            keys: [`Digit${i + 1}`, `Numpad${i + 1}`],
            shown: String(i + 1),
            does: `turn in ${plane} (the other way with shift)`,
            run(viewer, isShift) {
                const [from, to] = axesOf(plane);
                if (viewer.run?.dimension === 4 || to < 3) {
                    viewer.turn(from, to, isShift ? -kTurnDegrees : kTurnDegrees);
                }
            },
        }),
    ),
    {
        keys: ["Digit0", "Numpad0"],
        shown: "0",
        does: "turn back, slice in the middle",
        run: (viewer) => viewer.update({ rotation: identity(), w: null }),
    },
    {
        keys: ["KeyC"],
        shown: "C",
        does: "next coloring",
        run(viewer) {
            const there = viewer.colorings.filter(({ isThere }) => isThere);
            const names = there.map(({ name }) => name);
            viewer.update({ color: next(names, viewer.state.color), range: null });
        },
    },
    {
        keys: ["KeyS"],
        shown: "S",
        does: "one slice, side by side, onion skin",
        run: (viewer) => viewer.update({ layout: next(kLayouts, viewer.state.layout) }),
    },
    {
        keys: ["KeyG"],
        shown: "G",
        does: "ghost: none, orthographic, perspective",
        run: (viewer) => viewer.update({ ghost: next(kGhosts, viewer.state.ghost) }),
    },
    {
        keys: ["KeyB"],
        shown: "B",
        does: "tesseract box",
        run: (viewer) => viewer.update({ box: !viewer.state.box }),
    },
    {
        keys: ["Equal", "NumpadAdd"],
        shown: "+",
        does: "nearer",
        run: (viewer) => zoom(viewer, 1.2),
    },
    {
        keys: ["Minus", "NumpadSubtract"],
        shown: "\u2212",
        does: "further away",
        run: (viewer) => zoom(viewer, 1 / 1.2),
    },
    ...kLooks.map(
        ([key, way, right, up]): Action => ({
            keys: [`Key${key}`],
            shown: key,
            does: `look from ${way} (move with shift)`,
            run(viewer, isShift) {
                if (isShift) {
                    pan(viewer, kPanPart * right, kPanPart * up);
                } else {
                    look(viewer, kLookDegrees * right, kLookDegrees * up);
                }
            },
        }),
    ),
    {
        keys: ["KeyR"],
        shown: "R",
        does: "camera as at the start",
        run: (viewer) => viewer.update({ orbit: defaultState().orbit }),
    },
];

/** What the picture shows, in a sentence, for those who cannot see it. */
export function describe(viewer: Viewer): string {
    const { run, state, moment } = viewer;
    if (!run || !moment) {
        return "No body is open";
    }
    const places = slicePlaces(state, viewer.bounds, run.dimension).map((w) =>
        rounded(w, viewer.bounds.size),
    );
    const shift = viewer.bounds.shift(state.rotation)[3];
    const [low, high] = reachAlongW(moment, state.rotation, shift);
    const isEmpty = run.dimension === 4 && places.every((w) => w < low || w > high);
    const slice = `Slice at w = ${places.join(", ")} m${isEmpty ? ", where no body is," : ""}`;
    const what = run.dimension === 3 ? "Whole bodies" : slice;
    const time =
        run.frames.length > 1
            ? `, frame ${moment.frame}, ${timeText(moment.time, viewer.secondsPerFrame)}`
            : "";
    const color = state.color === "body" ? "" : `, colored by ${state.color}`;
    return `${what} of ${run.title}${time}${color}`;
}
