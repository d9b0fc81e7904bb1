#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the figures of the design pages.

  docs/design/figures/draw.py           writes every figure beside this file
  docs/design/figures/draw.py --check   fails if a committed figure differs from what would be written
"""

import sys
from pathlib import Path

from svg import Figure

HERE = Path(__file__).resolve().parent


def pipeline():
    """One plan request on its way through the daemon."""
    figure = Figure(880, 250, "A plan request on its way through the daemon")
    stages = [
        ("request", ["checked bytes,", "decoded message"]),
        ("motion", ["keyframes become", "a C² path"]),
        ("collision", ["collision intervals;", "the rest is proved free"]),
        ("correction", ["candidates,", "each proved"]),
        ("result", ["segments as sent,", "certificate"]),
    ]
    for i, (name, lines) in enumerate(stages):
        style = "accent" if name in ("collision", "correction") else "box"
        figure.box(16 + 172 * i, 40, 140, 70, [name] + lines, style)
        if i:
            figure.arrow([(156 + 172 * (i - 1), 75), (16 + 172 * i - 2, 75)])
    figure.arrow([(602, 110), (602, 150), (430, 150), (430, 112)], "")
    figure.text(516, 145, "every candidate is proved", "small")
    figure.box(360, 182, 140, 48, ["scene snapshot", "immutable, shared"], "warm")
    figure.arrow([(400, 182), (400, 112)])
    figure.arrow([(500, 206), (640, 206), (640, 112)])
    figure.text(86, 28, "bytes from LCM", "small")
    figure.text(774, 28, "bytes to LCM", "small")
    return figure


def proof():
    """Why a stretch of the path is free: the reach, and the slab where the reach is too long."""
    figure = Figure(880, 300, "Two ways to prove that a stretch of the path is free")
    figure.text(210, 24, "The reach", "title")
    figure.curve("M 40,230 C 140,120 260,110 390,190", "path")
    figure.add('<circle cx="208" cy="150" r="62" class="ghost"/>')
    figure.add('<line x1="192" y1="124" x2="224" y2="176" class="path"/>')
    figure.arrow([(208, 150), (252, 106)], "")
    figure.text(262, 100, "reach", "small", "start")
    figure.polygon([(250, 40), (330, 36), (300, 84)], "scene")
    figure.text(208, 232, "pose m", "small")
    figure.text(210, 262, "No point of the body strays further than the reach from where it is at m.", "small")
    figure.text(210, 280, "The scene is farther away, so the whole stretch is free.", "small")
    figure.text(660, 24, "The slab", "title")
    figure.curve("M 480,210 C 590,190 710,190 850,208", "path")
    figure.add('<line x1="480" y1="166" x2="480" y2="244" class="path"/>')
    figure.add('<line x1="850" y1="166" x2="850" y2="244" class="path"/>')
    figure.polygon([(610, 70), (716, 64), (664, 112)], "scene")
    figure.polygon([(470, 122), (858, 118), (858, 150), (470, 154)], "ghost")
    figure.text(664, 141, "slab, wider than the motion departs from a straight line", "small")
    figure.text(660, 262, "A slab separates the triangle from the body at both ends of the stretch.", "small")
    figure.text(660, 280, "Every body point keeps that close to a line, so it never crosses the slab.", "small")
    return figure


def ladder():
    """The rungs of the default correction, cheapest first."""
    figure = Figure(880, 400, "The ladder of corrections")
    rungs = [
        ("move", "a short row of bumps, away from what was met"),
        ("go round, with room", "A* for the ball that holds the body, then a spline drawn towards it"),
        ("turn", "a short row of bumps, about an axis: where it costs a third of going round"),
        ("is there a way at all?", "closed surfaces and cages prove that there is none"),
        ("go round, turning", "cells, narrow passages and two trees of proved motions"),
        ("shrink", "a smaller near distance, where the request allows it"),
    ]
    for i, (name, words) in enumerate(rungs):
        y = 14 + 63 * i
        style = "warm" if name.endswith("?") else "box"
        figure.box(40, y, 470, 44, [name, words], style)
        if i + 1 < len(rungs):
            figure.arrow([(120, y + 44), (120, y + 61)])
            figure.text(128, y + 57, "nothing was proved free" if not name.endswith("?") else "no proof", "small", "start")
        figure.arrow([(510, y + 22), (618, y + 22)], "proof" if name.endswith("?") else "proved free")
    figure.box(620, 14, 220, 170, ["accepted", "relaxed: the picture shifts", "little; drawn on few knots;", "and all is proved again"], "accent")
    figure.box(620, 203, 220, 44, ["infeasible", "the answer holds the proof"], "warm")
    figure.box(620, 266, 220, 107, ["accepted", "as above"], "accent")
    return figure


def snapshots():
    """What two revisions of a scene share."""
    figure = Figure(880, 270, "A change of a scene shares all that did not change")
    for x, name in ((90, "revision 7"), (530, "revision 8")):
        figure.box(x, 20, 260, 50, [name, "list of objects, upper tree"], "accent")
    objects = [(60, "walls"), (250, "table"), (440, "crate at 4 m"), (630, "crate at 5 m")]
    for x, name in objects:
        new = name.endswith("5 m")
        figure.box(x, 150, 160, 84, [name, "triangles in the world", "tree, distance field", "mirror"], "warm" if new else "box")
    for source, targets in ((220, (0, 1, 2)), (660, (0, 1, 3))):
        for i in targets:
            x = objects[i][0] + 80 + (14 if source > 400 else -14)
            figure.arrow([(source, 70), (x, 148)])
    figure.text(710, 256, "built by the change; all else is shared", "small")
    return figure


def threads():
    """The threads of the daemon, and what stands between them."""
    figure = Figure(880, 330, "Threads and queues of the daemon")
    figure.box(30, 120, 150, 70, ["LCM thread", "checks, decodes,", "queues, publishes"], "accent")
    figure.box(290, 30, 170, 60, ["plan queue", "fair in time, bounded"])
    figure.box(290, 125, 170, 60, ["scene queue", "one strand a scene"])
    figure.box(290, 220, 170, 60, ["watch checker", "one thread"], "accent")
    figure.box(560, 30, 150, 60, ["plan workers", "a fixed number"], "accent")
    figure.box(560, 125, 150, 60, ["scene workers", "a few"], "accent")
    figure.box(760, 72, 104, 70, ["scene store", "snapshots"], "warm")
    figure.arrow([(180, 140), (230, 60), (288, 60)])
    figure.arrow([(180, 155), (288, 155)])
    figure.arrow([(460, 60), (558, 60)])
    figure.arrow([(460, 155), (558, 155)])
    figure.arrow([(758, 96), (712, 66)])
    figure.arrow([(710, 150), (758, 124)])
    figure.arrow([(812, 142), (812, 250), (462, 250)], "")
    figure.text(640, 244, "changes", "small")
    figure.arrow([(635, 30), (635, 12), (105, 12), (105, 118)], "")
    figure.text(380, 8 + 18, "answers, through a mailbox", "small")
    figure.arrow([(635, 185), (635, 204), (240, 204), (182, 176)], "")
    figure.arrow([(288, 262), (105, 262), (105, 192)], "")
    figure.text(200, 256, "reports", "small")
    figure.box(30, 285, 200, 34, ["signals, reload, metrics"])
    return figure


def rooms():
    """The rooms, each above those that it includes."""
    figure = Figure(880, 604, "The rooms, each above those that it includes")
    figure.box(230, 16, 420, 44, ["daemon/process", "command line, configuration, signals, metrics"])
    figure.box(230, 82, 262, 44, ["daemon/service", "queue, transport; plans, scenes, watches"])
    figure.box(516, 82, 134, 44, ["daemon/fleet, nats", "fronts and planners"])
    figure.arrow([(583, 60), (583, 80)])
    figure.arrow([(516, 104), (494, 104)])
    figure.box(230, 148, 420, 44, ["daemon/messages", "planning's types and the messages"])
    figure.box(230, 214, 420, 44, ["daemon/planning", "plan(snapshot, request) → result"], "accent")
    figure.box(230, 280, 270, 44, ["daemon/correction", "path, search, smoothing, infeasibility, ladder"], "accent")
    figure.box(520, 280, 130, 44, ["daemon/paper", "the paper's method"])
    figure.box(230, 346, 420, 44, ["daemon/collision", "path and scene → collision intervals, or a proof that there is none"], "accent")
    figure.box(230, 412, 190, 56, ["daemon/motion", "path, body,", "spline, timing"], "accent")
    figure.box(440, 412, 210, 56, ["daemon/scene", "mesh, voxels, index, field,", "mirror, import, snapshot"], "warm")
    figure.box(230, 490, 420, 40, ["daemon/geometry", "triangles, boxes, segments, hulls, with rounding bounds"])
    figure.box(230, 548, 420, 40, ["daemon/base", "deadlines, progress, work on all processors"])
    for top in (60, 126, 192):
        figure.arrow([(440, top), (440, top + 20)])
    for x, top, bottom in ((365, 258, 278), (585, 258, 278), (365, 324, 344), (585, 324, 344),
                           (325, 390, 410), (545, 390, 410), (325, 468, 488), (545, 468, 488), (440, 530, 546)):
        figure.arrow([(x, top), (x, bottom)])
    figure.box(16, 16, 176, 56, ["client", "camway::Client,", "types, messages, engine"])
    figure.box(16, 115, 176, 56, ["lcmtypes", "messages, channels, checks,", "signatures"], "warm")
    figure.arrow([(104, 72), (104, 113)])
    figure.arrow([(230, 104), (212, 104), (212, 132), (194, 132)])
    figure.arrow([(230, 170), (212, 170), (212, 155), (194, 155)])
    figure.box(688, 16, 176, 72, ["tools", "camway, json, drawing,", "demo, make_scenes;", "may include everything"])
    figure.box(688, 115, 176, 56, ["tests", "the same tree;", "may include everything"])
    return figure


FIGURES = {"rooms": rooms, "pipeline": pipeline, "proof": proof, "ladder": ladder, "snapshots": snapshots, "threads": threads}


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        print(__doc__, file=sys.stderr)
        return 2
    stale = []
    for name, draw in FIGURES.items():
        path, drawn = HERE / f"{name}.svg", draw().file()
        if check and (not path.exists() or path.read_text() != drawn):
            stale.append(path.name)
        if not check:
            path.write_text(drawn)
    if stale:
        print(f"draw.py: these figures are not what draw.py draws: {', '.join(stale)}", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
