import { PentError } from "./error.ts";
import { JsonEntry } from "./json_entry.ts";

const kMagic = "G4MF";
const kHeader = 16; // bytes, of a file and of a chunk
const kDataUri = /^data:[^,]*;base64,/;

type Stored =
    | typeof Float32Array
    | typeof Float64Array
    | typeof Uint8Array
    | typeof Uint16Array
    | typeof Uint32Array;

const kReals = new Map<string, Stored>([
    ["float32", Float32Array],
    ["float64", Float64Array],
]);
const kIndices = new Map<string, Stored>([
    ["uint8", Uint8Array],
    ["uint16", Uint16Array],
    ["uint32", Uint32Array],
    ["int32", Uint32Array],
]);

/** The JSON of a G4MF file [g4mf] and the numbers of its buffers: of text (.g4tf), or of chunks (.g4b). All
 * failures are PentErrors that name the entry. */
export class G4mfDocument {
    readonly json: JsonEntry;
    private chunks: Uint8Array[] = [];
    private known = new Map<number, Uint8Array>(); // buffers
    private beside = new Map<string, Uint8Array>();

    constructor(
        private bytes: Uint8Array,
        readonly path: string,
    ) {
        const isChunked = String.fromCharCode(...bytes.subarray(0, 4)) === kMagic;
        if (isChunked) {
            this.readChunks();
        }
        const text = new TextDecoder().decode(isChunked ? this.chunks[0] : bytes);
        this.json = JsonEntry.parse(text, path, "G4MF file");
        const dimension = this.json.at("asset").at("dimension");
        if (dimension.whole() !== 4) {
            dimension.expected("4");
        }
    }

    /** The files beside this one that it has buffers in. */
    uris(): string[] {
        const buffers = this.json.has("buffers") ? this.json.at("buffers").list() : [];
        return buffers
            .filter((buffer) => buffer.has("uri"))
            .map((buffer) => buffer.at("uri").text())
            .filter((uri) => !kDataUri.test(uri));
    }

    /** Hands one of them over. */
    put(uri: string, bytes: Uint8Array): void {
        this.beside.set(uri, bytes);
    }

    private readChunks(): void {
        const { bytes, path } = this;
        const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
        const isRight =
            bytes.length >= 2 * kHeader &&
            view.getUint32(4, true) === 0 &&
            view.getBigUint64(8, true) === BigInt(bytes.length);
        if (!isRight) {
            throw new PentError(
                `${path}: a damaged header; expected that of a G4MF draft with ${bytes.length} bytes in the file`,
            );
        }
        for (let at = kHeader; at + kHeader <= bytes.length; ) {
            const where = `${path}: chunk ${this.chunks.length}`;
            const size = Number(view.getBigUint64(at + 8, true));
            if (size > bytes.length - at - kHeader) {
                throw new PentError(`${where} has ${size} bytes; the file ends before`);
            }
            if (view.getUint32(at + 4, true) !== 0) {
                throw new PentError(`${where} is compressed; expected one that is not`);
            }
            this.chunks.push(bytes.subarray(at + kHeader, at + kHeader + size));
            at += kHeader + Math.ceil(size / kHeader) * kHeader;
        }
        if (String.fromCharCode(...bytes.subarray(kHeader, kHeader + 4)) !== "JSON") {
            throw new PentError(`${path}: no JSON in its first chunk`);
        }
    }

    // The bytes of a buffer, from the text, a file beside this one, or a chunk.
    private buffer(to: JsonEntry): Uint8Array {
        const entry = this.json.at("buffers").pointed(to);
        const index = to.whole();
        const known = this.known.get(index);
        if (known) {
            return known;
        }
        if (entry.has("encoding") || entry.has("compression")) {
            entry.fail("is compressed; expected a buffer that is not");
        }
        const bytes = entry.has("uri")
            ? this.bytesOf(entry.at("uri"))
            : this.chunkOf(entry, index + 1);
        const length = entry.at("byteLength").whole();
        if (bytes.length < length) {
            entry.fail(`has ${bytes.length} bytes; expected ${length}, its byteLength`);
        }
        this.known.set(index, bytes);
        return bytes;
    }

    private bytesOf(uri: JsonEntry): Uint8Array {
        const text = uri.text();
        const start = kDataUri.exec(text);
        if (!start) {
            return this.beside.get(text) ?? uri.fail("no such file beside this one");
        }
        try {
            return Uint8Array.from(atob(text.slice(start[0].length)), (c) => c.charCodeAt(0));
        } catch {
            uri.fail("is no base64");
        }
    }

    private chunkOf(entry: JsonEntry, usual: number): Uint8Array {
        const chunk = entry.has("chunk") ? entry.at("chunk").whole() : usual;
        return this.chunks[chunk] ?? entry.fail(`chunk ${chunk} of ${this.chunks.length}`);
    }

    // The bytes that an accessor sees, and what is in them.
    private bytesSeen(accessor: JsonEntry): { bytes: Uint8Array; type: JsonEntry } {
        const view = this.json.at("bufferViews").pointed(accessor.at("bufferView"));
        const buffer = view.has("buffer") ? view.at("buffer") : new JsonEntry(0, view.where);
        const bytes = this.buffer(buffer);
        const offset = view.has("byteOffset") ? view.at("byteOffset").whole() : 0;
        const length = view.at("byteLength").whole();
        if (offset > bytes.length || length > bytes.length - offset) {
            view.fail(`reaches beyond its buffer, which has ${bytes.length} bytes`);
        }
        // Drafts of the format have called it both.
        const key = accessor.has("primitiveType") ? "primitiveType" : "componentType";
        return { bytes: bytes.subarray(offset, offset + length), type: accessor.at(key) };
    }

    /** The numbers of an accessor of reals whose elements have `size` of them. */
    reals(to: JsonEntry, size: number): Float64Array {
        return Float64Array.from(this.numbers(to, size, kReals, "float32 or float64"));
    }

    /** The same of indices. */
    indices(to: JsonEntry, size: number): Uint32Array {
        return Uint32Array.from(this.numbers(to, size, kIndices, "uint8, uint16 or uint32"));
    }

    private numbers(
        to: JsonEntry,
        size: number,
        types: Map<string, Stored>,
        expected: string,
    ): ArrayLike<number> {
        const accessor = this.json.at("accessors").pointed(to);
        const found = accessor.has("vectorSize") ? accessor.at("vectorSize").whole() : 1;
        if (found !== size) {
            accessor.fail(`has elements of ${found} numbers; expected ${size}`);
        }
        const { bytes, type } = this.bytesSeen(accessor);
        const Numbers = types.get(type.text()) ?? type.expected(expected);
        if (bytes.length % (size * Numbers.BYTES_PER_ELEMENT) !== 0) {
            accessor.fail(`its ${bytes.length} bytes are no whole number of elements`);
        }
        return new Numbers(new Uint8Array(bytes).buffer); // a copy, at an address of its own; little-endian, as browsers are
    }
}
