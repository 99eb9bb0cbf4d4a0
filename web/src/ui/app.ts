import { PentError } from "../format/error.ts";
import { EmbeddedRun } from "../run/embedded.ts";
import { ExampleRun, kExamples } from "../run/example.ts";
import type { FileSource } from "../run/listing.ts";
import { PentRun } from "../run/run.ts";
import type { Run } from "../run/run.ts";
import { LocalFiles, WebFiles, chosenFiles, droppedFiles } from "../run/sources.ts";
import { defaultState, formatState, kThemes, parseState } from "../view/state.ts";
import type { ViewState } from "../view/state.ts";
import { Viewer } from "../view/viewer.ts";
import { describe, kActions } from "./actions.ts";
import { Bottom } from "./bottom.ts";
import { button, menu, segments } from "./controls.ts";
import { byId, element } from "./dom.ts";
import { fillHelp } from "./help.ts";
import { kIcons } from "./icons.ts";
import { Messages } from "./messages.ts";
import { Overlay } from "./overlay.ts";
import { Panel } from "./panel.ts";
import { Pointer, kTools, kToolTexts } from "./pointer.ts";
import { VideoRecorder, savePicture, saveSlice } from "./saving.ts";

const kFollowEvery = 1500; // ms
const kFirstExample = "tesseract";

/** The page: everything around a viewer. */
export class App {
    readonly viewer: Viewer;
    private messages = new Messages(byId("messages"));
    private recorder: VideoRecorder;
    private title = element("span", { class: "run-title" });
    private opening = 0; // counts, so that only the last of several openings counts
    private files = element("input", {
        type: "file",
        multiple: true,
        accept: ".pent",
        hidden: true,
    });
    private folder = element("input", { type: "file", webkitdirectory: true, hidden: true });
    private addressTimer = 0;

    constructor() {
        this.viewer = new Viewer(byId<HTMLCanvasElement>("canvas"));
        const { viewer } = this;
        const overlay = new Overlay(byId("overlay"), viewer);
        new Panel(byId("panel"), viewer);
        new Bottom(byId("bottom"), viewer);
        const pointer = new Pointer(viewer.canvas, viewer, (text) => overlay.showTurn(text));
        this.recorder = new VideoRecorder(viewer);
        this.fillTop();
        this.fillTools(pointer);
        fillHelp(byId<HTMLDialogElement>("help"));
        this.listen();
        this.watchSize();
        setInterval(() => void this.follow(), kFollowEvery);
    }

    /** Opens what the address or the page names, else an example. */
    async start(): Promise<void> {
        const { state, unknown } = parseState(location.hash);
        await this.openFirst(state);
        if (unknown.length > 0) {
            const parts = unknown.join(", ");
            this.messages.note(`The address has parts that are not understood: ${parts}`);
        }
    }

    private async openFirst(state: ViewState): Promise<void> {
        const parameters = new URLSearchParams(location.search);
        const address = parameters.get("run");
        const example = parameters.get("example");
        if (address) {
            await this.openFiles(new WebFiles(address), state);
            return;
        }
        const embedded = await this.attempt(() => Promise.resolve(EmbeddedRun.find()));
        if (embedded) {
            await this.open(embedded, state);
        } else if (example && Object.hasOwn(kExamples, example)) {
            await this.open(new ExampleRun(kExamples[example]!, example), state);
        } else {
            if (example) {
                this.messages.error(
                    `No example is called "${example}"; there are ` +
                        Object.keys(kExamples).join(", "),
                );
            }
            await this.openExample(kFirstExample, location.hash ? state : undefined);
            this.showWelcome();
        }
    }

    async openExample(name: string, state?: ViewState): Promise<void> {
        await this.open(
            new ExampleRun(kExamples[name]!, name),
            state ?? { ...this.kept(), box: true, rotation: defaultState().rotation },
        );
    }

    async openFiles(source: FileSource, state: ViewState): Promise<void> {
        const turn = ++this.opening;
        this.messages.clear();
        this.messages.busy(`Opening ${source.title}`);
        const run = await this.attempt(() =>
            PentRun.open(source, (text) => this.messages.busy(text)),
        );
        this.messages.busy("");
        if (run && turn === this.opening) {
            await this.open(run, state);
        } else {
            run?.close();
        }
        if (!this.viewer.run) {
            // there is always something to see
            await this.openExample(kFirstExample);
            this.showWelcome();
        }
    }

