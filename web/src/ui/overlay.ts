import { tileRect } from "../render/picture.ts";
import type { Picture, Tile } from "../render/picture.ts";
import { sliceLabel, slicePlaces } from "../view/compose.ts";
import { bodyColor, colorTitle, rangeColors, toCss } from "../view/colors.ts";
import type { Color } from "../view/colors.ts";
import { roughly, timeText } from "../view/digits.ts";
import { short } from "../view/state.ts";
import type { Viewer } from "../view/viewer.ts";
import { element, svg } from "./dom.ts";
import { drawGizmo } from "./gizmo.ts";

/** Text over the picture: what slice each tile is, the legend of colors, the axes. */
export class Overlay {
    private labels = element("div", { class: "labels" });
    private colors = element("div", {});
    private skins = element("div", { class: "skins" });
    private gizmo = svg("svg", { viewBox: "0 0 100 100", class: "gizmo" }) as SVGSVGElement;
    private badge = element("div", { class: "badge", hidden: true });
    private labelsShown = "";
    private colorsShown = "";
    private skinsShown = "";

    constructor(
        private root: HTMLElement,
        private viewer: Viewer,
    ) {
        const legend = element("div", { class: "legend" }, this.colors, this.skins);
        root.append(this.labels, this.gizmo, legend, this.badge);
        viewer.on("picture", (picture) => this.show(picture));
    }

    showTurn(text: string): void {
        this.badge.hidden = text === "";
        this.badge.textContent = text;
    }

    private show(picture: Picture): void {
        const { viewer } = this;
        this.root.classList.toggle("tiled", picture.tiles.length > 1);
        this.gizmo.toggleAttribute("hidden", !viewer.state.axes);
        if (viewer.state.axes) {
            drawGizmo(this.gizmo, picture.rotation, picture.camera, viewer.run!.dimension);
        }
        this.showLabels(picture);
        this.showColors();
        this.showSkins(picture);
    }

    private showLabels(picture: Picture): void {
        const places = slicePlaces(
            this.viewer.state,
            this.viewer.bounds,
            this.viewer.run!.dimension,
        );
        const isTiled = picture.tiles.length > 1;
        const texts = picture.tiles.map((tile, i) =>
            tileText(tile, isTiled ? places[i]! : null, this.viewer.bounds.size),
        );
        const key = `${picture.width} ${picture.height} ${texts.join()}`;
        if (key === this.labelsShown) {
            return;
        }
        this.labelsShown = key;
        this.labels.replaceChildren(
            ...texts
                .map((text, i) => {
                    if (text === "") {
                        return [];
                    }
                    const [x, y, width, height] = tileRect(picture, i);
                    const part = (value: number, whole: number) => `${(100 * value) / whole}%`;
                    const label = element("span", {}, text);
                    label.style.left = part(x + width / 2, picture.width);
                    label.style.top = part(picture.height - y - height, picture.height);
                    const frame = element("i", {});
                    frame.style.left = part(x, picture.width);
                    frame.style.bottom = part(y, picture.height);
                    frame.style.width = part(width, picture.width);
                    frame.style.height = part(height, picture.height);
                    return [frame, label];
                })
                .flat(),
        );
    }

    // Which slice of an onion skin has which color.
    private showSkins({ tiles }: Picture): void {
        const slices = tiles.length === 1 ? tiles[0]!.slices : [];
        const key = slices.map(({ w }) => w).join();
        if (key === this.skinsShown) {
            return;
        }
        this.skinsShown = key;
        const { size } = this.viewer.bounds;
        const entries = slices.length > 1 ? [...slices].reverse() : [];
        this.skins.replaceChildren(
            ...entries.map(({ w, ghost }) => entry(ghost, sliceLabel(w, size))),
        );
    }

