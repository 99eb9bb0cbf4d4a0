import { PentError } from "./error.ts";
import { kPlyTypes, parseCount, parseReal } from "./ply.ts";
import type { PlyElement, PlyProperty, PlyType } from "./ply.ts";

export type Dimension = 2 | 3 | 4;

/** The header of a .pent file, as parsed; not yet compared with the body. */
export interface Header {
    isAscii: boolean;
    dimension: Dimension;
    createdBy: string;
    crc32c: number | null; // null where an ascii file states none
    mesh: { name: string; crc: number } | null; // of a frame
    frame: number;
    step: number;
    time: number; // s
    elements: PlyElement[]; // vertex first, then the cells (not in a frame), then others
    body: number; // offset of the byte after end_header's newline
}

const kCellNames = { 2: "triangle", 3: "tetrahedron", 4: "pentachoron" } as const;
const kCellPlurals = { 2: "triangles", 3: "tetrahedra", 4: "pentachora" } as const;

export function cellName(dimension: Dimension): string {
    return kCellNames[dimension];
}

export function cellNamePlural(dimension: Dimension): string {
    return kCellPlurals[dimension];
}

const kComments = ["pent", "dimension", "created_by", "crc32c", "mesh", "frame", "step", "time"];
const kLongestLine = 4096;
const kMostVertices = 0xffffffffn; // indices are 32 bits wide

// One byte a character: what is not ASCII is shown as a question mark.
function toText(bytes: Uint8Array): string {
    let text = "";
    for (let i = 0; i < bytes.length; i += kLongestLine) {
        text += String.fromCharCode(...bytes.subarray(i, i + kLongestLine));
    }
    return text;
}

export function printable(text: string): string {
    return text.replace(/[^ -~]/g, "?");
}

function quoted(text: string): string {
    const kLongest = 60;
    return `'${printable(text.slice(0, kLongest))}${text.length > kLongest ? "..." : ""}'`;
}

function declaration(property: PlyProperty): string {
    return `property ${property.countType ? "list " : ""}${property.type} ${property.name}`;
}

// Reads a header line by line; every failure names the line.
class Parser {
    private at = 0;
    private line = 0;
    private seen = new Set<string>();
    private header: Header = {
        isAscii: false,
        dimension: 4,
        createdBy: "",
        crc32c: null,
        mesh: null,
        frame: 0,
        step: 0,
        time: 0,
        elements: [],
        body: 0,
    };

    constructor(
        private bytes: Uint8Array,
        private path: string,
    ) {}

    parse(): Header {
        this.parsePreamble();
        for (;;) {
            const line = this.nextLine();
            if (line === "end_header") {
                break;
            }
            const words = line.split(" ").filter((word) => word !== "");
            if (words[0] === "comment") {
                if (words.length >= 2) {
                    this.parseComment(words, line);
                }
            } else if (words[0] === "element" && words.length === 3) {
                this.parseElement(words, line);
            } else if (words[0] === "property" && words.length >= 3) {
                this.parseProperty(words, line);
            } else {
                this.fail(line, "a comment, element, property or end_header line");
            }
        }
        this.header.body = this.at;
        this.checkElements();
        return this.header;
    }

    private fail(found: string, expected: string): never {
        throw new PentError(
            `${this.path}: header line ${this.line}: found ${quoted(found)}, expected ${expected}`,
        );
    }

    private failHeader(what: string): never {
        throw new PentError(`${this.path}: header: ${what}`);
    }

    private nextLine(): string {
        ++this.line;
        if (this.at >= this.bytes.length) {
            throw new PentError(
                `${this.path}: header line ${this.line}: ` +
                    "the file ends here, expected more header up to end_header",
            );
        }
        const end = this.bytes.indexOf(10, this.at);
        if (end < 0 || end - this.at > kLongestLine) {
            this.fail(
                toText(this.bytes.subarray(this.at, this.at + kLongestLine)),
                this.line === 1
                    ? "'ply' (is this a .pent file?)"
                    : "a line that ends with a newline",
            );
        }
        const line = toText(this.bytes.subarray(this.at, end));
        this.at = end + 1;
        if (line.endsWith("\r")) {
            this.fail(line, "lines that end with LF alone (CR LF comes from a text-mode transfer)");
        }
        return line;
    }

    private parsePreamble(): void {
        if (this.bytes.length === 0) {
            throw new PentError(`${this.path}: the file is empty, expected a .pent file`);
        }
        let line = this.nextLine();
        if (line !== "ply") {
            this.fail(line, "'ply' (is this a .pent file?)");
        }
        line = this.nextLine();
        this.header.isAscii = line === "format ascii 1.0";
        if (!this.header.isAscii && line !== "format binary_little_endian 1.0") {
            this.fail(line, "'format binary_little_endian 1.0' or 'format ascii 1.0'");
        }
        line = this.nextLine();
        if (line !== "comment pent 1.0") {
            this.fail(line, "'comment pent 1.0'");
        }
        line = this.nextLine();
        const dimension = /^comment dimension ([234])$/.exec(line);
        if (!dimension) {
            this.fail(line, "'comment dimension D' with D = 2, 3 or 4");
        }
        this.header.dimension = Number(dimension[1]) as Dimension;
    }