    private async open(run: Run, state: ViewState): Promise<void> {
        ++this.opening;
        byId("welcome").hidden = true;
        const before = this.viewer.run;
        await this.attempt(() => this.viewer.open(run, state));
        if (this.viewer.run === before) {
            run.close();
            return;
        }
        this.title.textContent = run.title;
        document.title = `${run.title} \u2013 Pentimento`;
        this.messages.say(describe(this.viewer));
    }

    // What stays when another run opens: how things are shown, not where.
    private kept(): ViewState {
        const { shade, smooth, floor, axes, theme, loop } = this.viewer.state;
        return { ...defaultState(), shade, smooth, floor, axes, theme, loop };
    }

    private async attempt<Value>(action: () => Promise<Value>): Promise<Value | null> {
        try {
            return await action();
        } catch (error) {
            this.messages.error((error as Error).message);
            if (!(error instanceof PentError)) {
                console.error(error);
            }
            return null;
        }
    }

    private async openLocal(files: Map<string, File>): Promise<void> {
        if (files.size > 0) {
            history.replaceState(null, "", location.pathname);
            await this.openFiles(new LocalFiles(files), this.kept());
        }
    }

    private async follow(): Promise<void> {
        if (this.viewer.run?.isGrowing && !document.hidden) {
            try {
                await this.viewer.refresh();
            } catch {
                // the server has ended; what is here stays
            }
        }
    }

    private fillTop(): void {
        const { viewer } = this;
        const openers = [
            ["A folder of pent-sim\u2026", () => this.folder.click()],
            [".pent files\u2026", () => this.files.click()],
            ...Object.entries(kExamples).map(
                ([name, { title }]) =>
                    [
                        title,
                        () => {
                            history.replaceState(null, "", `${location.pathname}?example=${name}`);
                            void this.openExample(name);
                        },
                    ] as const,
            ),
        ] as const;
        const savers = [
            ["Picture (PNG)", () => void this.attempt(() => savePicture(viewer))],
            ["Video of all frames", () => void this.record()],
            ["Slice (PLY)", () => saveSlice(viewer)],
            ["Copy the address of this view", () => void this.copyAddress()],
        ] as const;
        byId("top").append(
            element("h1", {}, "Pentimento"),
            this.title,
            element("span", { class: "grow" }),
            menu("Open", kIcons.open, "Open", openers),
            menu("Save", kIcons.save, "Save", savers),
            button("Light, dark, or as the system has it", kIcons.theme, () => {
                const at = kThemes.indexOf(viewer.state.theme);
                viewer.update({ theme: kThemes[(at + 1) % kThemes.length]! });
                this.messages.say(`theme ${viewer.state.theme}`);
            }),
            button("Keys and gestures", kIcons.help, () =>
                byId<HTMLDialogElement>("help").showModal(),
            ),
            button("Controls", kIcons.panel, () => document.body.classList.toggle("panel-toggled")),
            this.files,
            this.folder,
        );
        this.files.addEventListener(
            "change",
            () => void this.openLocal(chosenFiles(this.files.files!)),
        );
        this.folder.addEventListener(
            "change",
            () => void this.openLocal(chosenFiles(this.folder.files!)),
        );
    }

    private fillTools(pointer: Pointer): void {
        const tools = segments(
            "What dragging does",
            kTools.map((tool) => [tool, ...kToolTexts[tool]] as const),
            (tool) => {
                pointer.tool = tool;
            },
        );
        tools.show(pointer.tool);
        byId("tools").append(tools.root);
        this.viewer.on("run", (run) => {
            const inputs = [...tools.root.querySelectorAll("input")];
            inputs.forEach((input) => {
                input.parentElement!.hidden = run.dimension === 3 && /[xz]w/.test(input.value);
            });
        });
    }

