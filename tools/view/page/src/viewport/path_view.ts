// SPDX-License-Identifier: MIT
// The path as a tube coloured by certified clearance, corrected stretches in a sleeve, the path beside it (as
// interpolated, or of another answer) as a dashed ghost where it differs, and collisions in vermillion on whichever path
// has them.

import { Group, Vector3 } from 'three';
import type { Answer, Segment } from '../contract/answer.js';
import type { Beside } from '../model/beside.js';
import { clearanceColour, kPalette } from '../model/palette.js';
import { bezierAt, poseAt } from '../model/path.js';
import { indicesWithin } from '../model/spans.js';
import type { Span } from '../model/spans.js';
import type { Frame } from './frame.js';
import { rgbOf, TubeBuilder, Tubes } from './tubes.js';
import type { Rgb, TubeStyle, TubeUniforms } from './tubes.js';

const kSamplesOfPath = 700;
const kMostSamplesOfSegment = 32;
const kLeastSamplesOfSegment = 3;
/** Paths that differ less than that anywhere are drawn as one. */
const kSamePlace_m = 2e-4;

const kPathRadius_m = 0.012;
const kPathStyle: TubeStyle = { radius_m: kPathRadius_m, least_px: 3.6 };
const kCollisionStyle: TubeStyle = { radius_m: 1.25 * kPathRadius_m, least_px: 5.5 };
const kBeforeStyle: TubeStyle = { radius_m: 0.5 * kPathRadius_m, least_px: 2.2, isDashed: true };
const kSleeveStyle: TubeStyle = { radius_m: 3 * kPathRadius_m, least_px: 11 };

/** Colours of a path about whose clearance nothing is proved. */
export interface PathColours {
  unproved: Rgb;
}

function sampleTimes(path: readonly Segment[], breaks: readonly number[]): number[] {
  const duration = (path[path.length - 1]?.t1 ?? 0) - (path[0]?.t0 ?? 0);
  const times: number[] = [];
  for (const { t0, t1 } of path) {
    const wanted = Math.ceil((kSamplesOfPath * (t1 - t0)) / (duration || 1));
    const most = path.length > 500 ? kLeastSamplesOfSegment : kMostSamplesOfSegment;
    const count = Math.min(Math.max(wanted, kLeastSamplesOfSegment), most);
    for (let i = 0; i < count; ++i) times.push(t0 + ((t1 - t0) * i) / count);
  }
  const last = path[path.length - 1];
  if (last) times.push(last.t1);
  const inside = breaks.filter((t) => t > (path[0]?.t0 ?? 0) && t < (last?.t1 ?? 0));
  return [...new Set([...times, ...inside])].sort((a, b) => a - b);
}

class Samples {
  readonly times: number[];
  readonly points: Vector3[];

  constructor(path: readonly Segment[], frame: Frame, breaks: readonly number[]) {
    this.times = sampleTimes(path, breaks);
    let index = 0;
    this.points = this.times.map((t) => {
      while (index + 1 < path.length && (path[index] as Segment).t1 < t) ++index;
      const segment = path[index] as Segment;
      const u = (t - segment.t0) / (segment.t1 - segment.t0);
      return frame.toLocal(bezierAt(segment.position, Math.min(1, Math.max(0, u))));
    });
  }

  /** The points within a span. */
  within(span: Span): Vector3[] {
    const found = indicesWithin(this.times, span);
    return found ? this.points.slice(found[0], found[1] + 1) : [];
  }
}

/**
 * Certified lower bound of the clearance at a time; undefined without a profile. The one bound for the whole path says
 * nothing about a stretch: a path that is tight in one place would look tight everywhere.
 */
function clearanceAt(answer: Answer, time_s: number): number | undefined {
  const profile = answer.clearance_profile ?? [];
  let low = 0;
  let high = profile.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((profile[middle]?.t_end ?? 0) < time_s) low = middle + 1;
    else high = middle;
  }
  return profile[low]?.clearance_m;
}