    private parseComment(words: string[], line: string): void {
        const key = words[1]!;
        if (!kComments.includes(key)) {
            return;
        }
        if (this.header.elements.length > 0) {
            this.fail(line, `the comment '${key}' in front of the first element`);
        }
        if (key === "pent" || key === "dimension" || this.seen.has(key)) {
            this.fail(line, `the comment '${key}' only once`);
        }
        this.seen.add(key);
        if (key === "created_by") {
            this.header.createdBy = line.slice("comment created_by ".length);
        } else if (key === "crc32c") {
            this.header.crc32c = this.parseCrc(words, 2, line);
        } else if (key === "mesh") {
            const crc = this.parseCrc(words, 3, line);
            this.header.mesh = { name: words[2]!, crc };
        } else if (key === "time") {
            const time = words.length === 3 ? parseReal(words[2]!) : null;
            if (time === null) {
                this.fail(line, "'comment time NUMBER'");
            }
            if (!Number.isFinite(time)) {
                this.fail(line, "a finite time in seconds");
            }
            this.header.time = time;
        } else {
            const count = words.length === 3 ? parseCount(words[2]!) : null;
            if (count === null) {
                this.fail(line, `'comment ${key} NUMBER'`);
            }
            this.header[key as "frame" | "step"] = Number(count);
        }
    }

    private parseCrc(words: string[], word: number, line: string): number {
        if (words.length !== word + 1 || !/^[0-9a-fA-F]{8}$/.test(words[word]!)) {
            this.fail(
                line,
                `'comment ${word === 2 ? "crc32c" : "mesh NAME"} XXXXXXXX' ` +
                    "with 8 hexadecimal digits",
            );
        }
        return Number.parseInt(words[word]!, 16);
    }

    private parseElement(words: string[], line: string): void {
        const count = parseCount(words[2]!);
        if (count === null) {
            this.fail(line, "'element NAME COUNT' with a count of 0 to 2^64 - 1");
        }
        if (this.header.elements.some((element) => element.name === words[1])) {
            this.fail(line, "each element only once");
        }
        this.header.elements.push({ name: words[1]!, count, properties: [] });
    }

    private parseType(word: string, line: string): PlyType {
        const type = kPlyTypes.find((known) => known.name === word || known.alias === word);
        return (
            type?.name ??
            this.fail(line, "a PLY type: char uchar short ushort int uint float double")
        );
    }

    private parseProperty(words: string[], line: string): void {
        const element = this.header.elements.at(-1);
        if (!element) {
            this.fail(line, "an element line in front of the first property");
        }
        const property: PlyProperty = { name: "", type: "double", countType: null };
        if (words[1] === "list" && words.length === 5) {
            property.countType = this.parseType(words[2]!, line);
            if (property.countType === "float" || property.countType === "double") {
                this.fail(line, "a whole-number type for the length of a list");
            }
            property.type = this.parseType(words[3]!, line);
            property.name = words[4]!;
        } else if (words[1] !== "list" && words.length === 3) {
            property.type = this.parseType(words[1]!, line);
            property.name = words[2]!;
        } else {
            this.fail(line, "'property TYPE NAME' or 'property list TYPE TYPE NAME'");
        }
        if (element.properties.some((other) => other.name === property.name)) {
            this.fail(line, "each property only once in an element");
        }
        element.properties.push(property);
    }

    // The known elements must begin with their required properties, in order.
    private checkPrefix(element: PlyElement, names: string[], type: PlyType): void {
        names.forEach((name, i) => {
            const found = element.properties[i];
            if (!found || found.name !== name || found.type !== type || found.countType) {
                this.failHeader(
                    `property ${i} of element ${element.name}` +
                        (found ? ` is '${declaration(found)}'` : " is missing") +
                        `, expected '${declaration({ name, type, countType: null })}'`,
                );
            }
        });
        const list = element.properties.find((property) => property.countType);
        if (list) {
            this.failHeader(
                `element ${element.name} has the list property ${list.name}` +
                    ", expected properties of fixed width",
            );
        }
    }

    private checkElements(): void {
        const { dimension, elements, isAscii, crc32c, mesh } = this.header;
        const [vertex, cells] = elements;
        if (vertex?.name !== "vertex") {
            const found = vertex ? `element ${vertex.name} first` : "no element";
            this.failHeader(`found ${found}, expected element vertex first`);
        }
        if (vertex.count > kMostVertices) {
            this.failHeader(
                `element vertex has ${vertex.count} vertices, ` +
                    `expected at most ${kMostVertices}`,
            );
        }
        this.checkPrefix(vertex, [..."xyzw"].slice(0, dimension), "double");
        if (!isAscii && crc32c === null) {
            this.failHeader("no 'comment crc32c', expected one in a binary file");
        }
        if (mesh) {
            return;
        }
        if (cells?.name !== cellName(dimension)) {
            this.failHeader(
                `found ${cells ? `element ${cells.name}` : "no element"} after element ` +
                    `vertex, expected element ${cellName(dimension)} (dimension ${dimension})`,
            );
        }
        this.checkPrefix(
            cells,
            [..."01234"].slice(0, dimension + 1).map((k) => `v${k}`),
            "uint",
        );
    }
}

/** Parses and checks the header at the start of `bytes`; a PentError names the line, what was found
 * and what was expected. */
export function parseHeader(bytes: Uint8Array, path: string): Header {
    return new Parser(bytes, path).parse();
}
