// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer, Segment } from '../src/contract/answer.js';
import type { Quat, Vec3 } from '../src/contract/request.js';
import { Curves, sampledAlong, valueAt } from '../src/model/curves.js';
import type { Curve } from '../src/model/curves.js';
import { beginOf, endOf, lengthOf, motionAt, motionIn } from '../src/model/path.js';
import { bodyBall, bodyRadius } from '../src/model/shift.js';
import { Random } from './random.js';

const kEmpty = { status: 'ok' as const, message: '', keyframes: [], collisions: [], remaining_collisions: [] };
const kDense = 400;

function curveOf(curves: Curves, name: Parameters<Curves['curve']>[0]): Curve {
  const curve = curves.curve(name);
  assert.ok(curve, `no curve ${name}`);
  return curve;
}

test('curves are within two per cent of the path at every time, and ascend', () => {
  const random = new Random('dense');
  for (let round = 0; round < 40; ++round) {
    const path = random.path(1 + random.below(5));
    const curves = new Curves(path, [], undefined, undefined);
    const of = {
      speed: (t: number) => lengthOf(motionAt(path, t)?.velocity_m_per_s ?? []),
      acceleration: (t: number) => lengthOf(motionAt(path, t)?.acceleration_m_per_s2 ?? []),
      turn: (t: number) => (lengthOf(motionAt(path, t)?.turnRate_rad_per_s ?? []) * 180) / Math.PI,
    };
    for (const name of ['speed', 'acceleration', 'turn'] as const) {
      const curve = curveOf(curves, name);
      curve.times.reduce((a, b) => (assert.ok(a <= b), b));
      let most = 0;
      for (let k = 1; k < kDense; ++k) {
        const time_s = beginOf(path) + ((endOf(path) - beginOf(path)) * k) / kDense;
        const exact = of[name](time_s);
        most = Math.max(most, exact);
        const off = Math.abs((valueAt(curve, time_s) ?? NaN) - exact) / curve.largest;
        assert.ok(off <= 0.02, `${name} at ${time_s} is off by ${off}`);
      }
      assert.ok(curve.largest >= 0.98 * most);
    }
  }
});

test('a jump between segments is kept', () => {
  const path = new Random('jump').path(2);
  const [a, b] = path as [Segment, Segment];
  const sampled = sampledAlong(path, (segment) => (segment === a ? 1 : 3));
  const curve: Curve = { name: 'speed', ...sampled, largest: 3 };
  assert.equal(valueAt(curve, a.t1 - 1e-9), 1);
  assert.equal(valueAt(curve, b.t0), 3);
});

test('a path of very many segments has a bounded number of samples', () => {
  const [one] = new Random('many').path(1, 0) as [Segment];
  const path = Array.from({ length: 100_000 }, (_, i): Segment => ({ ...one, t0: i, t1: i + 1 }));
  assert.ok(sampledAlong(path, () => 1).times.length <= 20_000);
});

test('the clearance is a step for each stretch of the profile, with its limit', () => {
  const profile = [
    { t_begin: 0, t_end: 1, clearance_m: 0.3 },
    { t_begin: 1, t_end: 1.5, clearance_m: 0.01 },
    { t_begin: 1.5, t_end: 2, clearance_m: 0.2 },
  ];
  const path = new Random('profile').path(1, 0);
  const answer: Answer = { ...kEmpty, segments: path, clearance_profile: profile };
  const curve = curveOf(new Curves(path, [], { keyframes: [], options: { clearance_m: 0.005 } }, answer), 'clearance');
  for (const { t_begin, t_end, clearance_m } of profile) {
    assert.equal(valueAt(curve, (t_begin + t_end) / 2), clearance_m);
  }
  assert.equal(curve.largest, 0.3);
  assert.equal(curve.limit, 0.005);
  assert.equal(new Curves(path, [], undefined, { ...answer, clearance_profile: [] }).curve('clearance'), undefined);
});

/** Turns by matrices, so that the oracle shares nothing with the page. */
function matrixOf([w, x, y, z]: Quat): number[][] {
  const n = w * w + x * x + y * y + z * z;
  return [
    [1 - (2 * (y * y + z * z)) / n, (2 * (x * y - w * z)) / n, (2 * (x * z + w * y)) / n],
    [(2 * (x * y + w * z)) / n, 1 - (2 * (x * x + z * z)) / n, (2 * (y * z - w * x)) / n],
    [(2 * (x * z - w * y)) / n, (2 * (y * z + w * x)) / n, 1 - (2 * (x * x + y * y)) / n],
  ];
}

