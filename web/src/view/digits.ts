/** A number with four digits, and as many more as tell places apart that are a thousandth of `size` from one another
 * where these are far from zero. */
export function rounded(value: number, size: number): number {
    const kNothing = 1e-9; // of the size: what sums leave of zero
    if (Math.abs(value) < kNothing * size) {
        return 0;
    }
    const further = Math.ceil(Math.log10(Math.abs(value) / size));
    return Number(value.toPrecision(Math.min(15, 4 + Math.max(0, further))));
}

/** To about a hundredth of a size. */
export function roughly(value: number, size: number): number {
    const step = 10 ** (Math.floor(Math.log10(size)) - 2);
    return Number((Math.round(value / step) * step).toPrecision(12));
}

/** "0.25 s", with the digits that tell moments apart which are so many seconds from one another. */
export function timeText(time: number, apart: number): string {
    const digits = Math.min(15, Math.max(2, Math.ceil(-Math.log10(apart))));
    return `${time.toFixed(digits)} s`;
}
