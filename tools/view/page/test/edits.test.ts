// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer } from '../src/contract/answer.js';
import type { PlanRequest } from '../src/contract/request.js';
import * as edits from '../src/model/edits.js';
import { beginOf, endOf, poseAt } from '../src/model/path.js';
import { areApart, isTimed, timesOf } from '../src/model/times.js';
import { Random } from './random.js';

function accepted(result: PlanRequest | edits.Refusal): PlanRequest {
  assert.ok(!edits.isRefusal(result), 'refused' in result ? String(result.refused) : '');
  return result;
}

/** The rules of docs/requests.md that edits have to keep. */
function check(request: PlanRequest): void {
  assert.ok(request.keyframes.length >= 2);
  const timed = request.keyframes.filter(({ time }) => time !== undefined).length;
  assert.ok(timed === 0 || timed === request.keyframes.length, 'times in all keyframes or in none');
  timesOf(request).reduce((earlier, later) => (assert.ok(areApart(earlier, later), `${earlier}, ${later}`), later));
  assert.ok(!(timed > 0 && request.options?.['default_speed_m_per_s'] !== undefined), 'a speed beside times');
}

test('edits keep the rules of requests, and leave the old request as it was', () => {
  const random = new Random('edits');
  for (let round = 0; round < 200; ++round) {
    const path = random.path(4, 0);
    let request = random.request(2 + random.below(4));
    for (let step = 0; step < 20; ++step) {
      const old = request;
      const text = JSON.stringify(old);
      const index = random.below(request.keyframes.length + 1);
      const time_s = random.number(beginOf(path), endOf(path));
      const pose = { position: random.vector(), orientation: random.quaternion() };
      const results = [
        () => edits.withPose(request, index, pose),
        () => edits.withTime(request, index, time_s),
        () => edits.withTimes(request),
        () => edits.withoutTimes(request),
        () => edits.insertedAt(request, path, time_s),
        () => edits.insertedAfter(request, index - 1, pose),
        () => edits.withoutKeyframe(request, index),
        () => (isTimed(request) ? request : edits.withOption(request, ['default_speed_m_per_s'], random.number(0.1, 3))),
      ];
      const result = (results[random.below(results.length)] as (typeof results)[number])();
      if (!('refused' in result)) request = 'index' in result && 'request' in result ? (result as edits.Insertion).request : (result as PlanRequest);
      check(request);
      assert.equal(JSON.stringify(old), text);
    }
  }
});

test('a keyframe inserted on the path has its pose, and stands in the order of time', () => {
  const random = new Random('insert');
  for (let round = 0; round < 100; ++round) {
    const path = random.path(3, 0);
    const request = random.request(4);
    const time_s = random.number(0, endOf(path));
    const result = edits.insertedAt(request, path, time_s);
    assert.ok('index' in result);
    const inserted = result.request.keyframes[result.index];
    const pose = poseAt(path, time_s);
    assert.ok(inserted && pose);
    assert.deepEqual(inserted.position, pose.position);
    assert.deepEqual(inserted.orientation, pose.orientation);
    assert.equal(inserted.time, isTimed(request) ? time_s : undefined);
    assert.equal(result.index, timesOf(request).filter((time) => time < time_s).length);
    assert.deepEqual(accepted(edits.withoutKeyframe(result.request, result.index)), request);
  }
});

test('a second keyframe at the same time is refused', () => {
  const random = new Random('twice');
  const path = random.path(3, 0);
  const request = random.request(3, true);
  const time_s = request.keyframes[1]?.time as number;
  const result = edits.insertedAt(request, path, time_s);
  assert.ok('refused' in result);
  assert.match(result.refused, /there is a keyframe already/);
});

test('times stay in order, and the sentence names the neighbour', () => {
  const request = new Random('order').request(4, true);
  const after = request.keyframes[2]?.time as number;
  const result = edits.withTime(request, 1, after);
  assert.ok(edits.isRefusal(result));
  assert.match(result.refused, /^Keyframe 1 must be earlier than keyframe 2/);
  const begin = edits.withTime(request, 1, (request.keyframes[0]?.time as number) - 1);
  assert.ok(edits.isRefusal(begin) && /later than keyframe 0/.test(begin.refused));
});

test('a keyframe that is moved keeps its time and image, and is no longer called repaired', () => {
  const [first, second] = new Random('moved').request(2, true).keyframes;
  assert.ok(first && second);
  const request: PlanRequest = { keyframes: [{ ...first, image: [1, 0, 0, 0], repaired: true }, second] };
  const moved = edits.withPose(request, 0, { position: [1, 2, 3], orientation: [0, 1, 0, 0] });
  assert.deepEqual(moved.keyframes[0], { position: [1, 2, 3], orientation: [0, 1, 0, 0], time: first.time, image: [1, 0, 0, 0] });
  assert.equal(moved.keyframes[1], second);
  assert.equal(edits.withPose(request, 2, first), request);
});

