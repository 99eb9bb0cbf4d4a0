import type { PlayFacts, PlayStats } from "../../play/protocol.ts";
import { kGallery } from "../../play/scene_list.ts";
import { Slider, choice, section } from "../controls.ts";
import type { Curve } from "../controls.ts";
import { element } from "../dom.ts";
import { joules } from "./play_bar.ts";

/** What the panel asks for. */
export interface PlayWishes {
    openGallery(name: string): void;
    setGravity(gravity: number[]): void;
    /** `stepsPerSecond` null: as the machine has it. */
    tune(stiffness: number, damping: number, stepsPerSecond: number | null): void;
}

const kEarth = 9.8; // m/s^2
const kOwn = "own";
const kPowers: Curve = { toPlace: Math.log10, toValue: (place) => 10 ** place };
const kShowEvery = 250; // ms

/** The part of the panel that is there while a simulation runs. */
export class PlayPanel {
    readonly root: HTMLElement;
    private scene;
    private name = kOwn; // of the scene
    private note = element("p", { class: "note" });
    private directions: { axis: number; sign: number; button: HTMLButtonElement }[] = [];
    private strength: Slider;
    private stiffness: Slider;
    private damping: Slider;
    private rate;
    private table = element("table", { class: "energies" });
    private facts: PlayFacts | null = null;
    private direction = [0, -1, 0, 0];
    private lastShown = 0;

    constructor(private wishes: PlayWishes) {
        this.scene = choice(
            "Scene",
            [
                ...Object.entries(kGallery).map(([name, { title }]) => [name, title] as const),
                [kOwn, "your own"] as const,
            ],
            (name) => (name === kOwn ? this.scene.show(this.name) : wishes.openGallery(name)),
        );
        this.strength = new Slider("strength", "", { min: 0, max: 20, step: 0.1 }, (value) =>
            this.pull(this.direction, value),
        );
        this.stiffness = new Slider(
            "stiffness \u00d7",
            "",
            { min: -1, max: 1, step: 0.05 },
            (value) => this.tune({ stiffness: Number(value.toPrecision(3)) }),
            kPowers,
        );
        this.damping = new Slider("damping", "ms", { min: 0, max: 100, step: 1 }, (value) =>
            this.tune({ damping: Math.max(value, 0) / 1000 }),
        );
        this.rate = choice(
            "Time step",
            [
                ["auto", "automatic"],
                ...[30, 60, 120, 240].map((rate) => [String(rate), `1/${rate} s`] as const),
            ] as (readonly [string, string])[],
            (value) => this.tune({ rate: value === "auto" ? null : Number(value) }),
        );
        this.root = element(
            "div",
            { class: "play-panel" },
            section("Scene", this.scene.root, this.note),
            section("Gravity", this.compass(), this.strength.root),
            section("Body", this.stiffness.root, this.damping.root, this.rate.root),
            section("Energy", this.table),
        );
    }

    /** Another scene is open: one of the gallery, or "" for one's own. */
    showScene(name: string, dimension: 3 | 4, facts: PlayFacts): void {
        this.name = name || kOwn;
        this.scene.show(this.name);
        this.note.textContent = kGallery[name]?.note ?? "";
        this.directions.forEach(({ axis, button }) => {
            button.hidden = axis >= dimension;
        });
        const size = Math.hypot(...facts.gravity);
        this.direction = size > 0 ? facts.gravity.map((value) => value / size) : [0, -1, 0, 0];
        this.showFacts(facts);
    }

    showFacts(facts: PlayFacts): void {
        this.facts = facts;
        const size = Math.hypot(...facts.gravity);
        this.strength.show(size, 1);
        this.directions.forEach(({ axis, sign, button }) => {
            const isIt = size > 0 && facts.gravity[axis]! * sign > 0.999 * size;
            button.setAttribute("aria-pressed", String(isIt));
        });
        this.stiffness.show(facts.stiffness, 2);
        this.damping.show(1000 * facts.damping, 1);
        this.rate.show(facts.isAutomatic ? "auto" : String(facts.stepsPerSecond));
    }

    showStats(stats: PlayStats, isRunning: boolean): void {
        const now = performance.now();
        if (isRunning && now - this.lastShown < kShowEvery) {
            return;
        }
        this.lastShown = now;
        const total = stats.energies.reduce((sum, [, value]) => sum + value, 0);
        const rows: [string, string][] = [
            ...stats.energies.map(([name, value]) => [name, joules(value)] as [string, string]),
            ["together", joules(total)],
            ["step", `1/${stats.stepsPerSecond} s in ${stats.milliseconds.toFixed(1)} ms`],
            ["touching", String(stats.touching)],
            ["inside out", stats.inverted === 0 ? "none" : `${stats.inverted} cells`],
        ];
        this.table.replaceChildren(
            ...rows.map(([name, value]) =>
                element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, value)),
            ),
        );
    }

    private compass(): HTMLElement {
        for (const sign of [1, -1]) {
            [..."xyzw"].forEach((letter, axis) => {
                const text = `${sign > 0 ? "+" : "\u2212"}${letter}`;
                const direction = [0, 0, 0, 0];
                direction[axis] = sign;
                const button = element(
                    "button",
                    {
                        type: "button",
                        class: "button",
                        "aria-label": `gravity along ${text}`,
                        click: () => this.toggle(direction, button),
                    },
                    text,
                );
                this.directions.push({ axis, sign, button });
            });
        }
        return element(
            "div",
            { class: "compass", role: "group", "aria-label": "direction of gravity" },
            ...this.directions.map(({ button }) => button),
        );
    }

    // The direction that is there already: none.
    private toggle(direction: number[], button: HTMLButtonElement): void {
        const isOn = button.ariaPressed === "true";
        const size = Math.hypot(...this.facts!.gravity);
        this.pull(direction, isOn ? 0 : size > 0 ? size : kEarth);
    }

    private pull(direction: number[], size: number): void {
        this.direction = direction;
        const gravity = direction.map((value) => (value === 0 ? 0 : value * Math.max(size, 0)));
        this.wishes.setGravity(gravity);
        this.showFacts({ ...this.facts!, gravity });
    }

    private tune(wish: { stiffness?: number; damping?: number; rate?: number | null }): void {
        const { facts } = this;
        if (!facts) {
            return;
        }
        const now = facts.isAutomatic ? null : facts.stepsPerSecond;
        const rate = wish.rate === undefined ? now : wish.rate;
        const { stiffness = facts.stiffness, damping = facts.damping } = wish;
        this.showFacts({
            ...facts,
            stiffness,
            damping,
            isAutomatic: rate === null,
            stepsPerSecond: rate ?? facts.stepsPerSecond,
        });
        this.wishes.tune(stiffness, damping, rate);
    }
}
