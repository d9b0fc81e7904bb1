// SPDX-License-Identifier: MIT
//
// Rules that hold for the text of the page's sources.

import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { clearanceColour, kGivenKeyframe, kNames, kPalette } from '../src/model/palette.js';

const kSource = process.env['CAMWAY_SOURCE'] as string;
const kPage = `${kSource}/tools/view/page/src`;
const kDrawn = `${kSource}/tools/drawing/palette.h`;

test('names from files are text: no source parses HTML or runs text as code', () => {
  const names = readdirSync(kPage, { recursive: true }).filter((name) => name.endsWith('.ts'));
  assert.ok(names.length > 20);
  for (const name of names) {
    const text = readFileSync(`${kPage}/${name}`, 'utf8');
    assert.ok(!/\b(innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval|new Function|DOMParser|createContextualFragment)\b/.test(text), name);
  }
});

test('colours and names are those of camway draw', { skip: existsSync(kDrawn) ? false : 'tools/drawing/palette.h is missing' }, () => {
  const text = readFileSync(kDrawn, 'utf8');
  const shared: Record<string, string> = { ...kPalette, given: kGivenKeyframe.light };
  for (const [name, said] of Object.entries(kNames)) {
    const constant = `k${name.charAt(0).toUpperCase()}${name.slice(1)}`;
    const colour = new RegExp(`Color ${constant} = rgb\\(0x([0-9A-F]{6})\\)`).exec(text)?.[1];
    assert.equal(`#${colour}`, shared[name]?.toUpperCase(), `the colour ${constant}`);
    const drawn = new RegExp(`string_view ${constant} = "([^"]*)"`).exec(text)?.[1];
    assert.equal(drawn, said, `the name ${constant}`);
  }
});

test('the colour of the clearance goes from vermillion over yellow to blue', () => {
  const hex = (colour: readonly number[]): string => `#${colour.map((x) => Math.round(x * 255).toString(16).padStart(2, '0')).join('')}`.toUpperCase();
  assert.equal(hex(clearanceColour(0, 1)), kPalette.clearanceLow);
  assert.equal(hex(clearanceColour(0.5, 1)), kPalette.clearanceMiddle);
  assert.equal(hex(clearanceColour(1, 1)), kPalette.clearanceHigh);
  assert.equal(hex(clearanceColour(100, 1)), kPalette.clearanceHigh);
  assert.equal(hex(clearanceColour(Number.NaN, 1)), kPalette.clearanceLow);
  for (let k = 0; k < 1000; ++k) {
    const [a, b] = [clearanceColour(k / 1000, 1), clearanceColour((k + 1) / 1000, 1)];
    a.forEach((x, i) => assert.ok(Math.abs(x - (b[i] as number)) < 0.002 && x >= 0 && x <= 1, 'it has no jump'));
  }
});
