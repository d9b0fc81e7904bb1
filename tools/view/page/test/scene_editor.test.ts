// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SceneEditor } from '../src/door/scene_editor.js';
import type { Pose } from '../src/model/actions.js';

const poseAt = (x: number): Pose => ({ position: [x, 0, 0], orientation: [1, 0, 0, 0] });

/** Resolves once `condition` holds. */
async function until(condition: () => boolean): Promise<void> {
  while (!condition()) await new Promise((done) => setTimeout(done, 1));
}

test('a move that does not reach the door is sent when it is back, the newest of an object alone', async () => {
  const sent: string[] = [];
  const said: string[] = [];
  let isThere = false;
  globalThis.fetch = (place, options) => {
    if (!isThere) return Promise.reject(new TypeError('Failed to fetch'));
    sent.push(`${String(place)} ${JSON.parse(String(options?.body)).position[0]}`);
    return Promise.resolve(new Response('{}'));
  };
  const editor = new SceneEditor(() => 'office', () => undefined, (sentence) => said.push(sentence));
  editor.move('box', poseAt(1));
  await until(() => said.length === 1);
  editor.move('box', poseAt(2));
  await until(() => said.length === 2);
  isThere = true;
  editor.resume();
  await until(() => sent.length > 0);
  await new Promise((done) => setTimeout(done, 0));
  editor.resume();
  assert.deepEqual(sent, ['/v1/scenes/office/objects/box 2']);
});

test('a move that the door refuses is not sent again, and the scene is looked at anew', async () => {
  let asked = 0;
  let changed = 0;
  const said: string[] = [];
  globalThis.fetch = () => {
    ++asked;
    return Promise.resolve(new Response('{"error": "read only"}', { status: 403 }));
  };
  const editor = new SceneEditor(() => 'office', () => ++changed, (sentence) => said.push(sentence));
  editor.move('box', poseAt(1));
  await until(() => changed === 1);
  editor.resume();
  assert.deepEqual([asked, said], [1, ['read only']]);
});

test('an object is removed after the move of it that is under way, and not moved after that', async () => {
  const sent: string[] = [];
  let answer: () => void = () => undefined;
  globalThis.fetch = (_, options) => {
    sent.push(String(options?.method));
    return new Promise((done) => (answer = () => done(new Response('{}'))));
  };
  const said: string[] = [];
  const editor = new SceneEditor(() => 'office', () => undefined, (sentence) => said.push(sentence));
  editor.move('box', poseAt(1));
  editor.move('box', poseAt(2));
  editor.remove('box');
  await new Promise((done) => setTimeout(done, 0));
  assert.deepEqual(sent, ['PATCH']);
  answer();
  await until(() => sent.length === 2);
  answer();
  await new Promise((done) => setTimeout(done, 100)); // longer than the pause between moves
  assert.deepEqual([sent, said], [['PATCH', 'DELETE'], []]);
});
