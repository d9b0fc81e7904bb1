# SPDX-License-Identifier: MIT
"""Messages for the door of `camway view` that are nearly right: members of wrong types, without
end, too many, too deep, and texts that are no JSON. They depend on the dice alone."""

import json

# Objects that hostile clients may change; objects from before keep their names and places.
OWN_OBJECTS = ("x", "y", "z")
LARGEST_MADE = 300_000  # bytes of a message that is large on purpose

VALUES = ("null", "true", "false", "0", "-1", "1", "1e308", "-1e308", "1e999", "1e-320", "NaN",
          "-Infinity", "9007199254740993", "18446744073709551616", "0.1.2", "01", '""', '"x"',
          '"\\u0000"', '"\\ud800"', '"../../etc/passwd"', '"nan"', "[]", "{}", "[[]]", "[1,2,3]",
          "[1,2]", "[null,null,null]", '{"type":"box"}')
WORDS = ("plan", "check", "cancel", "interpolate", "triangles", "watch", "unwatch", "status",
         "version", "fields", "last", "scene.list", "scene.describe", "scene.add", "scene.move",
         "scene.remove", "", "PLAN", "scene.", "\x00")


class Raw:
    """A piece of text that stands in a message as it is."""

    def __init__(self, text):
        self.text = text


def written(value):
    """Returns `value` as JSON, pieces of raw text included."""
    if isinstance(value, Raw):
        return value.text
    if isinstance(value, dict):
        return "{" + ",".join(json.dumps(k) + ":" + written(v) for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ",".join(map(written, value)) + "]"
    return json.dumps(value)


def deep(dice):
    depth = dice.choice((10, 100, 1000, 20_000))
    begin, end = dice.choice((("[", "]"), ('{"a":', "}"), ('[{"a":', "}]"), ("[", "")))
    return Raw(begin * depth + "1" + end * depth)


def large(dice):
    size = dice.choice((1000, 30_000, LARGEST_MADE))
    return Raw(dice.choice(('"' + "a" * size + '"', "[" + "0," * (size // 2) + "0]",
                            "9" * size, "[" + '"",' * (size // 3) + "{}]")))


def odd_value(dice):
    kind = dice.random()
    if kind < 0.02:
        return deep(dice)
    if kind < 0.03:
        return large(dice)
    return Raw(dice.choice(VALUES))


def places_in(value, found=None):
    """Lists the containers and keys of all members."""
    found = [] if found is None else found
    keys = value.keys() if isinstance(value, dict) else range(len(value))
    for key in keys:
        found.append((value, key))
        if isinstance(value[key], (dict, list)):
            places_in(value[key], found)
    return found


def bent(message, dice):
    """Returns a copy of a message in which some members are wrong, missing or unknown."""
    message = json.loads(json.dumps(message))
    for _ in range(dice.choice((1, 1, 1, 2, 4))):
        places = places_in(message)
        if not places:
            return message
        holder, key = dice.choice(places)
        what = dice.random()
        if what < 0.6:
            holder[key] = odd_value(dice)
            break  # raw text has no members
        if what < 0.75:
            del holder[key]
        elif isinstance(holder, dict):
            holder["unknown" if what < 0.9 else key + " "] = holder[key]
        elif len(holder) < 100:
            holder.extend(holder * dice.choice((1, 3)))
    return message


def damaged(data, dice):
    """Returns bytes with some of them changed, removed, repeated or cut off."""
    data = bytearray(data)
    for _ in range(dice.choice((1, 1, 2, 6))):
        if not data:
            break
        at = dice.randrange(len(data))
        what = dice.randrange(5)
        if what == 0:
            data[at] = dice.randrange(256)
        elif what == 1:
            del data[at:at + dice.randrange(1, 20)]
        elif what == 2:
            data[at:at] = data[at:at + dice.randrange(1, 40)]
        elif what == 3:
            data[at:at] = dice.choice(b"{}[]\",:0-9e\\").to_bytes(1, "little")
        else:
            del data[at:]
    return bytes(data)


def form(dice):
    return dice.choice((
        {"type": "box", "size": [1, 1, 1]},
        {"type": "sphere", "radius_m": 0.3},
        {"type": "sphere", "radius_m": 1e3, "chord_error_m": 1e-9},
        {"type": "cylinder", "radius_m": 0.3, "height_m": 1e300},
        {"type": "mesh", "format": "obj", "text": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
        {"type": "mesh", "format": "stl", "base64": "c29saWQKZW5kc29saWQK"},
        {"type": "mesh", "file": "/etc/passwd"}))


def message(ident, requests, dice):
    """Returns a message of the socket that may be right."""
    word = dice.choices(WORDS, (3, 2, 3, 3, 3, 2, 3, 3, 3, 1, 1, 3, 3, 2, 3, 3, 1, 1, 1, 1))[0]
    made = {"id": ident, "do": word}
    if word in ("plan", "interpolate", "check") or (word == "watch" and dice.random() < 0.3):
        made["request"] = dice.choice(requests)
    if word == "check":
        made["path"] = {"segments": []}
    if word == "plan":
        made |= dice.choice(({}, {"progress": True}, {"drag": "a"}, {"drag": "b", "finish": True}))
    if word == "triangles":
        made["indices"] = [0, 1, -3, 1 << 40]
    if word.startswith("scene.") and dice.random() < 0.3:
        made["scene"] = dice.choice(("office", "attic", "../office.obj"))
    if word in ("scene.add", "scene.move", "scene.remove"):
        made["object"] = dice.choice(OWN_OBJECTS)
    if word == "scene.add":
        made["form"] = form(dice)
    if word in ("scene.add", "scene.move"):
        made["position"] = [40 + 10 * dice.random(), 1, 1]
    return made


def hostile_text(ident, requests, dice):
    """Returns the text of a message, in most cases a wrong one."""
    made = message(ident, requests, dice)
    kind = dice.random()
    if kind < 0.1:
        return written(made).encode("utf-8", "surrogatepass")
    text = written(bent(made, dice)).encode("utf-8", "surrogatepass")
    return damaged(text, dice) if kind > 0.6 else text
