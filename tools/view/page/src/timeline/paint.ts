// SPDX-License-Identifier: MIT
//
// Draws the time line on a canvas whose unit is a CSS pixel.

import type { Curve, CurveKind } from '../model/curves.js';
import { isEpoch, lowerBoundText, numberText, timeText } from '../model/format.js';
import { kPalette } from '../model/palette.js';
import type { Band, BandRow, Mark } from './bands.js';
import type { Layout } from './layout.js';
import { kBandHeight, kLaneHeight, kMarksHeight, kRulerHeight, ticksOf, xOf } from './layout.js';
import type { Theme } from './theme.js';

export interface Lane {
  kind: CurveKind;
  curve: Curve | undefined;
  /** Said where there is no curve. */
  missing: string;
}

export interface Picture {
  layout: Layout;
  rows: readonly BandRow[];
  marks: readonly Mark[];
  lanes: readonly Lane[];
  selectedKeyframe: number | undefined;
  theme: Theme;
}

type Context = CanvasRenderingContext2D;

/** Numbers of keyframes nearer than this to their neighbours are left out. */
const kNumberDistance = 18;
const kLeastBandWidth = 3;

/** Draws everything but the cursor. */
export function paint(context: Context, picture: Picture): void {
  const { layout, theme } = picture;
  context.clearRect(0, 0, layout.width, layout.height);
  context.font = `11px ${theme.font}`;
  context.textBaseline = 'middle';
  paintRuler(context, picture);
  picture.rows.forEach((row, i) => paintRow(context, picture, row, layout.bandsTop + i * kBandHeight));
  picture.lanes.forEach((lane, i) => paintLane(context, picture, lane, layout.lanesTop + i * kLaneHeight));
  paintMarks(context, picture);
}

/** Draws the cursor, and the line under the mouse. */
export function paintCursor(context: Context, layout: Layout, theme: Theme, cursor_s: number, hover_s: number | undefined): void {
  context.clearRect(0, 0, layout.width, layout.height);
  if (hover_s !== undefined) {
    context.strokeStyle = theme.muted;
    context.setLineDash([2, 3]);
    verticalLine(context, xOf(layout, hover_s), kRulerHeight, layout.height);
    context.setLineDash([]);
  }
  const x = Math.round(xOf(layout, cursor_s));
  context.strokeStyle = theme.accent;
  context.lineWidth = 2;
  verticalLine(context, x - 0.5, kRulerHeight - 8, layout.height);
  context.lineWidth = 1;
  context.fillStyle = theme.accent;
  context.beginPath();
  context.moveTo(x - 6, kRulerHeight - 14);
  context.lineTo(x + 6, kRulerHeight - 14);
  context.lineTo(x + 6, kRulerHeight - 9);
  context.lineTo(x, kRulerHeight - 2);
  context.lineTo(x - 6, kRulerHeight - 9);
  context.fill();
}

function paintRuler(context: Context, { layout, theme }: Picture): void {
  const origin_s = isEpoch(layout.t0) ? layout.t0 : 0;
  const ticks = ticksOf(layout.t0 - origin_s, layout.t1 - origin_s, layout.x1 - layout.x0);
  context.textAlign = 'center';
  for (const offset_s of ticks.times) {
    const x = xOf(layout, origin_s + offset_s);
    context.strokeStyle = theme.line;
    verticalLine(context, x, kRulerHeight - 4, layout.height);
    context.fillStyle = theme.muted;
    context.fillText(timeText(origin_s + offset_s, layout.t0, ticks.decimals), x, 7);
  }
  context.textAlign = 'right';
  context.fillText('time, s', layout.x0 - 12, 7);
}

