# SPDX-License-Identifier: MIT
"""Requests over HTTP for the door of `camway view`, right ones and wrong ones. They depend
on the dice and the address alone."""

import json
from dataclasses import dataclass, field

import hostile_json

LONGEST_PIPELINE = 8


@dataclass
class Request:
    """A request whose parts can be damaged one by one."""

    method: str
    target: str
    headers: list
    body: bytes = b""
    version: str = "HTTP/1.1"
    line_end: bytes = b"\r\n"
    chunks: list = field(default_factory=list)

    def bytes(self):
        lines = [f"{self.method} {self.target} {self.version}".rstrip()]
        lines += [f"{name}: {value}" for name, value in self.headers]
        head = self.line_end.join(line.encode("latin-1", "replace") for line in lines)
        return head + 2 * self.line_end + (b"".join(self.chunks) if self.chunks else self.body)

    def set(self, name, value):
        self.headers = [each for each in self.headers if each[0].lower() != name.lower()]
        if value is not None:
            self.headers.append((name, value))


def places(requests, dice):
    """Returns a place and a body for it."""
    request = dice.choice(requests)
    own = dice.choice(hostile_json.OWN_OBJECTS)
    placed = {"position": [40 + 10 * dice.random(), 1, 1]}
    return dice.choice((
        ("GET", "/v1/version", None), ("GET", "/v1/status", None), ("GET", "/v1/scenes", None),
        ("GET", "/v1/scenes/office", None), ("GET", "/v1/last", None), ("GET", "/v1/fields", None),
        ("GET", "/plan.svg", None), ("GET", "/", None), ("GET", "/v1/socket", None),
        ("HEAD", "/v1/scenes", None), ("OPTIONS", "/v1/plan", None), ("GET", "/nowhere", None),
        ("GET", "/v1/scenes/office/meshes/0123456789abcdef0123456789abcdef", None),
        ("POST", "/v1/plan", request), ("POST", "/v1/interpolate", request),
        ("POST", "/v1/check", {"request": request, "path": {"segments": []}}),
        ("POST", "/v1/review", {"request": request, "answer": {"status": "ok"}}),
        ("POST", "/v1/export?format=csv", {"request": request, "answer": {"status": "ok"}}),
        ("POST", "/v1/scenes/office/triangles", {"indices": [0, 5, -1]}),
        ("POST", "/v1/scenes/office/objects",
         {"name": own, "form": hostile_json.form(dice), **placed}),
        ("PATCH", f"/v1/scenes/office/objects/{own}", placed),
        ("DELETE", f"/v1/scenes/office/objects/{own}", None)))


def right_request(door, requests, dice):
    method, target, document = places(requests, dice)
    body = b""
    if document is not None:
        if dice.random() < 0.7:
            document = hostile_json.bent(document, dice)
        body = hostile_json.written(document).encode("utf-8", "surrogatepass")
        if dice.random() < 0.3:
            body = hostile_json.damaged(body, dice)
    made = Request(method, target, [("Host", f"127.0.0.1:{door.port}"),
                                    ("Authorization", f"Bearer {door.token}")], body)
    if body or method in ("POST", "PATCH"):
        made.set("Content-Length", str(len(body)))
    return made


def wrong_length(made, dice):
    length = len(made.body)
    made.set("Content-Length", str(dice.choice(
        (length + 1, length + 1000, max(length - 3, 0), -1, 1 << 24, (1 << 24) + 1, 1 << 63, 1 << 64,
         "x", "1, 2", "+5", "0x10", "", " "))))
    if dice.random() < 0.2:
        made.headers.append(("Content-Length", str(length)))


def chunked(made, dice):
    made.set("Content-Length", None if dice.random() < 0.8 else str(len(made.body)))
    made.headers.append(("Transfer-Encoding", dice.choice(
        ("chunked", "chunked", "chunked", "gzip, chunked", "identity", "chunked, chunked", "x"))))
    size = b"%x" % len(made.body)
    made.chunks = [dice.choice((size, size, b"ffffffffffffffffff", b"-1", b"zz", b"", b"0",
                                size + b";a=" + b"b" * dice.choice((1, 20_000)))), b"\r\n",
                   made.body, dice.choice((b"\r\n", b"\r\n", b"\n", b"")),
                   dice.choice((b"0\r\n\r\n", b"0\r\n\r\n", b"0\r\nTrailer: x\r\n\r\n", b"0", b""))]


