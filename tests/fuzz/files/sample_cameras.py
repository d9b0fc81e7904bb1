# SPDX-License-Identifier: MIT
"""Samples of camera paths of other programs, for sample_files.py."""

import json
import math

from sample_registry import lines, sample

def poses():
    for i in range(12):
        angle = 0.05 * i
        yield 0.5 * i, (i, 1.5, 0.1 * i), (0.0, math.sin(angle / 2), 0.0, math.cos(angle / 2))


@sample("cameras/shot.chan")
def chan():
    return lines((i + 1, *position, 0, 3 * i, 0, 40) for i, (_, position, _) in enumerate(poses()))


@sample("cameras/shot.csv")
def csv():
    rows = "time,x,y,z,qw,qx,qy,qz,fov_y_deg\n"
    return rows + "".join(",".join(str(x) for x in (t, *p, q[3], *q[:3], 40)) + "\n"
                          for t, p, q in poses())


@sample("cameras/shot.tum.txt")
def tum():
    return "# t x y z qx qy qz qw\n" + lines((t, *p, *q) for t, p, q in poses())


@sample("cameras/shot.kitti.txt")
def kitti():
    return lines((1, 0, 0, p[0], 0, 1, 0, p[1], 0, 0, 1, p[2]) for _, p, _ in poses())


def matrices():
    return [[[1, 0, 0, p[0]], [0, 1, 0, p[1]], [0, 0, 1, p[2]], [0, 0, 0, 1]]
            for _, p, _ in poses()]


@sample("cameras/camera_path.json")
def nerfstudio():
    path = [{"camera_to_world": [x for row in m for x in row], "fov": 40, "aspect": 1.5}
            for m in matrices()]
    return json.dumps({"camera_type": "perspective", "fps": 24, "seconds": 1, "camera_path": path},
                      indent=1)


@sample("cameras/transforms.json")
def transforms():
    frames = [{"file_path": f"{i}.png", "transform_matrix": m} for i, m in enumerate(matrices())]
    return json.dumps({"camera_angle_x": 0.7, "w": 640, "h": 480, "frames": frames}, indent=1)


@sample("cameras/images.txt")
def colmap():
    text = "# a remark\n"
    for i, (_, p, q) in enumerate(poses()):
        text += lines([(i + 1, q[3], *q[:3], *p, 1, f"{i:03}.png"), ("1.0 2.0 -1",)])
    return [text, ("cameras.txt", "1 PINHOLE 640 480 500 500 320 240\n")]
