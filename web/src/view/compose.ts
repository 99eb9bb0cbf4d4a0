import type { Coloring, Picture, SliceView, Tile } from "../render/picture.ts";
import type { Bounds } from "./bounds.ts";
import { tesseract } from "./box.ts";
import type { Film } from "./box.ts";
import { makeCamera } from "./camera.ts";
import { bodyColor, mapColor, obstacleColor, rangeColors } from "./colors.ts";
import type { Color } from "./colors.ts";
import type { Vector } from "./matrix.ts";
import { placeObstacles } from "./place_obstacles.ts";
import type { Obstacle } from "../format/obstacles.ts";
import { rounded } from "./digits.ts";
import type { ViewState } from "./state.ts";

const kBackgrounds: Record<"light" | "dark", Picture["background"] & { ink: Color }> = {
    light: {
        bottom: [0.86, 0.86, 0.85],
        top: [0.66, 0.7, 0.75],
        glow: [0.03, 0.03, 0.028],
        ink: [0.02, 0.025, 0.03],
    },
    dark: {
        bottom: [0.022, 0.023, 0.026],
        top: [0.011, 0.012, 0.015],
        glow: [0.05, 0.051, 0.055],
        ink: [0.8, 0.82, 0.85],
    },
};

const kMapSize = 256;

/** Where the slices are: one, or several about w. */
export function slicePlaces(state: ViewState, bounds: Bounds, dimension: number): number[] {
    const w = state.w ?? bounds.pivot[3];
    if (dimension === 3 || state.layout === "single") {
        return [w];
    }
    const spacing = spacingOf(state, bounds);
    return Array.from(
        { length: state.slices },
        (_, i) => w + (i - (state.slices - 1) / 2) * spacing,
    );
}

/** What is asked for, or what spreads the slices over two thirds of the bodies as they start. */
export function spacingOf(state: ViewState, bounds: Bounds): number {
    if (state.spacing !== null) {
        return state.spacing;
    }
    const [low, high] = bounds.start.reach(state.rotation, 3);
    return Number(((high - low) / 1.5 / state.slices).toPrecision(2)) || 0.1;
}

/** "w = 0.05", with the digits that tell slices of bodies of a size apart. */
export function sliceLabel(w: number, size: number): string {
    return `w = ${rounded(w, size)}`.replace("-", "\u2212");
}

/** How many tiles stand beside one another, so that they are as large as can be; rather without a
 * gap in the last row. */
export function columnsFor(count: number, width: number, height: number): number {
    const kGapCost = 0.2;
    let best = 1;
    let most = 0;
    for (let columns = 1; columns <= count; ++columns) {
        const rows = Math.ceil(count / columns);
        const size = Math.min(width / columns, height / rows);
        const worth = size * (rows * columns > count ? 1 - kGapCost : 1);
        if (worth > most) {
            most = worth;
            best = columns;
        }
    }
    return best;
}

function makeTiles(state: ViewState, bounds: Bounds, dimension: number): Tile[] {
    const places = slicePlaces(state, bounds, dimension);
    if (state.layout !== "onion" || places.length === 1) {
        return places.map((w) => tileOf([{ w, ghost: null, balls: [] }]));
    }
    // All but the middle one as ghosts, from teal, the first, to orange, the last.
    const middle = Math.floor(places.length / 2);
    const slices = places.map((w, i) => ({
        w,
        ghost: i === middle ? null : mapColor("w", i / (places.length - 1)),
        balls: [],
    }));
    return [tileOf(slices)];
}

function tileOf(slices: SliceView[]): Tile {
    return {
        slices,
        surfaces: [],
        rims: [],
        outlines: [],
        hasFloor: true,
        isAllSolid: false,
        away: null,
        lines: [],
    };
}

/** The eye of the projection: over the film, under it the middle of the bodies, at three times
 * their reach; a distance of 0 stands for infinitely far. */
