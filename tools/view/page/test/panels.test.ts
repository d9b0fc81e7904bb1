// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import type { Answer, Correction } from '../src/contract/answer.js';
import type { Field } from '../src/contract/door.js';
import { counted, lowerBoundText, numberText, positionText, timeText, withUnit } from '../src/model/format.js';
import * as words from '../src/panels/answer_words.js';
import { numberOf } from '../src/panels/inputs.js';
import { fieldGroups, labelOf, unitOf } from '../src/panels/option_fields.js';
import { isWithin, rangeOf, wrongText } from '../src/panels/ranges.js';
import { Random } from './random.js';

const kRequests = readFileSync(`${process.env['CAMWAY_SOURCE']}/docs/requests.md`, 'utf8');

test('every range of the table of options is read', () => {
  const rows = [...kRequests.matchAll(/^\| `(\w+)` \| .* \| ([^|]+) \| [^|]+ \|$/gm)];
  const ranges = rows.map((row) => [row[1] as string, (row[2] as string).trim()] as const).filter(([, range]) => range !== '' && range !== 'range');
  assert.ok(ranges.length >= 9, `${ranges.length} ranges`);
  for (const [name, text] of ranges) {
    const range = rangeOf(text);
    assert.ok(range, `${name}: ${text}`);
    const numbers = [...text.matchAll(/[0-9.e+-]*[0-9]/g)].map(([number]) => Number(number));
    assert.deepEqual([range.least, range.most].filter(Number.isFinite), numbers, text);
  }
});

test('the ends of ranges count as the words say', () => {
  const within = (text: string, ...values: number[]): boolean[] => values.map((value) => isWithin(rangeOf(text), value));
  assert.deepEqual(within('from 0 to 1e+09', -1, 0, 1e9, 1.1e9), [false, true, true, false]);
  assert.deepEqual(within('above 0 and at most 2', 0, 1e-9, 2, 3), [false, true, true, false]);
  assert.deepEqual(within('at least 0 and below 1', 0, 0.99, 1), [true, true, false]);
  assert.deepEqual(within('between 0 and 180°', 0, 180, 181), [true, true, false]);
  assert.deepEqual(within('at least 1e-05 and finite', 1e-5, 1e300, Infinity), [true, true, false]);
  assert.deepEqual(within('as you like', 5, Number.NaN), [true, false]);
});

test('options are named for people', () => {
  const names = ['clearance_m', 'acceleration_m_per_s2', 'turn_rate_deg_per_s', 'seed', 'max_inserted_keyframes'];
  assert.deepEqual(names.map((name) => labelOf(name)), ['Clearance, m', 'Acceleration, m/s²', 'Turn rate, °/s', 'Seed', 'Max inserted keyframes']);
  assert.equal(labelOf('max_shrink', '%'), 'Max shrink, %');
});

test('a field out of its range says the range', () => {
  assert.equal(wrongText(rangeOf('above 0 and at most 2')), 'This must be a number, above 0 and at most 2.');
  assert.equal(wrongText(rangeOf('at least 1'), true), 'This must be a whole number, at least 1 and at most 9007199254740991.');
  assert.equal(wrongText(undefined), 'This must be a number.');
});

test('numbers are read as people write them', () => {
  assert.equal(numberOf(' 0,5 '), 0.5);
  assert.equal(numberOf('1e-3'), 1e-3);
  assert.equal(numberOf(''), undefined);
  for (const wrong of ['1,2,3', '1.000,5', 'five', '0x']) assert.ok(Number.isNaN(numberOf(wrong)), wrong);
});

test('numbers are written with three digits and no needless exponent', () => {
  assert.deepEqual([0, 0.0094553, 9.2, 18.372, 1234.5, -0.05].map((x) => numberText(x)), ['0', '0.00946', '9.20', '18.4', '1235', '−0.0500']);
  assert.equal(numberText(1.5e-7), '1.50e−7');
  assert.equal(numberText(Number.NaN), '–');
  assert.equal(withUnit(22.14, '°'), '22.1°');
  assert.equal(withUnit(2, 'm/s'), '2.00 m/s');
  assert.equal(counted(1, 'triangle'), '1 triangle');
  assert.equal(counted(28612, 'triangle'), '28,612 triangles');
  assert.equal(timeText(1.7e9 + 2.5, 1.7e9), '+2.50');
  assert.equal(timeText(2.5, 0), '2.50');
  assert.equal(positionText(101, 100, 103.5), '101.00 / 103.50 s');
  assert.equal(positionText(1.7e9 + 2.5, 1.7e9, 1.7e9 + 4), '+2.50 / +4.00 s');
});