function shiftByMatrices(before: Segment, after: Segment, u: number, distance_m: number, lever_m: number, center: Vec3): number {
  const [a, b] = [motionIn(before, u), motionIn(after, u)];
  const [m, n] = [matrixOf(a.orientation), matrixOf(b.orientation)];
  let trace = 0;
  for (let i = 0; i < 3; ++i) for (let k = 0; k < 3; ++k) trace += ((m[k] as number[])[i] as number) * ((n[k] as number[])[i] as number);
  const turn_rad = Math.acos(Math.min(1, Math.max(-1, (trace - 1) / 2)));
  const at = (position: Vec3, turn: number[][], k: number): number =>
    (position[k] as number) + center.reduce((sum, x, i) => sum + x * ((turn[k] as number[])[i] as number), 0);
  const move_m = Math.sqrt([0, 1, 2].reduce((sum, k) => sum + (at(a.position, m, k) - at(b.position, n, k)) ** 2, 0));
  return ((turn_rad * lever_m + move_m) / distance_m) * (180 / Math.PI);
}

/** A path and the same one, changed a little. */
function changedPair(random: Random): [before: Segment[], after: Segment[]] {
  const before = random.path(1);
  const moved = (points: number[][], size: number): number[][] => points.map((point) => point.map((x) => x + random.number(-size, size)));
  const after = before.map((segment) => ({
    ...segment,
    position: moved(segment.position, 0.3) as Segment['position'],
    orientation: moved(segment.orientation, 0.05) as Segment['orientation'],
  }));
  return [before, after];
}

test('the shift is turn plus move over the viewing distance', () => {
  const random = new Random('shift');
  for (let round = 0; round < 60; ++round) {
    const [before, after] = changedPair(random);
    const distance_m = random.number(0.5, 20);
    const radius_m = random.number(0.1, 1);
    const center = random.vector(2);
    const bodies = [undefined, { type: 'sphere', radius_m }, { type: 'sphere', radius_m, center }];
    for (const body of bodies) {
      const request = { keyframes: [], options: { viewing_distance_m: distance_m }, ...(body ? { body } : {}) };
      const curves = new Curves(after, before, request, { ...kEmpty, segments: after });
      assert.equal(curves.scale.source, 'request');
      const curve = curveOf(curves, 'shift');
      curve.times.forEach((time_s, i) => {
        const [a, b] = [before[0] as Segment, after[0] as Segment];
        const expected = shiftByMatrices(a, b, (time_s - b.t0) / (b.t1 - b.t0), distance_m, body ? radius_m : distance_m, body?.center ?? [0, 0, 0]);
        assert.ok(Math.abs((curve.values[i] as number) - expected) < 1e-5 * (1 + expected), `${curve.values[i]} and ${expected}`);
      });
    }
  }
});

test('without the option, the viewing distance is the one that gives the mean shift of the answer', () => {
  const random = new Random('fit');
  for (let round = 0; round < 40; ++round) {
    const [before, after] = changedPair(random);
    const distance_m = random.number(1, 10);
    const known = new Curves(after, before, { keyframes: [], options: { viewing_distance_m: distance_m } }, { ...kEmpty, segments: after });
    const shift = curveOf(known, 'shift');
    const steps = 20_000;
    const at = (k: number): number => beginOf(after) + ((endOf(after) - beginOf(after)) * (k + 0.5)) / steps;
    const mean = Array.from({ length: steps }, (_, k) => valueAt(shift, at(k)) as number).reduce((sum, x) => sum + x, 0) / steps;
    const answer: Answer = { ...kEmpty, segments: after, measures: { before: {}, after: { mean_shift_deg: mean } } };
    const fitted = new Curves(after, before, { keyframes: [] }, answer);
    assert.equal(fitted.scale.source, 'answer');
    assert.ok(Math.abs(fitted.scale.viewingDistance_m / distance_m - 1) < 0.05, `${fitted.scale.viewingDistance_m} for ${distance_m}`);
    assert.ok(Math.abs(curveOf(fitted, 'shift').largest / shift.largest - 1) < 0.05);
  }
});

test('without the option, the viewing distance is the one that the answer says', () => {
  const [before, after] = changedPair(new Random('told'));
  const answer: Answer = { ...kEmpty, segments: after, viewing_distance_m: 2.5 };
  const { scale } = new Curves(after, before, { keyframes: [] }, answer);
  assert.deepEqual([scale.viewingDistance_m, scale.turnLever_m, scale.source], [2.5, 2.5, 'answer']);
});

