// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { compareCells } from '../../src/report/order.js';
import { Random } from '../random.js';

test('numbers are sorted by their size, and texts as people do', () => {
  const number = (value: number): { text: string; number: number } => ({ text: 'x', number: value });
  const text = (words: string): { text: string; number: undefined } => ({ text: words, number: undefined });
  const random = new Random('cells');
  for (let round = 0; round < 200; ++round) {
    const [a, b] = [random.number(-9, 9), random.number(-9, 9)];
    assert.equal(Math.sign(compareCells(number(a), number(b))), Math.sign(a - b));
  }
  assert.ok(compareCells(number(9), number(10)) < 0);
  assert.ok(compareCells(text('better'), text('worse')) < 0);
  assert.equal(compareCells(text('a'), text('a')), 0);
});
