// SPDX-License-Identifier: MIT
//
// Curves over the time of a path, sampled where they bend. They are for looking: proofs and limits are Camway's.

import type { Answer, ClearanceStretch, Segment } from '../contract/answer.js';
import type { PlanRequest } from '../contract/request.js';
import { lengthOf, motionIn, poseAt } from './path.js';
import type { ShiftScale } from './shift.js';
import { changeBetween, kDegreesPerRadian, shiftOf, shiftScale } from './shift.js';
import { TimeMap } from './times.js';

export type CurveName = 'speed' | 'acceleration' | 'turn' | 'clearance' | 'shift';

export interface Curve {
  name: CurveName;
  /** Ascending; a jump has the same time twice. */
  times: number[];
  values: number[];
  largest: number;
  /** The value that the request limits it to, or for clearance, that it must keep. */
  limit?: number;
}

export interface CurveKind {
  name: CurveName;
  label: string;
  unit: string;
  help: string;
}

export const kCurveKinds: readonly CurveKind[] = [
  { name: 'speed', label: 'speed', unit: 'm/s', help: 'Speed of the eye' },
  { name: 'acceleration', label: 'acceleration', unit: 'm/s²', help: 'Acceleration of the eye' },
  { name: 'turn', label: 'turn rate', unit: '°/s', help: 'Turn rate of the camera' },
  { name: 'clearance', label: 'clearance', unit: 'm', help: 'Certified lower bound of the distance from the scene' },
  { name: 'shift', label: 'shift', unit: '°', help: 'Shift of the picture from the path as interpolated' },
];

/** The shift of a slowed path, whose clock differs from that of the path as interpolated. */
export const kShiftByPlace: CurveKind = {
  name: 'shift',
  label: 'shift by place',
  unit: '°',
  help: 'Shift of the picture from the nearest place of the path as interpolated, as slowed parts have another clock',
};

/** Samples and golden sections for the nearest place on a slowed part. */
const kPlaceSamples = 16;
const kPlaceSections = 20;
const kGolden = (Math.sqrt(5) - 1) / 2;

/** Parts of a segment to begin with: fewer would miss bends whose middle is on the line. */
const kFirstParts = 8;
const kMostHalvings = 4;

/** A part is halved where its middle is off the line by more than this share of the largest value. */
const kTolerance = 0.004;

/** Beyond this many segments, each has fewer samples, so that a curve has at most some 12,000. */
const kManySegments = 2000;
const kMostSampledSegments = 6000;

interface Sampled {
  times: number[];
  values: number[];
}

/** Curves of a path and its answer. Each is made when it is first asked for, and kept. */
export class Curves {
  private readonly kept = new Map<CurveName, Curve | undefined>();
  readonly times: TimeMap;
  private scaleKept: ShiftScale | undefined;

  constructor(
    private readonly path: readonly Segment[],
    private readonly before: readonly Segment[],
    private readonly request: PlanRequest | undefined,
    private readonly answer: Answer | undefined,
  ) {
    this.times = new TimeMap(request, answer);
  }

  /** Undefined where there is nothing to draw: no path, no profile of the clearance, no path before. */
  curve(name: CurveName): Curve | undefined {
    if (!this.kept.has(name)) this.kept.set(name, this.made(name));
    return this.kept.get(name);
  }

  get scale(): ShiftScale {
    this.scaleKept ??= shiftScale(this.request, this.answer, this.before, this.times);
    return this.scaleKept;
  }

  private made(name: CurveName): Curve | undefined {
    if (this.path.length === 0) return undefined;
    const sampled = this.sampled(name);
    if (!sampled || sampled.times.length === 0) return undefined;
    const limit = limitOf(this.request, name);
    return {
      name,
      ...sampled,
      largest: sampled.values.reduce((most, value) => Math.max(most, value), 0),
      ...(limit !== undefined ? { limit } : {}),
    };
  }

  private sampled(name: CurveName): Sampled | undefined {
    switch (name) {
      case 'speed':
        return sampledAlong(this.path, (segment, u) => lengthOf(motionIn(segment, u).velocity_m_per_s));
      case 'acceleration':
        return sampledAlong(this.path, (segment, u) => lengthOf(motionIn(segment, u).acceleration_m_per_s2));
      case 'turn':
        return sampledAlong(this.path, (segment, u) => lengthOf(motionIn(segment, u).turnRate_rad_per_s) * kDegreesPerRadian);
      case 'clearance':
        return stepsOf(this.answer?.clearance_profile ?? []);
      case 'shift':
        if (this.before.length === 0 || !this.answer) return undefined;
        return sampledAlong(this.path, (segment, u) => this.shiftAt(segment, u));
    }
  }

  private shiftAt(segment: Segment, u: number): number {
    const [from_s, to_s] = this.times.givenRange(segment.t0 + u * (segment.t1 - segment.t0));
    const now = motionIn(segment, u);
    const shiftFrom = (time_s: number): number => {
      const then = poseAt(this.before, time_s);
      return then ? shiftOf(changeBetween(then, now, this.scale.center), this.scale) : 0;
    };
    // The clock of a slowed part is not known inside of it: there the path is compared with the nearest place.
    return from_s === to_s ? shiftFrom(from_s) : leastOf(shiftFrom, from_s, to_s);
  }
}

