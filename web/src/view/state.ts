import type { Orbit } from "./camera.ts";
import { formatTurns, fromTurns, identity, parseTurns, toTurns } from "./rotation.ts";
import type { Rotation } from "./rotation.ts";

export const kGhosts = ["none", "orthographic", "perspective"] as const;
export const kLayouts = ["single", "side", "onion"] as const;
export const kThemes = ["auto", "light", "dark"] as const;

/** All that decides what the picture shows, and nothing else. What is in it is in the address. */
export interface ViewState {
    w: number | null; // m, after turning; null: through the middle of the bodies
    rotation: Rotation;
    orbit: Orbit;
    frame: number | null; // its number; null: the first
    speed: number; // of playing, 1: as in the simulation
    loop: boolean;
    layout: (typeof kLayouts)[number];
    slices: number; // side by side or as onion skin, 2 to 9
    spacing: number | null; // between them, m; null: suitable
    ghost: (typeof kGhosts)[number];
    color: string; // one of kColorings, or a field
    range: [number, number] | null; // of colors; null: what the frames so far have
    smooth: boolean; // normals
    shade: boolean; // shadows and ambient occlusion
    floor: boolean;
    obstacles: boolean;
    box: boolean;
    axes: boolean;
    theme: (typeof kThemes)[number];
}

export function defaultState(): ViewState {
    return {
        w: null,
        rotation: identity(),
        orbit: { azimuth: 30, elevation: 18, zoom: 1, panX: 0, panY: 0 },
        frame: null,
        speed: 1,
        loop: true,
        layout: "single",
        slices: 3,
        spacing: null,
        ghost: "none",
        color: "body",
        range: null,
        smooth: true,
        shade: true,
        floor: true,
        obstacles: true,
        box: false,
        axes: true,
        theme: "auto",
    };
}

const kSwitches = ["loop", "smooth", "shade", "floor", "obstacles", "box", "axes"] as const;

/** Shortest text of a number that is right to so many digits. */
export function short(value: number, digits: number): string {
    return String(Number(value.toPrecision(digits)));
}

/** What differs from the defaults, as it stands behind # in the address. */
export function formatState(state: ViewState): string {
    const initial = defaultState();
    const parts: [string, string][] = [];
    const put = (key: string, value: string) => parts.push([key, value]);
    if (state.w !== null) {
        put("w", String(state.w)); // all its digits: bodies may be small, or far from 0
    }
    const turns = formatTurns(toTurns(state.rotation));
    if (turns !== "") {
        put("rotate", turns);
    }
    const camera = (["azimuth", "elevation", "zoom", "panX", "panY"] as const).map((key) =>
        short(state.orbit[key], 4),
    );
    const usual = (["azimuth", "elevation", "zoom", "panX", "panY"] as const).map((key) =>
        short(initial.orbit[key], 4),
    );
    if (camera.join() !== usual.join()) {
        put("camera", camera.join(","));
    }
    if (state.frame !== null) {
        put("frame", String(state.frame));
    }
    if (state.spacing !== null) {
        put("spacing", String(state.spacing));
    }
    if (state.range) {
        put("range", state.range.join(","));
    }
    for (const key of ["speed", "layout", "slices", "ghost", "color", "theme"] as const) {
        if (state[key] !== initial[key]) {
            put(key, encodeURIComponent(state[key])); // fields have any name
        }
    }
    for (const key of kSwitches) {
        if (state[key] !== initial[key]) {
            put(key, state[key] ? "on" : "off");
        }
    }
    return parts.map(([key, value]) => `${key}=${value}`).join("&");
}

function number(text: string, low: number, high: number): number | null {
    const value = text.trim() === "" ? NaN : Number(text);
    return value >= low && value <= high ? value : null;
}

function numbers(text: string, count: number, most: number): number[] | null {
    const values = text.split(",").map((word) => number(word, -most, most));
    return values.length === count && values.every((value) => value !== null)
        ? (values as number[])
        : null;
}

// Each gives whether it understood the value.
const kReaders: Record<string, (state: ViewState, text: string) => boolean> = {
    w: (state, text) => (state.w = number(text, -Number.MAX_VALUE, Number.MAX_VALUE)) !== null,
    rotate(state, text) {
        const turns = parseTurns(text);
        state.rotation = turns ? fromTurns(turns) : state.rotation;
        return turns !== null;
    },
    camera(state, text) {
        const [azimuth, elevation, zoom, panX, panY] = numbers(text, 5, 1e9) ?? [];
        if (zoom === undefined || zoom < 0.05 || zoom > 100 || Math.abs(elevation!) > 89) {
            return false;
        }
        state.orbit = { azimuth: azimuth!, elevation: elevation!, zoom, panX: panX!, panY: panY! };
        return true;
    },
    frame(state, text) {
        state.frame = /^\d{1,9}$/.test(text) ? Number(text) : null;
        return state.frame !== null;
    },
    speed: (state, text) => (state.speed = number(text, 0.01, 100) ?? state.speed) === Number(text),
    slices(state, text) {
        const count = number(text, 2, 9);
        state.slices = count !== null && Number.isInteger(count) ? count : state.slices;
        return state.slices === count;
    },
    spacing: (state, text) =>
        (state.spacing = number(text, Number.MIN_VALUE, Number.MAX_VALUE)) !== null,
    range(state, text) {
        const ends = numbers(text, 2, Number.MAX_VALUE);
        state.range = ends && ends[0]! < ends[1]! ? [ends[0]!, ends[1]!] : null;
        return state.range !== null;
    },
    layout: (state, text) =>
        choose(kLayouts, text, (value) => {
            state.layout = value;
        }),
    ghost: (state, text) =>
        choose(kGhosts, text, (value) => {
            state.ghost = value;
        }),
    color(state, text) {
        state.color = text || state.color;
        return text !== "";
    },
    theme: (state, text) =>
        choose(kThemes, text, (value) => {
            state.theme = value;
        }),
};

function choose<T extends string>(known: readonly T[], text: string, set: (value: T) => void) {
    const value = known.find((one) => one === text);
    if (value !== undefined) {
        set(value);
    }
    return value !== undefined;
}

/** Reads what formatState wrote, or a person did.
 *
 * @return  The state, and the parts that were not understood: they have their defaults. */
export function parseState(text: string): { state: ViewState; unknown: string[] } {
    const state = defaultState();
    const unknown: string[] = [];
    for (const part of text
        .replace(/^#/, "")
        .split("&")
        .filter((word) => word !== "")) {
        const [key, ...rest] = part.split("=");
        const value = rest.join("=");
        const flag = kSwitches.find((one) => one === key);
        let isKnown = false;
        try {
            const decoded = decodeURIComponent(value);
            if (flag) {
                isKnown = decoded === "on" || decoded === "off";
                state[flag] = isKnown ? decoded === "on" : state[flag];
            } else {
                isKnown = Object.hasOwn(kReaders, key!) && kReaders[key!]!(state, decoded);
            }
        } catch {
            // a broken %
        }
        if (!isKnown) {
            unknown.push(part);
        }
    }
    return { state, unknown };
}
