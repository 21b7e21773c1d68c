"""One way to break the library, as a row of a table has it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    name: str
    header: str
    old: str
    new: str
    tests: tuple
    scalar: bool = False
    survives: str = ""


def of(header, *rows):
    return [Mutant(name, header, old, new, tuple(tests.split()), **more)
            for name, old, new, tests, *rest in rows for more in [rest[0] if rest else {}]]
