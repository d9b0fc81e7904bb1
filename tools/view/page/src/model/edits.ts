// SPDX-License-Identifier: MIT
//
// Edits of a request: each takes a request and gives another one, which shares what did not change. Edits that
// change nothing return the request itself. What a request may hold is said in docs/requests.md.

import type { Answer, Segment } from '../contract/answer.js';
import type { Camera, Keyframe, Options, PlanRequest } from '../contract/request.js';
import type { Pose } from './actions.js';
import { timeText } from './format.js';
import { poseAt } from './path.js';
import { pathOf } from './stops.js';
import type { State } from './store.js';
import { areApart, isTimed, TimeMap, timesOf } from './times.js';

/** An edit that cannot be done, as a sentence. */
export interface Refusal {
  refused: string;
}

export function isRefusal(result: PlanRequest | Refusal): result is Refusal {
  return 'refused' in result;
}

export const kLeastKeyframes = 2;
const kDefaultSpeed = 'default_speed_m_per_s';

/** Replaces the pose of a keyframe. Its time and its image stay. */
export function withPose(request: PlanRequest, index: number, pose: Pose): PlanRequest {
  const old = request.keyframes[index];
  if (!old) return request;
  const { repaired: _, ...kept } = old;
  const keyframe: Keyframe = { ...kept, position: pose.position, orientation: pose.orientation };
  return { ...request, keyframes: spliced(request.keyframes, index, 1, keyframe) };
}

/** Moves a keyframe in time, between its neighbours. All keyframes get times if they had none. */
export function withTime(request: PlanRequest, index: number, time_s: number): PlanRequest | Refusal {
  const timed = withTimes(request);
  const old = timed.keyframes[index];
  if (!old || !Number.isFinite(time_s)) return { refused: `The time of keyframe ${index} must be a number.` };
  const before = timed.keyframes[index - 1]?.time;
  const after = timed.keyframes[index + 1]?.time;
  if (before !== undefined && !areApart(before, time_s)) {
    return { refused: `Keyframe ${index} must be later than keyframe ${index - 1} (${shortTime(before, timed)} s).` };
  }
  if (after !== undefined && !areApart(time_s, after)) {
    return { refused: `Keyframe ${index} must be earlier than keyframe ${index + 1} (${shortTime(after, timed)} s).` };
  }
  if (timed === request && old.time === time_s) return request;
  return { ...timed, keyframes: spliced(timed.keyframes, index, 1, { ...old, time: time_s }) };
}

/** A time as messages have it, rounded. */
function shortTime(time_s: number, request: PlanRequest): string {
  return timeText(time_s, timesOf(request)[0], 3);
}

/** Gives each keyframe the time that it has by the default speed, which is refused beside times and goes. */
export function withTimes(request: PlanRequest): PlanRequest {
  if (isTimed(request)) return request;
  const times = timesOf(request);
  const keyframes = request.keyframes.map((keyframe, i) => ({ ...keyframe, time: times[i] as number }));
  return withOption({ ...request, keyframes }, [kDefaultSpeed], undefined);
}

/** Takes the times away, and the frame with the images: these have a meaning with times only. */
export function withoutTimes(request: PlanRequest): PlanRequest {
  if (!isTimed(request)) return request;
  const { frame: _, ...rest } = request;
  return { ...rest, keyframes: request.keyframes.map(({ time: _t, image: _i, ...keyframe }) => keyframe) };
}

export interface Insertion {
  request: PlanRequest;
  /** Index of the new keyframe. */
  index: number;
}

/**
 * Inserts a keyframe at a time of the path through the keyframes, before slowing. Its pose is that of `path` there,
 * so that the path changes little, or `pose`. In a request with times it gets that time. In one without, all times
 * are derived again with it: the path keeps its speed.
 */
export function insertedAt(
  request: PlanRequest,
  path: readonly Segment[],
  time_s: number,
  pose?: Pose,
): Insertion | Refusal {
  const at = pose ?? poseAt(path, time_s);
  if (!at) return { refused: 'There is no path to insert a keyframe into.' };
  const times = timesOf(request);
  const found = times.findIndex((time) => time > time_s);
  const index = found < 0 ? times.length : found;
  const before = times[index - 1];
  const after = times[index];
  const isFree =
    (before === undefined || areApart(before, time_s)) && (after === undefined || areApart(time_s, after));
  if (!isFree) return { refused: `At ${shortTime(time_s, request)} s there is a keyframe already.` };
  const timed = isTimed(request) ? { time: time_s } : {};
  return insertion(request, index, { position: at.position, orientation: at.orientation, ...timed });
}