def wrong_right(made, dice):
    """Makes the request one of somebody who may not ask."""
    dice.choice((
        lambda: made.set("Authorization", None),
        lambda: made.set("Authorization", "Bearer 00000000000000000000000000000000"),
        lambda: made.set("Authorization", "Basic " + "A" * dice.choice((1, 5000))),
        lambda: made.set("Host", dice.choice(("evil.example", "127.0.0.1", "localhost:1", "", "[::1]"))),
        lambda: made.set("Host", None),
        lambda: made.set("Origin", dice.choice(("http://evil.example", "null", "", "http://localhost"))),
        lambda: made.headers.append(("Host", "127.0.0.1:1")),
    ))()


def strange_head(made, dice):
    dice.choice((
        lambda: setattr(made, "method", dice.choice(("", "get", "CONNECT", "TRACE", "X" * 5000, "P\x00"))),
        lambda: setattr(made, "target", dice.choice(
            ("", "*", "//", "/..", "/%00", "/v1/scenes/%2e%2e/", "/?" + "a=b&" * 3000, "/" * 9000,
             "/v1/scenes//objects/", "/v1/scenes/" + "a" * 500, "http://127.0.0.1/", "/\xff"))),
        lambda: setattr(made, "version", dice.choice(
            ("", "HTTP/1.0", "HTTP/0.9", "HTTP/2.0", "HTTP/9.9", "HTTP/1.1 x", "FTP/1.1"))),
        lambda: setattr(made, "line_end", b"\n"),
        lambda: made.headers.append(("X-" + "a" * dice.choice((10, 20_000)), "b")),
        lambda: made.headers.append(("X", "b" * dice.choice((10, 20_000, 200_000)))),
        lambda: made.headers.extend([("X", "b")] * dice.choice((100, 3000))),
        lambda: made.headers.append(("Na me", "v")),
        lambda: made.headers.append(("X", "a\r\n folded")),
        lambda: made.headers.append(("X\x00", "\x01\x02")),
        lambda: made.headers.append(("Expect", "100-continue")),
        lambda: made.headers.extend([("Upgrade", "websocket"), ("Connection", "Upgrade")]),
        lambda: made.headers.extend([("Upgrade", "h2c"), ("Connection", "Upgrade, HTTP2-Settings")]),
        lambda: made.headers.append(("Accept-Encoding", "gzip;q=" + "9" * 100)),
        lambda: made.headers.append(("Connection", "close")),
    ))()


def broken_upgrade(door, dice):
    made = Request("GET", f"/v1/socket?token={door.token}", [
        ("Host", f"127.0.0.1:{door.port}"), ("Upgrade", "websocket"), ("Connection", "Upgrade"),
        ("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="), ("Sec-WebSocket-Version", "13")])
    name, values = dice.choice((
        ("Sec-WebSocket-Key", (None, "", "x", "A" * 3000)),
        ("Sec-WebSocket-Version", (None, "12", "0", "99999999999", "x")),
        ("Sec-WebSocket-Extensions", ("permessage-deflate; server_max_window_bits=99", "x" * 900)),
        ("Sec-WebSocket-Protocol", ("a, b", ",,,,")),
        ("Upgrade", ("websockets", "")), ("Connection", ("close", "")),
        ("Origin", ("http://evil.example",)), ("Host", ("evil.example", None))))
    made.set(name, dice.choice(values))
    return made


def hostile_request(door, requests, dice):
    """Returns a name, the bytes of what is sent over one connection, and how many requests they
    are."""
    made = right_request(door, requests, dice)
    kind = dice.choice(("body", "body", "length", "chunks", "rights", "rights", "head", "head",
                        "upgrade", "pipeline", "bytes", "cut", "noise"))
    if kind == "length":
        wrong_length(made, dice)
    elif kind == "chunks":
        chunked(made, dice)
    elif kind == "rights":
        wrong_right(made, dice)
    elif kind == "head":
        strange_head(made, dice)
    elif kind == "upgrade":
        made = broken_upgrade(door, dice)
    data = made.bytes()
    count = 1
    if kind == "pipeline":
        count = dice.randrange(2, LONGEST_PIPELINE + 1)
        data = b"".join(right_request(door, requests, dice).bytes() for _ in range(count))
    elif kind == "bytes":
        data = hostile_json.damaged(data, dice)
    elif kind == "cut":
        data = data[:dice.randrange(1, len(data))]
    elif kind == "noise":
        data = bytes(dice.randrange(256) for _ in range(dice.randrange(1, 200)))
    return kind, data, count


def sample_requests(folder):
    """Returns requests that are right, of scenes/requests."""
    return [json.loads((folder / f"{name}.json").read_text())
            for name in ("office-graze-door", "office-free-straight")
            if (folder / f"{name}.json").exists()]