/** The least value of a function between two times: of its least sample, and of its neighbourhood by golden sections. */
function leastOf(value: (time_s: number) => number, from_s: number, to_s: number): number {
  const step_s = (to_s - from_s) / kPlaceSamples;
  const samples = Array.from({ length: kPlaceSamples + 1 }, (_, k) => value(from_s + k * step_s));
  const least = samples.reduce((best, sample, k) => (sample < (samples[best] as number) ? k : best), 0);
  let [a, b] = [from_s + Math.max(0, least - 1) * step_s, from_s + Math.min(kPlaceSamples, least + 1) * step_s];
  let [p, q] = [b - kGolden * (b - a), a + kGolden * (b - a)];
  let [atP, atQ] = [value(p), value(q)];
  for (let k = 0; k < kPlaceSections; ++k) {
    if (atP < atQ) {
      [b, q, atQ] = [q, p, atP];
      p = b - kGolden * (b - a);
      atP = value(p);
    } else {
      [a, p, atP] = [p, q, atQ];
      q = a + kGolden * (b - a);
      atQ = value(q);
    }
  }
  return Math.min(samples[least] as number, atP, atQ);
}

/** The value of a curve at a time, on the line between samples. At a jump, the value after it. */
export function valueAt(curve: Curve, time_s: number): number | undefined {
  const { times, values } = curve;
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] as number) <= time_s) low = middle + 1;
    else high = middle;
  }
  if (low === 0) return values[0];
  if (low === times.length) return values[low - 1];
  const [t0, t1] = [times[low - 1] as number, times[low] as number];
  const share = (time_s - t0) / (t1 - t0);
  return (values[low - 1] as number) + share * ((values[low] as number) - (values[low - 1] as number));
}

/** Samples a function along a path: more where it bends, with jumps at joints kept. */
export function sampledAlong(path: readonly Segment[], value: (segment: Segment, u: number) => number): Sampled {
  const stride = Math.max(1, Math.ceil(path.length / kMostSampledSegments));
  const isMany = path.length > kManySegments;
  const sampled: Sampled = { times: [], values: [] };
  const scale = { largest: 0 };
  for (let i = 0; i < path.length; i += stride) {
    sampleSegment(path[i] as Segment, value, isMany ? 1 : kFirstParts, isMany ? 0 : kMostHalvings, scale, sampled);
  }
  return sampled;
}

function sampleSegment(
  segment: Segment,
  value: (segment: Segment, u: number) => number,
  parts: number,
  halvings: number,
  scale: { largest: number },
  into: Sampled,
): void {
  const at = (u: number): number => {
    const result = value(segment, u);
    scale.largest = Math.max(scale.largest, result);
    return result;
  };
  const add = (u: number, result: number): void => {
    into.times.push(segment.t0 + u * (segment.t1 - segment.t0));
    into.values.push(result);
  };
  /** Adds the samples after `u0` up to `u1`. */
  const refine = (u0: number, v0: number, u1: number, v1: number, left: number): void => {
    if (left > 0) {
      const middle = (u0 + u1) / 2;
      const result = at(middle);
      if (Math.abs(result - (v0 + v1) / 2) > kTolerance * scale.largest) {
        refine(u0, v0, middle, result, left - 1);
        refine(middle, result, u1, v1, left - 1);
        return;
      }
    }
    add(u1, v1);
  };
  const values = Array.from({ length: parts + 1 }, (_, k) => at(k / parts));
  add(0, values[0] as number);
  for (let k = 0; k < parts; ++k) {
    refine(k / parts, values[k] as number, (k + 1) / parts, values[k + 1] as number, halvings);
  }
}

/** The profile of the clearance as steps: each bound holds for its whole stretch. */
function stepsOf(profile: readonly ClearanceStretch[]): Sampled {
  const sampled: Sampled = { times: [], values: [] };
  for (const { t_begin, t_end, clearance_m } of profile) {
    sampled.times.push(t_begin, t_end);
    sampled.values.push(clearance_m, clearance_m);
  }
  return sampled;
}

const kLimits: Readonly<Record<CurveName, readonly string[] | undefined>> = {
  speed: ['limits', 'speed_m_per_s'],
  acceleration: ['limits', 'acceleration_m_per_s2'],
  turn: ['limits', 'turn_rate_deg_per_s'],
  clearance: ['clearance_m'],
  shift: undefined,
};

function limitOf(request: PlanRequest | undefined, name: CurveName): number | undefined {
  const path = kLimits[name];
  if (!path) return undefined;
  const value = path.reduce<unknown>((inner, member) => (inner as Record<string, unknown> | undefined)?.[member], request?.options);
  return typeof value === 'number' && value > 0 ? value : undefined;
}
