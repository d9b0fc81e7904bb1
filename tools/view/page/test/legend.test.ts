// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer } from '../src/contract/answer.js';
import type { Compared } from '../src/contract/door.js';
import { kindsIn, nameOf } from '../src/legend.js';
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

test('the legend names the paths of two answers by the answers, and collisions that are drawn', () => {
  const path = new Random('legend').path(3);
  const collided = [{ t_begin: 0, t_end: 1 }];
  const compared = (members: object): Compared => ({ name: 'now', otherName: 'recorded', other: answerOf(members) });
  const proved = answerOf({ segments: path, certificate: { certified: true }, collisions: collided });
  assert.deepEqual(kindsIn({ answer: proved, before: path, compared: compared({ segments: path }) }), ['after', 'before']);
  assert.deepEqual(kindsIn({ answer: proved, before: path, compared: compared({}) }), ['after']);
  const colliding = compared({ segments: path, remaining_collisions: collided });
  assert.deepEqual(kindsIn({ answer: answerOf({ segments: path }), before: path, compared: colliding }), ['unproved', 'before', 'collision']);
  const names = (['after', 'before', 'unproved', 'collision'] as const).map((kind) => nameOf(kind, colliding));
  assert.deepEqual(names, ['now', 'recorded', 'now, not proved', 'collision']);
  assert.equal(nameOf('before', undefined), 'path as interpolated');
});
