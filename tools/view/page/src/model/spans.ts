// SPDX-License-Identifier: MIT
// Stretches of time on a path, and which samples of it are within.

import type { Answer, Segment } from '../contract/answer.js';
import type { PlanRequest } from '../contract/request.js';
import { beginOf, endOf } from './path.js';
import { TimeMap } from './times.js';

/** From one instant to another, in seconds. */
export interface Span {
  begin: number;
  end: number;
}

/** Rounding of times as a share of their size. */
const kRounding = 1e-12;

/**
 * The collisions of the path before, on the clock of `before`: answers have them on the clock of their own path, which
 * may be slowed. Nothing reaches beyond the ends of `before`.
 */
export function collisionSpansBefore(request: PlanRequest | undefined, answer: Answer | undefined, before: readonly Segment[]): Span[] {
  if (before.length === 0) return [];
  const clock = new TimeMap(request, answer);
  const inside = (time_s: number): number => Math.min(Math.max(clock.toGiven(time_s), beginOf(before)), endOf(before));
  return (answer?.collisions ?? []).map(({ t_begin, t_end }) => ({ begin: inside(t_begin), end: inside(t_end) }));
}

/** Indices of the first and the last of ascending `times` within a span; undefined if none is. */
export function indicesWithin(times: readonly number[], { begin, end }: Span): [number, number] | undefined {
  const slack = (time_s: number): number => kRounding * (1 + Math.abs(time_s));
  const first = times.findIndex((t) => t >= begin - slack(begin));
  const last = times.findLastIndex((t) => t <= end + slack(end));
  return first < 0 || last < first ? undefined : [first, last];
}