test('a proved lower bound is never rounded up', () => {
  const random = new Random('bounds');
  for (let round = 0; round < 2000; ++round) {
    const value = 10 ** random.number(-4, 3);
    const shown = Number(lowerBoundText(value));
    assert.ok(shown <= value && shown > value * 0.989, `${value}: ${shown}`);
  }
  assert.deepEqual([0, 0.06089, 0.009, 0.3, 100].map((x) => lowerBoundText(x)), ['0', '0.0608', '0.00900', '0.300', '100']);
});

test('every option of the door has a field, and members count where they are used', () => {
  const fields: Field[] = [
    { name: 'clearance_m', type: 'number', help: '`a`', range: 'from 0 to 1e+09', default: 0, unit: 'm' },
    { name: 'seed', type: 'count', help: '', default: 1 },
    { name: 'later', type: 'object', help: 'an option of a later release' },
    {
      name: 'orientation',
      type: 'object',
      help: '',
      fields: [
        { name: 'policy', type: 'choice', help: '', default: 'free', choices: ['free', 'keep', 'level', 'target'] },
        { name: 'up', type: 'vector', help: '', default: [0, 1, 0] },
        { name: 'cone_deg', type: 'number', help: '', unit: '°' },
      ],
    },
  ];
  const groups = fieldGroups(fields);
  assert.deepEqual(groups.map(({ name }) => name), fields.map(({ name }) => name));
  assert.deepEqual(groups.map(({ fields: [first] }) => first?.control), ['number', 'whole', 'json', 'choice']);
  assert.equal(groups[0]?.help, 'a');
  assert.equal(groups[0]?.fields[0]?.unset, '0');
  const used = (policy: string): string[] => {
    const request = { keyframes: [], options: { orientation: { policy } } };
    return groups[3]?.fields.filter((field) => field.isUsed(request)).map((field) => field.path.join('.')) ?? [];
  };
  assert.deepEqual(used('level'), ['orientation.policy', 'orientation.up']);
  assert.deepEqual(used('target'), ['orientation.policy', 'orientation.cone_deg']);
  assert.equal(unitOf('turn_rate_deg_per_s'), '°/s');
  assert.equal(unitOf('acceleration_m_per_s2'), 'm/s²');
});

const kCorrection: Correction = { t_begin: 1, t_end: 2, kind: 'move', changed: [0, 3], moved_m: 0.052, turned_deg: 0, largest_shift_deg: 0.7, mean_shift_deg: 0.1 };

test('corrections, and what was tried, are told in words', () => {
  assert.equal(words.correctionText(kCorrection), 'moved, at most 0.0520 m; shift up to 0.700°');
  assert.equal(words.correctionText({ ...kCorrection, kind: 'turn', moved_m: 0, turned_deg: 3 }), 'turned, at most 3.00°; shift up to 0.700°');
  const tried = { directions: 28, paths: 1, lattice_points: 100, tree_samples: 0 };
  assert.equal(words.correctionText({ ...kCorrection, kind: 'none', tried }), 'not corrected; tried 28 directions, 1 changed path, 100 places on a way round');
});

test('both proofs are told in words, with keyframes counted from 0', () => {
  const surface = words.infeasibilityWords({ keyframe_inside: 0, keyframe_outside: 1, triangles: [1, 2, 3] }).join(' ');
  assert.match(surface, /^Keyframe 0 is inside a closed surface of 3 triangles of the scene, keyframe 1 is outside of it\./);
  const cage = { orientation: [1, 0, 0, 0], min: [0, 0, 0], max: [1, 2, 3], widest_hole_m: 0.05, shortest_chord_m: 0.1 };
  const holes = words.infeasibilityWords({ keyframe_inside: 2, keyframe_outside: 0, triangles: [], cage }).join(' ');
  assert.match(holes, /a box of 1\.00 × 2\.00 × 3\.00 m/);
  assert.match(holes, /at most 0\.0500 m wide, and the body is at least 0\.100 m wide/);
});

test('the times of an answer are those of its total: reading the scene is none', () => {
  const answer = { timing_ms: { load_scene: 120, motion: 0.1, correct: 0.6, total: 0.7 } } as unknown as Answer;
  assert.deepEqual(words.stageTimes(answer).map(({ stage }) => stage), ['interpolate', 'correct']);
  assert.deepEqual(words.stageTimes(undefined), []);
});

test('every status has words and a symbol of its own', () => {
  const statuses = ['ok', 'partial', 'infeasible', 'timeout', 'invalid', 'internal_error'] as const;
  assert.equal(new Set(statuses.map((status) => words.statusWords(status).symbol)).size, statuses.length);
});
