import { tileRect } from "../render/picture.ts";
import type { Picture, Tile } from "../render/picture.ts";
import { sliceLabel, slicePlaces } from "../view/compose.ts";
import { bodyColor, kColorTitles, mapColor, toCss } from "../view/colors.ts";
import { short } from "../view/state.ts";
import type { Viewer } from "../view/viewer.ts";
import { element, svg } from "./dom.ts";
import { drawGizmo } from "./gizmo.ts";

/** Text over the picture: what slice each tile is, the legend of colors, the axes. */
export class Overlay {
    private labels = element("div", { class: "labels" });
    private legend = element("div", { class: "legend" });
    private gizmo = svg("svg", { viewBox: "0 0 100 100", class: "gizmo" }) as SVGSVGElement;
    private badge = element("div", { class: "badge", hidden: true });
    private labelsShown = "";
    private legendShown = "";

    constructor(
        private root: HTMLElement,
        private viewer: Viewer,
    ) {
        root.append(this.labels, this.gizmo, this.legend, this.badge);
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
        this.showLegend();
    }

    private showLabels(picture: Picture): void {
        const places = slicePlaces(
            this.viewer.state,
            this.viewer.bounds,
            this.viewer.run!.dimension,
        );
        const solid = picture.tiles.map((tile) => tile.isAllSolid).join();
        const key = `${picture.width} ${picture.height} ${places.join()} ${solid}`;
        if (key === this.labelsShown) {
            return;
        }
        this.labelsShown = key;
        const isTiled = picture.tiles.length > 1;
        this.labels.replaceChildren(
            ...picture.tiles
                .map((tile, i) => {
                    const text = tileText(tile, isTiled ? places[i]! : null);
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

    private showLegend(): void {
        const { state, range, run } = this.viewer;
        const key = `${state.color} ${range.join()} ${run!.bodies.map((body) => body.name).join()}`;
        if (key === this.legendShown) {
            return;
        }
        this.legendShown = key;
        if (state.color === "body") {
            const bodies = run!.bodies.length > 1 ? run!.bodies.slice(0, 8) : [];
            this.legend.replaceChildren(
                ...bodies.map((body, i) => {
                    const swatch = element("i", { class: "swatch" });
                    swatch.style.background = toCss(bodyColor(i));
                    return element("div", { class: "entry" }, swatch, body.name);
                }),
            );
            return;
        }
        const stops = Array.from({ length: 9 }, (_, i) => toCss(mapColor(state.color, i / 8)));
        const bar = element("div", { class: "colorbar" });
        bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
        this.legend.replaceChildren(
            element("div", { class: "title" }, kColorTitles[state.color]),
            bar,
            element(
                "div",
                { class: "ends" },
                ...range.map((end) => element("span", {}, short(end, 3))),
            ),
        );
    }
}

// "w = 0.05, all solid": what there is to say of a tile.
function tileText(tile: Tile, w: number | null): string {
    const place = w === null ? "" : sliceLabel(Number(w.toPrecision(6)));
    return [place, tile.isAllSolid ? "all solid" : ""].filter((text) => text !== "").join(", ");
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
    const time = run!.frames.length > 1 ? `t = ${moment!.time.toFixed(3)} s    ` : "";
    const isTiled = picture.tiles.length > 1;
    const middle = places[Math.floor(places.length / 2)]!;
    const where = isTiled ? "" : tileText(picture.tiles[0]!, run!.dimension === 3 ? null : middle);
    context.fillText(time + where, size, height - size);
    if (isTiled) {
        context.textAlign = "center";
        places.forEach((w, i) => {
            const [x, y, tileWidth, tileHeight] = tileRect(picture, i);
            context.fillText(
                tileText(picture.tiles[i]!, w),
                x + tileWidth / 2,
                height - y - tileHeight + 1.6 * size,
            );
        });
    }
    if (state.color !== "body") {
        const barWidth = Math.min(10 * size, width / 2);
        const left = width - barWidth - size;
        const bottom = height - 2.2 * size;
        for (let x = 0; x < barWidth; ++x) {
            context.fillStyle = toCss(mapColor(state.color, (x + 0.5) / barWidth));
            context.fillRect(left + x, bottom - size * 0.66, 1.5, size * 0.66);
        }
        context.fillStyle = viewer.theme === "dark" ? "#e8eaee" : "#1b1e24";
        context.textAlign = "center";
        context.fillText(kColorTitles[state.color], left + barWidth / 2, bottom - size);
        context.textAlign = "left";
        context.fillText(short(range[0], 3), left, height - size);
        context.textAlign = "right";
        context.fillText(short(range[1], 3), left + barWidth, height - size);
    }
}
