import assert from "node:assert/strict";
import { crc32 } from "../../src/play/zip.ts";

/** The files of an archive that stores them as they are, read by its directory at the end, as programs do. */
export function unzip(bytes: Uint8Array): Map<string, Uint8Array> {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    const end = bytes.length - 22;
    assert.equal(view.getUint32(end, true), 0x06054b50);
    const files = new Map<string, Uint8Array>();
    let at = view.getUint32(end + 16, true);
    for (let i = 0; i < view.getUint16(end + 10, true); ++i) {
        assert.equal(view.getUint32(at, true), 0x02014b50);
        const size = view.getUint32(at + 20, true);
        const nameSize = view.getUint16(at + 28, true);
        const local = view.getUint32(at + 42, true);
        const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + nameSize));
        const begin = local + 30 + view.getUint16(local + 26, true);
        const body = bytes.subarray(begin, begin + size);
        assert.equal(view.getUint32(local + 14, true), crc32(body), name);
        files.set(name, body);
        at += 46 + nameSize;
    }
    return files;
}
