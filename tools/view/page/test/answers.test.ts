// SPDX-License-Identifier: MIT
//
// The page against answers of the built program, which CAMWAY names: what the page computes of a path must be what
// the answer says of it.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { test } from 'node:test';
import type { Answer } from '../src/contract/answer.js';
import type { Options, PlanRequest } from '../src/contract/request.js';
import { Curves } from '../src/model/curves.js';
import { insertedAt, withAnswer, withOption } from '../src/model/edits.js';
import { beginOf, endOf, motionAt, motionIn } from '../src/model/path.js';
import { readRequest, requestText } from '../src/model/request_file.js';
import { timesOf, timesOnPath } from '../src/model/times.js';
import { correctionText, infeasibilityWords, stageTimes } from '../src/panels/answer_words.js';
import { bandRows, marksOf } from '../src/timeline/bands.js';

const kCamway = process.env['CAMWAY'];
const kScenes = `${process.env['CAMWAY_SOURCE']}/scenes`;
const kSkip = { skip: kCamway ? (false as const) : 'CAMWAY does not name the built program' };

function requestOf(name: string, options: Options = {}): PlanRequest {
  const read = readRequest(readFileSync(`${kScenes}/requests/${name}.json`, 'utf8'));
  assert.ok('request' in read);
  const request = { ...read.request, scene: `${kScenes}/${name.split('-')[0]}.obj` };
  return Object.entries(options).reduce((all, [option, value]) => withOption(all, [option], value), request as PlanRequest);
}

