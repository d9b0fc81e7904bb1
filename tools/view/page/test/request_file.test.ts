// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import type { PlanRequest } from '../src/contract/request.js';
import { answerText, readRequest, requestText } from '../src/model/request_file.js';
import { Random } from './random.js';

const kScenes = `${process.env['CAMWAY_SOURCE']}/scenes/requests`;

function read(text: string): PlanRequest {
  const result = readRequest(text);
  assert.ok('request' in result, 'error' in result ? result.error : '');
  return result.request;
}

function errorOf(json: unknown): string {
  const result = readRequest(typeof json === 'string' ? json : JSON.stringify(json));
  assert.ok('error' in result, 'this was read');
  return result.error;
}

const kKeyframe = { position: [0, 0, 0], orientation: [1, 0, 0, 0] };

test('requests are read from text as they were written, to the last bit', () => {
  const random = new Random('text');
  for (let round = 0; round < 200; ++round) {
    const request = random.request(2 + random.below(6));
    request.options = { limits: { speed_m_per_s: 10 ** random.number(-12, 12) }, comment: 'quotes " and \\ and é' };
    if (request.keyframes[0]) request.keyframes[0].position = [-0, 5e-324, 1e9];
    const again = read(requestText(request));
    assert.deepEqual(again, request);
    assert.ok(Object.is(again.keyframes[0]?.position[0], -0));
  }
});

test('all request files of the project are read and written as they are', () => {
  const names = readdirSync(kScenes).filter((name) => name.endsWith('.json'));
  assert.ok(names.length > 20);
  for (const name of names) {
    const text = readFileSync(`${kScenes}/${name}`, 'utf8');
    assert.deepEqual(JSON.parse(requestText(read(text))), JSON.parse(text), name);
  }
});

test('a request is written with a line for each keyframe', () => {
  const text = requestText({ scene: 'a.obj', keyframes: [kKeyframe, kKeyframe] as PlanRequest['keyframes'] });
  const line = '    {"position": [0, 0, 0], "orientation": [1, 0, 0, 0]}';
  assert.equal(text, `{\n  "scene": "a.obj",\n  "keyframes": [\n${line},\n${line}\n  ]\n}\n`);
});

test('an answer is written so that JSON reads the same', () => {
  const answer = { status: 'ok' as const, message: 'a', segments: new Random('answer').path(3), keyframes: [], collisions: [], remaining_collisions: [] };
  assert.deepEqual(JSON.parse(answerText(answer)), answer);
});

test('errors say what is wrong and where', () => {
  assert.match(errorOf('{"a": }'), /^This file is not JSON/);
  assert.match(errorOf('[]'), /must be a JSON object/);
  assert.match(errorOf({}), /"keyframes"/);
  assert.match(errorOf({ status: 'ok', segments: [], keyframes: [] }), /is an answer/);
  assert.match(errorOf({ keyframes: [kKeyframe] }), /2 to 100000 keyframes, and this one has 1/);
  assert.match(errorOf({ keyframes: [kKeyframe, { position: [0, 0], orientation: [1, 0, 0, 0] }] }), /"position" of keyframe 1/);
  assert.match(errorOf({ keyframes: [kKeyframe, { position: [0, 0, null], orientation: [1, 0, 0, 0] }] }), /"position" of keyframe 1/);
  assert.match(errorOf({ keyframes: [{ ...kKeyframe, orientation: [0, 0, 0, 0] }, kKeyframe] }), /keyframe 0 is zero/);
  assert.match(errorOf({ keyframes: [{ ...kKeyframe, position: [2e9, 0, 0] }, kKeyframe] }), /Keyframe 0 is farther/);
  assert.match(errorOf({ keyframes: [{ ...kKeyframe, time: 0 }, kKeyframe] }), /keyframe 1 has none/);
  assert.match(errorOf({ keyframes: [{ ...kKeyframe, time: 1 }, { ...kKeyframe, time: 1 }] }), /Keyframe 1 must be later/);
  assert.match(errorOf({ keyframes: [kKeyframe, kKeyframe], camera: { fov_x_deg: 80, fov_y_deg: 60 } }), /"near" of the camera/);
  assert.match(errorOf({ keyframes: [kKeyframe, kKeyframe], options: [] }), /"options"/);
});

test('old names and the other order of quaternions are read', () => {
  const request = read(
    JSON.stringify({
      keyframes: [kKeyframe, { position: [1, 2, 3], orientation_xyzw: [0.1, 0.2, 0.3, 0.4] }],
      options: { clearance: 0.1, limits: { speed: 1, turn_rate_deg: 30 } },
      _note: 'kept',
    }),
  );
  assert.deepEqual(request.keyframes[1], { position: [1, 2, 3], orientation: [0.4, 0.1, 0.2, 0.3] });
  assert.deepEqual(request.options, { clearance_m: 0.1, limits: { speed_m_per_s: 1, turn_rate_deg_per_s: 30 } });
  assert.equal(request['_note'], 'kept');
});

test('random damage is read or refused with a sentence, and never thrown', () => {
  const random = new Random('damage');
  const text = requestText(random.request(4));
  for (let round = 0; round < 5000; ++round) {
    const at = random.below(text.length);
    const damaged = text.slice(0, at) + '[]{}",:0-e'.charAt(random.below(10)) + text.slice(at + random.below(3));
    const result = readRequest(damaged);
    if ('error' in result) assert.match(result.error, /\.$/);
  }
});
