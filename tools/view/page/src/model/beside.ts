// SPDX-License-Identifier: MIT
// The path beside that of the answer: as interpolated, or that of another answer which is compared with it. Each of the
// paths may be slowed, so each has a clock of its own; the clock of the request joins them.

import type { Segment } from '../contract/answer.js';
import { beginOf, clampToPath, endOf } from './path.js';
import { collisionSpansBefore } from './spans.js';
import type { Span } from './spans.js';
import type { State } from './store.js';
import { TimeMap } from './times.js';

export interface Beside {
  path: readonly Segment[];
  /** Its collisions, on its own clock and within it. */
  collisions: Span[];
  /** A time on it for a time on the path of the answer. */
  timeOf(time_s: number): number;
  /** A time on the path of the answer for a time on it. */
  onAnswer(time_s: number): number;
}

type Shown = Pick<State, 'request' | 'answer' | 'before' | 'compared'>;

export function besideOf({ request, answer, before, compared }: Shown): Beside {
  const clock = new TimeMap(request, answer);
  if (!compared) {
    return {
      path: before,
      collisions: collisionSpansBefore(request, answer, before),
      timeOf: (time_s) => clock.toGiven(time_s),
      onAnswer: (time_s) => clock.toPath(time_s),
    };
  }
  const { other } = compared;
  const path = other.segments;
  const clockOfOther = new TimeMap(request, other);
  const inside = (time_s: number): number => Math.min(Math.max(time_s, beginOf(path)), endOf(path));
  return {
    path,
    collisions: path.length > 0 ? other.remaining_collisions.map((c) => ({ begin: inside(c.t_begin), end: inside(c.t_end) })) : [],
    timeOf: (time_s) => clockOfOther.toPath(clock.toGiven(time_s)),
    onAnswer: (time_s) => clock.toPath(clockOfOther.toGiven(time_s)),
  };
}

/** The state in which the two compared answers have changed places; undefined if there is one answer alone. */
export function withOtherAnswer(now: Shown & Pick<State, 'cursor_s'>): Partial<State> | undefined {
  const { answer, compared, cursor_s } = now;
  if (!answer || !compared) return undefined;
  const { name, otherName, other } = compared;
  const time_s = answer.segments.length > 0 ? besideOf(now).timeOf(cursor_s) : cursor_s;
  return {
    answer: other,
    compared: { name: otherName, otherName: name, other: answer },
    cursor_s: other.segments.length > 0 ? clampToPath(other.segments, time_s) : cursor_s,
  };
}