    private async record(): Promise<void> {
        if (this.viewer.run!.frames.length < 2) {
            this.messages.error("A single frame makes no video; save a picture");
            return;
        }
        this.messages.busy("Recording; pause to end it");
        await this.attempt(() => this.recorder.record());
        this.messages.busy("");
    }

    private async copyAddress(): Promise<void> {
        this.writeAddress();
        await this.attempt(() => navigator.clipboard.writeText(location.href));
        this.messages.note("The address of this view is in the clipboard");
    }

    private writeAddress(): void {
        const state = formatState(this.viewer.state);
        history.replaceState(
            null,
            "",
            location.pathname + location.search + (state && `#${state}`),
        );
    }

    private showWelcome(): void {
        const card = byId("welcome");
        card.replaceChildren(
            element(
                "p",
                {},
                element("b", {}, "Bodies of four dimensions, a slice at a time. "),
                "Move w below and turn xw beside: what you see is the part of the body that " +
                    "lies in the space w = 0.",
            ),
            element("p", {}, "Drop a run folder of pent-sim or a .pent mesh here, or "),
            element(
                "div",
                { class: "actions" },
                button(
                    "Open a run folder",
                    kIcons.open,
                    () => this.folder.click(),
                    "Open a folder",
                ),
                button("Open .pent files", kIcons.open, () => this.files.click(), "Open files"),
            ),
            button("Close", kIcons.close, () => {
                card.hidden = true;
            }),
        );
        card.hidden = false;
    }

    private applyTheme(): void {
        const { theme } = this.viewer.state;
        const isDark =
            theme === "dark" ||
            (theme === "auto" && matchMedia("(prefers-color-scheme: dark)").matches);
        document.documentElement.dataset["theme"] = isDark ? "dark" : "light";
        this.viewer.setTheme(isDark ? "dark" : "light");
    }

    private listen(): void {
        const { viewer } = this;
        viewer.on("notice", ({ text, isError }) =>
            isError ? this.messages.error(text) : this.messages.note(text),
        );
        viewer.on("state", () => {
            this.applyTheme();
            clearTimeout(this.addressTimer);
            this.addressTimer = window.setTimeout(() => this.writeAddress(), 400);
        });
        const label = () => {
            viewer.canvas.ariaLabel = describe(viewer);
        };
        viewer.on("state", label);
        viewer.on("moment", label);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () =>
            this.applyTheme(),
        );
        window.addEventListener("hashchange", (event) => {
            // Not location: the address may have been written meanwhile from the old state.
            viewer.update(parseState(new URL(event.newURL).hash).state);
        });
        document.addEventListener("keydown", (event) => this.onKey(event));
        document.addEventListener("dragover", (event) => {
            event.preventDefault();
            document.body.classList.add("dropping");
        });
        for (const kind of ["dragleave", "drop"] as const) {
            document.addEventListener(kind, () => document.body.classList.remove("dropping"));
        }
        document.addEventListener("drop", (event) => {
            event.preventDefault();
            if (event.dataTransfer) {
                void droppedFiles(event.dataTransfer).then((files) => this.openLocal(files));
            }
        });
        this.applyTheme();
    }

    private onKey(event: KeyboardEvent): void {
        const target = event.target as HTMLElement;
        const isTyping =
            target.matches("input:not([type=checkbox],[type=radio]), select") ||
            target.closest("dialog, [role=menu]") !== null;
        if (
            event.ctrlKey ||
            event.metaKey ||
            event.altKey ||
            isTyping ||
            (event.code === "Space" && target.matches("button, summary, input")) ||
            (event.code.startsWith("Arrow") && target.matches("input"))
        ) {
            return;
        }
        if (event.key === "?") {
            byId<HTMLDialogElement>("help").showModal();
            return;
        }
        const action = kActions.find(({ keys }) => keys.includes(event.code));
        if (action && this.viewer.run) {
            event.preventDefault();
            action.run(this.viewer, event.shiftKey);
        }
    }

    private watchSize(): void {
        const { canvas } = this.viewer;
        const measure = () =>
            this.viewer.resize(
                canvas.clientWidth,
                canvas.clientHeight,
                Math.min(window.devicePixelRatio || 1, 2),
            );
        new ResizeObserver(measure).observe(canvas);
        measure();
    }
}
