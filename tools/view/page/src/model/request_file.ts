// SPDX-License-Identifier: MIT
//
// Request files as text. Reading checks the shape that the page needs; Camway checks the rest, and its sentences
// name the field. Members that the page does not know are kept.

import type { Answer } from '../contract/answer.js';
import type { Keyframe, Options, PlanRequest, Quat, Vec3 } from '../contract/request.js';

const kMostKeyframes = 100_000;
const kLeastKeyframes = 2;
const kMostCoordinate_m = 1e9;

/** Names of the first release and those of today. */
const kOldOptions: readonly (readonly [string, string])[] = [['clearance', 'clearance_m']];
const kOldLimits: readonly (readonly [string, string])[] = [
  ['speed', 'speed_m_per_s'],
  ['acceleration', 'acceleration_m_per_s2'],
  ['turn_rate_deg', 'turn_rate_deg_per_s'],
];

export type ReadRequest = { request: PlanRequest } | { error: string };

class ShapeError extends Error {}

/** Reads the text of a request file. The error is one sentence for people. */
export function readRequest(text: string): ReadRequest {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch (error) {
    return { error: `This file is not JSON: ${(error as Error).message}.` };
  }
  try {
    return { request: requestOf(json) };
  } catch (error) {
    if (error instanceof ShapeError) return { error: error.message };
    throw error;
  }
}

function requestOf(json: unknown): PlanRequest {
  const object = objectOf(json, 'A request file');
  if ('status' in object && 'segments' in object) {
    throw new ShapeError('This file is an answer. Open the request that it answers.');
  }
  const list = object['keyframes'];
  if (!Array.isArray(list)) throw new ShapeError('A request has a member "keyframes", which is a list.');
  if (list.length < kLeastKeyframes || list.length > kMostKeyframes) {
    throw new ShapeError(`A request has ${kLeastKeyframes} to ${kMostKeyframes} keyframes, and this one has ${list.length}.`);
  }
  const keyframes = list.map(keyframeOf);
  checkTimes(keyframes);
  const request: PlanRequest = { ...object, keyframes };
  if ('camera' in object) checkCamera(object['camera']);
  if ('options' in object) request.options = optionsOf(object['options']);
  return request;
}

function keyframeOf(json: unknown, index: number): Keyframe {
  const name = `Keyframe ${index}`;
  const { orientation_xyzw, ...object } = objectOf(json, name);
  if (orientation_xyzw !== undefined) {
    const [x, y, z, w] = numbersOf(orientation_xyzw, 4, `"orientation_xyzw" of keyframe ${index}`) as Quat;
    object['orientation'] = [w, x, y, z];
  }
  const position = numbersOf(object['position'], 3, `"position" of keyframe ${index}`) as Vec3;
  if (position.some((x) => Math.abs(x) > kMostCoordinate_m)) {
    throw new ShapeError(`${name} is farther than ${kMostCoordinate_m} m from the origin.`);
  }
  const orientation = numbersOf(object['orientation'], 4, `"orientation" of keyframe ${index}`) as Quat;
  if (orientation.every((x) => x === 0)) throw new ShapeError(`"orientation" of keyframe ${index} is zero.`);
  if ('time' in object) numberOf(object['time'], `"time" of keyframe ${index}`);
  return { ...object, position, orientation };
}

function checkTimes(keyframes: readonly Keyframe[]): void {
  const timed = keyframes.filter((keyframe) => keyframe.time !== undefined).length;
  if (timed === 0) return;
  if (timed < keyframes.length) {
    const without = keyframes.findIndex((keyframe) => keyframe.time === undefined);
    throw new ShapeError(`All keyframes have a "time" or none has; keyframe ${without} has none.`);
  }
  const late = keyframes.findIndex((keyframe, i) => i > 0 && !((keyframes[i - 1] as Keyframe).time! < keyframe.time!));
  if (late > 0) throw new ShapeError(`Keyframe ${late} must be later than keyframe ${late - 1}.`);
}

function checkCamera(json: unknown): void {
  const camera = objectOf(json, '"camera"');
  for (const name of ['fov_x_deg', 'fov_y_deg', 'near']) {
    if (!(numberOf(camera[name], `"${name}" of the camera`) > 0)) throw new ShapeError(`"${name}" of the camera must be above 0.`);
  }
}

function optionsOf(json: unknown): Options {
  const options = renamed(objectOf(json, '"options"'), kOldOptions);
  const limits = options['limits'];
  return limits === undefined ? options : { ...options, limits: renamed(objectOf(limits, '"limits"'), kOldLimits) };
}

/** `object` with today's names. One that has a member by both names keeps both, and Camway refuses it. */
function renamed(object: Record<string, unknown>, names: readonly (readonly [string, string])[]): Options {
  const today = new Map(names.filter(([old, now]) => old in object && !(now in object)));
  return Object.fromEntries(Object.entries(object).map(([name, value]) => [today.get(name) ?? name, value]));
}

function objectOf(json: unknown, name: string): Record<string, unknown> {
  if (typeof json !== 'object' || json === null || Array.isArray(json)) throw new ShapeError(`${name} must be a JSON object.`);
  return json as Record<string, unknown>;
}

function numberOf(json: unknown, name: string): number {
  if (typeof json !== 'number' || !Number.isFinite(json)) throw new ShapeError(`${name} must be a number.`);
  return json;
}

function numbersOf(json: unknown, count: number, name: string): number[] {
  const isRight = Array.isArray(json) && json.length === count && json.every((x) => typeof x === 'number' && Number.isFinite(x));
  if (!isRight) throw new ShapeError(`${name} must be a list of ${count} numbers.`);
  return json as number[];
}

/** The text of a request file: a line for each member and for each keyframe. Reading it gives the same numbers. */
export function requestText(request: PlanRequest): string {
  return linesOf(request, new Set(['keyframes']));
}

/** The text of an answer file: a line for each member, and for each item of its lists. */
export function answerText(answer: Answer): string {
  const lists = Object.entries(answer).filter(([, value]) => Array.isArray(value) && typeof value[0] === 'object');
  return linesOf(answer, new Set(lists.map(([name]) => name)));
}

function linesOf(object: object, lists: ReadonlySet<string>): string {
  const members = Object.entries(object)
    .filter(([, value]) => value !== undefined)
    .map(([name, value]) => {
      const isList = lists.has(name) && Array.isArray(value) && value.length > 0;
      const text = isList ? `[\n${(value as unknown[]).map((item) => `    ${inline(item)}`).join(',\n')}\n  ]` : inline(value);
      return `  ${JSON.stringify(name)}: ${text}`;
    });
  return `{\n${members.join(',\n')}\n}\n`;
}

/** JSON on one line, with a space after each comma and colon. */
function inline(value: unknown): string {
  if (Array.isArray(value)) return `[${value.map(inline).join(', ')}]`;
  if (typeof value === 'object' && value !== null) {
    const members = Object.entries(value).filter(([, member]) => member !== undefined);
    return `{${members.map(([name, member]) => `${JSON.stringify(name)}: ${inline(member)}`).join(', ')}}`;
  }
  if (typeof value === 'number' && Object.is(value, -0)) return '-0.0';
  return JSON.stringify(value ?? null);
}
