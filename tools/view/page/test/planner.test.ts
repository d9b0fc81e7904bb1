// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Answer } from '../src/contract/answer.js';
import type { PlanRequest } from '../src/contract/request.js';
import { Planner } from '../src/door/planner.js';
import { DoorError, DoorLost } from '../src/door/socket.js';
import { isAnswered, kEmptyState, Store } from '../src/model/store.js';
import { Random } from './random.js';

type Message = Record<string, unknown>;

/** A socket whose questions are answered by hand, one after the other. */
class Socket {
  readonly asked: { done: (message: Message) => void; failed: (error: Error) => void }[] = [];
  readonly told: string[] = [];

  ask(): { id: number; answer: Promise<Message> } {
    const answer = new Promise<Message>((done, failed) => this.asked.push({ done, failed }));
    return { id: this.asked.length, answer };
  }

  tell(_: number, what: string): void {
    this.told.push(what);
  }
}

const settled = (): Promise<void> => new Promise((done) => setTimeout(done, 0));
const kOk = { status: 'ok', message: 'proved', certificate: { certified: true, clearance_lower_bound: 1 } } as unknown as Answer;

/** A page with an answer to its first request, and a second request that is being planned. */
async function planning(): Promise<{ store: Store; socket: Socket; planner: Planner; first: PlanRequest }> {
  const random = new Random('planner');
  const [first, second] = [random.request(3), random.request(3)];
  const store = new Store({ ...kEmptyState, connection: 'open', request: first });
  const socket = new Socket();
  const planner = new Planner(socket, store, () => Promise.resolve(random.path(3)));
  planner.plan(first, 'full');
  socket.asked[0]?.done({ answer: kOk });
  await settled();
  assert.ok(isAnswered(store.now) && store.now.answer?.status === 'ok');
  store.set({ request: second });
  planner.plan(second, 'full');
  assert.ok(!isAnswered(store.now), 'while it is planned, the answer is that of before');
  return { store, socket, planner, first };
}

test('a request that is refused, or cannot be asked, has no answer of an older one', async () => {
  for (const [error, words] of [[new DoorError('seed: above', 400), /^seed: above$/], [new DoorLost(), /when it is back/]] as const) {
    const { store, socket } = await planning();
    socket.asked[1]?.failed(error);
    await settled();
    assert.ok(!isAnswered(store.now) && store.now.answer === undefined);
    assert.match(store.now.unplanned, words);
    assert.ok(store.now.before.length > 0, 'the path as interpolated stays');
  }
});

test('an option that is refused does not keep the path from being drawn', async () => {
  const random = new Random('refused');
  const request: PlanRequest = { ...random.request(3), options: { clearance_m: -1, limits: { speed_m_per_s: -2 }, seed: 3 } };
  const store = new Store({ ...kEmptyState, connection: 'open', request });
  const asked: unknown[] = [];
  const path = random.path(2);
  const planner = new Planner(new Socket(), store, ({ options }) => {
    asked.push(options);
    if (options?.['clearance_m'] !== undefined) return Promise.reject(new DoorError('request: options.clearance_m: is -1; it must be from 0 to 1e+09', 400));
    if (options?.['limits'] !== undefined) return Promise.reject(new DoorError('request: options.limits.speed_m_per_s: is -2; it must be above 0', 400));
    return Promise.resolve(path);
  });
  planner.plan(request, 'full');
  await settled();
  assert.equal(store.now.before, path);
  assert.deepEqual(asked, [{ clearance_m: -1, limits: { speed_m_per_s: -2 }, seed: 3 }, { limits: { speed_m_per_s: -2 }, seed: 3 }, { seed: 3 }]);
});

test('planning that was cancelled leaves no answer of an older request, and a new plan brings one', async () => {
  const { store, socket, planner } = await planning();
  planner.cancel();
  socket.asked[1]?.done({ cancelled: true, answer: kOk });
  await settled();
  assert.deepEqual(socket.told, ['cancel']);
  assert.equal(store.now.answer, undefined);
  assert.match(store.now.unplanned, /cancelled/);
  planner.plan(store.now.request as PlanRequest, 'full');
  assert.equal(store.now.unplanned, '');
  socket.asked[2]?.done({ answer: kOk });
  await settled();
  assert.ok(isAnswered(store.now) && store.now.unplanned === '');
});

test('an answer stays where its own request was to be planned again, unless the scene changed', async () => {
  for (const isSceneChanged of [false, true]) {
    const { store, socket, planner } = await planning();
    socket.asked[1]?.done({ answer: kOk });
    await settled();
    if (isSceneChanged) store.set({ scene: { scene: { digest: 'other' } } as never });
    planner.plan(store.now.request as PlanRequest, 'full');
    planner.cancel();
    await settled();
    assert.equal(isAnswered(store.now), !isSceneChanged);
  }
});
