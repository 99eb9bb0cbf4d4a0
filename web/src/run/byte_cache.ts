/** Keeps the values that were used last, up to a number of bytes. */
export class ByteCache<Key, Value> {
    private entries = new Map<Key, { value: Value; bytes: number }>(); // the oldest first
    private used = 0;

    constructor(readonly limit: number) {}

    get bytes(): number {
        return this.used;
    }

    get size(): number {
        return this.entries.size;
    }

    has(key: Key): boolean {
        return this.entries.has(key);
    }

    /** The value, which now counts as used last. */
    get(key: Key): Value | undefined {
        const entry = this.entries.get(key);
        if (entry) {
            this.entries.delete(key);
            this.entries.set(key, entry);
        }
        return entry?.value;
    }

    /** Adds or replaces a value; drops those used longest ago, but never the one that came. */
    set(key: Key, value: Value, bytes: number): void {
        this.delete(key);
        this.entries.set(key, { value, bytes });
        this.used += bytes;
        for (const oldest of this.entries.keys()) {
            if (this.used <= this.limit || oldest === key) {
                break;
            }
            this.delete(oldest);
        }
    }

    delete(key: Key): void {
        const entry = this.entries.get(key);
        if (entry) {
            this.used -= entry.bytes;
            this.entries.delete(key);
        }
    }
}