function paintMarks(context: Context, { layout, theme, marks, selectedKeyframe }: Picture): void {
  const y = layout.marksTop + kMarksHeight / 2;
  label(context, theme, layout, 'keyframes', y);
  let numbered = -Infinity;
  for (const mark of marks) {
    const x = xOf(layout, mark.time_s);
    const isSelected = mark.index !== undefined && mark.index === selectedKeyframe;
    if (mark.origin === 'inserted') lozenge(context, x, y);
    else disc(context, theme, x, y, isSelected);
    if (mark.index === undefined || !(x - numbered >= kNumberDistance || isSelected)) continue;
    numbered = x;
    context.fillStyle = isSelected ? theme.accent : theme.muted;
    context.textAlign = 'left';
    context.fillText(String(mark.index), x + 7, y);
  }
}

/** Given keyframes are discs and inserted ones lozenges, as in the view and in the pictures of `camway draw`. */
function disc(context: Context, theme: Theme, x: number, y: number, isSelected: boolean): void {
  context.fillStyle = isSelected ? theme.accent : theme.text;
  context.beginPath();
  context.arc(x, y, isSelected ? 5.5 : 4.5, 0, 2 * Math.PI);
  context.fill();
}

function lozenge(context: Context, x: number, y: number): void {
  const size = 5;
  context.fillStyle = kPalette.inserted;
  context.beginPath();
  context.moveTo(x, y - size);
  context.lineTo(x + size, y);
  context.lineTo(x, y + size);
  context.lineTo(x - size, y);
  context.fill();
}

function paintRow(context: Context, { layout, theme }: Picture, row: BandRow, top: number): void {
  label(context, theme, layout, row.label, top + kBandHeight / 2);
  context.fillStyle = theme.line;
  context.globalAlpha = 0.35;
  context.fillRect(layout.x0, top + 2, layout.x1 - layout.x0, kBandHeight - 4);
  context.globalAlpha = 1;
  for (const band of row.bands) paintBand(context, theme, layout, band, top + 2, kBandHeight - 4);
}

function paintBand(context: Context, theme: Theme, layout: Layout, band: Band, top: number, height: number): void {
  const from = xOf(layout, band.t_begin);
  const width = Math.max(kLeastBandWidth, xOf(layout, band.t_end) - from);
  const x = Math.min(from, layout.x1 - width);
  context.save();
  context.beginPath();
  context.rect(x, top, width, height);
  context.clip();
  switch (band.kind) {
    case 'corrected':
      context.fillStyle = kPalette.corrected;
      context.fillRect(x, top, width, height);
      context.strokeStyle = kPalette.after;
      context.strokeRect(x + 0.5, top + 0.5, width - 1, height - 1);
      break;
    case 'remaining':
      context.fillStyle = kPalette.collision;
      context.fillRect(x, top, width, height);
      break;
    case 'collision':
      context.globalAlpha = 0.3;
      context.fillStyle = kPalette.collision;
      context.fillRect(x, top, width, height);
      context.globalAlpha = 1;
      context.strokeStyle = kPalette.collision;
      context.lineWidth = 1.5;
      hatch(context, x, top, width, height);
      context.strokeRect(x, top, width, height);
      break;
    case 'slowed':
      context.strokeStyle = theme.muted;
      context.strokeRect(x + 0.5, top + 0.5, width - 1, height - 1);
      chevrons(context, x, top, width, height);
      break;
  }
  context.restore();
}

function hatch(context: Context, x: number, top: number, width: number, height: number): void {
  context.beginPath();
  for (let at = x - height; at < x + width; at += 5) {
    context.moveTo(at, top + height);
    context.lineTo(at + height, top);
  }
  context.stroke();
}

function chevrons(context: Context, x: number, top: number, width: number, height: number): void {
  context.beginPath();
  for (let at = x + 4; at < x + width - 4; at += 12) {
    context.moveTo(at + 4, top + 2);
    context.lineTo(at, top + height / 2);
    context.lineTo(at + 4, top + height - 2);
  }
  context.stroke();
}

