#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plans a request file without a daemon: plan.py scenes/requests/office-graze-column.json"""
import sys

import numpy as np

import camway


def main(file: str) -> int:
    scene = camway.Scene.of_request(file)
    request = camway.Request.load(file)
    try:
        answer = camway.plan(scene, request)
    except camway.InvalidRequest as error:
        print(error)  # it names the member at fault, which is error.field
        return 2
    except KeyboardInterrupt:
        return 130
    print(f"{answer.status}: {answer.message}")
    for correction in answer.corrections:
        print(f"  {correction.t_begin_s:.2f}-{correction.t_end_s:.2f} s: {correction.method}, "
              f"moved up to {correction.moved_m:.2g} m")
    times_s = np.linspace(answer.path.begin_s, answer.path.end_s, 5)
    positions_m, orientations_wxyz = answer.path.evaluate(times_s)
    for time_s, position_m, wxyz in zip(times_s, positions_m, orientations_wxyz):
        print(f"{time_s:6.2f} s  {np.round(position_m, 3)} m  {np.round(wxyz, 3)}")
    proof = camway.check(scene, request, answer)
    print(proof.text.splitlines()[0])
    return 0 if answer.ok else 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
