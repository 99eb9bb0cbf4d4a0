import { PentError } from "../../format/error.ts";
import { PlayClient, SimulatorGone } from "../../play/client.ts";
import { LiveRun } from "../../play/live_run.ts";
import type {
    OpenedScene,
    PlayCalls,
    PlayFacts,
    PlayFrame,
    RunFiles,
    SceneFiles,
} from "../../play/protocol.ts";
import { kGallery } from "../../play/scene_list.ts";
import { zip } from "../../play/zip.ts";
import type { Run } from "../../run/run.ts";
import type { Viewer } from "../../view/viewer.ts";
import { byId, save } from "../dom.ts";
import type { Messages } from "../messages.ts";
import type { Pointer } from "../pointer.ts";
import type { Tools } from "../tools.ts";
import { Hand } from "./hand.ts";
import { PlayBar } from "./play_bar.ts";
import { PlayPanel } from "./play_panel.ts";

const kTuneDelay = 150; // ms after the last change of a slider: a change sets the simulation up anew

// Keys with which what is held is pulled: right, and up.
const kWays: Record<string, readonly [number, number]> = {
    ArrowLeft: [-1, 0],
    ArrowRight: [1, 0],
    ArrowUp: [0, 1],
    ArrowDown: [0, -1],
};
const kPullPart = 0.03; // of the picture, of the reach along w

/** What of the page a playground takes part in. */
export interface PlayHost {
    viewer: Viewer;
    messages: Messages;
    pointer: Pointer;
    tools: Tools;
    /** Shows a run in place of the one before; gives whether it does. */
    open(run: Run): Promise<boolean>;
    /** Shows the files of a run in the viewer. */
    watch(files: RunFiles, title: string): void;
}

/** The playground: a simulation in the page, and what a person does to it. */
export class PlayPage {
    private client: PlayClient | null = null;
    private run: LiveRun | null = null;
    private hand: Hand | null = null;
    private isRunning = false;
    private isRecording = false;
    private death = ""; // what was said of the simulator's end
    private opening = 0; // counts, so that only the last of several openings counts
    private tuning = 0; // a timer
    private bar: PlayBar;
    private panel: PlayPanel;

    constructor(private host: PlayHost) {
        this.bar = new PlayBar({
            toggleRunning: () => this.setRunning(!this.isRunning),
            step: () => void this.step(),
            reset: () => void this.ask("reset"),
            toggleRecording: () => void this.toggleRecording(),
        });
        this.panel = new PlayPanel({
            openGallery: (name) => void this.openGallery(name),
            setGravity: (gravity) => void this.ask("setGravity", gravity),
            tune: (stiffness, damping, stepsPerSecond) => {
                clearTimeout(this.tuning);
                this.tuning = window.setTimeout(
                    () => void this.tune({ stiffness, damping, stepsPerSecond }),
                    kTuneDelay,
                );
            },
        });
        byId("bottom").append(this.bar.root);
        byId("panel").prepend(this.panel.root);
        host.viewer.on("picture", () => {
            if (host.viewer.moment) {
                this.hand?.show(host.viewer.moment);
            }
        });
        // Nobody looks: it stands still.
        document.addEventListener("visibilitychange", () => {
            if (this.isRunning) {
                this.setRunning(true);
            }
        });
        this.showMode(false);
    }

    /** Whether a simulation is open. */
    get isOpen(): boolean {
        return this.run !== null;
    }

    openGallery(name: string): Promise<void> {
        const scene = kGallery[name]!;
        return this.start(name, scene.title, (client) => client.call("openGallery", name));
    }

