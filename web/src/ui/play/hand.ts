import type { Hit } from "../../play/library.ts";
import type { Moment } from "../../run/run.ts";
import type { Vector } from "../../view/matrix.ts";
import { roughly } from "../../view/digits.ts";
import { fromSeen, onPlane, project, sightAt, toSeen } from "../../view/pointing.ts";
import type { OpenedScene, PlayCalls } from "../../play/protocol.ts";
import type { Viewer } from "../../view/viewer.ts";
import { svg } from "../dom.ts";

/** Where a pointer is, in parts of the canvas. */
interface Place {
    x: number;
    y: number;
}

interface Held {
    hit: Hit;
    corners: number[]; // vertices of the cell
    anchor: number[]; // as seen: x y z w
}

/** Asks the simulation; undefined where it fails, which is said elsewhere. */
type Ask = <Name extends keyof PlayCalls>(
    name: Name,
    ...values: Parameters<PlayCalls[Name]>
) => Promise<ReturnType<PlayCalls[Name]> | undefined>;

// Places all over the picture, the middle first.
const kFromMiddle: Place[] = Array.from({ length: 81 }, (_, i) => ({
    x: 0.1 + 0.1 * (i % 9),
    y: 0.1 + 0.1 * Math.floor(i / 9),
})).sort((a, b) => Math.hypot(a.x - 0.5, a.y - 0.5) - Math.hypot(b.x - 0.5, b.y - 0.5));
const kWPerHeight = 1; // the reach of the bodies along w for a drag over the whole height

/** The hand with which a point of the slice is held and pulled: along the picture by the pointer, along w by the
 * wheel or an upright drag. */
export class Hand {
    private held: Held | null = null;
    private isByKeys = false;
    private last: Place = { x: 0, y: 0 };
    private line = svg("line", { class: "rope" });
    private point = svg("circle", { r: 5, class: "grip" });
    private anchor = svg("circle", { r: 9, class: "anchor" });
    private label = svg("text", { class: "depth" });
    private drawing = svg(
        "svg",
        { class: "hand", "aria-hidden": "true" },
        this.line,
        this.point,
        this.anchor,
        this.label,
    ) as SVGSVGElement;

    constructor(
        overlay: HTMLElement,
        private viewer: Viewer,
        private ask: Ask,
        private scene: OpenedScene,
    ) {
        overlay.append(this.drawing);
        this.drawing.toggleAttribute("hidden", true);
    }

    /** Whether keys took hold, and pull: while a pointer holds something, arrows mean what they always do. */
    get isHeldByKeys(): boolean {
        return this.isHolding && this.isByKeys;
    }

    get isHolding(): boolean {
        return this.held !== null;
    }

    /** Takes hold of what is at a place.
     *
     * @return  Whether something is. */
    async take(place: Place): Promise<boolean> {
        this.isByKeys = false;
        const picture = this.picture();
        const sight = sightAt(picture, place.x, place.y);
        const is4 = this.scene.dimension === 4;
        const origin = fromSeen(picture, [...sight.eye, sight.w]);
        const ahead = fromSeen(picture, [
            ...sight.eye.map((value, axis) => value + sight.direction[axis]!),
            sight.w,
        ]);
        const normal = [...picture.rotation.subarray(12, 16)];
        const hit = await this.ask("grab", {
            origin,
            direction: ahead.map((value, axis) => value - origin[axis]!),
            slice: is4 ? { normal, offset: sight.w - picture.shift[3] } : null,
        });
        if (!hit) {
            return false;
        }
        const size = this.scene.dimension + 1;
        const { cells } = this.scene.rests[hit.body]!;
        this.held = {
            hit,
            corners: [...cells.subarray(size * hit.cell, size * (hit.cell + 1))],
            anchor: toSeen(picture, [...hit.place, 0].slice(0, 4)),
        };
        this.last = place;
        this.show(this.viewer.moment!);
        return true;
    }

    /** Takes hold of what is nearest to the middle of the picture, for those who have no pointer.
     *
     * @return  Whether something is there. */
    async takeNearMiddle(): Promise<boolean> {
        for (const place of kFromMiddle) {
            if (await this.take(place)) {
                this.isByKeys = true;
                return true;
            }
        }
        return false;
    }