function planned(request: PlanRequest): Answer {
  const folder = mkdtempSync(`${tmpdir()}/camway-page-`);
  try {
    writeFileSync(`${folder}/request.json`, requestText(request));
    const run = spawnSync(kCamway as string, ['plan', '--request', `${folder}/request.json`, '--response', `${folder}/answer.json`], { encoding: 'utf8' });
    assert.ok(run.status === 0 || run.status === 3, run.stderr);
    return JSON.parse(readFileSync(`${folder}/answer.json`, 'utf8')) as Answer;
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** The path as interpolated: nothing is corrected. */
function interpolated(request: PlanRequest): Answer {
  return planned(withOption(request, ['max_inserted_keyframes'], 0));
}

const kNames = ['office-graze-column', 'office-graze-slalom', 'office-wall-tour', 'office-free-timed', 'maze-graze-corners'];

function isNear(value: number, expected: number, share: number): boolean {
  return Math.abs(value - expected) <= share * Math.abs(expected) + 1e-6;
}

for (const name of kNames) {
  test(`${name}: curves have the measures of the answer, and times are those derived`, kSkip, () => {
    const request = requestOf(name);
    const answer = planned(request);
    const curves = new Curves(answer.segments, interpolated(request).segments, request, answer);
    const after = answer.measures?.after ?? {};
    const largest = (curve: 'speed' | 'acceleration' | 'turn' | 'shift'): number => curves.curve(curve)?.largest ?? 0;
    assert.ok(isNear(largest('speed'), after['largest_speed_m_per_s'] as number, 0.02), 'speed');
    assert.ok(isNear(largest('acceleration'), after['largest_acceleration_m_per_s2'] as number, 0.03), 'acceleration');
    assert.ok(isNear(largest('turn'), after['largest_turn_rate_deg_per_s'] as number, 0.03), 'turn rate');
    assert.ok(isNear(largest('shift'), after['largest_shift_deg'] as number, 0.02), `shift ${largest('shift')}`);
    timesOnPath(request, answer).forEach((time_s, i) => assert.ok(isNear(time_s, timesOf(request)[i] as number, 1e-12), `time of keyframe ${i}`));
    assert.equal(marksOf({ request, answer }).length, answer.keyframes.length);
  });

  test(`${name}: the path is twice differentiable at its joints`, kSkip, () => {
    const { segments } = planned(requestOf(name));
    segments.slice(1).forEach((segment, i) => {
      const [end, begin] = [motionAt(segments, segment.t0), motionIn(segment, 0)];
      for (const member of ['position', 'velocity_m_per_s', 'acceleration_m_per_s2', 'orientation', 'turnRate_rad_per_s'] as const) {
        end?.[member].forEach((x, k) => assert.ok(Math.abs(x - (begin[member][k] as number)) < 1e-6, `${member} at joint ${i}`));
      }
    });
  });
}

test('the viewing distance that was asked for is found again from the mean shift alone', kSkip, () => {
  for (const distance_m of [1.5, 4, 9]) {
    const request = requestOf('office-graze-slalom', { viewing_distance_m: distance_m });
    const { viewing_distance_m: told, ...answer } = planned(request);
    assert.equal(told, distance_m);
    const curves = new Curves(answer.segments, interpolated(request).segments, { ...request, options: {} }, answer);
    assert.ok(isNear(curves.scale.viewingDistance_m, distance_m, 0.02), `${curves.scale.viewingDistance_m} for ${distance_m}`);
  }
});

test('a body off the eye shifts in the page as in the answer', kSkip, () => {
  const body = { type: 'box', center: [0, -1, 0], size: [0.5, 0.3, 0.2] };
  const { camera: _, ...rest } = requestOf('gallery-wall-slot', { viewing_distance_m: 2 });
  const request: PlanRequest = { ...rest, body };
  const answer = planned(request);
  assert.ok(answer.corrections?.some(({ turned_deg }) => turned_deg > 30));
  const curve = new Curves(answer.segments, interpolated(request).segments, request, answer).curve('shift');
  assert.ok(isNear(curve?.largest ?? 0, answer.measures?.after['largest_shift_deg'] as number, 0.02), `${curve?.largest}`);
});

test('an answer that is edited on plans to the same path', kSkip, () => {
  const request = requestOf('office-graze-column');
  const answer = planned(request);
  const again = planned(withAnswer(request, answer));
  assert.equal(again.status, 'ok');
  assert.equal(again.collisions.length, 0);
  for (let k = 0; k <= 50; ++k) {
    const time_s = beginOf(answer.segments) + ((endOf(answer.segments) - beginOf(answer.segments)) * k) / 50;
    const [a, b] = [motionAt(answer.segments, time_s), motionAt(again.segments, time_s)];
    a?.position.forEach((x, i) => assert.ok(Math.abs(x - (b?.position[i] as number)) < 1e-8));
  }
});

test('a keyframe that is inserted on a path is accepted', kSkip, () => {
  for (const name of ['office-graze-column', 'office-free-timed']) {
    const request = requestOf(name);
    const before = interpolated(request).segments;
    const inserted = insertedAt(request, before, beginOf(before) + 0.4 * (endOf(before) - beginOf(before)));
    assert.ok('index' in inserted);
    assert.ok(['ok', 'partial'].includes(planned(inserted.request).status));
  }
});

test('slowed, limited, partial and infeasible answers are told', kSkip, () => {
  const limits = { speed_m_per_s: 0.8, acceleration_m_per_s2: 0.6, retime: true };
  const slow = requestOf('office-graze-slalom', { limits });
  const slowed = planned(slow);
  assert.equal(bandRows(slowed).length, 3);
  const curves = new Curves(slowed.segments, interpolated(requestOf('office-graze-slalom')).segments, slow, slowed);
  assert.equal(curves.curve('speed')?.limit, 0.8);
  assert.ok((curves.curve('speed')?.largest ?? 9) <= 0.8);
  assert.ok((curves.curve('acceleration')?.largest ?? 9) <= 0.6);
  timesOf(slow).forEach((time_s, i) => assert.ok(isNear(curves.times.toPath(time_s), timesOnPath(slow, slowed)[i] as number, 1e-12)));

  const partial = interpolated(requestOf('office-graze-column'));
  assert.equal(partial.status, 'partial');
  assert.match(correctionText((partial.corrections ?? [])[0] as never), /^not corrected/);
  assert.ok(stageTimes(partial).length >= 3);

  for (const name of ['office-impossible-safe', 'office-impossible-shaft']) {
    const answer = planned(requestOf(name));
    assert.ok(answer.infeasibility);
    assert.match(infeasibilityWords(answer.infeasibility).join(' '), /^Keyframe [01] is inside a (closed surface|box) of .* keyframe [01] is outside/);
  }
});
