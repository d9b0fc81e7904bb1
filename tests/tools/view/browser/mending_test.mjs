// SPDX-License-Identifier: MIT
// Nothing is lost: no edits when the connection drops or the page is loaded again, and no pose by a stray key.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import test, {after} from 'node:test';

import {browser, open_page as open_window} from './browser.mjs';
import {open_door, request_file, request_with, scene_file} from './programs.mjs';

const kSmall = {width: 960, height: 600};  // drawn sooner
const kToWall_m = 2.55;  // as in editing_test.mjs

const door = await open_door('--scene', scene_file('office'), '--request', request_file('office-wall-rooms'));
after(async () => {
  await browser.close();
  assert.equal(await door.end(), 0, door.output);
});

function open_page(url) {
  return open_window(url, {window: kSmall});
}

// One page for the tests that leave it with the request as it was: to load it is most of the work.
const shared = await open_page(door.url);

test('a socket that the door closes is opened again, and what was asked is answered', async () => {
  const page = shared;
  await page.ready();
  const given = (await page.state()).request.keyframes[0].position[0];
  await page.tab.keyboard.press('n');
  // The edit is made before the page has heard of the close, so its plan is lost with the socket.
  const closed = page.drop_socket();
  await page.tab.keyboard.press('Alt+PageUp');
  assert.equal(await closed, 1003);
  await page.until(() => window.sockets.length === 2 && window.sockets[1].readyState === WebSocket.OPEN);
  const edited = (await page.state()).request;
  await page.until(({state}) => state.connection === 'open' && !state.isPending && state.answer?.certificate?.certified);
  const {request, answer} = await page.state();
  assert.deepEqual(request, edited);
  assert.equal(request.keyframes[0].position[0], given);
  request.keyframes[0].position.forEach((x, i) => assert.ok(Math.abs(answer.keyframes[0].position[i] - x) < 1e-9));
  await page.tab.keyboard.press('Control+z');
  await page.until(({state}, edited) => state.request.keyframes[0].position[1] !== edited && state.answer && !state.isPending, edited.keyframes[0].position[1]);
});

test('while there is no connection the bar says so, and edits are kept and planned later', async () => {
  const page = shared;
  await page.ready();
  // Attempts to connect fail until the test allows them.
  await page.tab.evaluate(() => {
    const Real = window.WebSocket;
    window.allow = () => (window.WebSocket = Real);
    window.failures = 0;
    window.WebSocket = class extends Real {
      constructor() {
        super(`ws://${location.host}/v1/nowhere`);
        this.addEventListener('error', () => ++window.failures);
      }
    };
  });
  await page.drop_socket();
  await page.tab.locator('#status', {hasText: 'connection lost, trying again'}).waitFor();
  await page.tab.locator('#message', {hasText: 'The connection to camway is lost'}).waitFor();
  await page.tab.keyboard.press('n');
  await page.tab.keyboard.press('Alt+PageUp');
  const edited = (await page.state()).request;
  await page.until(() => window.failures > 0);
  await page.tab.evaluate(() => window.allow());
  await page.until(({state}) => state.connection === 'open' && !state.isPending && state.answer?.status === 'ok');
  assert.deepEqual((await page.state()).request, edited);
  await page.has_no(page.tab.locator('#status', {hasText: 'connection lost'}));
  await page.forgive(/nowhere/);
  await page.tab.keyboard.press('Control+z');
  await page.until(({state}) => state.request.keyframes.every(({position}) => Math.abs(position[1] - 5.1) < 1e-9));
  await page.until(({state}) => state.answer?.status === 'ok' && !state.isPending);
});

test('a near free pose is accepted by Enter, a far one by its own key, and undo brings the old one back', async () => {
  const page = shared;
  await page.ready();
  const {keyboard, mouse} = page.tab;
  const [x, y, z] = (await page.state()).request.keyframes[0].position;
  const [begin, in_wall] = [await page.place_of([x, y, z]), await page.place_of([x, y, z + kToWall_m])];
  await mouse.move(...begin);
  await mouse.down();
  await mouse.move(...in_wall, {steps: 3});
  await page.until(({state}) => state.answer?.keyframe_faults?.length > 0 && !state.isPending);
  // The hand still has it.
  const held = (await page.state()).request;
  await keyboard.press('Enter');
  assert.deepEqual((await page.state()).request, held);
  await mouse.up();
  const fault = await page.until(({state}) => !state.isPending && !state.isDraft && state.answer?.keyframe_faults?.[0]);
  const dropped = (await page.state()).request.keyframes[0];
  const away_m = Math.hypot(...fault.free_pose.position.map((x, i) => x - dropped.position[i]));
  await page.tab.locator('.labels [data-kind="free"]', {hasText: /^free, [\d.]+ m.* away: Enter$/}).waitFor();
  assert.ok(away_m < 1, `${away_m} m`);
  await keyboard.press('Enter');
  await page.until(({state}, to) => state.request.keyframes[0].position.every((x, i) => x === to[i]), fault.free_pose.position);
  await keyboard.press('Control+z');
  await page.until(({state}, to) => state.request.keyframes[0].position.every((x, i) => x === to[i]), dropped.position);
  await keyboard.press('Control+z');
  await page.until(({state}, to) => state.request.keyframes[0].position.every((x, i) => x === to[i]), [x, y, z]);
  await page.until(({state}) => !state.isPending && state.answer?.status === 'ok');
  await page.close();
});