    /** Pulls along the picture, by parts of its width and height. */
    nudge(right: number, up: number): void {
        this.drag({ x: this.last.x + right, y: this.last.y - up }, false);
    }

    /** The pointer has moved.
     *
     * @param isAlongW  Upright along w, in place of along the picture. */
    drag(place: Place, isAlongW: boolean): void {
        if (!this.held) {
            return;
        }
        if (isAlongW) {
            this.moveW((this.last.y - place.y) * kWPerHeight);
        } else {
            const picture = this.picture();
            const [x, y, z] = this.held.anchor;
            const before = onPlane(picture, sightAt(picture, this.last.x, this.last.y), [
                x!,
                y!,
                z!,
            ]);
            const after = onPlane(picture, sightAt(picture, place.x, place.y), [x!, y!, z!]);
            if (before && after) {
                after.forEach((value, axis) => {
                    this.held!.anchor[axis]! += value - before[axis]!;
                });
                this.send();
            }
        }
        this.last = place;
    }

    /** Pulls along w, by parts of the reach of the bodies. */
    moveW(part: number): void {
        if (this.held && this.scene.dimension === 4) {
            const { bounds, state } = this.viewer;
            const [low, high] = bounds.reach(state.rotation, 3);
            this.held.anchor[3]! += part * (high - low);
            this.send();
        }
    }

    release(): void {
        if (this.held) {
            this.held = null;
            this.drawing.toggleAttribute("hidden", true);
            void this.ask("release");
        }
    }

    /** The simulator has let go. */
    drop(): void {
        this.held = null;
        this.drawing.toggleAttribute("hidden", true);
    }

    dispose(): void {
        this.drawing.remove();
    }

    /** Draws the hand at a moment of the bodies. */
    show(moment: Moment): void {
        if (!this.held) {
            return;
        }
        const { hit, corners, anchor } = this.held;
        const { positions } = moment.bodies[hit.body]!;
        const place = [0, 1, 2, 3].map((axis) =>
            corners.reduce((sum, v, k) => sum + hit.weights[k]! * positions[4 * v + axis]!, 0),
        );
        const picture = this.picture();
        const { clientWidth, clientHeight } = this.viewer.canvas;
        const onScreen = (p: number[]) => {
            const [x, y] = project(picture, p.slice(0, 3) as Vector);
            return [String(x * clientWidth), String(y * clientHeight)] as const;
        };
        const [x1, y1] = onScreen(toSeen(picture, place));
        const [x2, y2] = onScreen(anchor);
        set(this.line, { x1, y1, x2, y2 });
        set(this.point, { cx: x1, cy: y1 });
        set(this.anchor, { cx: x2, cy: y2 });
        const away = anchor[3]! - sightAt(picture, this.last.x, this.last.y).w;
        const [low, high] = this.viewer.bounds.reach(this.viewer.state.rotation, 3);
        const isAway = Math.abs(away) > 0.01 * (high - low);
        this.drawing.classList.toggle("above", isAway && away > 0);
        this.drawing.classList.toggle("below", isAway && away < 0);
        set(this.label, { x: String(Number(x2) + 15), y: String(Number(y2) + 5) });
        this.label.textContent = isAway
            ? `w ${away > 0 ? "+" : "\u2212"}${roughly(Math.abs(away), high - low)} m`
            : "";
        this.drawing.toggleAttribute("hidden", picture.tiles.length > 1);
    }

    private send(): void {
        const anchor = fromSeen(this.picture(), this.held!.anchor).slice(0, this.scene.dimension);
        void this.ask("move", anchor);
        this.show(this.viewer.moment!);
    }

    private picture() {
        const { clientWidth, clientHeight } = this.viewer.canvas;
        return this.viewer.makePicture(Math.max(clientWidth, 1), Math.max(clientHeight, 1), 1);
    }
}

function set(one: Element, attributes: Record<string, string>): void {
    Object.entries(attributes).forEach(([key, value]) => one.setAttribute(key, value));
}
