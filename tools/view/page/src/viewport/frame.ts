// SPDX-License-Identifier: MIT
// Between the world, in double precision, and the frame that is drawn, whose origin is the scene's centre: 32 bits
// would not resolve a millimetre some kilometres away.

import { Quaternion, Vector3 } from 'three';
import type { Pose } from '../model/actions.js';
import type { PlanRequest, Quat, Vec3 } from '../contract/request.js';

export type UpAxis = 'y' | 'z';

export class Frame {
  constructor(readonly origin: Vec3 = [0, 0, 0]) {}

  toLocal(p: readonly number[]): Vector3 {
    return new Vector3((p[0] ?? 0) - this.origin[0], (p[1] ?? 0) - this.origin[1], (p[2] ?? 0) - this.origin[2]);
  }

  toWorld(v: Vector3): Vec3 {
    return [v.x + this.origin[0], v.y + this.origin[1], v.z + this.origin[2]];
  }

  /** A pose whose position is rounded to a hundredth of a millimetre, for files that people read. */
  toPose(position: Vector3, orientation: Quaternion): Pose {
    const round = (x: number): number => Math.round(x * 1e5) / 1e5;
    const [x, y, z] = this.toWorld(position);
    return { position: [round(x), round(y), round(z)], orientation: toQuat(orientation) };
  }
}

/** From w, x, y, z of requests to three's order. */
export function toQuaternion(q: readonly number[]): Quaternion {
  return new Quaternion(q[1] ?? 0, q[2] ?? 0, q[3] ?? 0, q[0] ?? 1).normalize();
}

export function toQuat(q: Quaternion): Quat {
  return [q.w, q.x, q.y, q.z];
}

export function upVector(up: UpAxis): Vector3 {
  return up === 'y' ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
}

/**
 * The axis that is up for most of the cameras of a request: their picture's upward direction leans to it. Undefined
 * where another body moves, whose frame may have any axis up.
 */
export function uprightAxis(request: Pick<PlanRequest, 'body' | 'keyframes'> | undefined): UpAxis | undefined {
  const isCamera = !request?.body || request.body['type'] === 'camera';
  if (!request || !isCamera || request.keyframes.length === 0) return undefined;
  let y = 0;
  let z = 0;
  for (const { orientation } of request.keyframes) {
    const up = new Vector3(0, 1, 0).applyQuaternion(toQuaternion(orientation));
    y += Math.abs(up.y);
    z += Math.abs(up.z);
  }
  return y >= z ? 'y' : 'z';
}
