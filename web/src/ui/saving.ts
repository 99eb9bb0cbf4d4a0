import { slicePlaces } from "../view/compose.ts";
import type { Viewer } from "../view/viewer.ts";
import { save } from "./dom.ts";
import { drawCaption } from "./overlay.ts";

/** Draws the view with its caption into a plain canvas. */
function copyPicture(viewer: Viewer, target: HTMLCanvasElement): void {
    const picture = viewer.drawNow()!;
    if (target.width !== picture.width || target.height !== picture.height) {
        target.width = picture.width;
        target.height = picture.height;
    }
    const context = target.getContext("2d")!;
    context.drawImage(viewer.canvas, 0, 0);
    drawCaption(context, viewer, picture);
}

function fileName(viewer: Viewer, ending: string): string {
    const title = viewer.run!.title.replace(/[^\w-]+/g, "-").replace(/^-|-$/g, "") || "picture";
    return viewer.run!.frames.length > 1
        ? `${title}_${String(viewer.moment!.frame).padStart(6, "0")}.${ending}`
        : `${title}.${ending}`;
}

/** Saves what is seen as PNG. */
export async function savePicture(viewer: Viewer): Promise<void> {
    const canvas = document.createElement("canvas");
    copyPicture(viewer, canvas);
    const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
    if (!blob) {
        throw new Error("the picture is too large to be saved; make the window smaller");
    }
    save(blob, fileName(viewer, "png"));
}

const kLastPicture = 250; // ms that the last picture stays

const kVideoKinds = [
    ["video/mp4;codecs=avc1", "mp4"],
    ["video/webm;codecs=vp9", "webm"],
    ["video/webm", "webm"],
] as const;

/** Records the view while it plays from the first frame to the last. */
export class VideoRecorder {
    private recorder: MediaRecorder | null = null;
    private canvas = document.createElement("canvas");
    private track: CanvasCaptureMediaStreamTrack | null = null;
    private isCopying = false;

    constructor(private viewer: Viewer) {
        viewer.on("picture", () => {
            if (this.recorder && !this.isCopying) {
                this.copy();
            }
        });
        viewer.on("playing", (isPlaying) => {
            if (!isPlaying && this.recorder?.state === "recording") {
                setTimeout(() => this.recorder?.stop(), kLastPicture);
            }
        });
    }

    private copy(): void {
        this.isCopying = true;
        copyPicture(this.viewer, this.canvas);
        this.isCopying = false;
        this.track?.requestFrame(); // also where the page is too busy to be asked
    }

    /** Resolves when the video has been handed over to be saved. */
    async record(): Promise<void> {
        const { viewer } = this;
        const kind = kVideoKinds.find(([type]) => window.MediaRecorder?.isTypeSupported(type));
        if (!kind) {
            throw new Error("this browser cannot record videos; save pictures, or use pent-render");
        }
        const { loop } = viewer.state;
        viewer.pause();
        viewer.update({ loop: false, frame: viewer.run!.frames[0]! });
        this.copy();
        const stream = this.canvas.captureStream(60);
        this.track = stream.getVideoTracks()[0] as CanvasCaptureMediaStreamTrack;
        const recorder = new MediaRecorder(stream, {
            mimeType: kind[0],
            videoBitsPerSecond: 16_000_000,
        });
        const parts: Blob[] = [];
        recorder.ondataavailable = (event) => parts.push(event.data);
        const stopped = new Promise<void>((resolve) => {
            recorder.onstop = () => resolve();
        });
        this.recorder = recorder;
        recorder.start();
        this.copy();
        viewer.play();
        await stopped;
        this.recorder = null;
        this.track = null;
        stream.getTracks().forEach((track) => track.stop());
        viewer.update({ loop });
        save(
            new Blob(parts, { type: kind[0] }),
            fileName(viewer, kind[1]).replace(/_\d{6}\./, "."),
        );
    }
}

/** The slices shown, all bodies together, as a binary PLY of triangles, the way the shader made
 * them: closed, each edge with two triangles. */
function slicePly(viewer: Viewer): Blob {
    const picture = viewer.makePicture(64, 64, 1);
    const parts = slicePlaces(viewer.state, viewer.bounds, viewer.run!.dimension).flatMap((w) =>
        viewer.run!.bodies.map((_, body) => viewer.renderer.captureSlice(picture, body, w)),
    );
    const count = parts.reduce((sum, part) => sum + part.length / 9, 0);
    const faces = new DataView(new ArrayBuffer(13 * count));
    for (let i = 0; i < count; ++i) {
        faces.setUint8(13 * i, 3);
        [0, 1, 2].forEach((k) => faces.setUint32(13 * i + 1 + 4 * k, 3 * i + k, true));
    }
    const header =
        "ply\nformat binary_little_endian 1.0\ncomment slice by Pentimento\n" +
        `element vertex ${3 * count}\nproperty float x\nproperty float y\nproperty float z\n` +
        `element face ${count}\nproperty list uchar uint vertex_indices\nend_header\n`;
    return new Blob([header, ...parts.map((part) => part.buffer as ArrayBuffer), faces.buffer]);
}

export function saveSlice(viewer: Viewer): void {
    save(slicePly(viewer), fileName(viewer, "ply"));
}
