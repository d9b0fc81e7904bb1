// SPDX-License-Identifier: MIT
//
// Times of keyframes, by the rules of docs/requests.md, "Keyframes"; and the two clocks of a path that was slowed.

import type { Answer } from '../contract/answer.js';
import type { Keyframe, PlanRequest } from '../contract/request.js';
import { angleBetween, lengthOf } from './path.js';

const kDefaultSpeed_m_per_s = 1;
const kTurnRate_rad_per_s = 1;
const kLeastShareOfMean = 0.01;

/** Least distance of two times: absolute, and as a share of their size. */
const kLeastStep_s = 1e-9;
const kLeastRelativeStep = 1.42e-14;

/** A stretch whose duration changed by less than this share was not slowed. */
const kSameDuration = 1e-9;

export function isTimed(request: PlanRequest): boolean {
  return request.keyframes.length > 0 && request.keyframes.every((keyframe) => keyframe.time !== undefined);
}

/** Whether two times are far enough apart for two keyframes. */
export function areApart(earlier_s: number, later_s: number): boolean {
  const size = Math.max(Math.abs(earlier_s), Math.abs(later_s));
  return later_s - earlier_s >= Math.max(kLeastStep_s, kLeastRelativeStep * size);
}

/** The times of the keyframes of a request: as given, or as Camway derives them. */
export function timesOf(request: PlanRequest): number[] {
  if (isTimed(request)) return request.keyframes.map((keyframe) => keyframe.time as number);
  const asked = request.options?.['default_speed_m_per_s'];
  const speed_m_per_s = typeof asked === 'number' && asked > 0 ? asked : kDefaultSpeed_m_per_s;
  return derivedTimes(request.keyframes, speed_m_per_s);
}

/**
 * The times of the keyframes of a request on the path of `answer`, which may have slowed it. An answer to an older
 * request may have another number of keyframes; the times then are those of the request.
 */
export function timesOnPath(request: PlanRequest, answer: Answer | undefined): number[] {
  const given = answer?.keyframes?.filter((keyframe) => keyframe.origin !== 'inserted') ?? [];
  const hasAll = given.length === request.keyframes.length && given.every((keyframe) => keyframe.time !== undefined);
  return hasAll && answer?.segments.length ? given.map((keyframe) => keyframe.time as number) : timesOf(request);
}

function derivedTimes(keyframes: readonly Keyframe[], speed_m_per_s: number): number[] {
  const steps_s = keyframes.slice(1).map((keyframe, i) => {
    const before = keyframes[i] as Keyframe;
    const distance_m = lengthOf(keyframe.position.map((x, k) => x - (before.position[k] as number)));
    const angle_rad = angleBetween(unit(keyframe), unit(before));
    return Math.hypot(distance_m / speed_m_per_s, angle_rad / kTurnRate_rad_per_s);
  });
  const mean_s = steps_s.reduce((sum, step) => sum + step, 0) / Math.max(1, steps_s.length);
  let time_s = 0;
  const times = [0];
  for (const step_s of steps_s) {
    time_s += mean_s > 0 ? Math.max(step_s, kLeastShareOfMean * mean_s) : 1;
    times.push(time_s);
  }
  return times.slice(0, keyframes.length);
}

function unit(keyframe: Keyframe): Keyframe['orientation'] {
  const length = lengthOf(keyframe.orientation);
  return keyframe.orientation.map((x) => x / length) as Keyframe['orientation'];
}

/**
 * The clock of a path that was slowed against the clock of the request. They are known to match at the given
 * keyframes and at the ends of the slowed parts. In between, a slowed part is stretched evenly here, although Camway
 * slows it smoothly, so that there a time is near and not exact. Without slowing the clocks are the same.
 */
export class TimeMap {
  /** Matching instants on both clocks, ascending. */
  private readonly given: number[] = [];
  private readonly path: number[] = [];

  constructor(request: PlanRequest | undefined, answer: Answer | undefined) {
    const slowed = answer?.slowed ?? [];
    if (slowed.length === 0) return;
    const matches = slowed.flatMap(({ given, t_begin, t_end }): [number, number][] => [
      [given[0], t_begin],
      [given[1], t_end],
    ]);
    if (request) {
      const times = timesOf(request);
      const onPath = timesOnPath(request, answer);
      times.forEach((time_s, i) => matches.push([time_s, onPath[i] as number]));
    }
    matches.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    for (const [given_s, path_s] of matches) {
      const isLater = given_s > (this.given.at(-1) ?? -Infinity) && path_s > (this.path.at(-1) ?? -Infinity);
      if (!isLater) continue;
      this.given.push(given_s);
      this.path.push(path_s);
    }
  }

  /** Whether nothing was slowed. */
  get isSame(): boolean {
    return this.given.length === 0;
  }

  /** A time of the request for a time on the path. */
  toGiven(time_s: number): number {
    return mapped(this.path, this.given, time_s);
  }

  /** The times of the request that an instant of the path can be: one, or where the path was slowed, from one to another. */
  givenRange(time_s: number): [from: number, to: number] {
    const next = this.path.findIndex((end) => time_s < end);
    if (next <= 0) return [this.toGiven(time_s), this.toGiven(time_s)];
    const [begin, end] = [this.given[next - 1] as number, this.given[next] as number];
    const stretch_s = (this.path[next] as number) - (this.path[next - 1] as number);
    const isSlowed = Math.abs(stretch_s - (end - begin)) > kSameDuration * (end - begin);
    return isSlowed ? [begin, end] : [this.toGiven(time_s), this.toGiven(time_s)];
  }

  /** A time on the path for a time of the request. */
  toPath(time_s: number): number {
    return mapped(this.given, this.path, time_s);
  }
}

/** Maps on the lines between matches, and beyond them by the distance from the last one. */
function mapped(from: readonly number[], to: readonly number[], time_s: number): number {
  const last = from.length - 1;
  if (last < 0) return time_s;
  const next = from.findIndex((end) => time_s < end);
  if (next === 0) return time_s + ((to[0] as number) - (from[0] as number));
  if (next < 0) return time_s + ((to[last] as number) - (from[last] as number));
  const [a, b] = [from[next - 1] as number, from[next] as number];
  const share = (time_s - a) / (b - a);
  return (to[next - 1] as number) + share * ((to[next] as number) - (to[next - 1] as number));
}
