// SPDX-License-Identifier: MIT
// The validator of the Khronos Group finds nothing to say about glTF files that `camway export` writes.
import assert from 'node:assert/strict';
import test from 'node:test';

import {load, plan} from './camway.mjs';

const validator = load('gltf-validator');

async function issues_of(bytes) {
  const report = await validator.validateBytes(new Uint8Array(bytes), {maxIssues: 0});
  assert.equal(report.info.animationCount, 1);
  return report.issues;
}

for (const name of ['office-graze-column', 'office-graze-door']) {
  const planned = plan(name);
  for (const keys of ['dense', 'sparse']) {
    for (const extension of ['glb', 'gltf']) {
      test(`${name}, ${keys}, .${extension}`, async () => {
        const bytes = planned.write(`shot.${extension}`, '--format', 'gltf', '--keys', keys);
        assert.equal(bytes.subarray(0, 4).toString(), extension === 'glb' ? 'glTF' : '{"as');
        assert.equal(bytes.includes('CUBICSPLINE'), keys === 'sparse');
        const issues = await issues_of(bytes);
        assert.deepEqual(issues.messages, []);
        assert.equal(issues.numErrors + issues.numWarnings + issues.numInfos + issues.numHints, 0);
      });
    }
  }
}

test('a fault is found', async () => {
  const text = plan('office-graze-door').write('fault.gltf', '--format', 'gltf').toString();
  const issues = await issues_of(Buffer.from(text.replace('"VEC4"', '"VEC3"')));
  assert.ok(issues.numErrors > 0);
});
