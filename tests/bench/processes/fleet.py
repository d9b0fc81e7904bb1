#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures a fleet on this machine, in a network namespace of its own.

throughput   plans a second with 1, 2 and 4 planners, each with the same share of a core (cgroup v1)
round trip   what a front and NATS add to the time of a request, beside a daemon alone
kills        plans while planners are killed at random: all answered, none wrong

Exit code: 0 measured, 1 an answer was wrong or lost, or a part did not start.
"""
import argparse
import contextlib
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
PATIENCE_S = 60
CPU_GROUPS = pathlib.Path("/sys/fs/cgroup/cpu")
PERIOD_US = 10_000


class Failure(Exception):
    pass


class Part:
    """A process with its output in a file."""

    def __init__(self, folder, name, command, until=None):
        self.log = folder / f"{name}.log"
        self.command = command
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen(command, stdout=log, stderr=log)
        if until:
            self.wait_for(until)

    def wait_for(self, text):
        end = time.monotonic() + PATIENCE_S
        while text not in self.log.read_text(errors="replace"):
            if self.process.poll() is not None or time.monotonic() > end:
                raise Failure(f"{self.command[0]} does not say '{text}':\n{self.log.read_text()[-1000:]}")
            time.sleep(0.02)

    def end(self, number=signal.SIGTERM):
        if self.process.poll() is None:
            self.process.send_signal(number)
        self.process.wait()


class Fleet:
    """A server of NATS, a front and planners, in a folder that goes with them."""

    def __init__(self, programs, scene):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="camway-fleet-"))
        self.programs = programs
        self.server_url = "nats://127.0.0.1:4222"
        server = shutil.which("nats-server", path=os.environ["PATH"] + ":/usr/sbin")
        if not server:
            raise Failure("nats-server is not there: install the package nats-server")
        self.server = Part(self.folder, "nats", [server, "-js", "-sd", str(self.folder / "store"), "-a", "127.0.0.1"],
                           "Server is ready")
        self.front = Part(self.folder, "front", [programs / "camwayd", "--role", "front", "--fleet", self.server_url,
                                                 "--scene", scene], "serving")
        self.planners = []

    def start_planner(self):
        planner = Part(self.folder, f"planner{len(self.planners)}-{time.monotonic_ns()}",
                       [self.programs / "camwayd", "--role", "planner", "--fleet", self.server_url, "--workers", "1"],
                       "planning")
        self.planners.append(planner)
        return planner

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for part in [*self.planners, self.front, self.server]:
            part.end()
        shutil.rmtree(self.folder)


@contextlib.contextmanager
def limited(process, share):
    """Gives a process this share of a core."""
    group = CPU_GROUPS / f"camway-{process.pid}"
    group.mkdir()
    try:
        (group / "cpu.cfs_period_us").write_text(str(PERIOD_US))
        (group / "cpu.cfs_quota_us").write_text(str(int(share * PERIOD_US)))
        (group / "cgroup.procs").write_text(str(process.pid))
        yield
    finally:
        if process.poll() is None:
            (CPU_GROUPS / "cgroup.procs").write_text(str(process.pid))
        with contextlib.suppress(OSError):
            group.rmdir()


def load(programs, scene, requests, folder, clients, seconds):
    """Runs `camway load`; returns its measurements."""
    out = folder / "load.json"
    command = [programs / "camway", "load", "--scene", scene, "--clients", str(clients), "--seconds", str(seconds),
               "--json", str(out)]
    for request in requests:
        command += ["--request", request]
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode != 0:
        raise Failure(f"camway load: code {ran.returncode}\n{ran.stdout}{ran.stderr}")
    return json.loads(out.read_text())


def throughput(arguments):
    print(f"planners with {100 * arguments.share:g} % of a core each, {arguments.seconds:g} s")
    one = None
    rows = []
    for number in (1, 2, 4):
        with Fleet(arguments.bin, arguments.scene) as fleet, contextlib.ExitStack() as groups:
            for _ in range(number):
                groups.enter_context(limited(fleet.start_planner().process, arguments.share))
            time.sleep(1)
            measured = load(arguments.bin, arguments.scene, arguments.requests, fleet.folder, 3 * number,
                            arguments.seconds)
        rate = measured["answers_per_s"]
        one = one or rate
        rows.append({"planners": number, "answers_per_s": rate, "of_ideal": rate / (number * one)})
        print(f"  {number} planners: {rate:8.1f} answers a second, {rate / (number * one):.2f} of {number} times one")
    return rows


def latencies(programs, scene, request, folder, seconds):
    measured = load(programs, scene, [request], folder, 1, seconds)
    return measured["latency_without_planning_ms"]


def round_trip(arguments):
    request = arguments.free_request
    folder = pathlib.Path(tempfile.mkdtemp(prefix="camway-alone-"))
    alone = Part(folder, "alone", [arguments.bin / "camwayd", "--scene", arguments.scene], "serving")
    try:
        before = latencies(arguments.bin, arguments.scene, request, folder, arguments.seconds)
    finally:
        alone.end()
        shutil.rmtree(folder)
    with Fleet(arguments.bin, arguments.scene) as fleet:
        fleet.start_planner()
        time.sleep(1)
        after = latencies(arguments.bin, arguments.scene, request, fleet.folder, arguments.seconds)
    added = {key: after[key] - before[key] for key in ("p50", "p99")}
    print(f"latency less planning, ms: alone p50 {before['p50']:.3f} p99 {before['p99']:.3f}, "
          f"fleet p50 {after['p50']:.3f} p99 {after['p99']:.3f}: "
          f"{added['p50']:.3f} and {added['p99']:.3f} more")
    return {"alone_ms": before, "fleet_ms": after, "added_ms": added}


def kills(arguments):
    rng = random.Random(arguments.seed)
    with Fleet(arguments.bin, arguments.scene) as fleet:
        for _ in range(3):
            fleet.start_planner()
        ends = threading.Event()
        killed = 0

        def kill_now_and_then():
            nonlocal killed
            while not ends.wait(rng.uniform(0.2, 2.0)):
                victim = rng.randrange(3)
                fleet.planners[victim].end(signal.SIGKILL)
                killed += 1
                fresh = fleet.start_planner()
                fleet.planners.remove(fresh)
                fleet.planners[victim] = fresh

        killer = threading.Thread(target=kill_now_and_then)
        killer.start()
        try:
            measured = load(arguments.bin, arguments.scene, arguments.requests, fleet.folder, 6, arguments.kill_s)
        finally:
            ends.set()
            killer.join()
        status = subprocess.run([arguments.bin / "camway", "status"], capture_output=True, text=True).stdout
    fleet_line = re.search(r"^fleet .*$", status, re.M)
    print(f"{killed} kills (seed {arguments.seed}) in {arguments.kill_s:g} s: {measured['answered']} answered, "
          f"{measured['wrong']} wrong, {measured['lost']} lost; {fleet_line.group(0) if fleet_line else status}")
    if measured["wrong"] or measured["lost"] or measured["answered"] != measured["requests"]:
        raise Failure("an answer was wrong or lost")
    return {"kills": killed, "answered": measured["answered"], "wrong": measured["wrong"], "lost": measured["lost"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bench/bin")
    parser.add_argument("--only", choices=("throughput", "round_trip", "kills"))
    parser.add_argument("--seconds", type=float, default=10, help="of each measurement")
    parser.add_argument("--kill-s", type=float, default=60)
    parser.add_argument("--share", type=float, default=0.2, help="of a core, for each planner")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.bin = arguments.bin.resolve()
    arguments.scene = f"office={ROOT}/scenes/office.obj"
    arguments.requests = sorted((ROOT / "scenes/requests").glob("office-graze-*.json"))
    arguments.free_request = ROOT / "scenes/requests/office-free-door.json"
    results = {}
    try:
        for measure in (throughput, round_trip, kills):
            if arguments.only in (None, measure.__name__):
                results[measure.__name__] = measure(arguments)
    except Failure as failure:
        print(f"fleet: {failure}", file=sys.stderr)
        return 1
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
