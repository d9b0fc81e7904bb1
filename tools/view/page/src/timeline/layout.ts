// SPDX-License-Identifier: MIT
//
// Places on the time line, in CSS pixels.

export const kLeft = 120;
export const kRight = 84;
export const kRulerHeight = 27;
export const kMarksHeight = 22;
export const kBandHeight = 14;
export const kLaneHeight = 40;
const kBottom = 4;

/** Least distance of two ticks. */
const kTickDistance = 64;
const kTickSteps = [1, 2, 5] as const;

export interface Layout {
  width: number;
  height: number;
  /** Left and right end of the path. */
  x0: number;
  x1: number;
  t0: number;
  t1: number;
  marksTop: number;
  bandsTop: number;
  lanesTop: number;
  lanes: number;
}

export function layoutOf(width: number, t0: number, t1: number, bands: number, lanes: number): Layout {
  const marksTop = kRulerHeight;
  const bandsTop = marksTop + kMarksHeight;
  const lanesTop = bandsTop + bands * kBandHeight + 4;
  return {
    width,
    height: lanesTop + lanes * kLaneHeight + kBottom,
    x0: kLeft,
    x1: Math.max(kLeft + 1, width - kRight),
    t0,
    t1,
    marksTop,
    bandsTop,
    lanesTop,
    lanes,
  };
}

export function xOf(layout: Layout, time_s: number): number {
  const duration_s = layout.t1 - layout.t0;
  const share = duration_s > 0 ? (time_s - layout.t0) / duration_s : 0;
  return layout.x0 + share * (layout.x1 - layout.x0);
}

/** The time at a place, within the path. */
export function timeAtX(layout: Layout, x: number): number {
  const share = Math.min(1, Math.max(0, (x - layout.x0) / (layout.x1 - layout.x0)));
  return layout.t0 + share * (layout.t1 - layout.t0);
}

export interface Ticks {
  /** Offsets from the begin of the ruler's origin, in seconds. */
  times: number[];
  decimals: number;
}

/** Ticks at round times from `from_s` to `to_s` on a ruler of that width. */
export function ticksOf(from_s: number, to_s: number, width: number): Ticks {
  const duration_s = to_s - from_s;
  const most = Math.max(1, Math.floor(width / kTickDistance));
  if (!(duration_s > 0)) return { times: [from_s], decimals: 0 };
  const rough_s = duration_s / most;
  const power = Math.floor(Math.log10(rough_s));
  const size = 10 ** power;
  const factor = kTickSteps.find((step) => step * size >= rough_s) ?? 10;
  const step_s = factor * size;
  const first = Math.ceil(from_s / step_s - 1e-9);
  const last = Math.floor(to_s / step_s + 1e-9);
  const times = Array.from({ length: last - first + 1 }, (_, k) => (first + k) * step_s);
  return { times, decimals: Math.max(0, -Math.floor(Math.log10(step_s) + 1e-9)) };
}
