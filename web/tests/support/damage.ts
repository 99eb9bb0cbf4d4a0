/** One to four bytes changed, left out, put in, or the file cut: as the C++ tests damage them. */
export function damage(bytes: Uint8Array, random: () => number): Uint8Array {
    let data = [...bytes];
    const pick = (below: number) => Math.floor(random() * below);
    for (let i = 1 + pick(4); i > 0 && data.length > 0; --i) {
        const at = pick(data.length);
        const kind = pick(5);
        if (kind === 0) {
            data[at] = pick(256);
        } else if (kind === 1) {
            data.splice(at, 1 + pick(8));
        } else if (kind === 2) {
            const character = "0123456789-.e \n".charCodeAt(pick(15));
            data.splice(at, 0, ...Array<number>(1 + pick(8)).fill(character));
        } else if (kind === 3) {
            data = data.slice(0, at);
        } else {
            const from = pick(data.length);
            data.splice(at, 0, ...data.slice(from, from + pick(40)));
        }
    }
    return Uint8Array.from(data);
}
