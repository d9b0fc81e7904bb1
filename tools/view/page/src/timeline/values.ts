// SPDX-License-Identifier: MIT
//
// Values at an instant, as text for tooltips and screen readers.

import type { Curve } from '../model/curves.js';
import { kCurveKinds, valueAt } from '../model/curves.js';
import { lowerBoundText, timeText, withUnit } from '../model/format.js';
import type { BandRow, Mark } from './bands.js';
import { bandsAt } from './bands.js';
import type { Layout } from './layout.js';
import { xOf } from './layout.js';

/** A mark nearer than this is named. */
const kMarkDistance = 6;

export interface Readable {
  layout: Layout;
  rows: readonly BandRow[];
  marks: readonly Mark[];
  curves: readonly Curve[];
}

/** Lines for a tooltip: the time first. */
export function linesAt(readable: Readable, time_s: number): string[] {
  const { layout, rows, marks, curves } = readable;
  const lines = [`${timeText(time_s, layout.t0)} s`];
  const x = xOf(layout, time_s);
  const near = marks.filter((mark) => Math.abs(xOf(layout, mark.time_s) - x) <= kMarkDistance).at(-1);
  if (near) lines.push(near.index !== undefined ? `keyframe ${near.index}, given` : 'inserted keyframe');
  for (const curve of curves) {
    const kind = kCurveKinds.find((known) => known.name === curve.name);
    const value = valueAt(curve, time_s);
    if (kind && value !== undefined) lines.push(`${kind.label} ${curve.name === 'clearance' ? `${lowerBoundText(value)} m` : withUnit(value, kind.unit)}${excess(curve, value)}`);
  }
  const details = bandsAt(rows, time_s).map((band) => band.detail);
  return [...lines, ...new Set(details)];
}

function excess(curve: Curve, value: number): string {
  const isAbove = curve.name !== 'clearance' && curve.limit !== undefined && value > curve.limit;
  return isAbove ? ' (above the limit)' : '';
}
