// SPDX-License-Identifier: MIT
//
// Evaluation of a path: docs/answers.md, "The path". Positions are cubic Bezier curves, orientations degree-6 Bezier
// curves of four-vectors that are divided by their length. Derivatives are those of the curves, not differences.

import type { Segment } from '../contract/answer.js';
import type { Quat, Vec3 } from '../contract/request.js';
import type { Pose } from './actions.js';

/** Position with its derivatives, and orientation with its angular velocity in the world. */
export interface Motion extends Pose {
  velocity_m_per_s: Vec3;
  acceleration_m_per_s2: Vec3;
  /** In the frame of the camera: positive about +x looks up. */
  turnRate_rad_per_s: Vec3;
}

export function beginOf(path: readonly Segment[]): number {
  return path[0]?.t0 ?? 0;
}

export function endOf(path: readonly Segment[]): number {
  return path[path.length - 1]?.t1 ?? 0;
}

export function durationOf(path: readonly Segment[]): number {
  return endOf(path) - beginOf(path);
}

/** `time_s`, moved into the path. A time that is no number is the begin. */
export function clampToPath(path: readonly Segment[], time_s: number): number {
  return Math.min(Math.max(time_s, beginOf(path)), endOf(path)) || beginOf(path);
}

/** Index of the segment at a time: the first that ends at it or later. -1 if the path is empty. */
export function segmentAt(path: readonly Segment[], time_s: number): number {
  let low = 0;
  let high = path.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((path[middle] as Segment).t1 < time_s) low = middle + 1;
    else high = middle;
  }
  return high;
}

/** The point at `u` of the Bezier curve of any degree and dimension, by de Casteljau. */
export function bezierAt(points: readonly (readonly number[])[], u: number): number[] {
  let row = points.map((point) => [...point]);
  while (row.length > 1) {
    const next: number[][] = [];
    for (let i = 0; i + 1 < row.length; ++i) {
      const a = row[i] as number[];
      const b = row[i + 1] as number[];
      next.push(a.map((x, k) => x + ((b[k] as number) - x) * u));
    }
    row = next;
  }
  return row[0] ?? [];
}

/** Control points of the derivative by `u`: a curve of one degree less. */
export function bezierDerivative(points: readonly (readonly number[])[]): number[][] {
  const degree = points.length - 1;
  const result: number[][] = [];
  for (let i = 0; i < degree; ++i) {
    const a = points[i] as readonly number[];
    const b = points[i + 1] as readonly number[];
    result.push(a.map((x, k) => degree * ((b[k] as number) - x)));
  }
  return result;
}

/** The pose at a time; before the begin and after the end, that of the ends. Undefined if the path is empty. */
export function poseAt(path: readonly Segment[], time_s: number): Pose | undefined {
  const segment = path[segmentAt(path, time_s)];
  if (!segment) return undefined;
  const u = parameterAt(segment, time_s);
  const orientation = bezierAt(segment.orientation, u);
  return { position: bezierAt(segment.position, u) as Vec3, orientation: normalized(orientation) as Quat };
}

/** Pose and derivatives at a time, as `poseAt`. At a joint they are those of the segment before it. */
export function motionAt(path: readonly Segment[], time_s: number): Motion | undefined {
  const segment = path[segmentAt(path, time_s)];
  return segment && motionIn(segment, parameterAt(segment, time_s));
}

/** Pose and derivatives in a segment at `u` from 0 to 1. */
export function motionIn(segment: Segment, u: number): Motion {
  const duration_s = segment.t1 - segment.t0;
  const first = bezierDerivative(segment.position);
  const second = bezierDerivative(first);
  const image = bezierAt(segment.orientation, u);
  const imageRate = bezierAt(bezierDerivative(segment.orientation), u);
  return {
    position: bezierAt(segment.position, u) as Vec3,
    velocity_m_per_s: scaled(bezierAt(first, u), 1 / duration_s) as Vec3,
    acceleration_m_per_s2: scaled(bezierAt(second, u), 1 / (duration_s * duration_s)) as Vec3,
    orientation: normalized(image) as Quat,
    turnRate_rad_per_s: scaled(turnOf(image as Quat, imageRate as Quat), 1 / duration_s) as Vec3,
  };
}

/** The angle in radians by which orientations differ, from 0 to pi; exact for small angles, too. */
export function angleBetween(a: Quat, b: Quat): number {
  const minus = Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]);
  const plus = Math.hypot(a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]);
  return 4 * Math.asin(Math.min(1, Math.min(minus, plus) / 2));
}

/** The vector turned by a unit quaternion: v + 2 w (q x v) + 2 q x (q x v). */
export function turned([w, x, y, z]: Quat, [a, b, c]: Vec3): Vec3 {
  const [i, j, k] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * i + y * k - z * j, b + w * j + z * i - x * k, c + w * k + x * j - y * i];
}

export function lengthOf(vector: readonly number[]): number {
  return Math.hypot(...vector);
}

/** `vector` divided by its length. The zero vector becomes the first unit vector: no turn, as a quaternion. */
export function normalized(vector: readonly number[]): number[] {
  const length = lengthOf(vector);
  return length > 0 ? scaled(vector, 1 / length) : vector.map((_, k) => (k === 0 ? 1 : 0));
}

function parameterAt(segment: Segment, time_s: number): number {
  const u = (time_s - segment.t0) / (segment.t1 - segment.t0);
  return Math.min(1, Math.max(0, u)) || 0;
}

/**
 * The angular velocity of x / |x| in its own frame: the vector part of 2 conj(x) x' / |x|². The component of x'
 * along x changes only the real part, so x need not be normalised.
 */
function turnOf(x: Quat, rate: Quat): Vec3 {
  const [w, i, j, k] = x;
  const [a, b, c, d] = rate;
  const f = 2 / (w * w + i * i + j * j + k * k);
  return [
    f * (w * b - i * a - j * d + k * c),
    f * (w * c + i * d - j * a - k * b),
    f * (w * d - i * c + j * b - k * a),
  ];
}

function scaled(vector: readonly number[], factor: number): number[] {
  return vector.map((x) => x * factor);
}