test('the last two keyframes stay', () => {
  const request = new Random('two').request(2);
  const result = edits.withoutKeyframe(request, 0);
  assert.ok(edits.isRefusal(result));
});

test('times that are given are those that the path had, and go with the frame', () => {
  const random = new Random('timed');
  for (let round = 0; round < 50; ++round) {
    const request = edits.withOption(random.request(5, false), ['default_speed_m_per_s'], random.number(0.2, 4));
    const timed = edits.withTimes(request);
    assert.deepEqual(timesOf(timed), timesOf(request));
    assert.equal(edits.optionAt(timed, ['default_speed_m_per_s']), undefined);
    const framed: PlanRequest = { ...timed, frame: { reference: [1, 0, 0, 0] } };
    const free = edits.withoutTimes(framed);
    assert.equal('frame' in free, false);
    assert.equal(isTimed(free), false);
  }
});

test('an option that is set and reset leaves no trace', () => {
  const request = new Random('options').request(2);
  for (const path of [['seed'], ['limits', 'speed_m_per_s'], ['orientation', 'policy']]) {
    const set = edits.withOption(request, path, 3);
    assert.equal(edits.optionAt(set, path), 3);
    assert.equal(edits.withOption(set, path, 3), set);
    assert.deepEqual(edits.withOption(set, path, undefined), request);
    assert.equal(edits.withOption(request, path, undefined), request);
  }
  const two = edits.withOption(edits.withOption(request, ['limits', 'a'], 1), ['limits', 'b'], 2);
  assert.deepEqual(edits.withOption(two, ['limits', 'a'], undefined).options, { limits: { b: 2 } });
});

test('an answer is edited with its frame and the camera that was proved', () => {
  const request = edits.withOption(new Random('answer').request(2, false), ['default_speed_m_per_s'], 2);
  const keyframes = request.keyframes.map((keyframe, i) => ({ ...keyframe, time: i, origin: 'given' as const }));
  const answer = { status: 'ok' as const, message: '', segments: [], keyframes, collisions: [], remaining_collisions: [], near_scale: 0.5, frame: { reference: [1, 0, 0, 0] } };
  const edited = edits.withAnswer(request, answer);
  assert.deepEqual(edited.keyframes, keyframes);
  assert.deepEqual(edited.frame, answer.frame);
  assert.equal(edited.camera?.near, 0.075);
  check(edited);
});

test('a keyframe at the cursor is on the path that is shown, at the time before slowing', () => {
  const random = new Random('cursor');
  for (let round = 0; round < 100; ++round) {
    const request = edits.withTimes(random.request(3));
    const times = timesOf(request);
    const [begin, end] = [times[0] as number, times[2] as number];
    const factor = random.number(1, 3);
    const shown = random.path(4, begin);
    const scaled = (t: number): number => begin + ((t - begin) * factor * (end - begin)) / (endOf(shown) - begin);
    const segments = shown.map((segment) => ({ ...segment, t0: scaled(segment.t0), t1: scaled(segment.t1) }));
    const slowed = [{ t_begin: begin, t_end: endOf(segments), given: [begin, end] }];
    const keyframes = request.keyframes.map((given) => ({ ...given, time: begin + factor * ((given.time as number) - begin), origin: 'given' }));
    const answer = { segments, slowed, keyframes } as unknown as Answer;
    const given_s = random.number(begin, end);
    const cursor_s = begin + factor * (given_s - begin);
    const before = random.path(3, begin);
    const inserted = edits.insertedAtCursor(request, { answer, before }, cursor_s);
    if ('refused' in inserted) continue;
    const keyframe = inserted.request.keyframes[inserted.index];
    assert.deepEqual(keyframe?.position, poseAt(segments, cursor_s)?.position);
    assert.deepEqual(keyframe?.orientation, poseAt(segments, cursor_s)?.orientation);
    assert.ok(Math.abs((keyframe?.time ?? NaN) - given_s) < 1e-9 * (1 + Math.abs(given_s)));
  }
});

test('messages about times are rounded', () => {
  const request = { keyframes: [0, 1 / 3, 1].map((time) => ({ position: [0, 0, 0], orientation: [1, 0, 0, 0], time })) } as unknown as PlanRequest;
  assert.deepEqual(edits.withTime(request, 2, 0.1), { refused: 'Keyframe 2 must be later than keyframe 1 (0.333 s).' });
  const pose = { position: [0, 0, 0], orientation: [1, 0, 0, 0] } as never;
  assert.deepEqual(edits.insertedAt(request, [], 1 / 3, pose), { refused: 'At 0.333 s there is a keyframe already.' });
});
