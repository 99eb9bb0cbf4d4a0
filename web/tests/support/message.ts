import assert from "node:assert/strict";
import { PentError } from "../../src/format/error.ts";

/** What an action that is refused says, or ""; fails where it throws anything but a PentError, or more than a line. */
export function messageOf(action: () => unknown): string {
    try {
        action();
    } catch (error) {
        assert.ok(error instanceof PentError, `not an error of ours: ${(error as Error).stack}`);
        assert.ok(!/[\n\r]/.test(error.message), error.message);
        return error.message;
    }
    return "";
}
