// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Segment } from '../src/contract/answer.js';
import type { Quat } from '../src/contract/request.js';
import { angleBetween, beginOf, bezierAt, clampToPath, endOf, lengthOf, motionAt, motionIn, poseAt, segmentAt } from '../src/model/path.js';
import { Random } from './random.js';

const kStep = 1e-4; // of the parameter, for central differences: their error is its square times a derivative

function near(actual: readonly number[], expected: readonly number[], within: number, what: string): void {
  const off = Math.max(...actual.map((x, k) => Math.abs(x - (expected[k] as number))));
  const size = Math.max(1, ...expected.map(Math.abs));
  assert.ok(off <= within * size, `${what}: ${actual} and ${expected} differ by ${off}`);
}

function product([a, b, c, d]: Quat, [e, f, g, h]: Quat): Quat {
  return [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e];
}

test('points of Bezier curves are sums of Bernstein polynomials', () => {
  const random = new Random('bernstein');
  const choose = (n: number, k: number): number => (k === 0 ? 1 : (choose(n - 1, k - 1) * n) / k);
  for (let round = 0; round < 200; ++round) {
    const degree = 1 + random.below(8);
    const points = Array.from({ length: degree + 1 }, () => random.vector());
    const u = random.number();
    const sum = [0, 1, 2].map((k) =>
      points.reduce((total, point, i) => total + choose(degree, i) * u ** i * (1 - u) ** (degree - i) * (point[k] as number), 0),
    );
    near(bezierAt(points, u), sum, 1e-13, `degree ${degree} at ${u}`);
  }
});

test('derivatives are those of finite differences', () => {
  const random = new Random('derivatives');
  for (let round = 0; round < 300; ++round) {
    const [segment] = random.path(1) as [Segment];
    const u = random.number(0.05, 0.95);
    const h = kStep * (segment.t1 - segment.t0);
    const [a, now, b] = [motionIn(segment, u - kStep), motionIn(segment, u), motionIn(segment, u + kStep)];
    const speed = b.position.map((x, k) => (x - (a.position[k] as number)) / (2 * h));
    near(now.velocity_m_per_s, speed, 1e-6, 'velocity');
    const bend = b.velocity_m_per_s.map((x, k) => (x - (a.velocity_m_per_s[k] as number)) / (2 * h));
    near(now.acceleration_m_per_s2, bend, 1e-6, 'acceleration');
    const [w, x, y, z] = a.orientation;
    const turned = product([w, -x, -y, -z], b.orientation).slice(1).map((part) => part / h);
    near(now.turnRate_rad_per_s, turned, 1e-5, 'turn rate');
  }
});

/** The two halves of a curve, by the corners of de Casteljau's triangle. */
function halves<Point extends number[]>(points: Point[], u: number): [Point[], Point[]] {
  const left: Point[] = [];
  const right: Point[] = [];
  for (let n = 0; n < points.length; ++n) {
    left.push(bezierAt(points.slice(0, n + 1), u) as Point);
    right.push(bezierAt(points.slice(n), u) as Point);
  }
  return [left, right];
}

test('a segment that is cut in two moves as before, and has no jump at the cut', () => {
  const random = new Random('cut');
  for (let round = 0; round < 100; ++round) {
    const [whole] = random.path(1) as [Segment];
    const u = random.number(0.2, 0.8);
    const cut_s = whole.t0 + u * (whole.t1 - whole.t0);
    const [p0, p1] = halves(whole.position, u);
    const [q0, q1] = halves(whole.orientation, u);
    const parts: Segment[] = [
      { t0: whole.t0, t1: cut_s, position: p0, orientation: q0 },
      { t0: cut_s, t1: whole.t1, position: p1, orientation: q1 },
    ];
    for (let i = 0; i <= 20; ++i) {
      const time_s = whole.t0 + ((whole.t1 - whole.t0) * i) / 20;
      const [one, two] = [motionAt([whole], time_s), motionAt(parts, time_s)];
      assert.ok(one && two);
      near(two.position, one.position, 1e-12, 'position');
      near(two.orientation, one.orientation, 1e-12, 'orientation');
      near(two.acceleration_m_per_s2, one.acceleration_m_per_s2, 1e-9, 'acceleration');
      near(two.turnRate_rad_per_s, one.turnRate_rad_per_s, 1e-9, 'turn rate');
    }
    const [end, begin] = [motionIn(parts[0] as Segment, 1), motionIn(parts[1] as Segment, 0)];
    near(begin.velocity_m_per_s, end.velocity_m_per_s, 1e-9, 'velocity at the cut');
    near(begin.turnRate_rad_per_s, end.turnRate_rad_per_s, 1e-9, 'turn rate at the cut');
  }
});

test('the segment of a time is the first that ends at it or later', () => {
  const random = new Random('segments');
  for (let round = 0; round < 100; ++round) {
    const path = random.path(1 + random.below(20));
    const times = [...path.flatMap(({ t0, t1 }) => [t0, t1]), beginOf(path) - 1, endOf(path) + 1, random.number(beginOf(path), endOf(path))];
    for (const time_s of times) {
      const found = path.findIndex(({ t1 }) => t1 >= time_s);
      assert.equal(segmentAt(path, time_s), found < 0 ? path.length - 1 : found);
    }
  }
  assert.equal(segmentAt([], 0), -1);
});

test('times beyond the path are those of its ends', () => {
  const path = new Random('ends').path(3);
  assert.deepEqual(poseAt(path, endOf(path) + 5), poseAt(path, endOf(path)));
  assert.deepEqual(poseAt(path, beginOf(path) - 5), poseAt(path, beginOf(path)));
  assert.equal(clampToPath(path, Number.NaN), beginOf(path));
  assert.equal(clampToPath(path, Infinity), endOf(path));
  assert.equal(poseAt([], 0), undefined);
});

test('angles are twice the arc of quaternions, of either sign', () => {
  const random = new Random('angles');
  for (let round = 0; round < 300; ++round) {
    const [a, b] = [random.quaternion(), random.quaternion()];
    const dot = Math.abs(a.reduce((sum, x, k) => sum + x * (b[k] as number), 0));
    assert.ok(Math.abs(angleBetween(a, b) - 2 * Math.acos(Math.min(1, dot))) < 1e-7);
    assert.equal(angleBetween(a, b.map((x) => -x) as Quat), angleBetween(a, b));
    const small = 10 ** random.number(-12, -3);
    const turned = product(a, [Math.cos(small / 2), Math.sin(small / 2), 0, 0]);
    assert.ok(Math.abs(angleBetween(a, turned) / small - 1) < 1e-3, `an angle of ${small}`);
  }
  assert.equal(lengthOf([3, 4]), 5);
});
