#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Throws hostile requests and frames at a running `camway view` over its real socket.

  tests/tools/view/hostile/hostile_clients.py --programs FOLDER [--count 10000] [--seed 1] [--first 0]
                                              [--workers 4] [--daemon] [--growth-mb 128]

Each connection sends damaged HTTP (heads cut, huge and wrong, wrong lengths, broken chunks, wrong
tokens, hosts and origins, pipelines, broken upgrades, noise), or a WebSocket's frames: messages
with members of wrong types, too deep and too large ones, floods of drags, fragments, and at the end
a frame that breaks the protocol, or a connection that is dropped in the middle. --count says how
many requests and frames. Batch N of a seed sends the same every time, apart from port and token.

Every connection has to be answered or closed within LONGEST_S, and a right request is answered
after each batch. At the end the program answers a plan as before the first of them; its open files
and threads are those of the beginning; and its memory has grown by no more than --growth-mb since
the first tenth of them, as allocators keep what the largest ones needed. With --daemon it asks a
camwayd, which has to survive as well. The numbers are printed. Exit code: 0 all held, 1 something
did not.
"""

import argparse
import collections
import concurrent.futures
import http.client
import json
import os
import random
import signal
import socket
import struct
import subprocess
import sys
import time
import urllib.parse
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import hostile_frames  # noqa: E402
import hostile_json  # noqa: E402
import hostile_requests  # noqa: E402

ROOT = Path(__file__).resolve().parents[4]
# An answer or a close: the door's patience is 5 s, a plan's deadline 1 s, and machines are busy.
LONGEST_S = 60.0
BATCH = 200
MOST_FAULTS = 20  # then it ends before its time
LAST_ID = (1 << 53) - 1
SANITIZER = ("Sanitizer", "runtime error:", "Assertion", "terminate called")


@dataclass
class Door:
    port: int
    token: str

    def connect(self):
        connection = socket.create_connection(("127.0.0.1", self.port), LONGEST_S)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return connection

    def ask(self, method, place, document=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=LONGEST_S)
        connection.request(method, place, None if document is None else json.dumps(document),
                           {"Authorization": f"Bearer {self.token}", "Connection": "close"})
        response = connection.getresponse()
        answer = json.loads(response.read())
        connection.close()
        return response.status, answer


def drop(connection, dice):
    """Ends a connection as a program does that crashes, or that closes it."""
    if dice.random() < 0.5:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    connection.close()


def send(connection, data, dice):
    """Sends at once, in pieces, or byte by byte. The other side may hang up meanwhile."""
    way = dice.random()
    try:
        if way < 0.9:
            connection.sendall(data)
        elif way < 0.998:
            cut = dice.randrange(len(data) + 1)
            connection.sendall(data[:cut])
            connection.sendall(data[cut:])
        else:
            for byte in data[:50]:
                connection.sendall(bytes([byte]))
                time.sleep(0.005)
            connection.sendall(data[50:])
    except (BrokenPipeError, ConnectionResetError):
        pass


def read_to_end(connection):
    """Returns the first bytes that come until the other side closes, or a socket begins, which may stay silent."""
    first = b""
    try:
        while part := connection.recv(1 << 16):
            if len(first) < 64:
                first += part
            if first.startswith(b"HTTP/1.1 101"):
                break
    except (ConnectionResetError, BrokenPipeError):
        pass
    return first


class Frames:
    """Reads the frames of a door."""

    def __init__(self, connection, begun):
        self.connection = connection
        self.buffer = begun

    def take(self, count):
        while len(self.buffer) < count:
            part = self.connection.recv(1 << 16)
            if not part:
                raise ConnectionResetError
            self.buffer += part
        taken, self.buffer = self.buffer[:count], self.buffer[count:]
        return taken

    def next(self):
        first, length = self.take(2)
        if length == 126:
            length, = struct.unpack(">H", self.take(2))
        elif length == 127:
            length, = struct.unpack(">Q", self.take(8))
        return first & 15, self.take(length)


class Batch:
    """The clients of one batch, one after the other."""

    def __init__(self, door, requests, seed, number):
        self.door = door
        self.requests = requests
        self.dice = random.Random(f"{seed} {number}")
        self.name = f"seed {seed}, batch {number}"
        self.counts = collections.Counter()
        self.sent = 0
        self.longest_s = 0.0
        self.faults = []

    def run(self):
        while self.sent < BATCH:
            client = self.over_http if self.dice.random() < 0.7 else self.over_socket
            begin = time.monotonic()
            try:
                outcome = client()
            except TimeoutError:
                outcome = "HUNG"
            except OSError as error:
                outcome = f"FAILED {error}"
            if outcome.isupper() or outcome.startswith("FAILED"):
                self.faults.append(f"{self.name}: {outcome} after {self.sent} things sent")
            self.counts[outcome] += 1
            self.longest_s = max(self.longest_s, time.monotonic() - begin)
        try:
            code = self.door.ask("GET", "/v1/version")[0]
        except OSError as error:
            code = error
        if code != 200:
            self.faults.append(f"{self.name}: a right request was answered with {code} after it")
        return self

    def over_http(self):
        kind, data, count = hostile_requests.hostile_request(self.door, self.requests, self.dice)
        self.sent += count
        self.counts[f"sent: HTTP, {kind}"] += count
        connection = self.door.connect()
        send(connection, data, self.dice)
        if self.dice.random() < 0.1:
            drop(connection, self.dice)
            return "HTTP: dropped"
        # Few wait for the door to lose its patience.
        if self.dice.random() < 0.998:
            try:
                connection.shutdown(socket.SHUT_WR)
            except OSError:
                pass
        first = read_to_end(connection)
        connection.close()
        if first.startswith(b"HTTP/1."):
            return f"HTTP: answered {first[9:12].decode()}"
        return "HTTP: other bytes" if first else "HTTP: closed"

    def handshake(self, connection):
        connection.sendall((
            f"GET /v1/socket?token={self.door.token} HTTP/1.1\r\nHost: 127.0.0.1:{self.door.port}\r\n"
            "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n").encode())
        head = b""
        while b"\r\n\r\n" not in head:
            part = connection.recv(4096)
            if not part:
                raise ConnectionResetError("the upgrade was not answered")
            head += part
        if not head.startswith(b"HTTP/1.1 101"):
            raise ConnectionResetError(f"the upgrade was answered with {head[:12]}")
        return Frames(connection, head.split(b"\r\n\r\n", 1)[1])

    def messages(self):
        if self.dice.random() < 0.03:
            return self.flood()
        frames = []
        for ident in range(self.dice.choice((1, 5, 20, 60))):
            frames += hostile_frames.harmless(ident, self.requests, self.dice)
        return frames

    def flood(self):
        """Returns plans of a drag that come faster than they are answered."""
        frames = []
        for ident in range(self.dice.choice((50, 150))):
            message = {"id": ident, "do": "plan", "drag": "a", "request": self.dice.choice(self.requests)}
            frames.append(hostile_frames.frame(hostile_frames.TEXT, json.dumps(message).encode()))
        return frames

    def over_socket(self):
        connection = self.door.connect()
        frames = self.handshake(connection)
        hostile = self.messages()
        ending, last, outcome = self.ending()
        self.sent += len(hostile) + (1 if last else 0)
        self.counts["sent: frames"] += len(hostile)
        self.counts[f"sent: frame, {ending}"] += 1
        send(connection, b"".join(hostile) + last, self.dice)
        told = outcome(connection, frames)
        connection.close()
        return told

    def ending(self):
        """Returns the name of the last frame, its bytes, and the function that judges its end."""
        way = self.dice.random()
        if way < 0.45:
            probe = json.dumps({"id": LAST_ID, "do": "version"}).encode()
            return "right", hostile_frames.frame(hostile_frames.TEXT, probe), self.answered
        if way < 0.85:
            return *hostile_frames.breaking(self.dice), self.closed
        return "unfinished", hostile_frames.unfinished(self.dice), self.dropped

    def answered(self, connection, frames):
        """Reads until the last message is answered, which shows that all before it were read."""
        del connection
        while True:
            try:
                op, data = frames.next()
            except ConnectionResetError:
                return "SOCKET: CLOSED WITHOUT REASON"
            if op == hostile_frames.CLOSE:
                return f"SOCKET: CLOSED A RIGHT CONVERSATION, {struct.unpack('>H', data[:2])[0]}"
            if op == hostile_frames.TEXT and json.loads(data).get("id") == LAST_ID:
                return "socket: answered"

    def closed(self, connection, frames):
        del connection
        try:
            while True:
                op, data = frames.next()
                if op == hostile_frames.CLOSE:
                    code = struct.unpack(">H", data[:2])[0] if len(data) >= 2 else "without a code"
                    return f"socket: closed, {code}"
        except ConnectionResetError:
            return "socket: closed"

    def dropped(self, connection, frames):
        del frames
        drop(connection, self.dice)
        return "socket: dropped"


def run_batch(door, requests, seed, number):
    return Batch(door, requests, seed, number).run()


class Process:
    """A program under attack."""

    def __init__(self, command, **pipes):
        self.name = Path(command[0]).name
        self.running = subprocess.Popen(command, stdin=subprocess.DEVNULL, text=True,
                                        stderr=subprocess.PIPE, **pipes)

    def state(self):
        """Returns its resident memory in MB, its threads, and its open files."""
        folder = Path(f"/proc/{self.running.pid}")
        lines = dict(line.split(":", 1) for line in (folder / "status").read_text().splitlines())
        return (int(lines["VmRSS"].split()[0]) / 1024, int(lines["Threads"]),
                len(list((folder / "fd").iterdir())))

    def end(self):
        """Ends the program. Returns the faults of its end."""
        self.running.send_signal(signal.SIGINT)
        try:
            said = self.running.communicate(timeout=LONGEST_S)[1]
        except subprocess.TimeoutExpired:
            self.running.kill()
            return [f"{self.name} does not end"]
        spoke = [line for line in said.splitlines() if any(word in line for word in SANITIZER)]
        code = self.running.returncode
        return spoke + ([] if code in (0, -signal.SIGINT) else [f"{self.name} ended with {code}: {said[-2000:]}"])


def plan_of(door, request):
    """Returns the answer of a plan, without what differs each time."""
    code, answer = door.ask("POST", "/v1/plan", request)
    answer.pop("timing_ms", None)
    return code, answer


def first_plan(door, request):
    """Returns the answer of a plan as soon as it is right: a daemon may still be starting."""
    deadline = time.monotonic() + LONGEST_S
    while (answered := plan_of(door, request))[0] != 200 and time.monotonic() < deadline:
        time.sleep(0.2)
    return answered


def tidy(door):
    """Removes the objects of hostile clients. Returns why that was not possible."""
    code, described = door.ask("GET", "/v1/scenes/office")
    names = [each["name"] for each in described.get("objects", [])]
    for name in names:
        if name == "office":
            continue
        code, answer = door.ask("DELETE", "/v1/scenes/office/objects/" + name)
        if code == 429:
            time.sleep(1.0)
            code, answer = door.ask("DELETE", "/v1/scenes/office/objects/" + name)
        if code != 200:
            return [f"{name} cannot be taken out: {answer}"]
    return [] if code == 200 and "office" in names else [f"the scene is {described}"]


def calm(process, before):
    """Waits until the files and threads of a program are those of before. Returns the excess."""
    deadline = time.monotonic() + LONGEST_S
    while time.monotonic() < deadline:
        _, threads, files = process.state()
        if threads <= before[1] and files <= before[2]:
            return []
        time.sleep(0.2)
    return [f"{process.name} has {threads} threads and {files} open files, and had "
            f"{before[1]} and {before[2]}"]


def attack(door, processes, options):
    """Runs all batches. Returns what was counted, what was wrong, and the states in between: at
    least one."""
    requests = hostile_requests.sample_requests(ROOT / "scenes/requests")
    total = collections.Counter()
    faults = []
    states = []
    sent, longest_s, number = 0, 0.0, options.first
    shares = iter(range(1, 11))
    share = next(shares)
    with concurrent.futures.ProcessPoolExecutor(options.workers) as pool:
        running = set()
        while running or sent < options.count:
            while sent + BATCH * len(running) < options.count and len(running) < options.workers:
                running.add(pool.submit(run_batch, door, requests, options.seed, number))
                number += 1
            done, running = concurrent.futures.wait(
                running, return_when=concurrent.futures.FIRST_COMPLETED)
            for batch in (each.result() for each in done):
                sent += batch.sent
                total += batch.counts
                faults += batch.faults
                longest_s = max(longest_s, batch.longest_s)
            if share and sent >= options.count * share / 10:
                states.append([process.state() for process in processes])
                print(f"{sent:8} sent, {states[-1]} MB, threads, files", flush=True)
                share = next(shares, None)
            if len(faults) > MOST_FAULTS:
                break
    states = states or [[process.state() for process in processes]]
    print(f"sent {sent} requests and frames in {number - options.first} batches; longest connection {longest_s:.2f} s")
    return total, faults, states


def judge(door, processes, options):
    request = hostile_requests.sample_requests(ROOT / "scenes/requests")[0]
    right = first_plan(door, request)
    begin = [process.state() for process in processes]
    total, faults, states = attack(door, processes, options)
    if right[0] != 200:
        faults.append(f"the first plan was answered with {right}")
    for name, count in sorted(total.items()):
        print(f"  {count:8} {name}")
    faults += tidy(door)
    if plan_of(door, request) != right:
        faults.append("the answer is not that of the beginning")
    for i, process in enumerate(processes):
        faults += calm(process, states[0][i] if process.name == "camwayd" else begin[i])
        end = process.state()
        print(f"{process.name}: MB, threads, files at first {begin[i]}, after the first tenth "
              f"{states[0][i]}, at the end {end}")
        if end[0] > states[0][i][0] + options.growth_mb:
            faults.append(f"{process.name} grew from {states[0][i][0]:.0f} to {end[0]:.0f} MB")
    return faults


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=Path, required=True, help="folder with camway")
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first batch, to see one again")
    parser.add_argument("--workers", type=int, default=4)
    parser.add_argument("--daemon", action="store_true", help="ask a camwayd")
    parser.add_argument("--growth-mb", type=float, default=128.0)
    return parser.parse_args()


def main():
    options = parse_options()
    if "CAMWAY_NETNS" not in os.environ:
        netns = str(ROOT / "tools/scripts/netns.sh")
        os.execv(netns, [netns, sys.executable, "-B", *sys.argv])
    os.environ["CAMWAY_CACHE_DIR"] = ""
    scene = str(ROOT / "scenes/office.obj")
    others = []
    command = [str(options.programs / "camway"), "view", "--scene", scene]
    if options.daemon:
        others = [Process([str(options.programs / "camwayd"), "--scene", "office=" + scene,
                           "--log-level", "error"])]
        command = [str(options.programs / "camway"), "view", "office"]
    view = Process(command, stdout=subprocess.PIPE)
    faults = []
    try:
        url = urllib.parse.urlsplit(view.running.stdout.readline().strip())
        token = urllib.parse.parse_qs(url.query)["token"][0]
        print(f"seed {options.seed}, {options.count} requests and frames, {options.workers} at a time")
        faults += judge(Door(url.port, token), [view, *others], options)
    finally:
        for process in (view, *others):
            faults += process.end()
        for fault in faults:
            print(fault, file=sys.stderr)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
