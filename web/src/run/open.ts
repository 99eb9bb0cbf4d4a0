import { isModel } from "./listing.ts";
import type { FileSource } from "./listing.ts";
import { ModelRun } from "./model_run.ts";
import { PentRun } from "./run.ts";
import type { Run } from "./run.ts";

/** Opens what a source has: a run folder, a .pent mesh, or a model of other programs. Rejects with a PentError for
 * what is none of these. */
export async function openRun(
    source: FileSource,
    onProgress: (text: string) => void,
): Promise<Run> {
    const listing = await source.list();
    return listing.mesh !== undefined && isModel(listing.mesh)
        ? ModelRun.open(source, listing.mesh, onProgress)
        : PentRun.open(source, listing, onProgress);
}
