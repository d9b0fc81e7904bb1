// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { PlanRequest } from '../src/contract/request.js';
import { optionFault, withoutFault } from '../src/model/option_fault.js';

const kNegative = 'request: options.limits.speed_m_per_s: is -2; it must be above 0';

test('the option that a refusal names is found, with what is wrong', () => {
  assert.deepEqual(optionFault(kNegative), { path: ['limits', 'speed_m_per_s'], words: 'is -2; it must be above 0' });
  assert.equal(optionFault('request: keyframes[0].position: is missing'), undefined);
  assert.equal(optionFault(''), undefined);
});

test('a refused option is left out alone, and what lacks a member as a whole', () => {
  const request: PlanRequest = { keyframes: [], options: { seed: 3, limits: { speed_m_per_s: -2, retime: true }, orientation: { policy: 'target' } } };
  assert.deepEqual(withoutFault(request, kNegative)?.options, { seed: 3, limits: { retime: true }, orientation: { policy: 'target' } });
  assert.deepEqual(withoutFault(request, 'request: options.orientation.target: is missing')?.options, { seed: 3, limits: { speed_m_per_s: -2, retime: true } });
  assert.equal(withoutFault(request, 'request: options.clearance_m: is -1'), undefined);
  assert.equal(withoutFault(request, 'busy'), undefined);
});
