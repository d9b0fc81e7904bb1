#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes a scene of arrays in a running daemon, changes it, plans in it and asks for its occupancy."""
import numpy as np

import camway


def main() -> None:
    floor_m = np.array([[0, 0, 0], [9, 0, 0], [9, 0, 9], [0, 0, 9]], float)
    with camway.Client() as client:
        client.load_scene("hall", camway.SceneMesh.from_arrays(floor_m, np.array([[0, 1, 2], [0, 2, 3]])),
                          occupancy_resolution_m=0.1)
        client.put_object("hall", "crate", camway.SceneBox((1.0, 1.0, 1.0)), camway.Pose((4.5, 0.5, 4.5)))
        for each in client.describe_scene("hall").objects:
            print(f"{each.name}: {each.kind}, {each.num_triangles} triangles")

        request = camway.Request(
            "hall", body=camway.Body.sphere(0.3), clearance_m=0.05,
            keyframes=[camway.Keyframe(position_m=(1.0, 0.8, 4.5)), camway.Keyframe(position_m=(8.0, 0.8, 4.5))])
        answer = client.plan(request)
        print(answer.message)

        points_m = np.array([[4.5, 0.5, 4.95], [4.5, 2.0, 4.5]])
        print("occupied:", client.occupancy("hall", points_m=points_m).points_occupied)

        client.move_object("hall", "crate", camway.Pose((4.5, 0.5, 7.0)))
        print(client.plan(request).message)
        for change in client.scene_history("hall"):
            print(f"revision {change.revision}: {change.operation} {change.object}".rstrip())
        client.unload_scene("hall")


if __name__ == "__main__":
    main()
