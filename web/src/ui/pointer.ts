import type { Viewer } from "../view/viewer.ts";
import { look, moveW, pan, zoom } from "./actions.ts";
import type { Hand } from "./play/hand.ts";

/** What dragging does to a body that moves, where there is one. */
export const kPulls = ["pull", "pullw"] as const;
/** What dragging does. */
export const kTools = [...kPulls, "look", "xw", "zw", "xz", "pan"] as const;
export type Tool = (typeof kTools)[number];
type ViewTool = Exclude<Tool, (typeof kPulls)[number]>;

/** Name on the button, and what it says when pointed at. */
export const kToolTexts: Record<Tool, readonly [string, string]> = {
    pull: ["Pull", "Drag a body to pull at it; along w with shift or the wheel"],
    pullw: ["Pull w", "Drag a body up or down to pull at it along w"],
    look: ["Look", "Drag to look around"],
    xw: ["xw yw", "Drag across to turn in xw, upright in yw (right button, or shift)"],
    zw: ["zw xy", "Drag upright to turn in zw, across in xy (alt or control)"],
    xz: ["xz yz", "Drag across to turn in xz, upright in yz"],
    pan: ["Pan", "Drag to move the picture (middle button, or two fingers)"],
};

const kDegreesPerPixel = 0.35;

interface Finger {
    x: number;
    y: number;
}

/** Turns drags, the wheel and touches on the canvas into changes of the view. */
export class Pointer {
    tool: Tool = "look";
    /** What pulls at bodies, where there are some to pull at. */
    hand: Hand | null = null;
    private fingers = new Map<number, Finger>();
    private dragged: ViewTool | null = null;
    private sum = { across: 0, upright: 0 };

    /** @param onTurn  Told what is being turned, as in "xw 12°"; "" at the end. */
    constructor(
        private canvas: HTMLCanvasElement,
        private viewer: Viewer,
        private onTurn: (text: string) => void,
    ) {
        canvas.addEventListener("pointerdown", (event) => this.onDown(event));
        canvas.addEventListener("pointermove", (event) => this.onMove(event));
        for (const kind of ["pointerup", "pointercancel"] as const) {
            canvas.addEventListener(kind, (event) => this.onUp(event));
        }
        canvas.addEventListener("wheel", (event) => this.onWheel(event), { passive: false });
        canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    }

    private onDown(event: PointerEvent): void {
        this.canvas.setPointerCapture(event.pointerId);
        this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
        this.sum = { across: 0, upright: 0 };
        if (event.button === 1) {
            event.preventDefault();
        }
        const dragged = this.viewToolOf(event);
        if (this.isPull(event)) {
            void this.tryToTake(event, dragged);
        } else {
            this.hand?.release();
            this.dragged = dragged;
        }
    }

    private viewToolOf(event: PointerEvent): ViewTool {
        const is4 = this.viewer.run?.dimension === 4;
        return this.fingers.size > 1 || event.button === 1
            ? "pan"
            : is4 && (event.button === 2 || event.shiftKey)
              ? "xw"
              : is4 && (event.altKey || event.ctrlKey || event.metaKey)
                ? "zw"
                : this.tool === "pull" || this.tool === "pullw"
                  ? "look"
                  : this.tool;
    }

    private isPull(event: PointerEvent): boolean {
        const isPlain = event.button === 0 && !event.altKey && !event.ctrlKey && !event.metaKey;
        const doesPull = this.tool === "pull" || this.tool === "pullw";
        return this.hand !== null && doesPull && isPlain && this.fingers.size === 1;
    }

    // Where nothing is to be held the view is turned, as ever. The answer takes a moment.
    private async tryToTake(event: PointerEvent, otherwise: ViewTool): Promise<void> {
        const { hand } = this;
        this.dragged = null;
        const isHeld = await hand!.take(this.placeOf(event));
        if (isHeld && this.fingers.size !== 1) {
            hand!.release();
        } else if (!isHeld && this.fingers.has(event.pointerId)) {
            this.dragged = otherwise;
        }
    }

    private placeOf(event: PointerEvent): { x: number; y: number } {
        const box = this.canvas.getBoundingClientRect();
        return {
            x: (event.clientX - box.left) / box.width,
            y: (event.clientY - box.top) / box.height,
        };
    }

    private onMove(event: PointerEvent): void {
        const finger = this.fingers.get(event.pointerId);
        if (finger && this.hand?.isHolding) {
            this.hand.drag(this.placeOf(event), this.tool === "pullw" || event.shiftKey);
        }
        if (!finger || !this.dragged) {
            return;
        }
        const dx = event.clientX - finger.x;
        const dy = event.clientY - finger.y;
        if (this.fingers.size === 2) {
            const other = [...this.fingers.values()].find((one) => one !== finger)!;
            const before = Math.hypot(finger.x - other.x, finger.y - other.y);
            const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
            if (before > 10 && after > 10) {
                zoom(this.viewer, after / before);
            }
            this.drag("pan", dx / 2, dy / 2);
        } else {
            this.drag(this.dragged, dx, dy);
        }
        finger.x = event.clientX;
        finger.y = event.clientY;
    }

    private onUp(event: PointerEvent): void {
        this.fingers.delete(event.pointerId);
        this.hand?.release();
        if (this.fingers.size === 0) {
            this.dragged = null;
            this.onTurn("");
        }
    }

    private onWheel(event: WheelEvent): void {
        event.preventDefault();
        const pixels = (event.deltaY || event.deltaX) * (event.deltaMode === 1 ? 20 : 1);
        if (this.hand?.isHolding) {
            this.hand.moveW(-pixels / 2000);
        } else if ((event.shiftKey || event.altKey) && this.viewer.run?.dimension === 4) {
            moveW(this.viewer, -pixels / 50);
        } else {
            zoom(this.viewer, Math.exp(-pixels / 600));
        }
    }

    private drag(tool: ViewTool, dx: number, dy: number): void {
        const { viewer } = this;
        if (tool === "look") {
            look(viewer, -dx * kDegreesPerPixel, dy * kDegreesPerPixel);
            return;
        }
        if (tool === "pan") {
            const smaller = Math.min(this.canvas.clientHeight, this.canvas.clientWidth);
            pan(viewer, dx / smaller, -dy / smaller);
            return;
        }
        // Seen from behind, across is the other way round.
        const side = Math.cos((viewer.state.orbit.azimuth * Math.PI) / 180) < 0 ? -1 : 1;
        const across = side * dx * kDegreesPerPixel;
        const upright = -dy * kDegreesPerPixel;
        const [first, second] = {
            xw: [
                [0, 3, across],
                [1, 3, upright],
            ],
            zw: [
                [0, 1, -across],
                [2, 3, upright],
            ],
            xz: [
                [0, 2, -across],
                [1, 2, -upright],
            ],
        }[tool] as [[number, number, number], [number, number, number]];
        for (const [from, to, degrees] of [first, second]) {
            if (degrees !== 0) {
                viewer.turn(from, to, degrees);
            }
        }
        this.sum.across += first[2];
        this.sum.upright += second[2];
        const text = (turn: [number, number, number], sum: number) =>
            `${"xyzw"[turn[0]]}${"xyzw"[turn[1]]} ${Math.round(sum)}\u00b0`;
        this.onTurn(
            `${text(first, this.sum.across)}   ${text(second, this.sum.upright)}`.replaceAll(
                "-",
                "\u2212",
            ),
        );
    }
}
