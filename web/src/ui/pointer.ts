import type { Viewer } from "../view/viewer.ts";
import { moveW, zoom } from "./actions.ts";

/** What dragging does. */
export const kTools = ["look", "xw", "zw", "xz", "pan"] as const;
export type Tool = (typeof kTools)[number];

/** Name on the button, and what it says when pointed at. */
export const kToolTexts: Record<Tool, readonly [string, string]> = {
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
    private fingers = new Map<number, Finger>();
    private dragged: Tool | null = null;
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
        const is4 = this.viewer.run?.dimension === 4;
        this.dragged =
            this.fingers.size > 1 || event.button === 1
                ? "pan"
                : is4 && (event.button === 2 || event.shiftKey)
                  ? "xw"
                  : is4 && (event.altKey || event.ctrlKey || event.metaKey)
                    ? "zw"
                    : this.tool;
    }

    private onMove(event: PointerEvent): void {
        const finger = this.fingers.get(event.pointerId);
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
        if (this.fingers.size === 0) {
            this.dragged = null;
            this.onTurn("");
        }
    }

    private onWheel(event: WheelEvent): void {
        event.preventDefault();
        const pixels = (event.deltaY || event.deltaX) * (event.deltaMode === 1 ? 20 : 1);
        if ((event.shiftKey || event.altKey) && this.viewer.run?.dimension === 4) {
            moveW(this.viewer, -pixels / 50);
        } else {
            zoom(this.viewer, Math.exp(-pixels / 600));
        }
    }

    private drag(tool: Tool, dx: number, dy: number): void {
        const { viewer } = this;
        const { orbit } = viewer.state;
        if (tool === "look") {
            const elevation = Math.min(89, Math.max(-89, orbit.elevation + dy * kDegreesPerPixel));
            const azimuth = (orbit.azimuth - dx * kDegreesPerPixel) % 360;
            viewer.update({ orbit: { ...orbit, azimuth, elevation } });
            return;
        }
        if (tool === "pan") {
            const perPixel =
                2 / Math.min(this.canvas.clientHeight, this.canvas.clientWidth) / orbit.zoom;
            viewer.update({
                orbit: {
                    ...orbit,
                    panX: orbit.panX - dx * perPixel,
                    panY: orbit.panY + dy * perPixel,
                },
            });
            return;
        }
        // Seen from behind, across is the other way round.
        const side = Math.cos((orbit.azimuth * Math.PI) / 180) < 0 ? -1 : 1;
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
