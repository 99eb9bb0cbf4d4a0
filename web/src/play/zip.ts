// CRC-32 as archives have it [iso21320].
const kTable = Uint32Array.from({ length: 256 }, (_, byte) => {
    let value = byte;
    for (let bit = 0; bit < 8; ++bit) {
        value = value & 1 ? (value >>> 1) ^ 0xedb88320 : value >>> 1;
    }
    return value;
});

/** CRC-32 of bytes; of "123456789" it is 0xcbf43926. */
export function crc32(bytes: Uint8Array): number {
    let crc = 0xffffffff;
    for (const byte of bytes) {
        crc = kTable[(crc ^ byte) & 255]! ^ (crc >>> 8);
    }
    return (crc ^ 0xffffffff) >>> 0;
}

const kVersion = 20; // folders
const kUtf8 = 0x800; // names
const kDate = (1 << 5) | 1; // 1980-01-01: the same in, the same out

interface Entry {
    name: Uint8Array;
    crc: number;
    size: number;
    offset: number;
}

// What a file's own header and its line in the directory have in common.
function fill(view: DataView, at: number, { name, crc, size }: Entry): void {
    view.setUint16(at, kVersion, true);
    view.setUint16(at + 2, kUtf8, true);
    view.setUint16(at + 8, kDate, true);
    view.setUint32(at + 10, crc, true);
    view.setUint32(at + 14, size, true);
    view.setUint32(at + 18, size, true);
    view.setUint16(at + 22, name.length, true);
}

function header(size: number, signature: number): [Uint8Array<ArrayBuffer>, DataView] {
    const bytes = new Uint8Array(size);
    const view = new DataView(bytes.buffer);
    view.setUint32(0, signature, true);
    return [bytes, view];
}

/** A zip archive of files that are stored as they are, in parts for a Blob. Below 4 GB and 65536 files. */
export function zip(files: Map<string, Uint8Array>): Uint8Array<ArrayBuffer>[] {
    const parts: Uint8Array<ArrayBuffer>[] = [];
    const entries: Entry[] = [];
    let offset = 0;
    const add = (...added: Uint8Array<ArrayBuffer>[]) => {
        for (const part of added) {
            parts.push(part);
            offset += part.length;
        }
    };
    for (const [path, bytes] of files) {
        const name = new TextEncoder().encode(path);
        const entry = { name, crc: crc32(bytes), size: bytes.length, offset };
        entries.push(entry);
        const [head, view] = header(30, 0x04034b50);
        fill(view, 4, entry);
        add(head, name, bytes as Uint8Array<ArrayBuffer>);
    }
    const begin = offset;
    for (const entry of entries) {
        const [line, view] = header(46, 0x02014b50);
        view.setUint16(4, kVersion, true);
        fill(view, 6, entry);
        view.setUint32(42, entry.offset, true);
        add(line, entry.name as Uint8Array<ArrayBuffer>);
    }
    const [end, view] = header(22, 0x06054b50);
    view.setUint16(8, entries.length, true);
    view.setUint16(10, entries.length, true);
    view.setUint32(12, offset - begin, true);
    view.setUint32(16, begin, true);
    add(end);
    return parts;
}
