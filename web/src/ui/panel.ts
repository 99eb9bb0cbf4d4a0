import { kColorings } from "../run/quantities.ts";
import { spacingOf } from "../view/compose.ts";
import { axesOf, fromTurns, identity, kPlanes, toTurns } from "../view/rotation.ts";
import type { Plane, Rotation } from "../view/rotation.ts";
import type { ViewState } from "../view/state.ts";
import type { Viewer } from "../view/viewer.ts";
import { Slider, button, choice, section, segments, toggle } from "./controls.ts";
import { element } from "./dom.ts";
import { kIcons } from "./icons.ts";

// The six angles whose turns, in this order, make the rotation. What a slider sets is one of them.
const kOrder: Plane[] = ["zw", "yw", "yz", "xw", "xz", "xy"];

class TurnControls {
    readonly root: HTMLElement;
    private sliders = new Map<Plane, Slider>();
    private angles = new Map<Plane, number>();
    private own: Rotation | null = null; // what the sliders made themselves

    constructor(private viewer: Viewer) {
        for (const plane of kPlanes) {
            this.sliders.set(
                plane,
                new Slider(plane, "\u00b0", { min: -180, max: 180, step: 1 }, (degrees) =>
                    this.set(plane, degrees),
                ),
            );
        }
        this.root = element(
            "div",
            { class: "turns" },
            ...[...this.sliders.values()].map((slider) => slider.root),
            button(
                "Turn back to the start",
                kIcons.reset,
                () => viewer.update({ rotation: identity() }),
                "Turn back",
            ),
        );
    }

    show(rotation: Rotation, dimension: number): void {
        if (rotation !== this.own) {
            kPlanes.forEach((plane) => this.angles.set(plane, 0));
            for (const turn of toTurns(rotation)) {
                const plane = ("xyzw"[turn.from]! + "xyzw"[turn.to]!) as Plane;
                this.angles.set(plane, turn.degrees);
            }
        }
        this.sliders.forEach((slider, plane) => {
            slider.show(this.angles.get(plane)!, 1);
            slider.root.hidden = dimension === 3 && plane.includes("w");
        });
    }

    private set(plane: Plane, degrees: number): void {
        this.angles.set(plane, degrees);
        this.own = fromTurns(
            kOrder.map((one) => {
                const [from, to] = axesOf(one);
                return { from, to, degrees: this.angles.get(one) ?? 0 };
            }),
        );
        this.viewer.update({ rotation: this.own });
    }
}

/** The panel of controls beside the picture. */
export class Panel {
    private turns: TurnControls;
    private shows: ((state: ViewState) => void)[] = [];
    private onlyIn4: HTMLElement[] = [];

    constructor(
        private root: HTMLElement,
        private viewer: Viewer,
    ) {
        this.turns = new TurnControls(viewer);
        const slices = this.sliceSection();
        const color = this.colorSection();
        this.onlyIn4.push(slices);
        root.append(
            slices,
            section("Turn", this.turns.root),
            this.showSection(),
            color,
            element("p", { id: "facts", class: "facts" }),
        );
        viewer.on("state", (state) => this.show(state));
        viewer.on("run", () => this.show(viewer.state));
    }

    private show(state: ViewState): void {
        const dimension = this.viewer.run?.dimension ?? 4;
        this.turns.show(state.rotation, dimension);
        this.shows.forEach((show) => show(state));
        this.onlyIn4.forEach((one) => {
            one.hidden = dimension === 3;
        });
        const run = this.viewer.run;
        const facts = this.root.querySelector("#facts")!;
        const count = (key: "vertexCount" | "cellCount") =>
            run!.bodies.reduce((sum, body) => sum + body[key], 0).toLocaleString("en");
        // A simulation has no frames to count.
        const frames =
            !run || run.stage
                ? ""
                : run.frames.length === 1
                  ? ", 1 frame"
                  : `, ${run.frames.length} frames`;
        // Models of other programs are boundaries.
        const name = dimension === 4 ? "pentachora" : "tetrahedra";
        const cells =
            run && run.bodies.some(({ cellCount }) => cellCount > 0)
                ? `, ${count("cellCount")} ${name}`
                : "";
        facts.textContent = run
            ? `${run.bodies.length === 1 ? "1 body" : `${run.bodies.length} bodies`}` +
              `, ${count("vertexCount")} vertices${cells}${frames}`
            : "";
    }

