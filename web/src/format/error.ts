/** Something from outside that is not as it should be: one line that says where, what was found,
 * and what was expected or what to do. */
export class PentError extends Error {}
