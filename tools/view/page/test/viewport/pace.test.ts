// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { paceOf } from '../../src/viewport/pace.js';

test('the pace is that of people in rooms, and follows the size of other scenes', () => {
  assert.equal(paceOf(12).speed_m_per_s, paceOf(5).speed_m_per_s);
  for (let radius_m = 0.01; radius_m < 1e4; radius_m *= 1.1) {
    const [here, further] = [paceOf(radius_m), paceOf(1.1 * radius_m)];
    assert.ok(here.speed_m_per_s > 0 && further.speed_m_per_s >= here.speed_m_per_s && further.step_m >= here.step_m);
    assert.ok(further.speed_m_per_s / here.speed_m_per_s < 1.1 + 1e-9, 'it has no jump');
  }
  assert.ok(paceOf(400).speed_m_per_s > 10 && paceOf(0.5).speed_m_per_s < 0.2);
});
