// SPDX-License-Identifier: MIT
//
// The shift of the picture: docs/design/correction.md, "Closeness". It is the angle by which a point that lies at
// the viewing distance moves in the picture, from the pose on the path as interpolated to that on the path. For a body
// that is no camera, it is a bound of the motion of its points, divided by that distance.

import type { Answer, Segment } from '../contract/answer.js';
import type { PlanRequest, Vec3 } from '../contract/request.js';
import type { Pose } from './actions.js';
import { angleBetween, lengthOf, motionIn, poseAt, turned } from './path.js';
import type { TimeMap } from './times.js';

export const kDegreesPerRadian = 180 / Math.PI;

/** Used where neither the request nor the answer tells: the middle of the distances that Camway derives. */
const kAssumedDistance_m = 3;

/** Samples of a segment for means: even, for Simpson's rule. */
const kMeanSamples = 12;
const kMostMeanSegments = 500;

/** If moves are a smaller share of the mean shift than this, it says too little about the distance. */
const kLeastMoveShare = 0.02;

export interface ShiftScale {
  viewingDistance_m: number;
  /** A turn by an angle counts as much as a move by this length times the angle. */
  turnLever_m: number;
  /** The point whose move counts, in the camera frame: the eye of a camera, the centre of another body. */
  center: Vec3;
  /** Where the distance is from: an option, the answer or its mean shift, or a guess. */
  source: 'request' | 'answer' | 'assumed';
}

/** How far a pose differs from another one. */
interface Change {
  moved_m: number;
  turned_rad: number;
}

const kEye: Vec3 = [0, 0, 0];

/** `center`: the point that moves, in the camera frame. */
export function changeBetween(before: Pose, after: Pose, center: Vec3 = kEye): Change {
  const [from, to] = [turned(before.orientation, center), turned(after.orientation, center)];
  const moved = after.position.map((x, k) => x - (before.position[k] as number) + (to[k] as number) - (from[k] as number));
  return { moved_m: lengthOf(moved), turned_rad: angleBetween(before.orientation, after.orientation) };
}

/** The shift in degrees. */
export function shiftOf(change: Change, scale: ShiftScale): number {
  const shift_rad = (change.moved_m + scale.turnLever_m * change.turned_rad) / scale.viewingDistance_m;
  return shift_rad * kDegreesPerRadian;
}

/**
 * The scale of shifts of an answer. Without the option, the answer says the viewing distance. One of an earlier
 * version does not: the distance then follows from the mean shift, which is the mean turn plus the mean move over the
 * distance.
 */
export function shiftScale(
  request: PlanRequest | undefined,
  answer: Answer | undefined,
  before: readonly Segment[],
  times: TimeMap,
): ShiftScale {
  const ball = bodyBall(request?.body);
  const scaleOf = (distance_m: number, source: ShiftScale['source']): ShiftScale => ({
    viewingDistance_m: distance_m,
    turnLever_m: ball?.radius_m ?? distance_m,
    center: ball?.center ?? kEye,
    source,
  });
  const asked = request?.options?.['viewing_distance_m'];
  if (typeof asked === 'number' && asked > 0) return scaleOf(asked, 'request');
  if (answer?.viewing_distance_m !== undefined) return scaleOf(answer.viewing_distance_m, 'answer');
  // On a slowed path the means would be of other instants.
  if (!times.isSame) return scaleOf(kAssumedDistance_m, 'assumed');
  const shift_rad = (answer?.measures?.after['mean_shift_deg'] ?? 0) / kDegreesPerRadian;
  if (!answer || before.length === 0 || !(shift_rad > 0)) return scaleOf(kAssumedDistance_m, 'assumed');
  const mean = meanChange(answer.segments, before, times, ball?.center ?? kEye);
  if (ball) return scaleOf((mean.moved_m + ball.radius_m * mean.turned_rad) / shift_rad, 'answer');
  const byMoves_rad = shift_rad - mean.turned_rad;
  if (byMoves_rad < kLeastMoveShare * shift_rad) return scaleOf(kAssumedDistance_m, 'assumed');
  return scaleOf(mean.moved_m / byMoves_rad, 'answer');
}

