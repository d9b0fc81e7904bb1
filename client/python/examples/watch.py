#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Watches a path in the scene "office" of a running daemon while a box is put into it, in coroutines."""
import asyncio

import camway


async def put_box(client: camway.Client, position_m: tuple[float, float, float]) -> None:
    # A call that waits must not stop the other coroutines.
    box = camway.SceneBox((0.4, 1.0, 0.4))
    await asyncio.to_thread(client.put_object, "office", "box", box, camway.Pose(position_m))


async def main() -> None:
    request = camway.Request(
        "office", camera=camway.Camera(1.4, 1.0, 0.15),
        keyframes=[camway.Keyframe(position_m=(12.5, 1.6, 12.8), orientation_wxyz=(0.376, 0, -0.927, 0)),
                   camway.Keyframe(position_m=(17.5, 1.6, 17.9), orientation_wxyz=(0.376, 0, -0.927, 0))])
    with camway.Client() as client:
        answers = 0
        with client.watch(request) as watch:
            async for event in watch:
                if event.kind == "answer" and event.answer is not None:
                    print(f"revision {event.scene_revision}: {event.answer.message}")
                    answers += 1
                    if answers == 1:
                        middle = event.answer.path.pose((event.answer.path.begin_s + event.answer.path.end_s) / 2)
                        await put_box(client, (middle.position_m[0], middle.position_m[1], middle.position_m[2]))
                    elif answers == 2:
                        break
                elif event.kind == "broken":
                    times = ", ".join(f"{each.t_begin_s:.2f}-{each.t_end_s:.2f} s" for each in event.broken)
                    print(f"revision {event.scene_revision}: the path collides at {times}")
                else:
                    print(event.kind, event.error)
        await asyncio.to_thread(client.remove_object, "office", "box")


if __name__ == "__main__":
    asyncio.run(main())
