#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plots a path before and after correction, and its clearance: plot.py REQUEST PICTURE, cell by cell as a notebook."""
# %% What is needed
import sys

import numpy as np

import camway

file = sys.argv[1] if len(sys.argv) > 1 else "scenes/requests/office-graze-slalom.json"
picture = sys.argv[2] if len(sys.argv) > 2 else "path.svg"

# %% The path as interpolated, and the corrected one
scene = camway.Scene.of_request(file)
request = camway.Request.load(file)
request.clearance_profile = True
answer = camway.plan(scene, request)
request.max_inserted_keyframes = 0
before = camway.plan(scene, request)
print(answer.message)

# %% Their numbers
times_s = np.linspace(answer.path.begin_s, answer.path.end_s, 400)
after_m, _ = answer.path.evaluate(times_s)
before_m, _ = before.path.evaluate(times_s)
collides = np.zeros(len(times_s), bool)
for collision in answer.collisions:
    collides |= (times_s >= collision.t_begin_s) & (times_s <= collision.t_end_s)
print(f"moved by up to {np.linalg.norm(after_m - before_m, axis=1).max():.3f} m, "
      f"in collision for {collides.mean():.0%} of the time")

# %% The picture
try:
    import matplotlib  # type: ignore[import]
except ImportError:
    print("no picture: matplotlib is missing (python3-matplotlib)")
    sys.exit(0)
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # type: ignore[import]  # noqa: E402

figure, (plan, curve) = plt.subplots(2, 1, figsize=(8, 8), height_ratios=(3, 1))
plan.plot(before_m[:, 0], before_m[:, 2], "--", color="tab:gray", label="as interpolated")
plan.plot(before_m[collides, 0], before_m[collides, 2], ".", color="tab:red", label="collides")
plan.plot(after_m[:, 0], after_m[:, 2], color="tab:blue", label="corrected")
plan.set(xlabel="x, m", ylabel="z, m", aspect="equal", title=answer.message[:80])
plan.legend()
profile = answer.clearance_profile
curve.step([each.t_begin_s for each in profile], [each.clearance_m for each in profile], where="post")
curve.set(xlabel="time, s", ylabel="clearance, m")
figure.savefig(picture)
print(f"wrote {picture}")
