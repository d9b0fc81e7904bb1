// SPDX-License-Identifier: MIT
// Free poses that answers offer for keyframes that collide, and whether one is near enough to be taken in passing.

import type { Camera, PlanRequest } from '../contract/request.js';
import type { Pose } from './actions.js';
import { withUnit } from './format.js';
import { bodyRadius, changeBetween, kDegreesPerRadian } from './shift.js';
import type { State } from './store.js';

/** A pose that is farther away than this many sizes of the body, or turned by more, is another shot. */
const kMostBodySizes = 4;
const kMostTurn_deg = 30;
/** Smaller turns come from rounding. */
const kLeastTurn_deg = 1e-3;

export interface FreePose {
  keyframe: number;
  pose: Pose;
  moved_m: number;
  turned_deg: number;
  /** Whether it is only taken by a key or a button of its own. */
  isFar: boolean;
}

/** Diameter of the ball about the eye that holds what moves. Undefined for bodies that are files. */
export function bodySize_m(request: PlanRequest): number | undefined {
  if (request.body) {
    const radius_m = bodyRadius(request.body);
    return radius_m === undefined ? undefined : 2 * radius_m;
  }
  return request.camera && 2 * cornerDistance_m(request.camera);
}

function cornerDistance_m({ fov_x_deg, fov_y_deg, near }: Camera): number {
  const half = (angle_deg: number): number => Math.tan(angle_deg / 2 / kDegreesPerRadian);
  return near * Math.hypot(1, half(fov_x_deg), half(fov_y_deg));
}

/** The free poses that the answer offers, in the order of its faults. Without a known size of the body, all are far. */
export function freePoses({ request, answer }: Pick<State, 'request' | 'answer'>): FreePose[] {
  if (!request) return [];
  const most_m = kMostBodySizes * (bodySize_m(request) ?? 0);
  return (answer?.keyframe_faults ?? []).flatMap(({ keyframe, free_pose: pose }) => {
    const old = request.keyframes[keyframe];
    if (!pose || !old) return [];
    const change = changeBetween(old, pose);
    const turned_deg = change.turned_rad * kDegreesPerRadian;
    const isNear = change.moved_m <= most_m && turned_deg <= kMostTurn_deg;
    return [{ keyframe, pose, moved_m: change.moved_m, turned_deg, isFar: !isNear }];
  });
}

/** The free pose that a key accepts: that of the selected keyframe, or the first. */
export function offeredPose(now: Pick<State, 'request' | 'answer' | 'selection'>): FreePose | undefined {
  const poses = freePoses(now);
  const selected = now.selection && 'keyframe' in now.selection ? now.selection.keyframe : undefined;
  return poses.find(({ keyframe }) => keyframe === selected) ?? poses[0];
}

/** The distance of a free pose from its keyframe, in words. */
export function distanceText({ moved_m, turned_deg }: FreePose): string {
  const turn = turned_deg > kLeastTurn_deg ? ` and ${withUnit(turned_deg, '°')}` : '';
  return `${withUnit(moved_m, 'm')}${turn} away`;
}

/** The key that accepts a free pose. */
export function acceptingKey({ isFar }: FreePose): string {
  return isFar ? 'Shift Enter' : 'Enter';
}
