// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { sceneFault } from '../src/model/scene_name.js';

test('a request of another scene is told, by the stem of its file', () => {
  const fault = (scene: string | undefined, shown: string | undefined): string | undefined =>
    sceneFault({ keyframes: [], ...(scene === undefined ? {} : { scene }) }, shown);
  for (const same of ['office', '../office.obj', 'C:\\scenes\\office.glb', undefined]) assert.equal(fault(same, 'office'), undefined);
  assert.equal(fault('a.b', 'a.b'), undefined);
  assert.equal(fault('maze', undefined), undefined);
  assert.match(fault('../maze.obj', 'office') ?? '', /scene 'maze', and this page shows 'office'/);
});