/** Means over time, by Simpson's rule in each segment. */
function meanChange(after: readonly Segment[], before: readonly Segment[], times: TimeMap, center: Vec3): Change {
  const sum = { moved_m: 0, turned_rad: 0, duration_s: 0 };
  const stride = Math.max(1, Math.ceil(after.length / kMostMeanSegments));
  for (let i = 0; i < after.length; i += stride) {
    const segment = after[i] as Segment;
    const duration_s = segment.t1 - segment.t0;
    sum.duration_s += duration_s;
    for (let k = 0; k <= kMeanSamples; ++k) {
      const u = k / kMeanSamples;
      const then = poseAt(before, times.toGiven(segment.t0 + u * duration_s));
      if (!then) continue;
      const weight_s = (duration_s * (k === 0 || k === kMeanSamples ? 1 : k % 2 === 1 ? 4 : 2)) / (3 * kMeanSamples);
      const change = changeBetween(then, motionIn(segment, u), center);
      sum.moved_m += weight_s * change.moved_m;
      sum.turned_rad += weight_s * change.turned_rad;
    }
  }
  return { moved_m: sum.moved_m / sum.duration_s, turned_rad: sum.turned_rad / sum.duration_s };
}

/** A ball that holds a body, in the camera frame. */
export interface Ball {
  center: Vec3;
  radius_m: number;
}

/** The ball about the middle of the body's box. Undefined for cameras, and for bodies that are files. */
export function bodyBall(body: Record<string, unknown> | undefined): Ball | undefined {
  if (!body) return undefined;
  const center = (body['center'] as Vec3 | undefined) ?? kEye;
  if (body['type'] === 'sphere') return { center, radius_m: Number(body['radius_m'] ?? body['radius']) };
  if (body['type'] === 'box') return { center, radius_m: lengthOf(body['size'] as Vec3) / 2 };
  const points = pointsOf(body);
  if (points.length === 0) return undefined;
  const middle = kEye.map((_, k) => (extreme(points, k, Math.min) + extreme(points, k, Math.max)) / 2) as Vec3;
  return { center: middle, radius_m: farthest(points, middle) };
}

/** Radius of the ball about the eye that holds the body. Undefined for cameras, and for bodies that are files. */
export function bodyRadius(body: Record<string, unknown> | undefined): number | undefined {
  const ball = bodyBall(body);
  if (!body || !ball) return undefined;
  switch (body['type']) {
    case 'sphere':
      return lengthOf(ball.center) + ball.radius_m;
    case 'box':
      return lengthOf(ball.center.map((x, k) => Math.abs(x) + ((body['size'] as Vec3)[k] as number) / 2));
    default:
      return farthest(pointsOf(body), kEye);
  }
}

/** The points that span a convex body or a mesh; vertices that no triangle has are no part of it. */
function pointsOf(body: Record<string, unknown>): Vec3[] {
  if (body['type'] === 'convex') return ((body['pieces'] as Vec3[][] | undefined) ?? [(body['points'] as Vec3[] | undefined) ?? []]).flat();
  const vertices = (body['vertices'] as Vec3[] | undefined) ?? [];
  const used = new Set(((body['triangles'] as number[][] | undefined) ?? []).flat());
  return vertices.filter((_, i) => used.has(i));
}

function extreme(points: readonly Vec3[], axis: number, of: (a: number, b: number) => number): number {
  return points.reduce((most, point) => of(most, point[axis] as number), (points[0] as Vec3)[axis] as number);
}

function farthest(points: readonly Vec3[], from: Vec3): number {
  return points.reduce((most, point) => Math.max(most, Math.hypot(...point.map((x, k) => x - (from[k] as number)))), 0);
}