    private showColors(): void {
        const { state, range, run } = this.viewer;
        const key = `${state.color} ${range.join()} ${run!.bodies.map((body) => body.name).join()}`;
        if (key === this.colorsShown) {
            return;
        }
        this.colorsShown = key;
        if (state.color === "body") {
            const kMost = 8; // as many as there are colors
            const names = run!.bodies.length > 1 ? run!.bodies.map((body) => body.name) : [];
            const more = names.length - kMost;
            this.colors.replaceChildren(
                ...names.slice(0, kMost).map((name, i) => entry(bodyColor(i), name)),
                element("div", { class: "more" }, more > 0 ? `and ${more} more` : ""),
            );
            return;
        }
        const stops = rangeColors(state.color, range, 9).map(toCss);
        const ends = range[0] < range[1] ? range : [range[0]]; // or one value
        const title = colorTitle(state.color, run!.dimension);
        const bar = element("div", { class: "colorbar" });
        bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
        this.colors.replaceChildren(
            element("div", { class: "title", title }, title),
            bar,
            element(
                "div",
                { class: "ends" },
                ...ends.map((end) => element("span", {}, short(end, 3))),
            ),
        );
    }
}

// A line of a legend; without a color for what is solid in a picture of ghosts.
function entry(color: Color | null, text: string): HTMLElement {
    const swatch = element("i", { class: color ? "swatch" : "swatch none" });
    swatch.style.background = color ? toCss(color) : "none";
    return element("div", { class: "entry", title: text }, swatch, element("span", {}, text));
}

// "w = 0.05, all solid": what there is to say of a tile.
function tileText(tile: Tile, w: number | null, size: number): string {
    const place = w === null ? "" : sliceLabel(w, size);
    const solid = tile.isAllSolid ? "all solid" : "";
    const away = tile.away ? (w === null ? whereElse(tile.away, size) : "empty") : "";
    return [place, solid, away].filter((text) => text !== "").join(", ");
}

function whereElse([low, high]: [number, number], size: number): string {
    const [from, to] = [low, high].map((w) => String(roughly(w, size)).replace("-", "\u2212"));
    return `no body here: from w = ${from} to ${to}`;
}

/** The same texts drawn on a picture that is saved. */
export function drawCaption(
    context: CanvasRenderingContext2D,
    viewer: Viewer,
    picture: Picture,
): void {
    const { state, range, moment, run, bounds } = viewer;
    const size = Math.max(13, Math.min(picture.height / 30, 44));
    const { width, height } = picture;
    context.font = `${size}px system-ui, sans-serif`;
    context.fillStyle = viewer.theme === "dark" ? "#e8eaee" : "#1b1e24";
    context.textBaseline = "alphabetic";
    context.textAlign = "left";
    const places = slicePlaces(state, bounds, run!.dimension);
    const time =
        run!.frames.length > 1 ? `t = ${timeText(moment!.time, viewer.secondsPerFrame)}    ` : "";
    const isTiled = picture.tiles.length > 1;
    const middle = places[Math.floor(places.length / 2)]!;
    const where = isTiled
        ? ""
        : tileText(picture.tiles[0]!, run!.dimension === 3 ? null : middle, bounds.size);
    context.fillText(time + where, size, height - size);
    if (isTiled) {
        context.textAlign = "center";
        places.forEach((w, i) => {
            const [x, y, tileWidth, tileHeight] = tileRect(picture, i);
            context.fillText(
                tileText(picture.tiles[i]!, w, bounds.size),
                x + tileWidth / 2,
                height - y - tileHeight + 1.6 * size,
            );
        });
    }
    if (state.color !== "body") {
        const barWidth = Math.min(10 * size, width / 2);
        const left = width - barWidth - size;
        const bottom = height - 2.2 * size;
        rangeColors(state.color, range, Math.ceil(barWidth)).forEach((color, x) => {
            context.fillStyle = toCss(color);
            context.fillRect(left + x, bottom - size * 0.66, 1.5, size * 0.66);
        });
        context.fillStyle = viewer.theme === "dark" ? "#e8eaee" : "#1b1e24";
        context.textAlign = "center";
        const center = left + barWidth / 2;
        context.fillText(colorTitle(state.color, run!.dimension), center, bottom - size, barWidth);
        if (range[0] === range[1]) {
            context.fillText(short(range[0], 3), center, height - size);
            return;
        }
        context.textAlign = "left";
        context.fillText(short(range[0], 3), left, height - size);
        context.textAlign = "right";
        context.fillText(short(range[1], 3), left + barWidth, height - size);
    }
}
