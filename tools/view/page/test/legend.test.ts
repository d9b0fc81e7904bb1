// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer } from '../src/contract/answer.js';
import { kindsIn } from '../src/legend.js';
import { Random } from './random.js';

const answerOf = (members: object): Answer =>
  ({ status: 'ok', message: '', segments: [], keyframes: [], collisions: [], remaining_collisions: [], ...members }) as unknown as Answer;

test('the legend names what is drawn of a path', () => {
  const path = new Random('legend').path(3);
  const corrections = [{ kind: 'move' }];
  assert.deepEqual(kindsIn({ answer: undefined, before: path }), ['before']);
  assert.deepEqual(kindsIn({ answer: answerOf({ status: 'infeasible', infeasibility: {} }), before: path }), ['before', 'infeasible']);
  assert.deepEqual(kindsIn({ answer: answerOf({ status: 'invalid' }), before: [] }), []);
  assert.deepEqual(kindsIn({ answer: answerOf({ segments: path, certificate: { certified: true } }), before: path }), ['after']);
  assert.deepEqual(kindsIn({ answer: answerOf({ segments: path, corrections }), before: path }), ['before', 'corrected']);
});