    /** @param scene  The path of the scene file among the files. */
    openFiles(files: SceneFiles, scene: string): Promise<void> {
        const title = scene.replace(/^.*\//, "").replace(/\.toml$/, "");
        return this.start("", title, (client) => client.call("openFiles", files, scene));
    }

    /** Ends the simulation; the page is the viewer's again. */
    leave(): void {
        ++this.opening;
        this.setRunning(false);
        this.endHand();
        this.run = null;
        this.isRecording = false;
        this.showMode(false);
    }

    /** @return  Whether the key means something here. */
    onKey(event: KeyboardEvent): boolean {
        if (!this.isOpen) {
            return false;
        }
        const way = this.hand?.isHeldByKeys ? kWays[event.code] : undefined;
        if (way) {
            this.pull(way, event.shiftKey);
            return true;
        }
        const action = {
            Space: () => this.setRunning(!this.isRunning),
            ArrowRight: () => void this.step(),
            Backspace: () => void this.ask("reset"),
            KeyP: () => !event.repeat && void this.hold(),
            Escape: () => this.hand?.release(),
        }[event.code];
        action?.();
        return action !== undefined || event.code === "ArrowLeft";
    }

    // By keys, what the pointer does.
    private async hold(): Promise<void> {
        const { hand } = this;
        if (hand?.isHolding) {
            hand.release();
        } else if (await hand?.takeNearMiddle()) {
            this.host.messages.say("A body is held; arrows pull at it, P lets go");
        } else {
            this.host.messages.note("No body is in the picture to pull at");
        }
    }

    private pull([right, up]: readonly [number, number], isAlongW: boolean): void {
        if (isAlongW) {
            this.hand!.moveW(kPullPart * (up || right));
        } else {
            this.hand!.nudge(kPullPart * right, kPullPart * up);
        }
    }

    private async start(
        name: string,
        title: string,
        open: (client: PlayClient) => Promise<OpenedScene>,
    ): Promise<void> {
        const turn = ++this.opening;
        const { messages } = this.host;
        messages.clear();
        try {
            messages.busy(this.client ? `Opening ${title}` : "Loading the simulator");
            const client = (this.client ??= await this.connect());
            client.call("setRunning", false).catch(() => {}); // what was there stands still meanwhile
            const scene = await open(client);
            if (turn === this.opening) {
                await this.show(name, title, scene);
            }
        } catch (error) {
            if (turn === this.opening) {
                this.sayFailure(error as Error);
                if (this.run && this.client) {
                    this.setRunning(this.isRunning);
                }
            }
            if (!(error instanceof PentError)) {
                throw error;
            }
        } finally {
            messages.busy("");
        }
    }

    private async show(name: string, title: string, scene: OpenedScene): Promise<void> {
        this.endHand();
        const run = new LiveRun(title, scene, kGallery[name] ?? null);
        if (!(await this.host.open(run))) {
            this.leave(); // the simulator has the new scene, which nobody sees
            return;
        }
        this.run = run;
        this.hand = new Hand(
            byId("overlay"),
            this.host.viewer,
            (name, ...values) => this.ask(name, ...values),
            scene,
        );
        this.host.pointer.hand = this.hand;
        this.showMode(true);
        this.panel.showScene(name, scene.dimension, scene.facts);
        this.isRecording = false;
        this.bar.showRecording(null);
        this.setRunning(true);
    }

    private connect(): Promise<PlayClient> {
        return PlayClient.start({
            onFrame: (frame) => this.onFrame(frame),
            onFacts: (facts: PlayFacts) => this.panel.showFacts(facts),
            onNotice: (text, isError) => {
                const { messages } = this.host;
                if (isError) {
                    this.hand?.drop();
                    messages.error(text);
                } else {
                    messages.note(text);
                }
            },
            onDeath: (text) => {
                this.client = null;
                this.death = text;
                this.endHand();
                this.isRunning = false;
                this.bar.showRunning(false);
                this.host.messages.error(text);
            },
        });
    }

    private onFrame(frame: PlayFrame): void {
        const { viewer } = this.host;
        requestAnimationFrame(() => this.client && void this.ask("taken"));
        if (!this.run || viewer.run !== this.run) {
            return; // of the scene before
        }
        viewer.present(frame.moment);
        this.bar.show(frame, this.isRunning);
        this.panel.showStats(frame.stats, this.isRunning);
        if (this.isRecording) {
            this.bar.showRecording(frame.recorded);
        }
    }

    private setRunning(isRunning: boolean): void {
        this.isRunning = isRunning && this.client !== null;
        this.bar.showRunning(this.isRunning);
        if (this.run && (this.client || isRunning)) {
            void this.ask("setRunning", isRunning && !document.hidden);
        }
    }

    private async step(): Promise<void> {
        this.setRunning(false);
        await this.ask("step");
    }

    private async tune(settings: Parameters<PlayCalls["tune"]>[0]): Promise<void> {
        const facts = await this.ask("tune", settings);
        if (facts) {
            this.panel.showFacts(facts);
        }
    }

    private async toggleRecording(): Promise<void> {
        const isOn = !this.isRecording;
        this.isRecording = isOn;
        const files = await this.ask("setRecording", isOn);
        this.bar.showRecording(isOn ? 1 : null);
        if (files) {
            const title = this.run!.title.replace(/[^\w-]+/g, "-").toLowerCase();
            const folder = new Map([...files].map(([path, bytes]) => [`${title}/${path}`, bytes]));
            save(new Blob(zip(folder), { type: "application/zip" }), `${title}.zip`);
            this.host.messages.offer(
                `${title}.zip is a run as pent-sim writes them: unpack it, then pent-render ${title}/`,
                "Watch it here",
                () => this.host.watch(folder, title),
            );
        }
    }

    // Says what goes wrong.
    private async ask<Name extends keyof PlayCalls>(
        name: Name,
        ...values: Parameters<PlayCalls[Name]>
    ): Promise<ReturnType<PlayCalls[Name]> | undefined> {
        if (!this.client) {
            this.host.messages.error(this.death);
            return undefined;
        }
        try {
            return await this.client.call(name, ...values);
        } catch (error) {
            this.sayFailure(error as Error);
            return undefined;
        }
    }

    // The end of the simulator was said already.
    private sayFailure(error: Error): void {
        if (!(error instanceof SimulatorGone)) {
            this.host.messages.error(error.message);
        }
    }

    private endHand(): void {
        this.hand?.release();
        this.hand?.dispose();
        this.hand = null;
        this.host.pointer.hand = null;
    }

    private showMode(isPlaying: boolean): void {
        document.body.classList.toggle("playing", isPlaying);
        this.bar.root.hidden = !isPlaying;
        this.panel.root.hidden = !isPlaying;
        this.host.tools.showPulls(isPlaying);
    }
}