function eyeOf(state: ViewState, bounds: Bounds): [number, number, number, number] {
    const [x, y, z] = [0, 1, 2].map((axis) => {
        const [low, high] = bounds.reach(state.rotation, axis);
        return (low + high) / 2;
    });
    const diagonal = Math.hypot(...bounds.low.map((low, k) => bounds.high[k]! - low));
    return [x!, y!, z!, state.ghost === "perspective" ? 1.5 * diagonal : 0];
}

function addBox(tiles: Tile[], state: ViewState, bounds: Bounds, ink: Color): void {
    const eye = eyeOf(state, bounds);
    for (const tile of tiles) {
        const w = tile.slices.find((slice) => slice.ghost === null)!.w;
        const film: Film = (p) => {
            const scale = eye[3] > 0 ? eye[3] / (eye[3] - (p[3] - w)) : 1;
            return [0, 1, 2].map((k) => eye[k]! + (p[k]! - eye[k]!) * scale) as Vector;
        };
        tile.lines.push(...tesseract(bounds, state.rotation, w, film, ink));
    }
}

export function makeColoring(state: ViewState, range: [number, number], bodies: number): Coloring {
    const valueOf = state.color === "body" ? "nothing" : state.color === "w" ? "w" : "scalar";
    return {
        valueOf,
        range,
        bodies: Array.from({ length: bodies }, (_, i) => bodyColor(i)),
        map: rangeColors(state.color, range, kMapSize),
    };
}

/** What the page knows beside the state. */
export interface Stage {
    width: number; // pixels
    height: number;
    pixelRatio: number;
    theme: "light" | "dark";
    dimension: 3 | 4;
    bounds: Bounds;
    coloring: Coloring;
    obstacles: Obstacle[]; // at the moment shown
    reach: [number, number] | null; // of the bodies along w at that moment
}

/** The picture that a state asks for. */
export function makePicture(state: ViewState, stage: Stage): Picture {
    const { bounds, dimension, width, height } = stage;
    const tiles = makeTiles(state, bounds, dimension);
    const columns = columnsFor(tiles.length, width, height);
    const rows = Math.ceil(tiles.length / columns);
    const background = kBackgrounds[stage.theme];
    const center = bounds.pivot.slice(0, 3) as Vector;
    const camera = makeCamera(
        state.orbit,
        center,
        state.box && dimension === 4 ? Math.max(bounds.radius, bounds.boxRadius) : bounds.radius,
        width / columns / (height / rows),
    );
    const { reach } = stage;
    if (reach && dimension === 4) {
        const isAway = ({ w }: SliceView) => w < reach[0] || w > reach[1];
        tiles.forEach((tile) => {
            tile.away = tile.slices.every(isAway) ? reach : null;
        });
    }
    if (state.box && dimension === 4) {
        addBox(tiles, state, bounds, background.ink);
    }
    const ground = 2.6 * bounds.radius;
    const shift = bounds.shift(state.rotation);
    // Under the ghosts of an outline, too, but not far below a body that is thin.
    let [lowest] = bounds.reach(state.rotation, 1);
    if (state.obstacles) {
        const section = { rotation: state.rotation, shift, is4: dimension === 4 };
        const view = { center, reach: ground, largest: bounds.size };
        const eye = state.ghost === "none" ? null : eyeOf(state, bounds);
        lowest = Math.min(lowest, placeObstacles(tiles, stage.obstacles, section, view, eye));
    }
    return {
        width,
        height,
        pixelRatio: stage.pixelRatio,
        columns,
        tiles,
        camera,
        rotation: state.rotation,
        shift,
        center,
        radius: bounds.radius,
        floor: state.floor ? lowest - 0.004 * bounds.radius : null,
        ground,
        obstacles: state.obstacles ? obstacleColor(stage.theme) : null,
        outline:
            state.ghost === "none" || dimension === 3
                ? null
                : {
                      eye: eyeOf(state, bounds),
                      color: stage.theme === "dark" ? [0.75, 0.8, 0.9] : [0.16, 0.2, 0.28],
                  },
        coloring: stage.coloring,
        isSmooth: state.smooth,
        isShaded: state.shade,
        background,
        lineWidth: 0.75 * stage.pixelRatio,
    };
}
