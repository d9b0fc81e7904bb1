// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer } from '../src/contract/answer.js';
import { nextStop } from '../src/model/stops.js';
import { kEmptyState } from '../src/model/store.js';
import type { State } from '../src/model/store.js';
import { bandRows, bandsAt, marksOf } from '../src/timeline/bands.js';
import { layoutOf, ticksOf, timeAtX, xOf } from '../src/timeline/layout.js';
import { linesAt } from '../src/timeline/values.js';
import { Random } from './random.js';

const witness = { time: 1.5, object: 'column', triangle: 0, feature: 'inside', depth_m: 0.1, point: [0, 0, 0] as [number, number, number] };
const correction = { t_begin: 1, t_end: 2, kind: 'move' as const, moved_m: 0.1, turned_deg: 0, largest_shift_deg: 1, mean_shift_deg: 0.1 };

function answerWith(change: Partial<Answer>): Answer {
  return { status: 'ok', message: '', segments: [], keyframes: [], collisions: [], remaining_collisions: [], ...change };
}

test('places and times are inverse within the path', () => {
  const random = new Random('places');
  for (let round = 0; round < 200; ++round) {
    const t0 = random.number(-1e3, 1e3);
    const layout = layoutOf(random.number(300, 3000), t0, t0 + 10 ** random.number(-3, 4), 2, 2);
    const time_s = random.number(layout.t0, layout.t1);
    assert.ok(Math.abs(timeAtX(layout, xOf(layout, time_s)) - time_s) <= 1e-9 * (layout.t1 - layout.t0) + 1e-9);
    assert.equal(timeAtX(layout, -1e4), layout.t0);
    assert.ok(Math.abs(timeAtX(layout, 1e5) - layout.t1) < 1e-9 * Math.max(1, Math.abs(layout.t1)));
  }
});

test('ticks are round, inside the path, apart, and their labels differ', () => {
  const random = new Random('ticks');
  for (let round = 0; round < 500; ++round) {
    const from = random.number(-50, 50);
    const to = from + 10 ** random.number(-3, 5);
    const width = random.number(200, 2000);
    const { times, decimals } = ticksOf(from, to, width);
    const slack = 1e-6 * (to - from);
    assert.ok(times.every((time) => time >= from - slack && time <= to + slack));
    times.reduce((a, b) => (assert.ok(((b - a) / (to - from)) * width >= 63), b), -Infinity);
    assert.equal(new Set(times.map((time) => time.toFixed(decimals))).size, times.length);
    assert.ok(times.length <= width / 64 + 2);
  }
  assert.deepEqual(ticksOf(1, 1, 500).times, [1]);
});

test('bands tell collisions before, and what became of them', () => {
  const answer = answerWith({
    collisions: [{ t_begin: 1, t_end: 2, witness }, { t_begin: 5, t_end: 6, witness }],
    remaining_collisions: [{ t_begin: 5, t_end: 6, witness }],
    corrections: [
      { ...correction, changed: [0, 3] },
      { ...correction, kind: 'turn', changed: [0, 3] },
      { ...correction, kind: 'none', changed: [0, 0] },
    ],
  });
  const rows = bandRows(answer);
  assert.deepEqual(rows.map((row) => row.bands.map(({ kind, t_begin, t_end }) => [kind, t_begin, t_end])), [
    [['collision', 1, 2], ['collision', 5, 6]],
    [['corrected', 0, 3], ['remaining', 5, 6]],
  ]);
  assert.deepEqual(bandsAt(rows, 1.5).map(({ detail }) => detail), ['before: collides with column', 'corrected: moved, turned']);
  const slowed = bandRows(answerWith({ slowed: [{ t_begin: 1, t_end: 5, given: [1, 3] }] }));
  assert.equal(slowed[2]?.bands[0]?.detail, 'slowed: 2.00 times as long');
  assert.equal(bandRows(undefined).length, 2);
});

function stateOf(random: Random): State {
  const request = random.request(3, true);
  const inserted = { position: random.vector(), orientation: random.quaternion(), time: 4, origin: 'inserted' as const };
  request.keyframes.forEach((keyframe, i) => (keyframe.time = i * 5));
  const given = request.keyframes.map((keyframe) => ({ ...keyframe, origin: 'given' as const }));
  const answer = answerWith({ segments: random.path(3, 0), keyframes: [...given, inserted], collisions: [{ t_begin: 1, t_end: 2, witness }] });
  return { ...kEmptyState, request, answer };
}

test('marks tell given keyframes, counted from 0, from inserted ones', () => {
  const marks = marksOf(stateOf(new Random('marks')));
  assert.deepEqual(marks.map(({ index, origin, time_s }) => [index, origin, time_s]), [
    [undefined, 'inserted', 4],
    [0, 'given', 0],
    [1, 'given', 5],
    [2, 'given', 10],
  ]);
});

test('jumps go through all stops in order, and back', () => {
  const state = stateOf(new Random('jumps'));
  const walk = (cursor_s: number, direction: 'next' | 'previous'): number[] => {
    const next = nextStop({ ...state, cursor_s }, 'keyframe', direction);
    return next === undefined ? [] : [next, ...walk(next, direction)];
  };
  assert.deepEqual(walk(0, 'next'), [4, 5, 10]);
  assert.deepEqual(walk(10, 'previous'), [5, 4, 0]);
  assert.equal(nextStop(state, 'collision', 'next'), 1.5);
  assert.equal(nextStop({ ...state, cursor_s: 1.5 }, 'collision', 'next'), undefined);
});

test('the values at an instant are told with units, and what is above its limit', () => {
  const state = stateOf(new Random('values'));
  const layout = layoutOf(1000, 0, 10, 2, 1);
  const curves = [{ name: 'speed' as const, times: [0, 10], values: [1, 3], largest: 3, limit: 1.5 }];
  const readable = { layout, rows: bandRows(state.answer), marks: marksOf(state), curves };
  assert.deepEqual(linesAt(readable, 1.5), ['1.50 s', 'speed 1.30 m/s', 'before: collides with column']);
  assert.deepEqual(linesAt(readable, 5), ['5.00 s', 'keyframe 1, given', 'speed 2.00 m/s (above the limit)']);
  assert.deepEqual(linesAt(readable, 4).slice(0, 2), ['4.00 s', 'inserted keyframe']);
});
