// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer, Collision, Segment } from '../src/contract/answer.js';
import type { Compared } from '../src/contract/door.js';
import { besideOf, withOtherAnswer } from '../src/model/beside.js';
import { beginOf, endOf } from '../src/model/path.js';
import { pathOf } from '../src/model/stops.js';
import { kEmptyState } from '../src/model/store.js';
import type { State } from '../src/model/store.js';
import { Random } from './random.js';

const kRounding_s = 1e-12; // of times of some seconds, by a few operations
const kRandomRounding_s = 1e-9; // of those of random paths, whose pieces are scaled and cut

const collision = (t_begin: number, t_end: number): Collision => ({ t_begin, t_end }) as Collision;

function answerOf(segments: Segment[], members: object = {}): Answer {
  return { status: 'ok', message: '', segments, keyframes: [], collisions: [], remaining_collisions: [], ...members };
}

/** An answer whose path is `factor` times as slow as the request from `begin` to `end`. */
function slowed(random: Random, [begin, end]: [number, number], factor: number): Answer {
  const path = random.path(1, begin).map((segment) => ({ ...segment, t1: begin + factor * (end - begin) }));
  return answerOf(path, { slowed: [{ given: [begin, end], t_begin: begin, t_end: endOf(path) }] });
}

test('the path beside an answer alone is the path as interpolated, on the clock of the request', () => {
  const random = new Random('beside');
  const before = random.path(1, 2).map((segment) => ({ ...segment, t1: 5 }));
  const answer = { ...slowed(random, [2, 5], 3), collisions: [collision(5, 8)] };
  const beside = besideOf({ ...kEmptyState, answer, before });
  assert.equal(beside.path, before);
  assert.ok(Math.abs(beside.timeOf(8) - 4) < kRounding_s && Math.abs(beside.onAnswer(4) - 8) < kRounding_s);
  assert.ok(Math.abs((beside.collisions[0]?.begin ?? NaN) - 3) < kRounding_s);
});

test('two answers are on clocks of their own, which the clock of the request joins', () => {
  const random = new Random('compared');
  for (let round = 0; round < 100; ++round) {
    const span: [number, number] = [random.number(-5, 5), random.number(6, 9)];
    const [a, b] = [random.number(1, 4), random.number(1, 4)];
    const answer = slowed(random, span, a);
    const other = { ...slowed(random, span, b), remaining_collisions: [collision(-1e9, 1e9)] };
    const compared: Compared = { name: 'now', otherName: 'recorded', other };
    const now: State = { ...kEmptyState, answer, compared, before: random.path(2), cursor_s: random.number(span[0], endOf(answer.segments)) };
    const beside = besideOf(now);
    assert.equal(beside.path, other.segments);
    assert.deepEqual(beside.collisions, [{ begin: span[0], end: endOf(other.segments) }], 'nothing is beyond the ends');
    const given_s = random.number(...span);
    const on = (factor: number): number => span[0] + factor * (given_s - span[0]);
    assert.ok(Math.abs(beside.timeOf(on(a)) - on(b)) < kRandomRounding_s);
    assert.ok(Math.abs(beside.onAnswer(on(b)) - on(a)) < kRandomRounding_s);

    // The other one at the same instant of the request, and back.
    const exchanged = { ...now, ...withOtherAnswer(now) };
    assert.equal(exchanged.answer, other);
    assert.deepEqual(exchanged.compared, { name: 'recorded', otherName: 'now', other: answer });
    assert.ok(Math.abs(exchanged.cursor_s - beside.timeOf(now.cursor_s)) < kRandomRounding_s);
    const back = { ...exchanged, ...withOtherAnswer(exchanged) };
    assert.deepEqual({ ...back, cursor_s: 0 }, { ...now, cursor_s: 0 });
    assert.ok(Math.abs(back.cursor_s - now.cursor_s) < kRandomRounding_s);
  }
});

test('an answer without a path leaves the cursor on the path of the other one', () => {
  const random = new Random('no path');
  const [other, before] = [answerOf(random.path(2, 1)), random.path(3, 1)];
  const now: State = { ...kEmptyState, answer: answerOf([]), compared: { name: 'now', otherName: 'then', other }, before, cursor_s: 1.1 };
  assert.equal(pathOf(now), other.segments);
  const exchanged = { ...now, ...withOtherAnswer(now) };
  assert.equal(exchanged.cursor_s, 1.1);
  assert.deepEqual(besideOf(exchanged).collisions, []);
  assert.equal(pathOf({ ...now, compared: undefined }), before);
  assert.equal(withOtherAnswer({ ...now, compared: undefined }), undefined);
  assert.equal(beginOf(pathOf(exchanged)), 1);
});