    private sliceSection(): HTMLElement {
        const { viewer } = this;
        const layout = segments(
            "Slices",
            [
                ["single", "One"],
                ["side", "Side by side"],
                ["onion", "Onion skin", "Neighboring slices as ghosts"],
            ] as const,
            (value) => viewer.update({ layout: value }),
        );
        const count = new Slider("count", "", { min: 2, max: 9, step: 1 }, (value) =>
            viewer.update({ slices: Math.min(9, Math.max(2, Math.round(value))) }),
        );
        const spacing = new Slider("spacing", "m", { min: 0.001, max: 1, step: 0.001 }, (value) =>
            viewer.update({ spacing: value > 0 ? value : null }),
        );
        this.shows.push((state) => {
            const [low, high] = viewer.bounds.isEmpty
                ? [-1, 1]
                : viewer.bounds.reach(state.rotation, 3);
            layout.show(state.layout);
            spacing.setRange((high - low) / 1000, (high - low) / 2, (high - low) / 1000);
            count.show(state.slices, 0);
            const digits = Math.max(4, 4 - Math.floor(Math.log10(high - low || 1)));
            spacing.show(viewer.bounds.isEmpty ? 0.1 : spacingOf(state, viewer.bounds), digits);
            count.root.hidden = spacing.root.hidden = state.layout === "single";
        });
        return section("Slices", layout.root, count.root, spacing.root);
    }

    private showSection(): HTMLElement {
        const { viewer } = this;
        // A ghost of the whole body, projected along w.
        const ghost = choice(
            "Projection",
            [
                ["none", "none"],
                ["orthographic", "orthographic"],
                ["perspective", "perspective"],
            ] as const,
            (value) => viewer.update({ ghost: value }),
        );
        const switches = (
            [
                ["box", "Tesseract box", "The box about all bodies and its slice"],
                ["axes", "Axes", "How the axes x y z w lie"],
                ["floor", "Floor", "A floor that takes shadows, where there is no ground"],
                ["obstacles", "Obstacles", "What bodies touch: ground, walls, balls, boxes"],
                ["shade", "Shadows", "Shadows and ambient occlusion"],
                ["smooth", "Smooth", "Smooth normals, but for edges sharper than 57 degrees"],
            ] as const
        ).map(([key, label, title]) => {
            const control = toggle(label, (value) => viewer.update({ [key]: value }), title);
            this.shows.push((state) => control.show(state[key]));
            if (key === "box") {
                this.onlyIn4.push(control.root);
            } else if (key === "obstacles") {
                viewer.on("moment", ({ obstacles }) => {
                    control.root.hidden = obstacles.length === 0;
                });
            }
            return control.root;
        });
        this.onlyIn4.push(ghost.root);
        this.shows.push((state) => ghost.show(state.ghost));
        return section("Show", ghost.root, element("div", { class: "toggles" }, ...switches));
    }

    private colorSection(): HTMLElement {
        const { viewer } = this;
        const by = choice<string>("Color by", [], (value) =>
            viewer.update({ color: value, range: null }),
        );
        viewer.on("moment", () => {
            by.offer(
                viewer.colorings.map(({ name, isThere }) => {
                    if (isThere || kColorings.includes(name)) {
                        // What a run could have may be chosen, to be told how.
                        return [name, name === "force" ? "contact force" : name];
                    }
                    return [name, `${name} (not of all bodies)`, { disabled: true }];
                }),
            );
            by.show(viewer.state.color);
        });
        const ends = [0, 1].map((end) =>
            element("input", {
                type: "number",
                step: "any",
                "aria-label": end ? "highest value" : "lowest value",
                change: () => {
                    const range = [...viewer.range] as [number, number];
                    range[end] = ends[end]!.valueAsNumber;
                    viewer.update({ range: range[0] < range[1] ? range : null });
                },
            }),
        );
        const range = element(
            "div",
            { class: "row range" },
            element("span", {}, "from"),
            ends[0]!,
            element("span", {}, "to"),
            ends[1]!,
            button("Range as the frames have it", kIcons.reset, () =>
                viewer.update({ range: null }),
            ),
        );
        const showRange = () => {
            range.hidden = viewer.state.color === "body";
            ends.forEach((input, end) => {
                if (document.activeElement !== input) {
                    input.value = String(Number(viewer.range[end]!.toPrecision(4)));
                }
            });
        };
        this.shows.push((state) => {
            by.show(state.color);
            showRange();
        });
        viewer.on("picture", showRange);
        return section("Color", by.root, range);
    }
}
