// SPDX-License-Identifier: MIT
//
// The shift of the picture: docs/design/correction.md, "Closeness". It is the angle by which a point that lies at
// the viewing distance moves in the picture, from the pose on the path as interpolated to that on the path.

import type { Answer, Segment } from '../contract/answer.js';
import type { PlanRequest, Vec3 } from '../contract/request.js';
import type { Pose } from './actions.js';
import { angleBetween, lengthOf, poseAt } from './path.js';
import type { TimeMap } from './times.js';

export const kDegreesPerRadian = 180 / Math.PI;

/** Used where neither the request nor the answer tells: the middle of the distances that Camway derives. */
const kAssumedDistance_m = 3;

/** Range of the fit. Camway derives distances from 1 m to 10 m; a request may ask for any. */
const kLeastDistance_m = 1e-3;
const kMostDistance_m = 1e9;
const kFitSteps = 60;
const kFitSamplesASegment = 12;
const kMostFitSegments = 500;

/** Below this the largest shift says nothing about the distance: nothing was changed. */
const kLeastShift_deg = 1e-6;

export interface ShiftScale {
  viewingDistance_m: number;
  /** A turn by an angle counts as much as a move by this length times the angle. */
  turnLever_m: number;
  /** Where the distance is from: an option, the largest shift that the answer states, or a guess. */
  source: 'request' | 'answer' | 'assumed';
}

/** How far a pose differs from another one. */
interface Change {
  moved_m: number;
  turned_rad: number;
}

export function changeBetween(before: Pose, after: Pose): Change {
  const moved = after.position.map((x, k) => x - (before.position[k] as number));
  return { moved_m: lengthOf(moved), turned_rad: angleBetween(before.orientation, after.orientation) };
}

/** The shift in degrees. */
export function shiftOf(change: Change, scale: ShiftScale): number {
  const shift_rad = (change.moved_m + scale.turnLever_m * change.turned_rad) / scale.viewingDistance_m;
  return shift_rad * kDegreesPerRadian;
}

/** The scale of shifts of an answer. Without the option it is fitted to the largest shift that the answer states. */
export function shiftScale(
  request: PlanRequest | undefined,
  answer: Answer | undefined,
  before: readonly Segment[],
  times: TimeMap,
): ShiftScale {
  const radius_m = bodyRadius(request?.body);
  const scaleOf = (distance_m: number, source: ShiftScale['source']): ShiftScale => ({
    viewingDistance_m: distance_m,
    turnLever_m: radius_m ?? distance_m,
    source,
  });
  const asked = request?.options?.['viewing_distance_m'];
  if (typeof asked === 'number' && asked > 0) return scaleOf(asked, 'request');
  const largest_deg = answer?.measures?.after['largest_shift_deg'] ?? 0;
  if (!answer || before.length === 0 || !(largest_deg > kLeastShift_deg)) return scaleOf(kAssumedDistance_m, 'assumed');
  const changes = sampledChanges(answer.segments, before, times);
  const distance_m = fittedDistance(changes, largest_deg, (distance) => scaleOf(distance, 'answer'));
  return distance_m === undefined ? scaleOf(kAssumedDistance_m, 'assumed') : scaleOf(distance_m, 'answer');
}

/** The distance for which the largest shift is `largest_deg`, by bisection: shifts fall with the distance. */
function fittedDistance(changes: readonly Change[], largest_deg: number, scaleOf: (distance_m: number) => ShiftScale): number | undefined {
  const largest = (distance_m: number): number => {
    const scale = scaleOf(distance_m);
    return changes.reduce((most, change) => Math.max(most, shiftOf(change, scale)), 0);
  };
  if (largest(kLeastDistance_m) < largest_deg || largest(kMostDistance_m) > largest_deg) return undefined;
  let low = Math.log(kLeastDistance_m);
  let high = Math.log(kMostDistance_m);
  for (let step = 0; step < kFitSteps; ++step) {
    const middle = (low + high) / 2;
    if (largest(Math.exp(middle)) > largest_deg) low = middle;
    else high = middle;
  }
  return Math.exp((low + high) / 2);
}

function sampledChanges(after: readonly Segment[], before: readonly Segment[], times: TimeMap): Change[] {
  const changes: Change[] = [];
  const stride = Math.max(1, Math.ceil(after.length / kMostFitSegments));
  for (let i = 0; i < after.length; i += stride) {
    const { t0, t1 } = after[i] as Segment;
    for (let k = 0; k < kFitSamplesASegment; ++k) {
      const time_s = t0 + ((t1 - t0) * k) / kFitSamplesASegment;
      const now = poseAt(after, time_s);
      const then = poseAt(before, times.toGiven(time_s));
      if (now && then) changes.push(changeBetween(then, now));
    }
  }
  return changes;
}

/** Radius of the ball about the eye that holds the body. Undefined for cameras, and for bodies that are files. */
export function bodyRadius(body: Record<string, unknown> | undefined): number | undefined {
  if (!body) return undefined;
  const center = (body['center'] as Vec3 | undefined) ?? [0, 0, 0];
  switch (body['type']) {
    case 'sphere':
      return lengthOf(center) + Number(body['radius_m'] ?? body['radius']);
    case 'box': {
      const size = body['size'] as Vec3;
      return lengthOf(center.map((x, k) => Math.abs(x) + (size[k] as number) / 2));
    }
    case 'convex': {
      const pieces = (body['pieces'] as Vec3[][] | undefined) ?? [(body['points'] as Vec3[] | undefined) ?? []];
      return farthest(pieces.flat());
    }
    default: {
      const vertices = body['vertices'] as Vec3[] | undefined;
      return vertices && farthest(vertices);
    }
  }
}

function farthest(points: readonly Vec3[]): number {
  return points.reduce((most, point) => Math.max(most, lengthOf(point)), 0);
}
