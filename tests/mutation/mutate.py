#!/usr/bin/env python3
"""Breaks the library in every way of mutants/ and says which test noticed.

    mutate.py --check               every replacement still applies to the sources
    mutate.py --build DIRECTORY     builds and runs what should notice, and prints the table; needs what the tests need
              [--only WORD]         the mutants whose name or header contains the word

The library is broken in a copy, below DIRECTORY, with one instruction set and little optimisation. One mutant is one or two
test programs: the whole table takes an hour and a half. Fails where a mutant survives that the table does not explain,
or is no program.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import time

from mutants import MUTANTS

PROJECT = pathlib.Path(__file__).resolve().parents[2]
NO_PROGRAM = "DOES NOT COMPILE"
SECONDS = 180  # after which a test that hangs has noticed


def what_does_not_apply():
    wrong = []
    for mutant in MUTANTS:
        count = (PROJECT / "include/texgen" / mutant.header).read_text().count(mutant.old)
        if count != 1:
            wrong.append(f"{mutant.header}: {mutant.name}: the text occurs {count} times")
    names = [mutant.name for mutant in MUTANTS]
    wrong += [f"{name}: the name occurs twice" for name in sorted(set(names)) if names.count(name) > 1]
    return wrong


def configure(copy, build, flags):
    for part in (".cmake", ".github", "include", "tests", "CMakeLists.txt", "README.md"):
        source, target = PROJECT / part, copy / part
        if source.is_dir():
            shutil.copytree(source, target, dirs_exist_ok=True)
        else:
            shutil.copy2(source, target)
    subprocess.run(["cmake", "-S", copy, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None",
                    f"-DCMAKE_CXX_FLAGS=-O1 {flags}", "-DTEXGEN_BENCHMARKS=OFF", "-DTEXGEN_TESTS=ON",
                    "-DTEXGEN_TESTS_TOGETHER=OFF"],
                   check=True, stdout=subprocess.DEVNULL)


def who_noticed(mutant, copy, build):
    """The test that failed, or None."""
    header = copy / "include/texgen" / mutant.header
    right = header.read_text()
    header.write_text(right.replace(mutant.old, mutant.new))
    try:
        for test in mutant.tests:
            built = subprocess.run(["cmake", "--build", build, "--target", test], capture_output=True, text=True)
            if built.returncode != 0:
                print(built.stdout[-3000:], file=sys.stderr)
                return NO_PROGRAM
            try:
                ran = subprocess.run([build / "tests" / test, "--abort-after=1"], capture_output=True, timeout=SECONDS)
            except subprocess.TimeoutExpired:
                return test + " (it hangs)"
            if ran.returncode != 0:
                return test
    finally:
        header.write_text(right)
    return None


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--check", action="store_true")
    options.add_argument("--build", type=pathlib.Path)
    options.add_argument("--only", default="")
    given = options.parse_args()

    wrong = what_does_not_apply()
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(MUTANTS)} mutants apply")
    if given.check or not given.build:
        return

    chosen = [m for m in MUTANTS if given.only in m.name or given.only in m.header]
    copy = given.build.resolve() / "copy"
    builds = {}
    for scalar in sorted({m.scalar for m in chosen}):
        builds[scalar] = given.build.resolve() / ("scalar" if scalar else "vectors")
        configure(copy, builds[scalar], "-DTEXGEN_SCALAR" if scalar else "-march=native -DTEXGEN_NO_DISPATCH")
    unexplained = 0
    for mutant in chosen:
        began = time.monotonic()
        test = who_noticed(mutant, copy, builds[mutant.scalar])
        if test:
            verdict = test
            unexplained += test == NO_PROGRAM
        elif mutant.survives:
            verdict = "survives: " + mutant.survives
        else:
            verdict = "SURVIVES"
            unexplained += 1
        print(f"{mutant.header:24} {mutant.name:56} {verdict}", flush=True)
        print(f"{time.monotonic() - began:.0f} s", file=sys.stderr, flush=True)
    print(f"{len(chosen)} mutants, {unexplained} survive unexplained or do not compile")
    sys.exit(1 if unexplained else 0)


if __name__ == "__main__":
    main()