export class PathView {
  readonly group = new Group();
  private readonly sleeve: Tubes;
  private readonly ghost: Tubes;
  private readonly tube: Tubes;

  constructor(shared: TubeUniforms) {
    this.sleeve = new Tubes(shared, 20, 0.3);
    this.ghost = new Tubes(shared, 21);
    this.tube = new Tubes(shared, 22);
    this.group.add(this.sleeve, this.ghost, this.tube);
  }

  show(answer: Answer | undefined, beside: Beside, frame: Frame, colours: PathColours): void {
    const tube = new TubeBuilder();
    const ghost = new TubeBuilder();
    const sleeve = new TubeBuilder();
    const after = answer?.segments ?? [];
    if (answer && after.length > 0) {
      const spans = answer.remaining_collisions.map((c) => ({ begin: c.t_begin, end: c.t_end }));
      const breaks = [
        ...(answer.clearance_profile ?? []).flatMap((s) => [s.t_begin, s.t_end]),
        ...spans.flatMap((s) => [s.begin, s.end]),
      ];
      const samples = new Samples(after, frame, breaks.slice(0, 20_000));
      const colourAt = (i: number): Rgb => {
        const clearance = clearanceAt(answer, samples.times[i] ?? 0);
        if (clearance !== undefined) return clearanceColour(clearance);
        return answer.certificate?.certified ? rgbOf(kPalette.after) : colours.unproved;
      };
      tube.line(samples.points, colourAt, kPathStyle);
      this.addSpans(tube, samples, spans, rgbOf(kPalette.collision), kCollisionStyle);
      this.addSpans(sleeve, samples, correctedSpans(answer), rgbOf(kPalette.corrected), kSleeveStyle);
    }
    if (beside.path.length > 0) this.addGhost(ghost, tube, answer, beside, frame);
    this.sleeve.show(sleeve);
    this.ghost.show(ghost);
    this.tube.show(tube);
  }

  private addSpans(builder: TubeBuilder, samples: Samples, spans: readonly Span[], colour: Rgb, style: TubeStyle): void {
    for (const span of spans) {
      const points = samples.within(span);
      if (points.length === 1) points.push((points[0] as Vector3).clone().add(new Vector3(1e-4, 0, 0)));
      builder.line(points, () => colour, style);
    }
  }

  private addGhost(ghost: TubeBuilder, tube: TubeBuilder, answer: Answer | undefined, beside: Beside, frame: Frame): void {
    const spans = beside.collisions;
    const samples = new Samples(beside.path, frame, spans.flatMap((s) => [s.begin, s.end]));
    const after = answer?.segments ?? [];
    const differs = samples.times.map((t, i) => {
      const pose = after.length > 0 ? poseAt(after, beside.onAnswer(t)) : undefined;
      return !pose || frame.toLocal(pose.position).distanceTo(samples.points[i] as Vector3) > kSamePlace_m;
    });
    const orange = rgbOf(kPalette.before);
    let run: Vector3[] = [];
    differs.forEach((differsHere, i) => {
      if (differsHere || differs[i - 1] || differs[i + 1]) run.push(samples.points[i] as Vector3);
      else {
        ghost.line(run, () => orange, kBeforeStyle);
        run = [];
      }
    });
    ghost.line(run, () => orange, kBeforeStyle);
    this.addSpans(tube, samples, spans, rgbOf(kPalette.collision), kCollisionStyle);
  }
}

/** The stretches that corrections changed, on the clock of the path, joined where they overlap. */
export function correctedSpans(answer: Answer): Span[] {
  const spans = (answer.corrections ?? [])
    .filter(({ kind }) => kind !== 'none')
    .map(({ changed }) => ({ begin: changed[0], end: changed[1] }))
    .sort((a, b) => a.begin - b.begin);
  const joined: Span[] = [];
  for (const span of spans) {
    const last = joined[joined.length - 1];
    if (last && span.begin <= last.end) last.end = Math.max(last.end, span.end);
    else joined.push({ ...span });
  }
  return joined;
}