test('no shift is drawn without the path before', () => {
  const [, after] = changedPair(new Random('slow'));
  assert.equal(new Curves(after, [], undefined, { ...kEmpty, segments: after }).curve('shift'), undefined);
});

/** The path of a segment after `s` -> `s + bend * s * (1 - s)`, in pieces: a slowed path has the same places at other times. */
function slowedPath(before: Segment, factor: number, bend: number, pieces: number): Segment[] {
  const given = (share: number): number => share + bend * share * (1 - share);
  const duration_s = before.t1 - before.t0;
  return Array.from({ length: pieces }, (_, i) => {
    const [u0, u1] = [given(i / pieces), given((i + 1) / pieces)];
    const [t0, t1] = [before.t0 + (factor * duration_s * i) / pieces, before.t0 + (factor * duration_s * (i + 1)) / pieces];
    return { t0, t1, position: part(before.position, u0, u1) as Segment['position'], orientation: part(before.orientation, u0, u1) as Segment['orientation'] };
  });
}

/** Control points of a Bezier curve between two parameters, by its blossom. */
function part(points: readonly (readonly number[])[], u0: number, u1: number): number[][] {
  const degree = points.length - 1;
  return points.map((_, i) => {
    let row = points.map((point) => [...point]);
    for (let level = 0; level < degree; ++level) {
      const u = level < degree - i ? u0 : u1;
      row = row.slice(1).map((next, k) => next.map((x, axis) => (1 - u) * (row[k]?.[axis] as number) + u * x));
    }
    return row[0] as number[];
  });
}

test('a path that was only slowed has no shift, and one that was moved as well has that of the move', () => {
  const random = new Random('slowed');
  for (let round = 0; round < 20; ++round) {
    const [before] = random.path(1, 0) as [Segment];
    const after = slowedPath(before, 1 + 2 * random.number(), random.number(-0.5, 0.5), 12);
    const end_s = after.at(-1)?.t1 as number;
    const slowed = [{ t_begin: 0, t_end: end_s, given: [0, before.t1] as [number, number] }];
    const request = { keyframes: [], options: { viewing_distance_m: 5 } };
    const shiftOf = (path: Segment[]): Curve => curveOf(new Curves(path, [before], request, { ...kEmpty, segments: path, slowed }), 'shift');
    const largest = shiftOf(after).largest;
    assert.ok(largest < 0.05, `${largest} degrees at places that are the same`);
    const moved_m = 30;
    const aside = after.map((segment) => ({ ...segment, position: segment.position.map(([x, y, z]) => [x, y + moved_m, z]) as Segment['position'] }));
    // The path is within 10 m of the origin, so no place of it is nearer than this.
    const least = ((moved_m - 20) / 5) * (180 / Math.PI);
    for (const value of shiftOf(aside).values) assert.ok(value >= least, `${value}`);
  }
});

test('the radius of a body is that of the ball about the eye', () => {
  assert.equal(bodyRadius(undefined), undefined);
  assert.equal(bodyRadius({ type: 'sphere', radius_m: 0.2, center: [0, 3, 4] }), 5.2);
  assert.equal(bodyRadius({ type: 'box', size: [2, 4, 4], center: [0, 0, 0] }), 3);
  assert.equal(bodyRadius({ type: 'convex', points: [[3, 4, 0], [1, 0, 0]] }), 5);
  assert.equal(bodyRadius({ type: 'mesh', vertices: [[0, 0, 2], [0, 0, 9]], triangles: [[0, 0, 0]] }), 2);
  assert.equal(bodyRadius({ type: 'mesh', file: 'a.obj' }), undefined);
});

test('the ball of a body is about the middle of its box', () => {
  assert.equal(bodyBall(undefined), undefined);
  assert.equal(bodyBall({ type: 'mesh', file: 'a.obj' }), undefined);
  assert.deepEqual(bodyBall({ type: 'sphere', radius_m: 0.2, center: [0, 3, 4] }), { center: [0, 3, 4], radius_m: 0.2 });
  assert.deepEqual(bodyBall({ type: 'box', size: [2, 4, 4], center: [0, 0, -2] }), { center: [0, 0, -2], radius_m: 3 });
  assert.deepEqual(bodyBall({ type: 'convex', pieces: [[[3, 4, 0]], [[3, 0, 0]]] }), { center: [3, 2, 0], radius_m: 2 });
  const vertices = [[0, 0, 2], [9, 9, 9], [0, 0, 4], [0, 0, 3]];
  assert.deepEqual(bodyBall({ type: 'mesh', vertices, triangles: [[0, 2, 3]] }), { center: [0, 0, 3], radius_m: 1 });
});
