#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads damaged files of every format with the programs as they are installed.

  tests/fuzz/files/hostile_files.py --programs FOLDER [--mutants 40] [--seed 1] [--workers 2]
                              [--samples FOLDER] [--only TEXT] [--without TEXT ...] [--keep FOLDER]
                              [--forked]

Each sample file is damaged in many ways: cut off, bits flipped, bytes replaced, spans removed,
repeated and exchanged, numbers replaced by huge, negative and meaningless ones. `camway info` reads
each of them, and `camway import` those of a folder `cameras`. Whatever is in a file, the program
ends in time with a code that is documented, and says in a sentence why it refused the file. The
process that reads the file may fall where a library reads it; where Camway's own readers do, it may
not.

With --forked, each file is read by a fork of the import program, which has loaded its library
before (forked_reader.h): the same code under the same limits, for very many files, without what
`camway` makes of the answer.

The files come from sample_files.py, and from the folder that --samples names; --only keeps those
with a text in their name. --keep writes the files that broke something into a folder. Exit code: 0
nothing broke, 1 something did.
"""

import argparse
import collections
import concurrent.futures
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import sample_files  # noqa: E402

# Formats that Camway reads with readers of its own: these may not fall.
OWN_ENDINGS = (".obj", ".off", ".ply", ".stl", ".ug", ".pcd", ".xyz", ".las", ".voxel.json",
               ".bpt")
INVENTOR_ENDINGS = (".iv", ".wrl", ".vrml", ".wrz", ".iv.gz", ".wrl.gz", ".ivz", ".iv.asc")
CAD_ENDINGS = (".step", ".stp", ".iges", ".igs")
# What `camway info` and `camway import` end with (docs/commands.md): read, or refused.
GOOD_CODES = (0, 2)
# The import process has a minute of wall clock; then a busy machine needs some time to say so.
LONGEST_S = 60.0 + 15.0
SANITIZER = re.compile(rb"Sanitizer|runtime error:|==ERROR|Assertion .* failed")
# Numbers that break readers: counts beyond any file, below zero, and no numbers at all.
NUMBERS = (b"0", b"-1", b"1", b"2147483647", b"-2147483648", b"4294967295", b"4294967296",
           b"18446744073709551615", b"99999999999999999999", b"1e308", b"-1e308", b"1e-320", b"nan",
           b"-inf", b"0.1.2", b"1e", b"")
INTEGERS = (0, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)
FLOATS = (float("nan"), float("inf"), -1e38, 1e300, 5e-324)


def cut(data, dice):
    return data[:dice.randrange(len(data) + 1)]


def flip_bits(data, dice):
    changed = bytearray(data)
    for _ in range(dice.choice((1, 1, 2, 8, 32))):
        changed[dice.randrange(len(changed))] ^= 1 << dice.randrange(8)
    return bytes(changed)


def replace_bytes(data, dice):
    changed = bytearray(data)
    for _ in range(dice.choice((1, 1, 2, 8))):
        changed[dice.randrange(len(changed))] = dice.choice((0, 10, 32, 45, 127, 255,
                                                             dice.randrange(256)))
    return bytes(changed)


def span(data, dice):
    begin = dice.randrange(len(data))
    return begin, min(len(data), begin + 1 + int(dice.expovariate(1 / 20)))


def remove_span(data, dice):
    begin, end = span(data, dice)
    return data[:begin] + data[end:]


def repeat_span(data, dice):
    begin, end = span(data, dice)
    return data[:end] + data[begin:end] * dice.choice((1, 1, 2, 100)) + data[end:]


def exchange_spans(data, dice):
    begin, end = span(data, dice)
    at = dice.randrange(len(data))
    return data[:at] + data[begin:end] + data[at + end - begin:]


def replace_number(data, dice):
    """A decimal in a text, or the bytes of a binary number."""
    found = list(re.finditer(rb"-?\d+(\.\d+)?([eE][-+]?\d+)?", data[:100_000]))
    if found and dice.random() < 0.6:
        number = dice.choice(found)
        return data[:number.start()] + dice.choice(NUMBERS) + data[number.end():]
    at = dice.randrange(len(data))
    if dice.random() < 0.7:
        width = dice.choice((1, 2, 4, 4, 8))
        order = dice.choice(("little", "big"))
        other = (dice.choice(INTEGERS) & ((1 << 8 * width) - 1)).to_bytes(width, order)
    else:
        kind = dice.choice("fd")
        other = struct.pack("<" + kind, dice.choice(FLOATS[:3] if kind == "f" else FLOATS))
    return data[:at] + other + data[at + len(other):]


def drop_line(data, dice):
    lines = data.split(b"\n")
    at = dice.randrange(len(lines))
    dice.choice((lambda: lines.pop(at), lambda: lines.insert(at, lines[dice.randrange(len(lines))]),
                 lambda: dice.shuffle(lines)))()
    return b"\n".join(lines)


DAMAGES = (cut, flip_bits, replace_bytes, remove_span, repeat_span, exchange_spans, replace_number,
           replace_number, drop_line)


def mutant(data, dice):
    for _ in range(dice.choice((1, 1, 1, 2, 4))):
        if data:
            data = dice.choice(DAMAGES)(data, dice)
    return data


class Sample:
    """A file, the files beside it, and how it is read."""

    def __init__(self, path, root):
        self.name = str(path.relative_to(root))
        self.path = path
        self.companions = [p for p in path.parent.iterdir() if p.is_file() and p != path]
        self.is_camera = "cameras" in path.parts[len(root.parts):-1]
        self.is_own = not self.is_camera and self.name.lower().endswith(OWN_ENDINGS)
        # Of voxels of splats, most is in the second file.
        self.damaged = [self.path]
        if self.name.endswith(".voxel.json"):
            self.damaged.append(path.with_suffix(".bin"))

    def command(self, programs, file):
        verb = ["import"] if self.is_camera else ["info", "--json", "--no-cache"]
        extra = ["--request", "-", "--fov-y-deg", "40", "--aspect", "1.5"] if self.is_camera else []
        return [str(programs / "camway"), *verb, str(file), *extra]


    def is_by_import_program(self):
        """Whether an import program reads it, not `camway` itself."""
        return not self.is_camera or self.name.lower().endswith((".dae", ".fbx"))

    def forked_program(self):
        name = self.name.lower()
        if name.endswith(INVENTOR_ENDINGS):
            return "forked_import_inventor"
        return "forked_import_cad" if name.endswith(CAD_ENDINGS) else "forked_import"


class Worker:
    """Writes and reads the damaged files of one sample, in a folder of its own."""

    def __init__(self, sample, options):
        self.sample = sample
        self.options = options
        self.counts = collections.Counter()
        self.faults = []
        self.longest_s = 0.0

    def run(self):
        if not self.options.forked:
            return self.run_all(self.read)
        program = self.options.programs / self.sample.forked_program()
        with subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              text=True, errors="replace") as self.forked:
            return self.run_all(self.read_forked)

    def run_all(self, read):
        with tempfile.TemporaryDirectory(prefix="camway-hostile-") as folder:
            file = Path(folder) / self.sample.path.name
            for companion in self.sample.companions:
                shutil.copy(companion, folder)
            read(file, self.sample.path.read_bytes(), self.sample.path, "whole")
            for i in range(self.options.mutants):
                dice = random.Random(f"{self.options.seed} {self.sample.name} {i}")
                source = dice.choice(self.sample.damaged)
                read(file, mutant(source.read_bytes(), dice), source, f"mutant {i}")
        return self

    def write(self, file, data, source):
        """Returns the file that is damaged."""
        for original in self.sample.damaged:
            if original != source:
                (file.parent / original.name).write_bytes(original.read_bytes())
        damaged = file.parent / source.name
        damaged.write_bytes(data)
        return damaged

    def read_forked(self, file, data, source, what):
        damaged = self.write(file, data, source)
        begin = time.monotonic()
        order = f"cameras {file}" if self.sample.is_camera else str(file)
        self.forked.stdin.write(order + "\n")
        self.forked.stdin.flush()
        outcome, _, said = self.forked.stdout.readline().rstrip("\n").partition("\t")
        self.longest_s = max(self.longest_s, time.monotonic() - begin)
        self.counts[outcome] += 1
        problem = None
        if outcome not in ("read", "refused", "limited", "fallen"):
            problem = f"answered with '{outcome}'"
        elif outcome == "refused" and not re.search(r"\w \w", said):
            problem = "refused it without a sentence"
        elif outcome == "fallen" and self.sample.is_own:
            problem = "the import process fell in a reader of Camway's own"
        elif what == "whole" and outcome != "read":
            problem = "the sample itself is refused"
        if problem:
            self.fault(what, problem, damaged, said.encode())

    def read(self, file, data, source, what):
        damaged = self.write(file, data, source)
        begin = time.monotonic()
        try:
            done = subprocess.run(self.sample.command(self.options.programs, file),
                                  stdin=subprocess.DEVNULL, capture_output=True,
                                  timeout=LONGEST_S, cwd=file.parent, check=False)
        except subprocess.TimeoutExpired:
            self.fault(what, f"takes longer than {LONGEST_S} s", damaged, b"")
            return
        self.longest_s = max(self.longest_s, time.monotonic() - begin)
        self.judge(what, done, damaged)

    def judge(self, what, done, damaged):
        said = done.stderr
        if done.returncode == 0:
            outcome = "read"
        elif b"crashed its reader" in said:
            outcome = "fallen"
        elif b"more than the limit" in said:
            outcome = "limited"
        else:
            outcome = "refused"
        self.counts[outcome] += 1
        problem = None
        if done.returncode < 0:
            problem = f"died of {signal.Signals(-done.returncode).name}"
        elif done.returncode not in GOOD_CODES:
            problem = f"ended with {done.returncode}"
        elif SANITIZER.search(said) or SANITIZER.search(done.stdout):
            problem = "a sanitizer or an assertion spoke"
        elif done.returncode != 0 and not re.search(rb"camway: .*\w \w", said):
            problem = "refused it without a sentence"
        elif outcome == "fallen" and self.sample.is_own:
            problem = "the import process fell in a reader of Camway's own"
        elif what == "whole" and done.returncode != 0:
            problem = "the sample itself is refused"
        if problem:
            self.fault(what, problem, damaged, said)

    def fault(self, what, problem, damaged, said):
        shown = said.decode(errors="replace").strip()[:400]
        self.faults.append(f"{self.sample.name}, {what}: {problem}: {shown}")
        if self.options.keep:
            place = self.options.keep / f"{self.sample.name.replace('/', '_')}.{what}"
            place.mkdir(parents=True, exist_ok=True)
            for file in damaged.parent.iterdir():
                shutil.copy(file, place)


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=Path, required=True, help="folder with camway")
    parser.add_argument("--mutants", type=int, default=40, help="of each sample (40)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--samples", type=Path, help="a folder with more samples")
    parser.add_argument("--only", default="", help="samples with this text in their name")
    parser.add_argument("--without", action="append", default=[],
                        help="no samples with this text in their name; may be given again")
    parser.add_argument("--forked", action="store_true", help="by forks of the import programs")
    parser.add_argument("--keep", type=Path, help="folder for files that broke something")
    options = parser.parse_args()
    options.programs = options.programs.resolve()
    return options


def samples_in(folder, options):
    made = [(path, folder) for path in sample_files.write_all(folder)]
    if options.samples:
        root = options.samples.resolve()
        made += [(path, root) for path in sorted(root.rglob("*")) if path.is_file()]
    wanted = [Sample(path, root) for path, root in made]
    return [sample for sample in wanted if options.only in sample.name
            and (sample.is_by_import_program() or not options.forked) and not any(text in sample.name for text in options.without)]


def main():
    options = parse_options()
    os.environ["CAMWAY_CACHE_DIR"] = ""
    total = collections.Counter()
    faults = []
    print(f"{'sample':28} {'read':>7} {'refused':>8} {'limited':>8} {'fallen':>7} {'longest':>9}")
    with tempfile.TemporaryDirectory(prefix="camway-samples-") as folder:
        samples = samples_in(Path(folder).resolve(), options)
        with concurrent.futures.ThreadPoolExecutor(options.workers) as pool:
            for worker in pool.map(lambda sample: Worker(sample, options).run(), samples):
                counts = worker.counts
                print(f"{worker.sample.name:28} {counts['read']:7} {counts['refused']:8} "
                      f"{counts['limited']:8} {counts['fallen']:7} {worker.longest_s:7.2f} s",
                      flush=True)
                total += counts
                faults += worker.faults
    print(f"{'all':28} {total['read']:7} {total['refused']:8} {total['limited']:8} "
          f"{total['fallen']:7}")
    for fault in faults:
        print(fault, file=sys.stderr)
    if not total:
        sys.exit("there is no sample")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
