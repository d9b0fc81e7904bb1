// SPDX-License-Identifier: MIT
import type { Answer, Correction } from '../contract/answer.js';
import { numberText } from '../model/format.js';
import { timesOnPath } from '../model/times.js';
import type { State } from '../model/store.js';

export type BandKind = 'collision' | 'remaining' | 'corrected' | 'slowed';

/** A stretch of time with a meaning. `detail` is for tooltips. */
export interface Band {
  kind: BandKind;
  t_begin: number;
  t_end: number;
  detail: string;
}

export interface BandRow {
  label: string;
  bands: Band[];
}

const kKinds: Readonly<Record<Correction['kind'], string>> = {
  move: 'moved',
  turn: 'turned',
  go_round: 'goes round',
  shrink: 'smaller camera',
  none: 'not corrected',
};

export function correctionWords(correction: Correction): string {
  return kKinds[correction.kind] ?? correction.kind;
}

/** Rows of bands: collisions before, then what became of them; slowed parts only where there are any. */
export function bandRows(answer: Answer | undefined): BandRow[] {
  const collisions = (answer?.collisions ?? []).map((collision): Band => ({
    kind: 'collision',
    t_begin: collision.t_begin,
    t_end: collision.t_end,
    detail: `before: collides with ${collision.witness.object}`,
  }));
  const remaining = (answer?.remaining_collisions ?? []).map((collision): Band => ({
    kind: 'remaining',
    t_begin: collision.t_begin,
    t_end: collision.t_end,
    detail: `still collides with ${collision.witness.object}`,
  }));
  const rows: BandRow[] = [
    { label: 'before', bands: collisions },
    { label: 'path', bands: [...correctedBands(answer?.corrections ?? []), ...remaining] },
  ];
  const slowed = (answer?.slowed ?? []).map(({ t_begin, t_end, given }): Band => ({
    kind: 'slowed',
    t_begin,
    t_end,
    detail: `slowed: ${numberText((t_end - t_begin) / Math.max(given[1] - given[0], Number.MIN_VALUE))} times as long`,
  }));
  if (slowed.length > 0) rows.push({ label: 'slowed', bands: slowed });
  return rows;
}

/** Corrections change more time than their collision, and several may change the same: one band for each range. */
function correctedBands(corrections: readonly Correction[]): Band[] {
  const byRange = new Map<string, Band>();
  for (const correction of corrections) {
    if (correction.kind === 'none') continue;
    const [t_begin, t_end] = correction.changed;
    const words = correctionWords(correction);
    const known = byRange.get(`${t_begin} ${t_end}`);
    if (!known) byRange.set(`${t_begin} ${t_end}`, { kind: 'corrected', t_begin, t_end, detail: `corrected: ${words}` });
    else if (!known.detail.includes(words)) known.detail += `, ${words}`;
  }
  return [...byRange.values()];
}

export function bandsAt(rows: readonly BandRow[], time_s: number): Band[] {
  return rows.flatMap((row) => row.bands.filter((band) => band.t_begin <= time_s && time_s <= band.t_end));
}

export interface Mark {
  time_s: number;
  origin: 'given' | 'inserted';
  /** Index in the request of a given keyframe. */
  index?: number;
}

/** Marks of keyframes: those of the request, and those that the answer inserted. */
export function marksOf(state: Pick<State, 'request' | 'answer'>): Mark[] {
  const given = state.request ? timesOnPath(state.request, state.answer) : [];
  const inserted = (state.answer?.segments?.length ? (state.answer.keyframes ?? []) : []).filter(
    (keyframe) => keyframe.origin === 'inserted' && keyframe.time !== undefined,
  );
  return [
    ...inserted.map((keyframe): Mark => ({ time_s: keyframe.time as number, origin: 'inserted' })),
    ...given.map((time_s, index): Mark => ({ time_s, origin: 'given', index })),
  ];
}
