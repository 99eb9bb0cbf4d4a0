import { readOrSay } from "../run/sources.ts";
import type { SceneFiles } from "./protocol.ts";

/** A scene among files that were dropped. */
export interface DroppedScene {
    path: string; // relative to its folder
    read(files: Map<string, Blob>): Promise<SceneFiles>;
}

/** The scene to be simulated among the paths of files: the .toml file in the shallowest folder, with all that lies in
 * that folder and below. Null where there is none, and for a run folder: that is looked at. */
export function sceneAmong(paths: string[]): DroppedScene | null {
    const scenes = paths
        .filter((path) => /(^|\/)[^./][^/]*\.toml$/.test(path))
        .sort((a, b) => a.split("/").length - b.split("/").length || (a < b ? -1 : 1));
    const isRun = paths.some((path) => /(^|\/)frames\/[^/]+\.pent$/.test(path));
    const [scene] = scenes;
    if (scene === undefined || isRun) {
        return null;
    }
    const folder = scene.slice(0, scene.lastIndexOf("/") + 1);
    return {
        path: scene.slice(folder.length),
        async read(files) {
            const taken: SceneFiles = new Map();
            for (const [path, file] of files) {
                if (path.startsWith(folder) && /\.(toml|pent)$/.test(path)) {
                    const bytes = new Uint8Array(await readOrSay(path, file.arrayBuffer()));
                    taken.set(path.slice(folder.length), bytes);
                }
            }
            return taken;
        },
    };
}
