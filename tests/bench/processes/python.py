#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures `camway.Client.plan` of Python beside `camway::Client::plan` of C++: both plan the same requests of one
daemon over the loopback, by turns, from the call to the answer.

Must: the median of Python at most 0.3 ms above that of C++. Exit code: 0 met, 1 not met or a plan failed.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
MUST_MS = 0.3
REQUESTS = ("office-free-straight", "office-graze-column", "office-graze-slalom")
SCENE = "office"


def start_daemon(programs):
    daemon = subprocess.Popen([programs / "camwayd", "--scene", f"{SCENE}={ROOT / 'scenes' / 'office.obj'}"],
                              stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    for line in daemon.stderr:
        if "[info] ready" in line:
            break
    # The pipe must not fill up with later lines.
    subprocess.Popen(["cat"], stdin=daemon.stderr, stdout=subprocess.DEVNULL)
    return daemon


def measure(client, peer, request, count):
    """Milliseconds of Python and of C++ for `count` pairs of calls: that pass, and those of the processor, of all threads
    of the process, which a busy machine changes little; of Python also those in which it reads all members of the
    answer afterwards. Who is first changes from pair to pair: the second finds warm
    caches in the daemon."""

    def by_python(seed):
        request.seed = seed
        processor_begin_s, begin_s = time.process_time(), time.perf_counter()
        answer = client.plan(request)
        taken_s, processor_s = time.perf_counter() - begin_s, time.process_time() - processor_begin_s
        begin_s = time.perf_counter()
        for name in answer.__match_args__:
            getattr(answer, name)
        mine.append((1000 * taken_s, 1000 * processor_s, 1000 * (time.perf_counter() - begin_s)))
        return answer.ok

    def by_cpp(seed):
        print(seed, file=peer.stdin, flush=True)
        taken_ms, processor_ms, is_ok = peer.stdout.readline().split()
        theirs.append((float(taken_ms), float(processor_ms)))
        return is_ok == "1"

    mine, theirs = [], []
    for i in range(count):
        for plan in (by_python, by_cpp) if i % 2 == 0 else (by_cpp, by_python):
            if not plan(i + 1):
                raise SystemExit("a plan failed")
    return mine, theirs


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, required=True, help="folder of the build")
    parser.add_argument("--count", type=int, default=400, help="pairs of calls for each request")
    parser.add_argument("--json", help="file for the numbers")
    arguments = parser.parse_args()
    sys.path.insert(0, str(arguments.build / "python"))
    import camway

    programs = (arguments.build / "bin").resolve()
    daemon = start_daemon(programs)
    rows = []
    try:
        with camway.Client() as client:
            for name in REQUESTS:
                file = ROOT / "scenes" / "requests" / f"{name}.json"
                with subprocess.Popen([programs / "bench_python_peer", file, SCENE], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, text=True) as peer:
                    request = camway.Request.load(file)
                    request.scene = SCENE
                    mine, theirs = measure(client, peer, request, arguments.count)
                    peer.stdin.close()
                python_ms, python_processor_ms, read_ms = map(statistics.median, zip(*mine))
                cpp_ms, cpp_processor_ms = map(statistics.median, zip(*theirs))
                rows.append({"request": name, "python_ms": python_ms, "cpp_ms": cpp_ms, "more_ms": python_ms - cpp_ms,
                             "python_processor_ms": python_processor_ms, "cpp_processor_ms": cpp_processor_ms,
                             "processor_more_ms": python_processor_ms - cpp_processor_ms, "read_ms": read_ms})
                line = ("{request:24} Python {python_ms:.3f} ms, C++ {cpp_ms:.3f} ms, {more_ms:+.3f} ms; "
                        "{processor_more_ms:+.3f} ms of processor time; {read_ms:.3f} ms to read all of the answer")
                print(line.format(**rows[-1]))
    finally:
        daemon.terminate()
        daemon.wait()
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(rows, indent=2) + "\n")
    is_met = all(row["more_ms"] <= MUST_MS for row in rows)
    print(f"at most {MUST_MS} ms more: {'met' if is_met else 'NOT met'}")
    return 0 if is_met else 1


if __name__ == "__main__":
    sys.exit(main())
