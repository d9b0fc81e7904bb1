// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SceneEditor } from '../src/door/scene_editor.js';
import type { Pose } from '../src/model/actions.js';

const poseAt = (x: number): Pose => ({ position: [x, 0, 0], orientation: [1, 0, 0, 0] });

/** An editor, and all that it tells. `shows` is called where the scene is fetched anew. */
function makeEditor(shows: () => Promise<void> = () => Promise.resolve()): { editor: SceneEditor; said: string[]; moves: () => [string, Pose][] } {
  const said: string[] = [];
  let moves: ReadonlyMap<string, Pose> = new Map();
  const editor = new SceneEditor(() => 'office', {
    onChanged: shows,
    onMoves: (now) => (moves = now),
    onError: (sentence) => said.push(sentence),
  });
  return { editor, said, moves: () => [...moves] };
}

/** Resolves once `condition` holds. */
async function until(condition: () => boolean): Promise<void> {
  while (!condition()) await new Promise((done) => setTimeout(done, 1));
}

test('a move that does not reach the door is sent when it is back, the newest of an object alone', async () => {
  const sent: string[] = [];
  const { editor, said, moves } = makeEditor();
  let isThere = false;
  globalThis.fetch = (place, options) => {
    if (!isThere) return Promise.reject(new TypeError('Failed to fetch'));
    sent.push(`${String(place)} ${JSON.parse(String(options?.body)).position[0]}`);
    return Promise.resolve(new Response('{}'));
  };
  editor.move('box', poseAt(1));
  await until(() => said.length === 1);
  editor.move('box', poseAt(2));
  await until(() => said.length === 2);
  assert.deepEqual(moves(), [['box', poseAt(2)]]);
  isThere = true;
  editor.resume();
  await until(() => sent.length > 0);
  await new Promise((done) => setTimeout(done, 0));
  editor.resume();
  assert.deepEqual([sent, moves()], [['/v1/scenes/office/objects/box 2'], []]);
});

test('a move that the door refuses is not sent again, and the scene is looked at anew', async () => {
  let asked = 0;
  let changed = 0;
  let moved: unknown;
  const { editor, said, moves } = makeEditor(() => {
    ++changed;
    moved = moves();
    return Promise.resolve();
  });
  globalThis.fetch = () => {
    ++asked;
    return Promise.resolve(new Response('{"error": "read only"}', { status: 403 }));
  };
  editor.move('box', poseAt(1));
  await until(() => changed === 1);
  editor.resume();
  assert.deepEqual([asked, said, moved], [1, ['read only'], []]);
});

test('an object is where its last move asks for until the scene has it, whatever comes of the moves before', async () => {
  const sent: number[] = [];
  globalThis.fetch = (_, options) => {
    sent.push(JSON.parse(String(options?.body)).position[0]);
    return Promise.resolve(new Response('{}'));
  };
  const shown: (() => void)[] = [];
  const { editor, moves } = makeEditor(() => new Promise((done) => shown.push(done)));
  editor.move('box', poseAt(1));
  await until(() => shown.length === 1);
  editor.move('box', poseAt(2));
  editor.move('box', poseAt(3));
  shown[0]?.();
  await new Promise((done) => setTimeout(done, 0));
  assert.deepEqual(moves(), [['box', poseAt(3)]]);
  await until(() => shown.length === 2);
  assert.deepEqual([sent, moves()], [[1, 3], [['box', poseAt(3)]]]);
  shown[1]?.();
  await new Promise((done) => setTimeout(done, 0));
  assert.deepEqual(moves(), []);
});

test('an object is removed after the move of it that is under way, and not moved after that', async () => {
  const sent: string[] = [];
  let answer: () => void = () => undefined;
  globalThis.fetch = (_, options) => {
    sent.push(String(options?.method));
    return new Promise((done) => (answer = () => done(new Response('{}'))));
  };
  const { editor, said } = makeEditor();
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
