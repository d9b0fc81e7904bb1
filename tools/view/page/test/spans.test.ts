// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer, Collision } from '../src/contract/answer.js';
import type { PlanRequest } from '../src/contract/request.js';
import { beginOf, endOf } from '../src/model/path.js';
import { collisionSpansBefore, indicesWithin } from '../src/model/spans.js';
import { Random } from './random.js';

const collision = (t_begin: number, t_end: number): Collision => ({ t_begin, t_end }) as Collision;

test('collisions of a slowed path are on the clock of the path before, and within it', () => {
  const random = new Random('spans');
  for (let round = 0; round < 200; ++round) {
    const before = random.path(3, random.number(-5, 5));
    const [begin, end] = [beginOf(before), endOf(before)];
    const factor = random.number(1, 4);
    const slowed = (t: number): number => begin + factor * (t - begin);
    const [from, to] = [random.number(begin, end), random.number(begin, end)].sort((a, b) => a - b) as [number, number];
    const answer = {
      segments: [],
      collisions: [collision(slowed(from), slowed(to)), collision(slowed(end), slowed(end) + 1)],
      slowed: [{ t_begin: begin, t_end: slowed(end), given: [begin, end] }],
    } as unknown as Answer;
    const spans = collisionSpansBefore({ keyframes: [] } as PlanRequest, answer, before);
    assert.ok(Math.abs((spans[0]?.begin ?? NaN) - from) < 1e-9 && Math.abs((spans[0]?.end ?? NaN) - to) < 1e-9);
    assert.ok(Math.abs((spans[1]?.begin ?? NaN) - end) < 1e-9);
    assert.ok((spans[1]?.end ?? NaN) <= end, 'nothing is beyond the end');
  }
  assert.deepEqual(collisionSpansBefore(undefined, { collisions: [collision(0, 1)] } as unknown as Answer, []), []);
});

test('a span has the samples that are within, and none if it is beside them', () => {
  const times = [0, 1, 2, 3];
  assert.deepEqual(indicesWithin(times, { begin: 1, end: 2 }), [1, 2]);
  assert.deepEqual(indicesWithin(times, { begin: -1, end: 9 }), [0, 3]);
  assert.deepEqual(indicesWithin(times, { begin: 2, end: 2 }), [2, 2]);
  for (const [begin, end] of [[4, 5], [-2, -1], [1.2, 1.8]] as const) assert.equal(indicesWithin(times, { begin, end }), undefined);
});
