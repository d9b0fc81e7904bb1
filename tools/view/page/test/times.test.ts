// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer } from '../src/contract/answer.js';
import type { PlanRequest } from '../src/contract/request.js';
import { areApart, TimeMap, timesOf, timesOnPath } from '../src/model/times.js';
import { Random } from './random.js';

const kEmpty = { status: 'ok' as const, message: '', segments: [], keyframes: [], collisions: [], remaining_collisions: [] };

test('times without given ones follow the rule of docs/requests.md', () => {
  const random = new Random('derived');
  for (let round = 0; round < 100; ++round) {
    const request = random.request(2 + random.below(6), false);
    const v = random.number(0.1, 5);
    request.options = { default_speed_m_per_s: v };
    const steps = request.keyframes.slice(1).map((b, i) => {
      const a = request.keyframes[i] as PlanRequest['keyframes'][number];
      const d = Math.sqrt(a.position.reduce((sum, x, k) => sum + (x - (b.position[k] as number)) ** 2, 0));
      const dot = Math.abs(a.orientation.reduce((sum, x, k) => sum + x * (b.orientation[k] as number), 0));
      return Math.sqrt((d / v) ** 2 + (2 * Math.acos(Math.min(1, dot))) ** 2);
    });
    const least = steps.reduce((sum, x) => sum + x, 0) / steps.length / 100;
    let time = 0;
    const expected = [0, ...steps.map((step) => (time += Math.max(step, least)))];
    timesOf(request).forEach((t, i) => assert.ok(Math.abs(t - (expected[i] as number)) < 1e-7 * (1 + t)));
  }
});

test('where nothing moves, each interval lasts a second, and a short one a hundredth of the mean', () => {
  const keyframe = { position: [1, 2, 3], orientation: [1, 0, 0, 0] };
  const still = { keyframes: [keyframe, keyframe, keyframe] } as PlanRequest;
  assert.deepEqual(timesOf(still), [0, 1, 2]);
  const far = { position: [3, 2, 3], orientation: [1, 0, 0, 0] };
  const [, second, third] = timesOf({ keyframes: [keyframe, keyframe, far] } as PlanRequest);
  assert.equal(second, 0.01);
  assert.equal(third, 2.01);
});

test('two times need the distance that docs/requests.md states', () => {
  assert.ok(areApart(0, 1e-9) && !areApart(0, 0.9e-9));
  assert.ok(areApart(1.7e9, 1.7e9 + 3e-5) && !areApart(1.7e9, 1.7e9 + 2e-5));
  assert.ok(!areApart(2, 1));
});

test('the clocks of a slowed path are inverse, ascending, and match at keyframes', () => {
  const random = new Random('slowed');
  for (let round = 0; round < 100; ++round) {
    const request = random.request(4, true);
    const times = request.keyframes.map(({ time }) => time as number);
    const [from, to] = [times[1] as number, times[3] as number];
    const factor = random.number(1.1, 4);
    const slow = (t: number): number => (t <= from ? t : from + (Math.min(t, to) - from) * factor + Math.max(0, t - to));
    const answer: Answer = {
      ...kEmpty,
      segments: random.path(1),
      keyframes: request.keyframes.map((keyframe) => ({ ...keyframe, time: slow(keyframe.time as number), origin: 'given' })),
      slowed: [{ given: [from, to], t_begin: from, t_end: slow(to) }],
    };
    const map = new TimeMap(request, answer);
    assert.equal(map.isSame, false);
    let last = -Infinity;
    for (let k = 0; k <= 60; ++k) {
      const given_s = (times[0] as number) - 1 + ((to - (times[0] as number) + 2) * k) / 60;
      const path_s = map.toPath(given_s);
      assert.ok(path_s > last);
      last = path_s;
      assert.ok(Math.abs(map.toGiven(path_s) - given_s) < 1e-9);
      assert.ok(Math.abs(path_s - slow(given_s)) < 1e-9, 'an even slowing is mapped exactly');
    }
    times.forEach((time, i) => assert.ok(Math.abs(map.toPath(time) - (timesOnPath(request, answer)[i] as number)) < 1e-12));
  }
});

test('without slowing both clocks are the same', () => {
  const map = new TimeMap(undefined, kEmpty);
  assert.ok(map.isSame);
  assert.equal(map.toGiven(1.25), 1.25);
});

test('an answer to another number of keyframes does not tell their times', () => {
  const request = new Random('older').request(3, true);
  const answer: Answer = { ...kEmpty, segments: new Random('p').path(1), keyframes: request.keyframes.slice(1) };
  assert.deepEqual(timesOnPath(request, answer), timesOf(request));
});
