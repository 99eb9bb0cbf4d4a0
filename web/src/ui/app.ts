import { PentError } from "../format/error.ts";
import { EmbeddedRun } from "../run/embedded.ts";
import { ExampleRun, kExamples } from "../run/example.ts";
import type { FileSource } from "../run/listing.ts";
import { openRun } from "../run/open.ts";
import type { Run } from "../run/run.ts";
import { LocalFiles, WebFiles, chosenFiles, droppedFiles } from "../run/sources.ts";
import { kGallery } from "../play/scene_list.ts";
import { sceneAmong } from "../play/scene_files.ts";
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
import { PlayPage } from "./play/play_page.ts";
import { Pointer } from "./pointer.ts";
import { Tools } from "./tools.ts";
import { VideoRecorder, savePicture, saveSlice } from "./saving.ts";
import { showWelcome } from "./welcome.ts";

const kFollowEvery = 1500; // ms
const kRestsFor = 500; // ms
const kPatience = 700; // ms until it is said that a frame is waited for
const kFirstExample = "tesseract";
const kFirstScene = "octopus";

/** The page: everything around a viewer. */
export class App {
    readonly viewer: Viewer;
    private messages = new Messages(byId("messages"));
    private recorder: VideoRecorder;
    private title = element("span", { class: "run-title" });
    private welcome = () =>
        showWelcome({
            openFolder: () => this.folder.click(),
            openFiles: () => this.files.click(),
            play: () => void this.openScene(kFirstScene),
        });
    private opening = 0; // counts, so that only the last of several openings counts
    private files = element("input", {
        type: "file",
        multiple: true,
        accept: ".pent,.toml,.g4b,.g4tf,.bin",
        hidden: true,
    });
    private folder = element("input", { type: "file", webkitdirectory: true, hidden: true });
    private addressTimer = 0;
    private sayTimer = 0;
    private waitTimer = 0;
    readonly play: PlayPage;
    private mode = segments(
        "Mode",
        [
            ["view", "Viewer"],
            [
                "play",
                "Playground",
                "Bodies that are simulated in this page, to be pulled and dropped",
            ],
        ] as const,
        (mode) => this.setMode(mode),
    );
    private sceneState: ViewState | null = null; // of the view that a scene opens with
    private viewed = () => this.openExample(kFirstExample); // to come back to

    constructor() {
        this.viewer = new Viewer(byId<HTMLCanvasElement>("canvas"));
        const { viewer } = this;
        const overlay = new Overlay(byId("overlay"), viewer);
        new Panel(byId("panel"), viewer);
        new Bottom(byId("bottom"), viewer);
        const pointer = new Pointer(viewer.canvas, viewer, (text) => overlay.showTurn(text));
        this.recorder = new VideoRecorder(viewer);
        this.fillTop();
        this.play = new PlayPage({
            viewer,
            messages: this.messages,
            pointer,
            tools: new Tools(byId("tools"), pointer, viewer),
            open: (run) => this.open(run, this.sceneState ?? this.kept()),
            watch: (files, title) => this.watch(files, title),
        });
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
        const scene = parameters.get("play");
        if (scene !== null) {
            await this.openScene(Object.hasOwn(kGallery, scene) ? scene : kFirstScene, state);
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
            this.welcome();
        }
    }

    /** Opens a scene of the playground. */
    async openScene(name: string, state: ViewState | null = null): Promise<void> {
        this.setAddress(`?play=${name}`);
        this.mode.show("play");
        this.sceneState = state;
        await this.play.openGallery(name);
        this.sceneState = null;
        if (!this.viewer.run) {
            await this.openExample(kFirstExample);
        }
        this.mode.show(this.play.isOpen ? "play" : "view");
    }

    private setMode(mode: "view" | "play"): void {
        if (mode === "play") {
            void this.openScene(kFirstScene);
        } else {
            this.setAddress("");
            void this.viewed();
        }
    }

    private watch(files: Map<string, Uint8Array>, title: string): void {
        const all = [...files].map(([path, bytes]): [string, File] => [
            path,
            new File([bytes as Uint8Array<ArrayBuffer>], path),
        ]);
        void this.openFiles(new LocalFiles(new Map(all), title), this.kept());
    }

