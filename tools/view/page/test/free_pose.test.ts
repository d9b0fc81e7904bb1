// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer } from '../src/contract/answer.js';
import type { PlanRequest, Quat, Vec3 } from '../src/contract/request.js';
import { acceptingKey, bodySize_m, distanceText, freePoses, offeredPose } from '../src/model/free_pose.js';
import { Random } from './random.js';

const kCamera = { fov_x_deg: 90, fov_y_deg: 90, near: 0.1 };
const kLevel: Quat = [1, 0, 0, 0];

function withFault(request: PlanRequest, keyframe: number, position: Vec3, orientation: Quat = kLevel): { request: PlanRequest; answer: Answer } {
  const faults = [{ keyframe, free_pose: { position, orientation } }];
  return { request, answer: { status: 'invalid', message: '', keyframe_faults: faults } as unknown as Answer };
}

function turnedBy(angle_deg: number): Quat {
  const half = (angle_deg * Math.PI) / 360;
  return [Math.cos(half), 0, Math.sin(half), 0];
}

test('the size of a body is the diameter of the ball about the eye', () => {
  assert.ok(Math.abs((bodySize_m({ keyframes: [], camera: kCamera }) as number) - 0.2 * Math.sqrt(3)) < 1e-12);
  assert.equal(bodySize_m({ keyframes: [], body: { type: 'sphere', radius_m: 0.25 } }), 0.5);
  assert.equal(bodySize_m({ keyframes: [], body: { type: 'mesh', file: 'a.obj' } }), undefined);
});

test('poses beyond four sizes of the body or 30 degrees are far, whatever the keyframe', () => {
  const random = new Random('far');
  for (let round = 0; round < 100; ++round) {
    const at = random.vector();
    const request: PlanRequest = { camera: kCamera, keyframes: [{ position: at, orientation: kLevel }] };
    const bound_m = 4 * (bodySize_m(request) as number);
    const [share, angle_deg] = [random.number(0, 2), random.number(0, 60)];
    const to: Vec3 = [at[0], at[1] + share * bound_m, at[2]];
    const [pose] = freePoses(withFault(request, 0, to, turnedBy(angle_deg)));
    assert.ok(pose && Math.abs(pose.moved_m - share * bound_m) < 1e-9 && Math.abs(pose.turned_deg - angle_deg) < 1e-6);
    assert.equal(pose.isFar, share > 1 || angle_deg > 30);
    assert.equal(acceptingKey(pose), pose.isFar ? 'Shift Enter' : 'Enter');
  }
});

test('a body of unknown size is taken nowhere in passing', () => {
  const request: PlanRequest = { body: { type: 'mesh', file: 'a.obj' }, keyframes: [{ position: [0, 0, 0], orientation: kLevel }] };
  assert.equal(freePoses(withFault(request, 0, [0, 1e-3, 0]))[0]?.isFar, true);
});

test('the pose of the selected keyframe is offered, or the first, with its distance', () => {
  const keyframe = (x: number): PlanRequest['keyframes'][number] => ({ position: [x, 0, 0], orientation: kLevel });
  const request: PlanRequest = { camera: kCamera, keyframes: [keyframe(0), keyframe(5)] };
  const faults = [0, 1].map((i) => ({ keyframe: i, free_pose: { position: [5 * i, 0.25, 0], orientation: i ? turnedBy(20) : kLevel } }));
  const now = { request, answer: { keyframe_faults: faults } as unknown as Answer };
  assert.equal(offeredPose({ ...now, selection: undefined })?.keyframe, 0);
  const second = offeredPose({ ...now, selection: { keyframe: 1 } });
  assert.equal(second?.keyframe, 1);
  assert.equal(second && distanceText(second), '0.250 m and 20.0° away');
  assert.equal(offeredPose({ ...now, answer: undefined, selection: { keyframe: 1 } }), undefined);
});
