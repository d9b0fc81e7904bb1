# SPDX-License-Identifier: MIT
"""Frames of WebSocket, right ones and such as break the protocol. They depend on the dice
alone."""

import struct

import hostile_json

TEXT, BINARY, CLOSE, PING, PONG, CONTINUED = 1, 2, 8, 9, 10, 0
MASK = b"\x12\x34\x56\x78"
NOT_UTF8 = (b"\xff", b"\xc0\x80", b"\xed\xa0\x80", b"\xf8\x88\x80\x80\x80", b"abc\xe2\x82",
            b"\xf4\x90\x80\x80")
CLOSE_CODES = (0, 1, 999, 1000, 1001, 1004, 1005, 1006, 1015, 1016, 2999, 3000, 4999, 5000, 65535)


def masked(data, mask):
    if not data:
        return data
    key = int.from_bytes((mask * (len(data) // 4 + 1))[:len(data)], "little")
    return (int.from_bytes(data, "little") ^ key).to_bytes(len(data), "little")


def frame(op, data, *, is_last=True, reserved=0, is_masked=True, form=None, said=None):
    """Returns a frame. `form` is the number of bits of its length, `said` a length that is not its
    own."""
    length = len(data) if said is None else said
    if form is None:
        form = 7 if length < 126 else 16 if length < 1 << 16 else 64
    head = bytes([(0x80 if is_last else 0) | reserved << 4 | op])
    mark = 0x80 if is_masked else 0
    if form == 7:
        head += bytes([mark | min(length, 125)])
    elif form == 16:
        head += bytes([mark | 126]) + struct.pack(">H", length & 0xFFFF)
    else:
        head += bytes([mark | 127]) + struct.pack(">Q", length & (1 << 64) - 1)
    return head + (MASK + masked(data, MASK) if is_masked else data)


def fragmented(data, dice):
    """Returns a text in several frames, with a control frame between some of them, and their
    number."""
    cuts = sorted(dice.randrange(len(data) + 1) for _ in range(dice.choice((1, 2, 5))))
    ends = [0, *cuts, len(data)]
    frames = []
    for i, (begin, end) in enumerate(zip(ends, ends[1:])):
        frames.append(frame(CONTINUED if i else TEXT, data[begin:end],
                            is_last=end == len(data) and i == len(ends) - 2))
        if dice.random() < 0.3 and i < len(ends) - 2:
            frames.append(frame(PING, b"between"))
    return frames


def harmless(ident, requests, dice):
    """Returns frames of one message that keep the protocol, and whose content is hostile."""
    kind = dice.random()
    if kind < 0.05:
        return [frame(dice.choice((PING, PONG)), bytes(dice.randrange(126)))]
    text = hostile_json.hostile_text(ident, requests, dice)
    try:
        text.decode()
    except UnicodeDecodeError:
        text = text.decode(errors="replace").encode()
    if kind < 0.2:
        return fragmented(text, dice)
    return [frame(TEXT, text)]


def breaking(dice):
    """Returns a name and a frame that ends the connection of its sender."""
    some = bytes(dice.randrange(256) for _ in range(dice.randrange(1, 60)))
    kinds = {
        "reserved opcode": lambda: frame(dice.choice((3, 4, 5, 6, 7, 11, 12, 13, 14, 15)), some),
        "deflate bit": lambda: frame(TEXT, some, reserved=4),
        "reserved bits": lambda: frame(TEXT, b"{}", reserved=dice.choice((1, 2, 3, 7))),
        "unmasked": lambda: frame(TEXT, b"{}", is_masked=False),
        "binary": lambda: frame(BINARY, some),
        "not UTF-8": lambda: frame(TEXT, dice.choice(NOT_UTF8)),
        "not UTF-8 in parts": lambda: frame(TEXT, b"\xe2", is_last=False) + frame(CONTINUED, b"("),
        "continuation of nothing": lambda: frame(CONTINUED, some),
        "text within a text": lambda: frame(TEXT, b"{", is_last=False) + frame(TEXT, b"}"),
        "long control": lambda: frame(dice.choice((CLOSE, PING, PONG)), bytes(200)),
        "fragmented control": lambda: frame(dice.choice((CLOSE, PING, PONG)), b"a", is_last=False),
        "huge": lambda: frame(TEXT, some, form=64, said=dice.choice(
            (1 << 23, 1 << 31, 1 << 32, (1 << 63) - 1, 1 << 63, (1 << 64) - 1))),
        "length in too many bytes": lambda: frame(TEXT, b"{}", form=dice.choice((16, 64))),
        "close code": lambda: frame(CLOSE, struct.pack(">H", dice.choice(CLOSE_CODES)) +
                                    dice.choice((b"", b"bye", b"\xff\xff", bytes(123)))),
        "close of one byte": lambda: frame(CLOSE, b"\x03"),
        "close": lambda: frame(CLOSE, b""),
        "HTTP": lambda: b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
    }
    name = dice.choice(sorted(kinds))
    return name, kinds[name]()


def unfinished(dice):
    """Returns a frame that lacks its end."""
    whole = frame(TEXT, b'{"id": 1, "do": "version"}')
    return dice.choice((whole[:dice.randrange(1, len(whole))],
                        frame(TEXT, b"{", is_last=False),
                        frame(TEXT, b"abc", form=16, said=60_000)))