    async openExample(name: string, state?: ViewState): Promise<void> {
        this.viewed = () => this.openExample(name);
        await this.open(
            new ExampleRun(kExamples[name]!, name),
            state ?? { ...this.kept(), box: true, rotation: defaultState().rotation },
        );
    }

    async openFiles(source: FileSource, state: ViewState): Promise<void> {
        const turn = ++this.opening;
        this.viewed = () => this.openFiles(source, this.kept());
        this.messages.clear();
        this.messages.busy(`Opening ${source.title}`);
        const run = await this.attempt(() => openRun(source, (text) => this.messages.busy(text)));
        this.messages.busy("");
        if (run && turn === this.opening) {
            await this.open(run, state);
        } else {
            run?.close();
        }
        if (!this.viewer.run) {
            // there is always something to see
            await this.openExample(kFirstExample);
            this.welcome();
        }
    }

    // Gives whether it is shown: not where that fails, or another one was opened meanwhile.
    private async open(run: Run, state: ViewState): Promise<boolean> {
        ++this.opening;
        byId("welcome").hidden = true;
        const isShown = await this.attempt(() => this.viewer.open(run, state));
        if (!isShown) {
            run.close();
            return false;
        }
        const isLive = run.stage !== undefined;
        this.mode.show(isLive ? "play" : "view");
        if (!isLive) {
            this.play.leave();
        }
        this.title.textContent = run.title;
        document.title = `${run.title} \u2013 Pentimento`;
        this.messages.say(describe(this.viewer));
        return true;
    }

    // What stays when another run opens: how things are shown, not where.
    private kept(): ViewState {
        const { shade, smooth, floor, obstacles, axes, theme, loop } = this.viewer.state;
        return { ...defaultState(), shade, smooth, floor, obstacles, axes, theme, loop };
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
        const scene = sceneAmong([...files.keys()]);
        if (files.size > 0) {
            this.setAddress("");
        }
        if (scene) {
            await this.play.openFiles(await scene.read(files), scene.path);
        } else if (files.size > 0) {
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
            ["Files (.pent, .g4b, .toml)\u2026", () => this.files.click()],
            ...Object.entries(kExamples).map(
                ([name, { title }]) =>
                    [
                        title,
                        () => {
                            this.setAddress(`?example=${name}`);
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
            this.mode.root,
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
            this.panelButton(),
            this.files,
            this.folder,
        );
        for (const input of [this.files, this.folder]) {
            input.addEventListener("change", () => {
                const files = chosenFiles(input.files!);
                input.value = ""; // so that the same ones, changed meanwhile, can be chosen again
                void this.attempt(() => this.openLocal(files));
            });
        }
    }

    // Whether the panel is there at first depends on the width of the window.
    private panelButton(): HTMLElement {
        const panel = byId("panel");
        const made = button("Controls", kIcons.panel, () =>
            document.body.classList.toggle("panel-toggled"),
        );
        made.setAttribute("aria-controls", panel.id);
        new ResizeObserver(() => {
            made.ariaExpanded = String(panel.clientWidth > 0);
        }).observe(panel);
        return made;
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

    private setAddress(search: string): void {
        history.replaceState(null, "", location.pathname + search);
    }

    private writeAddress(): void {
        const state = formatState(this.viewer.state);
        history.replaceState(
            null,
            "",
            location.pathname + location.search + (state && `#${state}`),
        );
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
        viewer.on("waiting", (frame) => {
            clearTimeout(this.waitTimer);
            if (frame === null) {
                this.messages.busy("", "frame");
            } else {
                const say = () => this.messages.busy(`Loading frame ${frame}`, "frame");
                this.waitTimer = window.setTimeout(say, kPatience);
            }
        });
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
                const dropped = droppedFiles(event.dataTransfer);
                void this.attempt(async () => this.openLocal(await dropped));
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
        if (this.play.onKey(event)) {
            event.preventDefault();
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
            this.sayLater();
        }
    }

    // What keys have done, once they rest: who cannot see the picture hears it.
    private sayLater(): void {
        clearTimeout(this.sayTimer);
        this.sayTimer = window.setTimeout(
            () => this.messages.say(describe(this.viewer)),
            kRestsFor,
        );
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
