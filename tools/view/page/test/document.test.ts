// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { PlanRequest } from '../src/contract/request.js';
import { RequestDocument } from '../src/model/document.js';
import { insertedAfter, isRefusal, withOption, withoutKeyframe, withPose } from '../src/model/edits.js';
import { requestText } from '../src/model/request_file.js';
import { Random } from './random.js';

function randomEdit(random: Random, request: PlanRequest): PlanRequest {
  const index = random.below(request.keyframes.length);
  const pose = { position: random.vector(), orientation: random.quaternion() };
  switch (random.below(4)) {
    case 0:
      return withPose(request, index, pose);
    case 1:
      return insertedAfter(request, index, pose).request;
    case 2: {
      const next = withoutKeyframe(request, index);
      return isRefusal(next) ? request : next;
    }
    default:
      return withOption(request, ['limits', 'speed_m_per_s'], random.number() < 0.3 ? undefined : random.number(0, 5));
  }
}

test('undo and redo restore every state bit for bit', () => {
  const random = new Random('undo');
  for (let round = 0; round < 60; ++round) {
    const document = new RequestDocument(random.request(2 + random.below(5)), 'r.json');
    // The oracle: all texts of the history, and where in it the document is.
    let texts = [requestText(document.current)];
    let at = 0;
    for (let step = 0; step < 100; ++step) {
      const dice = random.below(10);
      if (dice < 3) assert.equal(document.undo(), at > 0 && (at--, true));
      else if (dice < 5) assert.equal(document.redo(), at + 1 < texts.length && (at++, true));
      else {
        const next = randomEdit(random, document.current);
        if (!document.apply(next)) continue;
        texts = [...texts.slice(0, at + 1), requestText(next)];
        ++at;
      }
      assert.equal(requestText(document.current), texts[at]);
      assert.equal(document.canUndo, at > 0);
      assert.equal(document.canRedo, at + 1 < texts.length);
    }
  }
});

test('the frames of a drag are one step', () => {
  const random = new Random('drag');
  const document = new RequestDocument(random.request(3), 'r.json');
  const first = requestText(document.current);
  const drag = (name: string): void => {
    for (let frame = 0; frame < 20; ++frame) {
      document.apply(withPose(document.current, 1, { position: random.vector(), orientation: random.quaternion() }), name);
    }
    document.endDrag();
  };
  drag('keyframe 1');
  const dragged = requestText(document.current);
  drag('keyframe 1');
  assert.notEqual(requestText(document.current), dragged);
  document.undo();
  assert.equal(requestText(document.current), dragged);
  document.undo();
  assert.equal(requestText(document.current), first);
  assert.equal(document.canUndo, false);
  document.redo();
  assert.equal(requestText(document.current), dragged);
});

test('a drag ends where something is undone: its name may be used again', () => {
  const random = new Random('again');
  const document = new RequestDocument(random.request(3), 'r.json');
  const moved = (): PlanRequest => withPose(document.current, 1, { position: random.vector(), orientation: random.quaternion() });
  document.apply(moved(), 'keyframe 1');
  document.apply(withOption(document.current, ['seed'], 2));
  document.apply(moved(), 'keyframe 1');
  document.undo();
  const text = requestText(document.current);
  document.apply(moved(), 'keyframe 1');
  document.undo();
  assert.equal(requestText(document.current), text);
});

test('the history is bounded, and by the number of keyframes, too', () => {
  const random = new Random('bound');
  const steps = (keyframes: number, edits: number): number => {
    const document = new RequestDocument(random.request(keyframes, false), 'r.json');
    const pose = { position: random.vector(), orientation: random.quaternion() };
    for (let i = 0; i < edits; ++i) document.apply(withPose(document.current, 0, { ...pose, position: [i, 0, 0] }));
    let count = 0;
    while (document.undo()) ++count;
    return count;
  };
  assert.equal(steps(2, 500), 200);
  assert.equal(steps(100_000, 30), 20);
});

test('a document is dirty until it is saved, and after undoing to what was saved it is not', () => {
  const random = new Random('dirty');
  const document = new RequestDocument(random.request(3), 'r.json');
  assert.equal(document.isDirty, false);
  document.apply(withOption(document.current, ['seed'], 3));
  assert.equal(document.isDirty, true);
  document.markSaved();
  assert.equal(document.isDirty, false);
  document.undo();
  assert.equal(document.isDirty, true);
  document.redo();
  assert.equal(document.isDirty, false);
});
