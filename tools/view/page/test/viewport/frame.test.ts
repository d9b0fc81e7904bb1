// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Quaternion } from 'three';
import type { Quat } from '../../src/contract/request.js';
import { Frame, toQuat, toQuaternion, uprightAxis } from '../../src/viewport/frame.js';

test('a pose goes to the frame and back to a hundredth of a millimetre, far from the origin', () => {
  const frame = new Frame([500_000, -4_000_000, 300]);
  for (let i = 0; i < 100; ++i) {
    const place: [number, number, number] = [500_000 + Math.sin(i), -4_000_000 + 20 * Math.cos(i), 300 + 0.1 * i];
    const back = frame.toPose(frame.toLocal(place), new Quaternion()).position;
    back.forEach((x, k) => assert.ok(Math.abs(x - (place[k] ?? 0)) < 6e-6));
  }
});

test('quaternions keep their order', () => {
  assert.deepEqual(toQuat(toQuaternion([0.5, 0.5, -0.5, 0.5])), [0.5, 0.5, -0.5, 0.5]);
});

test('the upright axis is that of the pictures of cameras', () => {
  const withKeyframes = (orientations: Quat[], body?: Record<string, unknown>) =>
    uprightAxis({ keyframes: orientations.map((orientation) => ({ position: [0, 0, 0], orientation })), ...(body && { body }) });
  assert.equal(withKeyframes([[1, 0, 0, 0], [Math.SQRT1_2, 0, Math.SQRT1_2, 0]]), 'y');
  assert.equal(withKeyframes([[Math.SQRT1_2, Math.SQRT1_2, 0, 0]]), 'z');
  assert.equal(withKeyframes([[1, 0, 0, 0]], { type: 'camera' }), 'y');
  assert.equal(withKeyframes([[1, 0, 0, 0]], { type: 'box', size: [1, 1, 1] }), undefined);
  assert.equal(withKeyframes([]), undefined);
  assert.equal(uprightAxis(undefined), undefined);
});