/**
 * Inserts a keyframe at a time of the path that is shown, which may be corrected and slowed: at the pose that it has
 * there, and at the time that this is before slowing.
 */
export function insertedAtCursor(
  request: PlanRequest,
  shown: Pick<State, 'answer' | 'before'>,
  time_s: number,
  pose?: Pose,
): Insertion | Refusal {
  const path = pathOf(shown);
  return insertedAt(request, path, new TimeMap(request, shown.answer).toGiven(time_s), pose ?? poseAt(path, time_s));
}

/**
 * Inserts a keyframe after that of the index `after`, -1 for the begin. With times it is half way to the next one, or
 * at either end as far from its neighbour as this is from the one beyond.
 */
export function insertedAfter(request: PlanRequest, after: number, pose: Pose): Insertion {
  const index = Math.max(0, Math.min(request.keyframes.length, after + 1));
  const timed = isTimed(request) ? { time: timeBetween(timesOf(request), index) } : {};
  return insertion(request, index, { position: pose.position, orientation: pose.orientation, ...timed });
}

function insertion(request: PlanRequest, index: number, keyframe: Keyframe): Insertion {
  return { request: { ...request, keyframes: spliced(request.keyframes, index, 0, keyframe) }, index };
}

function timeBetween(times: readonly number[], index: number): number {
  const before = times[index - 1];
  const after = times[index];
  if (before !== undefined && after !== undefined) return before + (after - before) / 2;
  if (before !== undefined) return before + (before - (times[index - 2] ?? before - 1));
  if (after !== undefined) return after - ((times[index + 1] ?? after + 1) - after);
  return 0;
}

export function withoutKeyframe(request: PlanRequest, index: number): PlanRequest | Refusal {
  if (!request.keyframes[index]) return request;
  if (request.keyframes.length <= kLeastKeyframes) {
    return { refused: `A path needs ${kLeastKeyframes} keyframes, so the last ${kLeastKeyframes} stay.` };
  }
  return { ...request, keyframes: spliced(request.keyframes, index, 1) };
}

/** Sets an option by the path of its name, or takes it away with `undefined`, together with objects left empty. */
export function withOption(request: PlanRequest, path: readonly string[], value: unknown): PlanRequest {
  const old = request.options ?? {};
  const options = withMember(old, path, value);
  if (options === old) return request;
  if (Object.keys(options).length > 0) return { ...request, options };
  const { options: _, ...rest } = request;
  return rest as PlanRequest;
}

function withMember(options: Options, path: readonly string[], value: unknown): Options {
  const [name, ...rest] = path;
  if (name === undefined) return options;
  const old = options[name];
  let next = value;
  if (rest.length > 0) {
    const inner = isObject(old) ? old : {};
    next = withMember(inner, rest, value);
    if (next === inner) return options;
    if (Object.keys(next as Options).length === 0) next = undefined;
  }
  if (next === undefined) {
    if (!(name in options)) return options;
    const { [name]: _, ...others } = options;
    return others;
  }
  return isSame(old, next) ? options : { ...options, [name]: next };
}

export function optionAt(request: PlanRequest | undefined, path: readonly string[]): unknown {
  let value: unknown = request?.options;
  for (const name of path) value = isObject(value) ? value[name] : undefined;
  return value;
}

export function withCamera(request: PlanRequest, camera: Partial<Camera>): PlanRequest {
  if (!request.camera) return request;
  const next = { ...request.camera, ...camera };
  return isSame(next, request.camera) ? request : { ...request, camera: next };
}

/**
 * The request for editing an answer: docs/requests.md, "Editing an answer". The camera is the one that was proved:
 * smaller, if it was shrunk. With a slowed path the keyframes stay and the frame goes, as the answer has none.
 */
export function withAnswer(request: PlanRequest, answer: Answer): PlanRequest {
  const { frame: _, ...rest } = request;
  const keyframes = answer.keyframes.map((keyframe) => ({ ...keyframe }));
  const edited: PlanRequest = { ...rest, keyframes };
  if (answer['frame'] !== undefined) edited.frame = answer['frame'];
  if (request.camera && answer.near_scale !== undefined) {
    edited.camera = { ...request.camera, near: request.camera.near * answer.near_scale };
  }
  return withOption(edited, [kDefaultSpeed], undefined);
}

/** A copy of `list` without `count` items from `index` on, and with `added` in their place. */
function spliced<Item>(list: readonly Item[], index: number, count: number, ...added: Item[]): Item[] {
  const copy = [...list];
  copy.splice(index, count, ...added);
  return copy;
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

function isSame(a: unknown, b: unknown): boolean {
  return a === b || JSON.stringify(a) === JSON.stringify(b);
}
