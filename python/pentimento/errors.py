"""What this package raises."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """What the library refused, in its own words: one line that says where, what was found and
    what was expected."""


class ProgramError(Error):
    """A program that refused, failed or is not there.

    The text is the program's own line without its name in front, which is in `program`.
    """

    def __init__(self, message: str, program: str, exit_code: int | None) -> None:
        super().__init__(message)
        self.program = program
        self.exit_code = exit_code  #: None if it did not run.

    def __reduce__(self) -> tuple[Any, ...]:
        # Pools of processes hand on what their workers raise, and wait for ever for what they
        # cannot read.
        return ProgramError, (str(self), self.program, self.exit_code)
