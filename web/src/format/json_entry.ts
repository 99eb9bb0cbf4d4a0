import { PentError } from "./error.ts";
import { printable } from "./header.ts";

/** A place in a JSON document, of which messages speak by its name: "a.g4tf: meshes[0].vertices". */
export class JsonEntry {
    constructor(
        readonly value: unknown,
        readonly where: string,
        private isTop = false,
    ) {}

    /** Reads a document. Throws a PentError where it is none. */
    static parse(text: string, path: string, what: string): JsonEntry {
        try {
            return new JsonEntry(JSON.parse(text), path, true);
        } catch (error) {
            const said = printable((error as Error).message).slice(0, 100);
            throw new PentError(`${path}: is no ${what} (${said})`);
        }
    }

    has(key: string): boolean {
        const { value } = this;
        return typeof value === "object" && value !== null && Object.hasOwn(value, key);
    }

    /** The value of a key; undefined where it is not there, which is said when it is asked for. */
    at(key: string): JsonEntry {
        const value = this.has(key) ? (this.value as Record<string, unknown>)[key] : undefined;
        return new JsonEntry(value, `${this.where}${this.isTop ? ": " : "."}${key}`);
    }

    list(): JsonEntry[] {
        const { value, where } = this;
        if (!Array.isArray(value)) {
            this.expected("a list");
        }
        return value.map((one: unknown, i) => new JsonEntry(one, `${where}[${i}]`));
    }

    /** The entry of this list that another entry points to. */
    pointed(to: JsonEntry): JsonEntry {
        const { value } = this;
        const index = to.whole();
        if (!Array.isArray(value) || index >= value.length) {
            const count = Array.isArray(value) ? value.length : 0;
            to.fail(`points to entry ${index} of ${count}`);
        }
        return new JsonEntry(value[index], `${this.where}[${index}]`);
    }

    /** 0, 1, 2 and so on, as far as doubles tell them apart, or to the most there may be. */
    whole(most = Number.MAX_SAFE_INTEGER): number {
        const { value } = this;
        if (!Number.isSafeInteger(value) || (value as number) < 0 || (value as number) > most) {
            const end = most === Number.MAX_SAFE_INTEGER ? "on" : `to ${most}`;
            this.expected(`a whole number from 0 ${end}`);
        }
        return value as number;
    }

    real(): number {
        const { value } = this;
        if (!Number.isFinite(value)) {
            this.expected("a finite number");
        }
        return value as number;
    }

    text(): string {
        const { value } = this;
        if (typeof value !== "string") {
            this.expected("a text");
        }
        return value;
    }

    reals(count: number): number[] {
        const { value } = this;
        const isRight =
            Array.isArray(value) &&
            value.length === count &&
            value.every((x) => Number.isFinite(x));
        if (!isRight) {
            this.expected(`${count} finite numbers`);
        }
        return value as number[];
    }

    expected(what: string): never {
        const { value } = this;
        if (value === undefined) {
            this.fail(`is missing; expected ${what}`);
        }
        const kLongest = 40;
        const text = printable(JSON.stringify(value).slice(0, kLongest + 1));
        const found = text.length > kLongest ? `${text.slice(0, kLongest)}...` : text;
        this.fail(`found ${found}; expected ${what}`);
    }

    fail(what: string): never {
        throw new PentError(`${this.where}: ${what}`);
    }
}
