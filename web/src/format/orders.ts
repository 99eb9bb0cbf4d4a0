/** An order of 0, 1 and so on. */
export interface Order {
    order: number[];
    isOdd: boolean; // whether an odd number of swaps makes it
}

/** All orders of so many, in the sequence of a dictionary. */
export function allOrders(count: number): Order[] {
    const extend = ({ order, isOdd }: Order): Order[] =>
        order.length === count
            ? [{ order, isOdd }]
            : Array.from({ length: count }, (_, i) => i)
                  .filter((i) => !order.includes(i))
                  .flatMap((next, before) =>
                      extend({ order: [...order, next], isOdd: isOdd !== (before % 2 === 1) }),
                  );
    return extend({ order: [], isOdd: false });
}
