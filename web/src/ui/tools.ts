import type { Viewer } from "../view/viewer.ts";
import { segments } from "./controls.ts";
import { kPulls, kTools, kToolTexts } from "./pointer.ts";
import type { Pointer, Tool } from "./pointer.ts";

/** The buttons under the picture that say what dragging does. */
export class Tools {
    private control;
    private hasPulls = false;

    constructor(
        root: HTMLElement,
        private pointer: Pointer,
        private viewer: Viewer,
    ) {
        this.control = segments(
            "What dragging does",
            kTools.map((tool) => [tool, ...kToolTexts[tool]] as const),
            (tool) => {
                pointer.tool = tool;
            },
        );
        root.append(this.control.root);
        viewer.on("run", () => this.show());
        this.show();
    }

    /** Whether there is something to pull at; then that is what dragging does. */
    showPulls(hasPulls: boolean): void {
        if (hasPulls !== this.hasPulls) {
            this.hasPulls = hasPulls;
            this.pointer.tool = hasPulls ? "pull" : "look";
        }
        this.show();
    }

    private show(): void {
        const is3 = this.viewer.run?.dimension === 3;
        this.control.show(this.pointer.tool);
        for (const input of this.control.root.querySelectorAll("input")) {
            const tool = input.value as Tool;
            const isPull = kPulls.some((one) => one === tool);
            input.parentElement!.hidden =
                (isPull && !this.hasPulls) ||
                (this.hasPulls && (tool === "xz" || tool === "pan")) ||
                (is3 && ["xw", "zw", "pullw"].includes(tool));
        }
    }
}
