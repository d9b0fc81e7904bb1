// SPDX-License-Identifier: MIT
import type { Answer } from '../contract/answer.js';
import type { Direction, Stop } from './actions.js';
import type { State } from './store.js';
import { timesOnPath } from './times.js';

/** Nearer instants count as the one where the cursor is, as a share of the duration. */
const kSameInstant = 1e-6;

/**
 * The path that the cursor runs along: that of the answer. Where the answer has none, it is that of the answer which
 * it is compared with, or the path as interpolated.
 */
export function pathOf({ answer, before, compared }: Pick<State, 'answer' | 'before'> & Partial<State>): State['before'] {
  if (answer?.segments?.length) return answer.segments;
  return compared?.other.segments.length ? compared.other.segments : before;
}

/** Instants of collisions: the witnesses of those that remain, or else of those that were corrected. */
export function collisionTimes(answer: Answer | undefined): number[] {
  const times = [...(answer?.collisions ?? []), ...(answer?.remaining_collisions ?? [])].map((collision) => collision.witness.time);
  return ascending(times);
}

/** Instants of all keyframes of the answer, inserted ones included; of the request where it has none. */
export function keyframeStops(state: State): number[] {
  const times = state.request ? timesOnPath(state.request, state.answer) : [];
  const answered = state.answer?.segments?.length ? (state.answer.keyframes ?? []).map((keyframe) => keyframe.time) : [];
  return ascending([...times, ...answered.filter((time) => time !== undefined)]);
}

/** The next instant of a kind from the cursor on, or the previous one. Undefined if there is none. */
export function nextStop(state: State, stop: Stop, direction: Direction): number | undefined {
  const times = stop === 'keyframe' ? keyframeStops(state) : collisionTimes(state.answer);
  const path = pathOf(state);
  const first = path[0];
  const last = path[path.length - 1];
  const near_s = first && last ? kSameInstant * (last.t1 - first.t0) : 0;
  if (direction === 'next') return times.find((time) => time > state.cursor_s + near_s);
  return times.filter((time) => time < state.cursor_s - near_s).at(-1);
}

function ascending(times: readonly number[]): number[] {
  return [...new Set(times)].sort((a, b) => a - b);
}