test('a file that is chosen late is opened, too', async () => {
  const page = await open_page(door.url);
  await page.ready();
  // A dialog that stays open, while the browser tidies up its memory.
  await page.tab.evaluate(() => {
    HTMLInputElement.prototype.click = function() {
      window.picker = new WeakRef(this);
    };
  });
  await page.tab.keyboard.press('Control+o');
  await page.tab.evaluate(() => new Promise(done => setTimeout(done)));  // a WeakRef holds until the end of its task
  const session = await page.tab.context().newCDPSession(page.tab);
  await session.send('HeapProfiler.collectGarbage');
  assert.ok(await page.tab.evaluate(() => window.picker.deref() !== undefined), 'the browser has forgotten the dialog');
  await page.close();
});

test('an option that is refused is marked, and the path is still drawn', async () => {
  const refused = await open_door('--scene', scene_file('office'));
  const page = await open_page(refused.url);
  await page.ready();
  const [chooser] = await Promise.all([page.tab.waitForEvent('filechooser'), page.tab.keyboard.press('Control+o')]);
  const request = JSON.parse(fs.readFileSync(request_with('office-wall-rooms', {clearance_m: -1, chord_error_m: 0.01}), 'utf8'));
  await chooser.setFiles({name: 'wrong.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(request))});
  await page.until(({state}) => state.unplanned && state.before.length > 0);
  await page.show_panel('Options');
  const field = page.tab.locator('[data-key="clearance_m"]');
  await field.locator('xpath=..').getByText(/^Refused: it is -1; it must be from 0/).waitFor();
  assert.equal(await field.getAttribute('aria-invalid'), 'true');
  assert.equal(await page.tab.locator('[data-key="chord_error_m"]').getAttribute('aria-invalid'), null);
  await field.fill('0.01');
  await field.press('Enter');
  await page.until(({state}) => state.answer?.status === 'ok' && !state.isPending);
  await page.has_no(page.tab.getByText(/^Refused: /));
  await page.forgive(/400/);
  await page.close();
  assert.equal(await refused.end(), 0, refused.output);
});

test('a text that is being typed outlives a drawing of its panel', async () => {
  const page = await open_page(door.url);
  await page.ready();
  await page.show_panel('Options');
  const field = page.tab.locator('[data-key="clearance_m"]');
  for (const [typed, rest, left, value] of [['0.0', '2', 'Tab', 0.02], ['0.03', '', 'Tab', 0.03], ['0.0', '4', 'Enter', 0.04]]) {
    await field.fill(typed);
    const old = await field.elementHandle();
    await page.drop_socket();  // the panel is drawn anew, with the state of the connection
    await page.until(({state}, old) => state.connection === 'open' && !old.isConnected, old);
    assert.equal(await field.inputValue(), typed);
    await page.tab.keyboard.type(rest);
    await page.tab.keyboard.press(left);
    await page.until(({state}, value) => state.request.options?.clearance_m === value, value);
  }
  await page.close();
});

test('a page with an edit is loaded again, with the request that was planned last', async () => {
  const page = await open_page(door.url);
  await page.ready();
  await page.tab.keyboard.press('n');
  await page.tab.keyboard.press('Alt+PageUp');
  await page.until(({state}) => !state.isPending && state.answer?.status === 'ok');
  const {keyframes} = (await page.state()).request;
  const asked = [];
  page.tab.on('dialog', dialog => {
    asked.push(dialog.type());
    dialog.accept();
  });
  await page.tab.reload();
  await page.ready();
  assert.deepEqual(asked, ['beforeunload'], 'an edit that is not saved is asked for');
  assert.deepEqual((await page.state()).request.keyframes, keyframes);
  await page.close();
});