function paintLane(context: Context, { layout, theme }: Picture, lane: Lane, top: number): void {
  const low = top + kLaneHeight - 5;
  const high = top + 6;
  label(context, theme, layout, `${lane.kind.label}, ${lane.kind.unit}`, (low + high) / 2);
  context.strokeStyle = theme.line;
  context.beginPath();
  context.moveTo(layout.x0, Math.round(low) + 0.5);
  context.lineTo(layout.x1, Math.round(low) + 0.5);
  context.stroke();
  const curve = lane.curve;
  if (!curve) {
    context.fillStyle = theme.muted;
    context.textAlign = 'left';
    context.fillText(lane.missing, layout.x0 + 8, (low + high) / 2);
    return;
  }
  const most = Math.max(curve.largest, curve.limit ?? 0) || 1;
  const yOf = (value: number): number => low - (Math.min(value, most) / most) * (low - high);
  paintCurve(context, layout, curve, yOf, low, theme);
  context.textAlign = 'left';
  if (curve.limit !== undefined) paintLimit(context, theme, layout, lane, curve.limit, yOf(curve.limit));
  context.fillStyle = theme.muted;
  // Below the limit's words, or above them where the limit is low.
  const y = curve.limit === undefined ? (low + high) / 2 : yOf(curve.limit) < (low + high) / 2 ? low - 5 : high + 1;
  // The least clearance matters, not the largest.
  const least = curve.values.reduce((smallest, value) => Math.min(smallest, value), Infinity);
  const words = lane.kind.name === 'clearance' ? `min ${lowerBoundText(least)}` : `max ${numberText(curve.largest)}`;
  context.fillText(words, layout.x1 + 8, y);
}

/** A limit as a dashed line with a word: an upper one, or for the clearance a lower one. */
function paintLimit(context: Context, theme: Theme, layout: Layout, lane: Lane, limit: number, y: number): void {
  context.strokeStyle = kPalette.collision;
  context.setLineDash([6, 4]);
  context.beginPath();
  context.moveTo(layout.x0, Math.round(y) + 0.5);
  context.lineTo(layout.x1, Math.round(y) + 0.5);
  context.stroke();
  context.setLineDash([]);
  context.fillStyle = theme.text;
  context.fillText(`${lane.kind.name === 'clearance' ? 'least' : 'limit'} ${numberText(limit)}`, layout.x1 + 8, y);
}

/** Draws a curve with at most some points for each pixel: of those in one pixel, the lowest and the highest. */
function paintCurve(context: Context, layout: Layout, curve: Curve, yOf: (value: number) => number, low: number, theme: Theme): void {
  const line = new Path2D();
  const { times, values } = curve;
  const x0 = xOf(layout, times[0] as number);
  line.moveTo(x0, yOf(values[0] as number));
  let pixel = Number.NaN;
  let least = 0;
  let most = 0;
  for (let i = 1; i < times.length; ++i) {
    const x = xOf(layout, times[i] as number);
    const value = values[i] as number;
    const isSamePixel = Math.floor(x) === pixel;
    if (isSamePixel && value >= least && value <= most && i + 1 < times.length) continue;
    least = isSamePixel ? Math.min(least, value) : value;
    most = isSamePixel ? Math.max(most, value) : value;
    pixel = Math.floor(x);
    line.lineTo(x, yOf(value));
  }
  const area = new Path2D(line);
  area.lineTo(xOf(layout, times.at(-1) as number), low);
  area.lineTo(x0, low);
  context.fillStyle = theme.text;
  context.globalAlpha = 0.07;
  context.fill(area);
  context.globalAlpha = 1;
  context.strokeStyle = theme.text;
  context.lineWidth = 1.25;
  context.stroke(line);
  context.lineWidth = 1;
}

function label(context: Context, theme: Theme, layout: Layout, text: string, y: number): void {
  context.fillStyle = theme.muted;
  context.textAlign = 'right';
  context.fillText(text, layout.x0 - 12, y);
}

function verticalLine(context: Context, x: number, top: number, bottom: number): void {
  context.beginPath();
  context.moveTo(Math.round(x) + 0.5, top);
  context.lineTo(Math.round(x) + 0.5, bottom);
  context.stroke();
}
